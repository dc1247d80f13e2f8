#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/contract/stage_facts.hpp>
#include <ricochet/contract/step_plan.hpp>
#include <ricochet/contract/unit_mass.hpp>
#include <string_view>

namespace ricochet {
namespace {

// Collects the first thing that is wrong. Sentences begin with the name of a stage and the part of it: both are put
// together only for the first of them.
class Checker {
  using Name = std::string_view;

 public:
  Checker(std::size_t slots) : slots_(slots) {}
  std::optional<std::string> wrong;

  template <class... Values>
  void demand(bool holds, fmt::format_string<const Values&...> sentence, const Values&... values) {
    if (!holds && !wrong) wrong = fmt::format(sentence, values...);
  }
  void number(double x, Name name, const char* part) { demand(std::isfinite(x), "{}{} is not finite", name, part); }
  void levels(const Levels& list, Name name, const char* part) {
    demand(list.size() <= most_levels, "{}{} has {} time levels, at most {} are marched", name, part, list.size(),
           most_levels);
    for (const Level& level : list) {
      number(level.at, name, part);
      number(level.weight, name, part);
    }
  }
  /// `jumps`: whether w is known there.
  void combination(const Combination& c, Name name, const char* part, bool jumps = false) {
    demand(c.slots.size() <= slots_, "{}{} combines more slots than the plan has", name, part);
    for (const double w : c.slots) number(w, name, part);
    number(c.z, name, part);
    number(c.w, name, part);
    demand(jumps || c.w == 0, "{}{} weighs w, which is known only after the effort of a stage that has an impulse",
           name, part);
  }
  void operators(const OperatorWeights& weights, Name name, const char* part) {
    for (const double w : {weights.M, weights.C, weights.K}) number(w, name, part);
  }
  void impulse(const Stage& stage, Name name) {
    operators(stage.impulse->R, name, ": R of the impulse");
    operators(stage.impulse->feed, name, ": feed of the impulse");
    const auto some = [](const OperatorWeights& w) { return w.M != 0 || w.C != 0 || w.K != 0; };
    demand(some(stage.impulse->R), "{}: R of the impulse is zero: no w solves R w = Hᵀp", name);
    demand(some(stage.matrix), "{}: an impulse in a stage that solves nothing: its S is zero", name);
  }
  void effort(const std::vector<double>& weights, Name name, const char* part) {
    demand(!weights.empty() && weights.size() <= most_efforts, "{}{} has {} effort weights, one to {} are marched",
           name, part, weights.size(), most_efforts);
    for (const double w : weights) number(w, name, part);
  }
  void partition(const Levels& list, Name name, const char* part) {
    if (list.empty()) return;
    double sum = 0;
    for (const Level& level : list) sum += level.weight;
    demand(std::abs(sum - 1) < 1e-9, "{}{} must weight its levels to one", name, part);
  }
  // Stage k of a step, where it gives back the work of another one.
  void restoring(const std::vector<Stage>& stages, std::size_t k, Name name) {
    const auto& impact = stages[k].impact;
    if (!impact || impact->restores == 0) return;
    const auto works_whole = [](const Stage& stage) {
      return stage.impact && !stage.impact->gate && stage.impact->effort == std::vector{1.0} && stage.work &&
             stage.work->effort == std::vector{1.0};
    };
    const auto same = [&](const Combination& a, const Combination& b) {
      bool equal = a.z == b.z;
      for (std::size_t j = 0; j < slots_; ++j)
        equal = equal && (j < a.slots.size() ? a.slots[j] : 0.0) == (j < b.slots.size() ? b.slots[j] : 0.0);
      return equal;
    };
    demand(impact->restores > 0 && static_cast<std::size_t>(impact->restores) <= k,
           "{}: gives back the work of the stage {} before it, which is none of the same step", name, impact->restores);
    demand(works_whole(stages[k]), "{}: a stage that gives work back has a work form, its own effort alone and no gate",
           name);
    if (wrong) return;
    demand(impact->value.z > 0 && same(impact->value, stages[k].work->displacement),
           "{}: what a stage that gives work back measures is its test displacement, which its effort moves", name);
    const Stage& source = stages[k - static_cast<std::size_t>(impact->restores)];
    demand(works_whole(source) && source.impact->restores == 0,
           "{}: the stage whose work is given back measures positions, with its own effort alone and a work form",
           name);
    for (std::size_t other = 0; other < k; ++other)
      demand(!stages[other].impact || stages[other].impact->restores == 0 ||
                 other + static_cast<std::size_t>(impact->restores) !=
                     k + static_cast<std::size_t>(stages[other].impact->restores),
             "{}: the work that it gives back was given back before", name);
  }
  void stage(const Stage& stage, Name name) {
    const bool jumps = stage.impulse.has_value();
    operators(stage.matrix, name, ": S");
    if (jumps) impulse(stage, name);
    demand(stage.history.size() <= slots_, "{}: history names more slots than the plan has", name);
    for (const OperatorWeights& w : stage.history) operators(w, name, ": history");
    levels(stage.load, name, ": load");
    demand(stage.update.size() == slots_, "{}: update must give one combination per slot", name);
    for (const Combination& c : stage.update) combination(c, name, ": update", jumps);
    for (const LossTerm& term : stage.loss) {
      number(term.coefficient, name, ": loss");
      demand(!(term.coefficient < 0), "{}: loss has a negative coefficient: it would be a gain", name);
      combination(term.value, name, ": loss", jumps);
    }
    if (stage.impact) {
      combination(stage.impact->value, name, ": impact measure", jumps);
      number(stage.impact->impulse, name, ": impact impulse");
      levels(stage.impact->bound, name, ": impact bound");
      if (!stage.impact->gate && stage.impact->restores == 0)
        partition(stage.impact->bound, name, ": position-level impact bound");
      if (stage.impact->gate) {
        combination(stage.impact->gate->predictor, name, ": gate predictor");
        combination(stage.impact->gate->approach, name, ": gate approach");
        partition(stage.impact->gate->predictor_bound, name, ": gate predictor bound");
        levels(stage.impact->gate->approach_bound, name, ": gate approach bound");
        number(stage.impact->gate->restitution, name, ": restitution");
        levels(stage.impact->gate->predictor_bound, name, ": gate predictor bound");
      }
      effort(stage.impact->effort, name, ": impact");
    }
    for (const auto& compliance : stage.compliance) {
      if (!compliance) continue;
      combination(compliance->displacement, name, ": compliance", jumps);
      combination(compliance->rate, name, ": compliance rate", jumps);
      number(compliance->impulse, name, ": compliance impulse");
      levels(compliance->bound, name, ": compliance bound");
      partition(compliance->bound, name, ": compliance bound");
      levels(compliance->rate_bound, name, ": compliance rate bound");
      effort(compliance->effort, name, ": compliance");
      if (compliance->before) {
        combination(*compliance->before, name, ": compliance before the step");
        levels(compliance->before_bound, name, ": compliance bound before the step");
      }
    }
    if (stage.work) {
      combination(stage.work->displacement, name, ": work displacement", jumps);
      combination(stage.work->rate, name, ": work rate", jumps);
      number(stage.work->impulse, name, ": work impulse");
      levels(stage.work->load, name, ": work load");
      effort(stage.work->effort, name, ": work");
      levels(stage.work->support, name, ": work support");
    }
  }

