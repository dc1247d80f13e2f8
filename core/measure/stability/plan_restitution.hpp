#pragma once
#include <optional>
#include <ricochet/contract/step_plan.hpp>

namespace ricochet {

/// The restitution coefficient e of a scheme at rigid stops, −v⁺/v⁻ of a free unit mass thrown at one. Without forces
/// this is what the scheme restitutes, exactly and at any step. Nothing for plans without an impact measure, or whose
/// measure no effort can move. Compliant laws rebound by themselves: this says nothing of them.
std::optional<double> plan_restitution(const StepPlan& plan, double h);

/// The same over the phases at which the mass may meet its stop within a step.
struct RestitutionRange {
  double least = 0, mean = 0, most = 0;
};
std::optional<RestitutionRange> restitution_range(const StepPlan& plan, double h);

}  // namespace ricochet
