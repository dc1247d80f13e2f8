#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/contract/stage_facts.hpp>
#include <ricochet/contract/unit_mass.hpp>

namespace ricochet {
namespace {

using namespace free_motion;

// The first thing that is wrong with one stage's levels and measures on a motion at constant speed.
std::string wrong_stage(const Stage& stage, const Uniform& motion, const std::string& name) {
  constexpr double tolerance = 1e-6;  // levels written as decimals
  std::string wrong;
  const auto near = [&](double a, double b) { return std::abs(a - b) <= tolerance * std::max(1.0, std::abs(b)); };
  const auto stands = [&](const Levels& levels, const Combination& c, const char* what) {
    if (levels.empty() || !wrong.empty()) return;
    double weight = 0, moment = 0;
    for (const Level& level : levels) {
      weight += level.weight;
      moment += level.weight * level.at;
    }
    if (!near(weight, motion.weight(c)))
      wrong = fmt::format("{}: {} weights its levels to {:g}, what it bounds weights positions to {:g}", name, what,
                          weight, motion.weight(c));
    else if (!near(moment, motion.moment(c)))
      wrong = fmt::format("{}: {} stands at t + {:g}h on a motion at constant speed, what it bounds at t + {:g}h", name,
                          what, moment, motion.moment(c));
  };
  const auto is_rate = [&](const Combination& c, const char* what) {
    if (wrong.empty() && !near(motion.rate(c), 1))
      wrong = fmt::format("{}: {} is {:g} m/s on a motion at 1 m/s", name, what, motion.rate(c));
  };
  const auto moves = [&](const Levels& levels, const Combination& rate, const char* what) {
    double weight = 0;
    for (const Level& level : levels) weight += level.weight;
    if (wrong.empty() && !levels.empty() && !near(weight, motion.rate(rate)))
      wrong = fmt::format("{}: {} weights its levels to {:g}, what it bounds is {:g} m/s on a motion at 1 m/s", name,
                          what, weight, motion.rate(rate));
  };
  if (const auto& impact = stage.impact) {
    if (const auto& gate = impact->gate) {
      moves(impact->bound, impact->value, "impact bound");
      stands(gate->predictor_bound, gate->predictor, "gate predictor bound");
      moves(gate->approach_bound, gate->approach, "gate approach bound");
      is_rate(gate->approach, "gate approach");
      is_rate(impact->value, "impact measure");
    } else if (impact->restores > 0) {
      stands(impact->bound, impact->value, "bound of the work given back");
    } else {
      stands(impact->bound, impact->value, "impact bound");
      if (wrong.empty() && !near(motion.weight(impact->value), 1))
        wrong = fmt::format("{}: the impact measure of a mass at rest is {:g} times its position", name,
                            motion.weight(impact->value));
    }
  }
  for (const auto& compliance : stage.compliance) {
    if (!compliance) continue;
    stands(compliance->bound, compliance->displacement, "compliance bound");
    moves(compliance->rate_bound, compliance->rate, "compliance rate bound");
    if (wrong.empty() && !near(motion.weight(compliance->displacement), 1))
      wrong = fmt::format("{}: the compliance measure of a mass at rest is {:g} times its position", name,
                          motion.weight(compliance->displacement));
    if (!compliance->rate.slots.empty() || compliance->rate.z != 0) is_rate(compliance->rate, "compliance rate");
    if (!compliance->before) continue;
    stands(compliance->before_bound, *compliance->before, "compliance bound before the step");
    const double moved = motion.moment(compliance->displacement) - motion.moment(*compliance->before);
    if (wrong.empty() && stage.work && !near(moved, motion.moment(stage.work->displacement)))
      wrong = fmt::format("{}: the displacement before the step is {:g} steps behind, the test displacement is {:g}",
                          name, moved, motion.moment(stage.work->displacement));
  }
  if (stage.work) {
    stands(stage.work->support, stage.work->displacement, "work support");
    // Without C nothing is damped.
    bool damped = stage.matrix.C != 0;
    for (const OperatorWeights& row : stage.history) damped = damped || row.C != 0;
    const bool empty = stage.work->rate.z == 0 && stage.work->rate.slots.empty();
    if (damped || !empty) is_rate(stage.work->rate, "work rate");
    if (wrong.empty() && !is_zero(motion.weight(stage.work->displacement)))
      wrong = fmt::format("{}: the work displacement of a mass at rest is {:g} times its position", name,
                          motion.weight(stage.work->displacement));
  }
  return wrong;
}

}  // namespace

std::string inconsistent_motion(const StepPlan& plan) {
  if (!has_inertia(plan)) return {};
  Uniform motion(plan);
  const double h = motion.h();
  if (!(h > 0) || !std::isfinite(h))
    return fmt::format("a step moves a free mass at 1 m/s by {:g} m: a plan carries it forward by h", h);
  constexpr double tolerance = 1e-9;  // of a few steps of numbers of order one
  const double first = plan.start_advances ? 1 : 0;
  for (int n = 0; n < 4; ++n) {
    if (std::abs(motion.rest().slots[0] - 1) > tolerance)
      return fmt::format("a free mass at rest at 1 m is at {:g} m after {} steps", motion.rest().slots[0], n + first);
    if (std::abs(motion.moving().slots[0] / h - (n + first)) > tolerance * 10)
      return fmt::format("a free mass at 1 m/s moves by {:g} h in {} steps of the plan", motion.moving().slots[0] / h,
                         n + first);
    const double speed = combined(plan.velocity, motion.moving().slots);
    if (std::abs(speed - 1) > 1e-6)
      return fmt::format("velocity: the plan's velocity is {:g} m/s on a motion at 1 m/s", speed);
    motion.begin();
    for (std::size_t k = 0; k < plan.stages.size(); ++k) {
      motion.look(plan.stages[k]);
      if (std::string wrong = wrong_stage(plan.stages[k], motion, fmt::format("stage {}", k + 1)); !wrong.empty())
        return wrong;
      motion.pass(plan.stages[k]);
    }
  }
  return {};
}

}  // namespace ricochet