 private:
  std::size_t slots_;
};

}  // namespace

std::optional<std::string> check_plan(const StepPlan& plan) {
  Checker check(plan.slots.size());
  check.demand(!plan.slots.empty() && plan.slots.front() == "q", "the first slot of a plan is the position q");
  check.demand(plan.initial.size() == plan.slots.size(), "a plan says for each slot how it starts");
  for (const auto& [position, velocity] : plan.initial) {
    check.number(position, "", "initial");
    check.number(velocity, "", "initial");
  }
  check.demand(plan.slots.size() <= most_slots, "the plan has {} slots, at most {} are marched", plan.slots.size(),
               most_slots);
  for (std::size_t j = 0; j < plan.slots.size(); ++j) {
    check.demand(!plan.slots[j].empty(), "slot {} has no name", j + 1);
    for (std::size_t i = 0; i < j; ++i)
      check.demand(plan.slots[i] != plan.slots[j], "two slots have the name {}", plan.slots[j]);
  }
  check.demand(!plan.stages.empty() && plan.stages.size() <= most_stages,
               "the plan has {} stages, one to {} are marched", plan.stages.size(), most_stages);
  check.demand(plan.start.size() <= most_stages, "the start has {} stages, at most {} are marched", plan.start.size(),
               most_stages);
  for (const Stage& stage : plan.start) {
    check.stage(stage, "start");
    check.demand(!stage.impact || stage.impact->restores == 0, "start: only a stage of a step gives work back");
  }
  for (std::size_t k = 0; k < plan.stages.size(); ++k) {
    const std::string name = fmt::format("stage {}", k + 1);
    check.stage(plan.stages[k], name);
    check.restoring(plan.stages, k, name);
  }
  for (const QuadraticTerm& term : plan.energy) {
    check.demand(term.slots.size() <= plan.slots.size(), "energy: more slots than the plan has");
    check.number(term.coefficient, "", "energy");
    for (const double w : term.slots) check.number(w, "", "energy");
  }
  check.combination(plan.velocity, "", "velocity");
  check.demand(plan.velocity.z == 0, "velocity combines slots after the step, not z");
  check.demand(std::isfinite(plan.facts.order) && plan.facts.order > 0, "facts: the order is positive");
  check.demand(!plan.facts.stability_limit || *plan.facts.stability_limit > 0,
               "facts: the stability limit is positive");
  check.demand(!plan.facts.contact_order || (std::isfinite(*plan.facts.contact_order) && *plan.facts.contact_order > 0),
               "facts: the order at contact is positive, where it is known");
  if (!check.wrong)
    if (std::string wrong = inconsistent_motion(plan); !wrong.empty()) check.wrong = std::move(wrong);
  return check.wrong;
}

std::optional<std::string> check_plan(const StepPlan& plan, double h) {
  if (auto wrong = check_plan(plan)) return wrong;
  const double carried = step_of(plan);
  // Twice the tolerance of a motion at constant speed.
  if (carried != 0 && !(std::abs(carried - h) <= 2e-8 * h))
    return fmt::format("a step of {:g} s carries a free mass at 1 m/s by {:g} m", h, carried);
  return std::nullopt;
}

namespace {

using namespace free_motion;

// The first thing that is wrong with one stage's levels and measures on a motion at constant speed.
class MotionCheck {
 public:
  explicit MotionCheck(const Uniform& motion) : motion_(motion) {}

