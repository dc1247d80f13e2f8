#include <fmt/format.h>

#include <cmath>
#include <ricochet/engine/indefinite_step.hpp>
#include <ricochet/kernels/sparse_ldlt.hpp>
#include <utility>

namespace ricochet {

namespace {

[[noreturn]] void blame_indefinite(const IndefiniteMatrix& found, const std::string& matrix,
                                   const OperatorWeights& weights, const SemiDiscrete& problem) {
  using Of = IndefiniteStep::Of;
  const std::string what = fmt::format("{} is indefinite, as {} shows: ", matrix, found.where);
  std::string negative;
  for (const auto& [name, weight] : {std::pair("M", weights.M), {"C", weights.C}, {"K", weights.K}})
    if (weight < 0) negative += fmt::format("{}{} by {:g}", negative.empty() ? "" : ", ", name, weight);
  if (!negative.empty())
    throw IndefiniteStep(Of::scheme, what + "the plan weighs " + negative + ", where no matrix is negative");
  throw IndefiniteStep(Of::structure, what + (problem.damping.matrix ? "C" : "a matrix") +
                                          " of the structure is negative along some motion. Correct it, or use a "
                                          "smaller step");
}

}  // namespace

OperatorOrRefusal definite_operator(const Program& whole, const FoldedStage& folded, int lanes, const char* name,
                                    const OperatorWeights& weights) {
  try {
    return make_operator(whole.kind, *whole.model, folded, lanes);
  } catch (const IndefiniteMatrix& found) {
    blame_indefinite(found, name, weights, *whole.problem);
  }
}

void check_stiffness_of_law(const SemiDiscrete& problem) {
  constexpr double round_off = 1e-10;  // of a diagonal that all but cancels
  SparseLdlt ldlt;
  if (!problem.changed_by_law() || !ldlt.factorise(problem.stiffness)) return;
  for (std::size_t i = 0; i < ldlt.pivot().size(); ++i)
    if (ldlt.pivot()[i] < -round_off * std::abs(problem.stiffness.coeff(ldlt.order()[i], ldlt.order()[i])))
      throw IndefiniteStep(IndefiniteStep::Of::law,
                           fmt::format("S is indefinite: the stiffness that the law leaves is negative along some "
                                       "motion, as pivot {} of {} shows",
                                       i + 1, ldlt.size()));
}

}  // namespace ricochet
