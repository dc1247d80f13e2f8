#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <ricochet/kernels/eigenvalues.hpp>

#include "runners/check/mass_checks.hpp"

namespace ricochet::checking {
namespace {

Eigen::MatrixXd matrix(const Mass& mass, const SpaceBench& bench) {
  const FiniteElementSpace space = unit_space(bench);
  return dense(built(mass, space), space);
}

// 2 T of a translation of the free nodes with 1 m/s.
double translated(const Mass& mass, const SpaceBench& bench) {
  const Eigen::MatrixXd M = matrix(mass, bench);
  Eigen::VectorXd rigid = Eigen::VectorXd::Ones(M.rows());
  if (bench.beam)
    for (Eigen::Index i = 1; i < rigid.size(); i += 2) rigid[i] = 0;
  return rigid.dot(M * rigid);
}

// The same matrix seen from the other end: nodes in reverse order, slopes with the other sign.
Eigen::MatrixXd mirrored(const Eigen::MatrixXd& M, bool beam) {
  const Eigen::Index n = M.rows(), per_node = beam ? 2 : 1;
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index node = i / per_node, part = i % per_node;
    P(i, n - (node + 1) * per_node + part) = part == 0 ? 1 : -1;
  }
  return P * M * P.transpose();
}

// The first three pulsations, by compliances so that kernels do no harm.
std::array<double, 3> pulsations_of(const Mass& mass, const SpaceBench& bench) {
  const Eigen::MatrixXd M = matrix(mass, bench), K = unit_stiffness(unit_space(bench));
  const Eigen::VectorXd mu = symmetric_modes(0.5 * (M + M.transpose()), K, EigenVectors::none).values;
  std::array<double, 3> found{};
  for (std::size_t k = 0; k < 3; ++k) found[k] = 1 / std::sqrt(mu[mu.size() - 1 - static_cast<Eigen::Index>(k)]);
  return found;
}

std::array<double, 3> exact_pulsations(const SpaceBench& bench) {
  if (!bench.beam) return {0.5 * std::numbers::pi, 1.5 * std::numbers::pi, 2.5 * std::numbers::pi};
  // Roots of cos β cosh β = −1.
  constexpr std::array<double, 3> beta = {1.8751040687119611, 4.6940911329741746, 7.8547574382376126};
  return {beta[0] * beta[0], beta[1] * beta[1], beta[2] * beta[2]};
}

struct Astray {
  std::string sentence;
};

// The orders of the first three frequencies, "beam order 4.0, …"; throws Broken where one does not converge.
std::string frequency_orders(const Mass& mass, SpaceBench bench) {
  const std::array<double, 3> exact = exact_pulsations(bench);
  std::array<std::array<double, 3>, 3> errors{};
  for (std::size_t level = 0; level < 3; ++level) {
    bench.elements = 8 << level;
    const std::array<double, 3> here = pulsations_of(mass, bench);
    for (std::size_t k = 0; k < 3; ++k) errors[level][k] = std::abs(here[k] / exact[k] - 1);
  }
  std::string orders;
  for (std::size_t k = 0; k < 3; ++k) {
    const double order = std::log2(errors[1][k] / std::max(errors[2][k], 1e-15));
    constexpr double round_off = 1e-7;  // of eigenvalues of a bending stiffness at 32 elements
    if (!(errors[2][k] < round_off || (order > 0.5 && errors[2][k] < 0.2)))
      throw Astray{
          fmt::format("the {} of a {}{} does not converge: relative errors {:.3g}, {:.3g}, {:.3g} with 8, 16 "
                      "and 32 elements",
                      std::array{"first frequency", "second frequency", "third frequency"}[k],
                      bench.beam ? "cantilever beam" : "bar",
                      bench.stops == SpaceBench::Stops::none ? "" : " with a stop at its free end", errors[0][k],
                      errors[1][k], errors[2][k])};
    orders += (k ? ", " : "") + (errors[2][k] < round_off ? std::string("exact") : fmt::format("{:.1f}", order));
  }
  return std::string(bench.beam ? "beam" : "bar") + " order " + orders;
}

}  // namespace

Verdict total_mass_is_right(const Mass& mass) {
  std::string found;
  for (SpaceBench bench : accepted(mass, 8)) {
    // Fixed nodes take mass with them in proportion to the element: the limit is what counts.
    const double coarse = translated(mass, bench);
    const bool free = !bench.left_fixed && !bench.right_fixed;
    bench.elements = 16;
    const double fine_one = translated(mass, bench), total = free ? coarse : 2 * fine_one - coarse;
    const double tolerance = free ? 1e-9 : 5e-3;
    if (!(std::abs(total - 1) <= tolerance))
      return fails(fmt::format("{}: a translation moves {:.6g} kg of 1 kg{}", space_text(bench), total,
                               free ? "" : " in the limit of fine meshes"));
    const double without = fine_one;
    bench.point_mass = true;
    const double added = translated(mass, bench) - without;
    if (std::abs(added - 0.3) > 1e-9)
      return fails(fmt::format("{}: a point mass of 0.3 kg adds {:.6g} kg", space_text(bench), added));
    found = "that of the structure, point masses included";
  }
  return found.empty() ? not_applicable("every structure with elements is refused") : fine(found);
}

Verdict ends_are_treated_alike(const Mass& mass) {
  const std::vector<SpaceBench> all = accepted(mass, 7);
  int compared = 0;
  for (const SpaceBench& bench : all) {
    SpaceBench other = bench;
    std::swap(other.left_fixed, other.right_fixed);
    const bool there = std::any_of(all.begin(), all.end(), [&](const SpaceBench& candidate) {
      return candidate.beam == other.beam && candidate.left_fixed == other.left_fixed &&
             candidate.right_fixed == other.right_fixed && candidate.stops == other.stops;
    });
    if (!there) return fails(space_text(bench) + " is accepted, its mirror image is refused");
    const Eigen::MatrixXd M = matrix(mass, bench), N = mirrored(matrix(mass, other), bench.beam);
    const double gap = (M - N).cwiseAbs().maxCoeff(), size = M.cwiseAbs().maxCoeff();
    if (gap > 1e-10 * size)
      return fails(fmt::format("{} and its mirror image have masses that differ by {:.3g} of {:.3g} kg",
                               space_text(bench), gap, size));
    ++compared;
  }
  return compared == 0 ? not_applicable("every structure with elements is refused")
                       : fine("a mirrored structure has the mirrored matrix");
}

Verdict frequencies_converge(const Mass& mass) {
  std::string found;
  const auto add = [&](const std::string& text) { found += (found.empty() ? "" : "; ") + text; };
  for (const bool beam : {false, true}) {
    std::string without;
    for (const auto stops : {SpaceBench::Stops::none, SpaceBench::Stops::ends}) {
      const SpaceBench bench{beam, 8, beam, !beam, false, stops};
      if (std::holds_alternative<Refusal>(ask_mass(mass, unit_space(bench)))) continue;
      try {
        const std::string orders = frequency_orders(mass, bench);
        if (stops == SpaceBench::Stops::none)
          add(without = orders);
        else if (orders != without)
          add(orders + " with a stop at its free end");
      } catch (const Astray& astray) {
        return fails(astray.sentence);
      }
    }
  }
  return found.empty() ? not_applicable("every structure with elements is refused") : fine(found);
}

}  // namespace ricochet::checking
