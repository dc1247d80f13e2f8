#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/kernels/eigenvalues.hpp>

#include "runners/check/mass_checks.hpp"

namespace ricochet::checking {
namespace {

constexpr int elements = 6;

// Of one unit: slopes counted in rad per element length, so that eigenvalues compare.
Eigen::MatrixXd scaled(Eigen::MatrixXd M, const SpaceBench& bench) {
  if (!bench.beam) return M;
  Eigen::VectorXd unit = Eigen::VectorXd::Ones(M.rows());
  for (Eigen::Index i = 1; i < unit.size(); i += 2) unit[i] = bench.elements;
  return unit.asDiagonal() * M * unit.asDiagonal();
}

// Every structure that is accepted, and what is found there.
Verdict everywhere(const Mass& mass, std::string (*wrong)(const Inertia&, const Eigen::MatrixXd&, std::string& found)) {
  std::string found;
  int count = 0;
  for (SpaceBench bench : accepted(mass, elements))
    for (const bool point : {false, true}) {
      bench.point_mass = point;
      const FiniteElementSpace space = unit_space(bench);
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
            last = refusal->sentence;
            if (std::string poor = poor_refusal(last, mass.entry->manual); !poor.empty())
              return fails(space_text(bench) + ": " + poor);
          }
  const InertiaOrRefusal oscillator = ask_mass(mass, oscillator_space());
  if (const auto* refusal = std::get_if<Refusal>(&oscillator)) {
    if (std::string poor = poor_refusal(refusal->sentence, mass.entry->manual); !poor.empty())
      return fails("an oscillator: " + poor);
  } else {
    const Eigen::MatrixXd M = dense(std::get<Inertia>(oscillator), oscillator_space());
    if (std::abs(M(0, 0) - 1) > 1e-12)
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

}  // namespace ricochet::checking
