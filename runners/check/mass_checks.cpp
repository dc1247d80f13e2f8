#include "runners/check/mass_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <ricochet/kernels/eigenvalues.hpp>
#include <ricochet/scene/assembly.hpp>

namespace ricochet::checking {

namespace {

constexpr int elements = 6;

// Of one unit: slopes counted in rad per element length, so that eigenvalues compare.
Eigen::MatrixXd scaled(Eigen::MatrixXd M, const SpaceBench& bench) {
  if (!bench.beam) return M;
  Eigen::VectorXd unit = Eigen::VectorXd::Ones(M.rows());
  const std::vector<DofPlace> places = dof_places(unit_space(bench));
  for (Eigen::Index i = 0; i < unit.size(); ++i)
    if (places[static_cast<std::size_t>(i)].slope) unit[i] = bench.elements;
  return unit.asDiagonal() * M * unit.asDiagonal();
}

// Every structure that is accepted, and what is found there.
Verdict everywhere(const Mass& mass, std::string (*wrong)(const Inertia&, const Eigen::MatrixXd&, std::string& found)) {
  std::string found;
  int count = 0;
  std::vector<SpaceBench> all = accepted(mass, elements);
  for (const SpaceBench& bench : accepted_pinned(mass, elements)) all.push_back(bench);
  for (SpaceBench bench : all)
    for (const bool uneven : {false, true}) {
      bench.point_mass = bench.point_inertia = bench.rotary = bench.uneven = uneven;
      FiniteElementSpace space = unit_space(bench);
      if (uneven && std::holds_alternative<Refusal>(ask_mass(mass, space))) {
        bench.rotary = false;
        space = unit_space(bench);
      }
      const Inertia inertia = built(mass, space);
      if (std::string sentence = wrong(inertia, scaled(dense(inertia, space), bench), found); !sentence.empty())
        return fails(space_text(bench) + ": " + sentence);
      ++count;
    }
  return count == 0 ? not_applicable("every structure with elements is refused") : fine(found);
}

}  // namespace

Verdict some_structure_is_accepted(const Mass& mass) {
  std::string last;
  int taken = 0;
  for (const int count : {1, 2, 3, elements})
    for (const bool beam : {false, true})
      for (const bool left : {true, false})
        for (const bool right : {false, true})
          for (const auto stops : stops_of(left && right)) {
            const SpaceBench bench{beam, count, left, right, false, stops};
            const FiniteElementSpace space = unit_space(bench);
            if (space.dofs == 0) continue;
            const InertiaOrRefusal answer = ask_mass(mass, space);
            const auto* refusal = std::get_if<Refusal>(&answer);
            if (!refusal) {
              dense(std::get<Inertia>(answer), space);
              ++taken;
              continue;
            }
            last = refusal->sentence.text;
            if (std::string poor = poor_refusal(last, mass.entry->manual); !poor.empty())
              return fails(space_text(bench) + ": " + poor);
          }
  const InertiaOrRefusal oscillator = ask_mass(mass, oscillator_space());
  if (const auto* refusal = std::get_if<Refusal>(&oscillator)) {
    if (std::string poor = poor_refusal(refusal->sentence.text, mass.entry->manual); !poor.empty())
      return fails("an oscillator: " + poor);
  } else {
    const Eigen::MatrixXd M = dense(std::get<Inertia>(oscillator), oscillator_space());
    if (!(std::abs(M(0, 0) - 1) <= 1e-12))
      return fails(fmt::format("the mass of an oscillator of 1 kg is {:g} kg", M(0, 0)));
    ++taken;
  }
  if (taken == 0) return fails("refuses every structure: " + last);
  return fine(last.empty() ? "nothing is refused" : last);
}

Verdict matrix_is_symmetric(const Mass& mass) {
  return everywhere(mass, [](const Inertia&, const Eigen::MatrixXd& M, std::string&) -> std::string {
    const double gap = (M - M.transpose()).cwiseAbs().maxCoeff(), size = M.cwiseAbs().maxCoeff();
    if (gap <= 1e-13 * size) return {};
    return fmt::format("the matrix is not symmetric: entries that should agree differ by {:.3g} of {:.3g}", gap, size);
  });
}

Verdict matrix_is_semidefinite(const Mass& mass) {
  return everywhere(mass, [](const Inertia&, const Eigen::MatrixXd& M, std::string&) -> std::string {
    const Eigen::VectorXd values = symmetric_modes(0.5 * (M + M.transpose()), EigenVectors::none).values;
    const double largest = values[values.size() - 1];
    if (!(largest > 0)) return "no motion has a kinetic energy";
    if (values[0] >= -1e-12 * largest) return {};
    return fmt::format("a motion has a negative kinetic energy: the least eigenvalue is {:.3g} times the largest",
                       values[0] / largest);
  });
}

Verdict kernel_as_declared(const Mass& mass) {
  return everywhere(mass, [](const Inertia& inertia, const Eigen::MatrixXd& M, std::string& found) -> std::string {
    const Eigen::VectorXd values = singular_values(M);
    const auto kernel = static_cast<int>((values.array() <= 1e-11 * values[0]).count());
    found = inertia.kernel_dimension > 0 ? "singular, as declared" : "regular, as declared";
    if (kernel == inertia.kernel_dimension) return {};
    return fmt::format("declares a kernel of dimension {}, its matrix has {}", inertia.kernel_dimension, kernel);
  });
}

namespace {

Eigen::MatrixXd matrix(const Mass& mass, const SpaceBench& bench) {
  const FiniteElementSpace space = unit_space(bench);
  return dense(built(mass, space), space);
}

// 2 T of a translation of the free nodes with 1 m/s.
double translated(const Mass& mass, const SpaceBench& bench) {
  const Eigen::MatrixXd M = matrix(mass, bench);
  Eigen::VectorXd rigid = Eigen::VectorXd::Ones(M.rows());
  const std::vector<DofPlace> places = dof_places(unit_space(bench));
  for (Eigen::Index i = 0; i < rigid.size(); ++i)
    if (places[static_cast<std::size_t>(i)].slope) rigid[i] = 0;
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
std::array<double, 3> slowest(const Eigen::MatrixXd& M, const Eigen::MatrixXd& K) {
  const Eigen::VectorXd mu = symmetric_modes(0.5 * (M + M.transpose()), K, EigenVectors::none).values;
  std::array<double, 3> found{};
  for (std::size_t k = 0; k < 3; ++k) found[k] = 1 / std::sqrt(mu[mu.size() - 1 - static_cast<Eigen::Index>(k)]);
  return found;
}

// Closed forms of even structures; of uneven ones what a fine mesh of the consistent mass has.
std::array<double, 3> exact_pulsations(SpaceBench bench) {
  if (bench.uneven) {
    bench.elements = 96;
    const FiniteElementSpace space = unit_space(bench);
    return slowest(Eigen::MatrixXd(consistent_mass(space)), unit_stiffness(space));
  }
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
    const std::array<double, 3> here = slowest(matrix(mass, bench), unit_stiffness(unit_space(bench)));
    for (std::size_t k = 0; k < 3; ++k) errors[level][k] = std::abs(here[k] / exact[k] - 1);
  }
  std::string orders;
  for (std::size_t k = 0; k < 3; ++k) {
    const double order = std::log2(errors[1][k] / std::max(errors[2][k], 1e-15));
    constexpr double round_off = 1e-7;  // of eigenvalues of a bending stiffness at 32 elements
    // An order of unequal elements is not regular: errors may pass through 0.
    const bool tends =
        bench.uneven ? errors[2][k] < std::max(5e-3, 0.5 * errors[0][k]) : order > 0.5 && errors[2][k] < 0.2;
    if (!(errors[2][k] < round_off || tends))
      throw Astray{fmt::format(
          "the {} of a {}{}{} does not converge: relative errors {:.3g}, {:.3g}, {:.3g} with 8, 16 "
          "and 32 elements",
          std::array{"first frequency", "second frequency", "third frequency"}[k],
          bench.beam ? "cantilever beam" : "bar", bench.uneven ? " of unequal elements and two sections" : "",
          bench.stops == SpaceBench::Stops::none ? "" : " with a stop at its free end", errors[0][k], errors[1][k],
          errors[2][k])};
    orders += (k ? ", " : "") + (errors[2][k] < round_off ? std::string("exact") : fmt::format("{:.1f}", order));
  }
  return std::string(bench.beam ? "beam" : "bar") + " order " + orders;
}

}  // namespace

Verdict total_mass_is_right(const Mass& mass) {
  std::string found;
  std::vector<SpaceBench> all = accepted(mass, 8);
  for (const SpaceBench& bench : accepted_pinned(mass, 8)) all.push_back(bench);
  for (const SpaceBench& accepted_bench : all)
    for (const bool uneven : {false, true}) {
      SpaceBench bench = accepted_bench;
      bench.uneven = uneven;
      // Fixed nodes take mass with them in proportion to the element: the limit is what counts.
      const double coarse = translated(mass, bench);
      const bool free = !bench.left_fixed && !bench.right_fixed;
      bench.elements = 16;
      const double fine_one = translated(mass, bench), total = free ? coarse : 2 * fine_one - coarse;
      const double tolerance = free ? 1e-9 : uneven ? 3e-2 : 5e-3, expected = mass_of(unit_space(bench));
      if (!(std::abs(total - expected) <= tolerance * expected))
        return fails(fmt::format("{}: a translation moves {:.6g} kg of {:.6g} kg{}", space_text(bench), total, expected,
                                 free ? "" : " in the limit of fine meshes"));
      bench.point_mass = true;
      const double added = translated(mass, bench) - fine_one;
      if (!(std::abs(added - 0.3) <= 1e-9))
        return fails(fmt::format("{}: a point mass of 0.3 kg adds {:.6g} kg", space_text(bench), added));
      found = "that of the structure, of equal and unequal elements and sections, point masses included";
    }
  return found.empty() ? not_applicable("every structure with elements is refused") : fine(found);
}

namespace {

// 2 T of a rotation of the free nodes with 1 rad/s about the left end.
double turned(const Mass& mass, const SpaceBench& bench) {
  const FiniteElementSpace space = unit_space(bench);
  const std::vector<DofPlace> places = dof_places(space);
  Eigen::VectorXd rigid(space.dofs);
  for (Eigen::Index i = 0; i < rigid.size(); ++i) {
    const DofPlace& place = places[static_cast<std::size_t>(i)];
    rigid[i] = place.slope ? 1 : place.x;
  }
  return rigid.dot(dense(built(mass, space), space) * rigid);
}

bool refuses(const Mass& mass, const SpaceBench& bench) {
  return std::holds_alternative<Refusal>(ask_mass(mass, unit_space(bench)));
}

}  // namespace

Verdict rotations_have_their_inertia(const Mass& mass) {
  std::string found;
  for (SpaceBench bench : accepted(mass, 8)) {
    // A rotation about the left end, which a fixed right end would not make.
    if (!bench.beam || bench.right_fixed) continue;
    bench.uneven = true;
    const double without = turned(mass, bench);
    bench.point_inertia = true;
    if (!refuses(mass, bench)) {
      const double added = turned(mass, bench) - without;
      if (!(std::abs(added - 0.05) <= 1e-9))
        return fails(
            fmt::format("{}: a point inertia of 0.05 kg m² adds {:.6g} to a rotation", space_text(bench), added));
      found = "point inertias are added whole";
    }
    bench.point_inertia = false;
    bench.rotary = true;
    if (refuses(mass, bench)) continue;
    // A diagonal takes a part of it.
    const double added = turned(mass, bench) - without, expected = rotary_of(unit_space(bench));
    if (!(added >= -1e-9 && added <= 1.05 * expected))
      return fails(fmt::format("{}: the sections add {:.6g} kg m² to a rotation, of {:.6g}", space_text(bench), added,
                               expected));
    found = fmt::format("point inertias are added whole, of the sections' {:.2g}", added / expected);
  }
  return found.empty() ? not_applicable("every beam is refused") : fine(found);
}

Verdict ends_are_treated_alike(const Mass& mass) {
  const std::vector<SpaceBench> all = accepted(mass, 7);
  int compared = 0;
  for (SpaceBench bench : all) {
    bench.uneven = true;
    SpaceBench other = bench;
    other.mirrored = true;
    std::swap(other.left_fixed, other.right_fixed);
    const bool there = std::any_of(all.begin(), all.end(), [&](const SpaceBench& candidate) {
      return candidate.beam == other.beam && candidate.left_fixed == other.left_fixed &&
             candidate.right_fixed == other.right_fixed && candidate.stops == other.stops;
    });
    if (!there) return fails(space_text(bench) + " is accepted, its mirror image is refused");
    const Eigen::MatrixXd M = matrix(mass, bench), N = mirrored(matrix(mass, other), bench.beam);
    const double gap = (M - N).cwiseAbs().maxCoeff(), size = M.cwiseAbs().maxCoeff();
    if (!(gap <= 1e-10 * size))
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
        SpaceBench uneven = bench;
        uneven.uneven = true;
        frequency_orders(mass, uneven);
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
