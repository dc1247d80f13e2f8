#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/contract/step_plan.hpp>
#include <ricochet/scene/semi_discrete.hpp>

#include "runners/kinds/stability/stability_tables.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

// A pulsation that the structure's fastest mode reaches at least, by Rayleigh's quotient of single dofs; 0: not known.
double fastest_at_least(const SemiDiscrete& problem) {
  if (!problem.inertia.assembled()) return 0;
  double most = 0;
  const Eigen::VectorXd K = problem.stiffness.diagonal(), M = problem.inertia.mass.diagonal();
  for (Eigen::Index i = 0; i < K.size(); ++i)
    if (M[i] > 0 && K[i] > 0) most = std::max(most, K[i] / M[i]);
  return std::sqrt(most);
}

}  // namespace

void compare_with_declared(const StepPlan& plan, const SemiDiscrete& problem, const OpenLimit& open,
                           CaseRecord& record) {
  // What a scheme declares holds without viscosity.
  if (problem.damping.stiffness != 0 || problem.damping.mass != 0) return;
  const std::optional<double>& declared = plan.facts.stability_limit;
  const std::string declares = declared ? fmt::format("h·ω ≤ {:.6g}", *declared) : std::string("no limit on the step");
  const double product = open.step ? *open.step * open.pulsation : open.last * fastest_at_least(problem);
  const bool agrees = !open.step  ? !declared || open.unstable || product <= *declared * (1 + limit_tolerance)
                      : !declared ? open.pulsation == 0
                                  : open.pulsation == 0 || std::abs(product / *declared - 1) <= limit_tolerance;
  if (agrees) return;
  put_measure(record, "undeclared_limit", product);
  record.notes.push_back(fmt::format(
      "open: the scheme declares {}; it is stable up to h·ω = {:.4g}{}: an error of the method's facts, which "
      "`ricochet check` measures",
      declares, product, open.step ? "" : ", at least"));
}

}  // namespace ricochet
