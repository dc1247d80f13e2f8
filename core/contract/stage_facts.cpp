#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <ricochet/contract/plan_algebra.hpp>
#include <ricochet/contract/stage_facts.hpp>
#include <ricochet/contract/unit_mass.hpp>

namespace ricochet {
namespace {

using namespace free_motion;

// Steps that a unit mass makes before it is looked at: start rules and slots with a memory have settled.
constexpr int settling_steps = 64;

// Under a constant force, once everything has settled: where rates stand on the positions. Parasitic roots −1 are
// averaged out over two steps.
class Accelerated {
 public:
  Accelerated(const StepPlan& plan, double h) : plan_(plan), h_(h) {
    UnitMass mass(plan, 0, 0);
    mass.advance(plan.start, 1);
    std::vector<double> positions;
    for (int n = 0; n < settling_steps + 3; ++n) {
      before_.push_back(mass);
      positions.push_back(mass.slots[0]);
      mass.advance(plan.stages, 1);
    }
    // (q_{n+1} − q_{n−1})/2h is the velocity at t_n of whatever parabola the positions lie on.
    for (int n = 0; n < 2; ++n) {
      const auto at = static_cast<std::size_t>(settling_steps + n);
      speeds_[static_cast<std::size_t>(n)] = (positions[at + 1] - positions[at - 1]) / (2 * h_);
    }
  }
  /// Of a rate in stage `k` of a step.
  double place_of(const Combination& rate, std::size_t k) const {
    return mean([&](UnitMass mass) {
      for (std::size_t j = 0; j < k; ++j) mass.update(plan_.stages[j], mass.unknown(plan_.stages[j], 1, 0));
      return combined(rate, mass.slots, mass.unknown(plan_.stages[k], 1, 0));
    });
  }

