#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/contract/stage_facts.hpp>
#include <ricochet/contract/unit_mass.hpp>

/// \file
/// What momentum an effort finally gives to a free mass.
namespace ricochet {
namespace {

using namespace free_motion;

// Marches a mass, under one effort of 1 N, until its velocity stays. The effort is found by stage `source` of the first
// step; a negative `source` is a stage of the start rule.
double settled_momentum(const StepPlan& plan, UnitMass mass, const StageEfforts& efforts, std::ptrdiff_t source) {
  constexpr int most_steps = 4096;
  const auto stages = static_cast<std::ptrdiff_t>(plan.stages.size());
  double speed = combined(plan.velocity, mass.slots), largest_change = std::abs(speed);
  int quiet = 0;
  for (int n = 0; n < most_steps && quiet < 4 + most_efforts; ++n) {
    for (std::ptrdiff_t k = 0; k < stages; ++k) {
      const std::ptrdiff_t back = n * stages + k - source;
      const auto& [weights, impulse] = efforts[static_cast<std::size_t>(k)];
      const bool acts = back >= 0 && back < static_cast<std::ptrdiff_t>(weights.size());
      const Stage& stage = plan.stages[static_cast<std::size_t>(k)];
      const double w = back == 0 ? UnitMass::jump(stage, impulse) : 0.0;
      mass.update(stage, mass.unknown(stage, 0, acts ? weights[static_cast<std::size_t>(back)] : 0.0, w), w);
    }
    const double now = combined(plan.velocity, mass.slots), change = std::abs(now - speed);
    largest_change = std::max(largest_change, change);
    quiet = change <= 1e-14 * largest_change ? quiet + 1 : 0;
    speed = now;
  }
  return quiet > 0 || largest_change == 0 ? speed : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

StageEfforts stage_efforts(const std::vector<Stage>& stages, const std::optional<Evaluation>& evaluation) {
  StageEfforts efforts;
  for (const Stage& stage : stages) {
    efforts.emplace_back();
    const auto reads = [&](const auto& measure) {
      if (measure) efforts.back() = {measure->effort, stage.impulse ? measure->impulse : 0.0};
    };
    if (evaluation)
      reads(stage.at(*evaluation));
    else
      reads(stage.impact);
  }
  return efforts;
}

std::vector<double> momentum_weights(const StepPlan& plan, const StageEfforts& efforts) {
  const std::size_t stages = plan.stages.size();
  if (!has_inertia(plan)) return std::vector<double>(stages, std::numeric_limits<double>::quiet_NaN());
  const double h = Uniform(plan).h();
  std::vector<double> weights;
  for (std::size_t source = 0; source < stages; ++source)
    weights.push_back(
        h * simple(settled_momentum(plan, UnitMass(plan, 0, 0), efforts, static_cast<std::ptrdiff_t>(source)) / h));
  return weights;
}

double start_momentum(const StepPlan& plan, std::size_t stage, const StageEfforts& start, const StageEfforts& efforts) {
  if (!has_inertia(plan)) return std::numeric_limits<double>::quiet_NaN();
  UnitMass mass(plan, 0, 0);
  for (std::size_t k = 0; k < plan.start.size(); ++k) {
    const bool acts = k >= stage && k - stage < start[k].weights.size();
    const double w = k == stage ? UnitMass::jump(plan.start[k], start[k].impulse) : 0.0;
    mass.update(plan.start[k], mass.unknown(plan.start[k], 0, acts ? start[k].weights[k - stage] : 0.0, w), w);
  }
  const double h = Uniform(plan).h();
  const auto source = static_cast<std::ptrdiff_t>(stage) - static_cast<std::ptrdiff_t>(plan.start.size());
  return h * simple(settled_momentum(plan, mass, efforts, source) / h);
}

}  // namespace ricochet