  std::string wrong(const Stage& stage) {
    if (stage.impact) impact(*stage.impact);
    for (const auto& one : stage.compliance)
      if (one) compliance(*one, stage);
    if (stage.work) work(stage);
    return wrong_;
  }

 private:
  static bool near(double a, double b) {
    constexpr double tolerance = 1e-6;  // levels written as decimals
    return std::abs(a - b) <= tolerance * std::max(1.0, std::abs(b));
  }

  void stands(const Levels& levels, const Combination& c, const char* what) {
    if (levels.empty() || !wrong_.empty()) return;
    double weight = 0, moment = 0;
    for (const Level& level : levels) {
      weight += level.weight;
      moment += level.weight * level.at;
    }
    if (!near(weight, motion_.weight(c)))
      wrong_ = fmt::format("{} weights its levels to {:g}, what it bounds weights positions to {:g}", what, weight,
                           motion_.weight(c));
    else if (!near(moment, motion_.moment(c)))
      wrong_ = fmt::format("{} stands at t + {:g}h on a motion at constant speed, what it bounds at t + {:g}h", what,
                           moment, motion_.moment(c));
  }

  void is_rate(const Combination& c, const char* what) {
    if (wrong_.empty() && !near(motion_.rate(c), 1))
      wrong_ = fmt::format("{} is {:g} m/s on a motion at 1 m/s", what, motion_.rate(c));
  }

  void moves(const Levels& levels, const Combination& rate, const char* what) {
    double weight = 0;
    for (const Level& level : levels) weight += level.weight;
    if (wrong_.empty() && !levels.empty() && !near(weight, motion_.rate(rate)))
      wrong_ = fmt::format("{} weights its levels to {:g}, what it bounds is {:g} m/s on a motion at 1 m/s", what,
                           weight, motion_.rate(rate));
  }

  // What it measures of a mass at rest is its position.
  void is_position(const Combination& c, const char* what) {
    if (wrong_.empty() && !near(motion_.weight(c), 1))
      wrong_ = fmt::format("the {} measure of a mass at rest is {:g} times its position", what, motion_.weight(c));
  }

  void impact(const ImpactMeasure& impact) {
    if (const auto& gate = impact.gate) {
      moves(impact.bound, impact.value, "impact bound");
      stands(gate->predictor_bound, gate->predictor, "gate predictor bound");
      moves(gate->approach_bound, gate->approach, "gate approach bound");
      is_rate(gate->approach, "gate approach");
      is_rate(impact.value, "impact measure");
    } else if (impact.restores > 0) {
      stands(impact.bound, impact.value, "bound of the work given back");
    } else {
      stands(impact.bound, impact.value, "impact bound");
      is_position(impact.value, "impact");
    }
  }

  void compliance(const ComplianceMeasure& measure, const Stage& stage) {
    stands(measure.bound, measure.displacement, "compliance bound");
    moves(measure.rate_bound, measure.rate, "compliance rate bound");
    is_position(measure.displacement, "compliance");
    if (!measure.rate.slots.empty() || measure.rate.z != 0) is_rate(measure.rate, "compliance rate");
    if (!measure.before) return;
    stands(measure.before_bound, *measure.before, "compliance bound before the step");
    const double moved = motion_.moment(measure.displacement) - motion_.moment(*measure.before);
    if (wrong_.empty() && stage.work && !near(moved, motion_.moment(stage.work->displacement)))
      wrong_ = fmt::format("the displacement before the step is {:g} steps behind, the test displacement is {:g}",
                           moved, motion_.moment(stage.work->displacement));
  }

  void work(const Stage& stage) {
    stands(stage.work->support, stage.work->displacement, "work support");
    // Without C nothing is damped.
    bool damped = stage.matrix.C != 0;
    for (const OperatorWeights& row : stage.history) damped = damped || row.C != 0;
    const bool empty = stage.work->rate.z == 0 && stage.work->rate.slots.empty();
    if (damped || !empty) is_rate(stage.work->rate, "work rate");
    if (wrong_.empty() && !is_zero(motion_.weight(stage.work->displacement)))
      wrong_ = fmt::format("the work displacement of a mass at rest is {:g} times its position",
                           motion_.weight(stage.work->displacement));
  }

  const Uniform& motion_;
  std::string wrong_;
};

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
      motion.measure(plan.stages[k]);
      if (const std::string wrong = MotionCheck(motion).wrong(plan.stages[k]); !wrong.empty())
        return fmt::format("stage {}: {}", k + 1, wrong);
      motion.pass(plan.stages[k]);
    }
  }
  return {};
}

}  // namespace ricochet