 private:
  template <class Value>
  double mean(const Value& value) const {
    double sum = 0;
    for (std::size_t n = 0; n < 2; ++n) sum += (value(before_[settling_steps + n]) - speeds_[n]) / h_;
    return simple(0.5 * sum);
  }
  const StepPlan& plan_;
  double h_;
  std::vector<UnitMass> before_;
  std::array<double, 2> speeds_{};
};

// Where in time the momentum of a plan stands after a step, in steps. It is found under the force F = t, from the
// increase of the velocity. No start rule and no first-order error of the positions contributes to that.
double momentum_place(const StepPlan& plan, double h, double last_step) {
  UnitMass mass(plan, 0, 0);
  std::array<double, 3> speeds{};
  for (int n = 0; n < settling_steps; ++n) {
    for (const Stage& stage : plan.stages) {
      double load = 0;
      for (const Level& level : stage.load) load += level.weight * (n + level.at) * h;
      mass.update(stage, mass.unknown(stage, 0, load));
    }
    speeds = {speeds[1], speeds[2], combined(plan.velocity, mass.slots)};
  }
  // Over two steps, so that a root −1 does not count; they end at settling_steps.
  const double force = (speeds[2] - speeds[0]) / (2 * h), offset = force / h - (settling_steps - 1);
  return std::abs(offset + 0.5 * last_step) < 0.25 * last_step ? simple(-0.5 * last_step) : 0.0;
}

void add_level(Levels& levels, double at, double weight) {
  at = simple(at);
  weight = simple(weight);
  if (is_zero(weight)) return;
  for (Level& level : levels)
    if (is_zero(level.at - at)) {
      level.weight += weight;
      return;
    }
  levels.push_back({at, weight});
}

// The share of c that moves with the new position stands where that stands. The rest stands where it is found on a
// motion at constant speed.
Levels levels_of(const Uniform& motion, const Stage& stage, const StageFacts& facts, const Combination& c) {
  const Combination& position = stage.update[0];
  double share = position.z != 0 ? c.z / position.z : position.w != 0 ? c.w / position.w : 0.0;
  if (facts.to == facts.from) share = 0;
  const double weight = motion.weight(c) - share, moment = motion.moment(c) - share * facts.to;
  Levels levels;
  add_level(levels, facts.to, share);
  if (!is_zero(weight)) {
    add_level(levels, moment / weight, weight);
  } else if (!is_zero(moment) && facts.to != facts.from) {
    add_level(levels, facts.to, moment / (facts.to - facts.from));
    add_level(levels, facts.from, -moment / (facts.to - facts.from));
  } else if (!is_zero(moment)) {
    // A way at a time at which the position stands: half of it before, half after.
    add_level(levels, facts.to + 0.5, moment);
    add_level(levels, facts.to - 0.5, -moment);
  }
  return levels;
}

double latest(const Levels& levels) {
  double at = -std::numeric_limits<double>::infinity();
  for (const Level& level : levels) at = std::max(at, level.at);
  return std::isfinite(at) ? at : 1.0;
}

Combination position_increment(const Stage& stage) {
  Combination increment = stage.update[0];
  if (increment.slots.empty()) increment.slots.push_back(0);
  increment.slots[0] -= 1;
  return increment;
}

// Nothing has settled where a motion starts: what slots alone say of a rate stands where the stage begins, one that the
// stage finds where it ends.
void fill_levels(Stage& stage, StageFacts& facts, const Uniform& motion, const Accelerated* settled,
                 std::size_t index) {
  const auto stands = [&](Levels& levels, const Combination& c) {
    if (levels.empty()) levels = levels_of(motion, stage, facts, c);
  };
  const auto moves = [&](Levels& levels, const Combination& rate) {
    if (!levels.empty() || is_zero(motion.rate(rate))) return;
    const double first = rate.z == 0 && rate.w == 0 ? facts.from : facts.to;
    levels = {{settled ? settled->place_of(rate, index) : first, simple(motion.rate(rate))}};
  };
  if (stage.work) stands(stage.work->support, stage.work->displacement);
  if (stage.impact && stage.impact->restores > 0 && stage.impact->bound.empty())
    stage.impact->bound = stage.work->support;
  if (stage.impact) {
    if (stage.impact->gate) {
      moves(stage.impact->bound, stage.impact->value);
      stands(stage.impact->gate->predictor_bound, stage.impact->gate->predictor);
      moves(stage.impact->gate->approach_bound, stage.impact->gate->approach);
    } else {
      stands(stage.impact->bound, stage.impact->value);
    }
  }
  double instant = stage.impact && stage.impact->restores == 0 ? latest(stage.impact->bound) : -1;
  for (auto& compliance : stage.compliance) {
    if (!compliance) continue;
    stands(compliance->bound, compliance->displacement);
    moves(compliance->rate_bound, compliance->rate);
    if (compliance->before) stands(compliance->before_bound, *compliance->before);
    if (!stage.impact) instant = std::max(instant, latest(compliance->bound));
  }
  const bool moves_position = !is_zero(facts.to - facts.from);
  facts.instant = moves_position || instant < 0 ? facts.to : simple(instant);
}

std::vector<StageFacts> derive_stages(std::vector<Stage>& stages, Uniform& motion, const Accelerated* settled) {
  std::vector<StageFacts> all;
  motion.begin();
  for (std::size_t k = 0; k < stages.size(); ++k) {
    StageFacts facts;
    facts.increment = position_increment(stages[k]);
    motion.measure(stages[k]);
    facts.from = simple(motion.place());
    Uniform after = motion;
    after.pass(stages[k]);
    facts.to = simple(after.place());
    fill_levels(stages[k], facts, motion, settled, k);
    motion = after;
    all.push_back(facts);
  }
  return all;
}

// Without inertia nothing tells where a stage stands.
std::vector<StageFacts> at_the_end(std::vector<Stage>& stages) {
  std::vector<StageFacts> all;
  const auto end = [](Levels& levels) {
    if (levels.empty()) levels = {{1, 1}};
  };
  for (Stage& stage : stages) {
    if (stage.work && stage.work->support.empty()) stage.work->support = {{1, 1}, {0, -1}};
    if (stage.impact && stage.impact->restores > 0 && stage.impact->bound.empty())
      stage.impact->bound = stage.work->support;
    if (stage.impact) end(stage.impact->bound);
    if (stage.impact && stage.impact->gate) {
      end(stage.impact->gate->predictor_bound);
      end(stage.impact->gate->approach_bound);
    }
    for (auto& compliance : stage.compliance) {
      if (!compliance) continue;
      end(compliance->bound);
      end(compliance->rate_bound);
      if (compliance->before) end(compliance->before_bound);
    }
    all.push_back({0, 1, 1, position_increment(stage), {}});
  }
  return all;
}

bool same(const Combination& a, const Combination& b) {
  const auto slot = [](const Combination& c, std::size_t j) { return j < c.slots.size() ? c.slots[j] : 0.0; };
  for (std::size_t j = 0; j < std::max(a.slots.size(), b.slots.size()); ++j)
    if (slot(a, j) != slot(b, j)) return false;
  return a.z == b.z && a.w == b.w;
}

int find_increment(const DerivedPlan& derived) {
  if (derived.stages.size() != 1 || derived.start.size() > 1) return -1;
  const auto holds = [](const std::vector<Stage>& stages, const std::vector<StageFacts>& facts, std::size_t slot) {
    for (std::size_t k = 0; k < stages.size(); ++k)
      if (!same(stages[k].update[slot], facts[k].increment)) return false;
    return true;
  };
  for (std::size_t j = 1; j < derived.plan.slots.size(); ++j)
    if (holds(derived.plan.start, derived.start, j) && holds(derived.plan.stages, derived.stages, j))
      return static_cast<int>(j);
  return -1;
}

}  // namespace

namespace {

// What c is after the stage, over what is before it.
Combination after_stage(const Combination& c, const Stage& stage) {
  Combination out;
  out.slots.assign(stage.update.size(), 0.0);
  for (std::size_t j = 0; j < c.slots.size(); ++j) {
    const Combination& row = stage.update[j];
    for (std::size_t i = 0; i < row.slots.size(); ++i) out.slots[i] += c.slots[j] * row.slots[i];
    out.z += c.slots[j] * row.z;
    out.w += c.slots[j] * row.w;
  }
  return out;
}

EndRate end_rate_of(const DerivedPlan& derived, const Stage& stage, const StageFacts& facts, const Uniform& motion) {
  const auto is_rate = [&](const Combination& c) {
    return (c.z != 0 || c.w != 0) && is_zero(motion.weight(c) * derived.h) && is_zero(motion.rate(c) - 1);
  };
  if (stage.impact && stage.impact->gate && is_rate(stage.impact->value))
    return {stage.impact->value, stage.impact->bound, {}};
  const double length = (facts.to - facts.from) * derived.h;
  const Levels mean = {{facts.to, 1 / length}, {facts.from, -1 / length}};
  if (const Combination velocity = after_stage(derived.plan.velocity, stage); is_rate(velocity)) {
    if (derived.velocity_offset != 0 && length != 0) return {velocity, {}, mean};
    return {velocity, {{facts.to, 1}}, {}};
  }
  if (const auto& implicit = stage.at(Evaluation::implicit_end); implicit && is_rate(implicit->rate))
    return {implicit->rate, implicit->rate_bound, {}};
  Combination way = facts.increment;
  for (double& weight : way.slots) weight /= length;
  way.z /= length;
  way.w /= length;
  if (length != 0 && is_rate(way)) return {way, {}, mean};
  return {};
}

// Of a start stage that finds an acceleration alone: the mean rate until its stops are looked at.
EndRate rate_ahead(const Stage& stage, const Uniform& motion) {
  const auto& now = stage.at(Evaluation::implicit_end);
  if (!stage.impact || stage.impact->gate || !now) return {};
  const double from = motion.moment(now->displacement), to = motion.moment(stage.impact->value);
  const double length = (to - from) * motion.h();
  if (!(length > 0)) return {};
  using namespace plan_algebra;
  return {(1 / length) * (stage.impact->value - now->displacement), {}, {{to, 1 / length}, {from, -1 / length}}};
}

void add_end_rates(const DerivedPlan& derived, const std::vector<Stage>& stages, Uniform motion,
                   std::vector<StageFacts>& facts) {
  for (std::size_t k = 0; k < stages.size(); ++k) {
    motion.measure(stages[k]);
    facts[k].end_rate = end_rate_of(derived, stages[k], facts[k], motion);
    if (&stages == &derived.plan.start && !facts[k].end_rate.known()) facts[k].end_rate = rate_ahead(stages[k], motion);
    motion.pass(stages[k]);
  }
}

}  // namespace

double step_of(const StepPlan& plan) {
  return has_inertia(plan) ? Uniform(plan).h() : 0.0;
}

DerivedPlan derive(StepPlan plan) {
  DerivedPlan derived;
  if (!has_inertia(plan)) {
    derived.start = at_the_end(plan.start);
    derived.stages = at_the_end(plan.stages);
    derived.plan = std::move(plan);
    derived.increment_slot = find_increment(derived);
    return derived;
  }
  StepPlan filled = plan;
  Uniform motion(plan);
  derived.h = motion.h();
  const Accelerated settled(plan, derived.h);
  derived.stages = derive_stages(filled.stages, motion, &settled);
  // The start rule looks at slots that hold what they begin with.
  StepPlan bare = plan;
  bare.start.clear();
  Uniform first(bare, derived.h);
  derived.start = derive_stages(filled.start, first, nullptr);
  double last_step = 1;
  for (const StageFacts& facts : derived.stages)
    if (!is_zero(facts.to - facts.from)) last_step = facts.to - facts.from;
  derived.velocity_offset = momentum_place(plan, derived.h, last_step);
  derived.plan = std::move(filled);
  derived.increment_slot = find_increment(derived);
  add_end_rates(derived, derived.plan.start, Uniform(bare, derived.h), derived.start);
  add_end_rates(derived, derived.plan.stages, Uniform(plan), derived.stages);
  return derived;
}

}  // namespace ricochet
