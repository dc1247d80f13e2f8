#include "runners/march/explicit_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/measure/stability/stability.hpp>

namespace ricochet {
namespace {

bool explicit_step(const StepPlan& plan) {
  return std::all_of(plan.stages.begin(), plan.stages.end(), [](const Stage& stage) { return stage.matrix.K == 0; });
}

}  // namespace

std::string beyond_explicit_limit(const std::shared_ptr<const SemiDiscrete>& problem, const StepPlan& plan, double h,
                                  const std::function<PlanOrRefusal(double)>& plan_at) {
  if (!explicit_step(plan)) return {};
  LinearLaw open;
  open.absent = true;
  const StabilityPredictor predictor(problem, open);
  const auto radius_of = [&](const StepPlan& step, double length) -> std::optional<double> {
    const auto spectrum = predictor.open(step, length, Detail::radius);
    const auto* known = std::get_if<StepSpectrum>(&spectrum);
    return known ? std::optional(known->radius) : std::nullopt;
  };
  const auto radius = radius_of(plan, h);
  if (!radius || *radius <= 1 + growth_tolerance) return {};
  // The largest stable step lies below h; twelve decades below it there is none.
  double stable = 0, grows = h;
  const auto is_stable = [&](double length) {
    const PlanOrRefusal made = plan_at(length);
    const auto* step = std::get_if<StepPlan>(&made);
    const auto found = step ? radius_of(*step, length) : std::nullopt;
    return found && *found <= 1 + growth_tolerance;
  };
  for (double length = h / 2; length > 1e-12 * h && stable == 0; length /= 2)
    if (is_stable(length))
      stable = length;
    else
      grows = length;
  constexpr int halvings = 20;
  for (int k = 0; k < halvings && stable > 0; ++k) {
    const double middle = 0.5 * (stable + grows);
    (is_stable(middle) ? stable : grows) = middle;
  }
  const std::string remedy =
      stable > 0 ? fmt::format(
                       "its largest stable step there is {:.5g} s: use a smaller step, a mass with lower highest "
                       "frequencies, or an implicit scheme",
                       stable)
                 : std::string("no smaller step is stable either: use an implicit scheme");
  return fmt::format(
      "the step of {:.5g} s is beyond the limit of an explicit scheme on this structure, whose free motion grows "
      "{:.4g} "
      "times per step: {}",
      h, *radius, remedy);
}

}  // namespace ricochet
