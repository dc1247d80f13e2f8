#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/contract/stage_facts.hpp>
#include <ricochet/contract/unit_mass.hpp>

namespace ricochet {
namespace {

// Steps that a unit mass makes before it is looked at: start rules and slots with a memory have settled.
constexpr int settling_steps = 64;
// Round-off of a few dozen steps in numbers of order one.
constexpr double round_off = 1e-9;

bool is_zero(double x) {
  return std::abs(x) < round_off;
}

// Levels and weights are mostly simple fractions, found here by arithmetic that rounds: the fraction is meant.
double simple(double x) {
  constexpr double denominator = 5040;
  const double nearest = std::round(x * denominator) / denominator;
  return std::abs(x - nearest) < round_off * std::max(1.0, std::abs(x)) ? nearest : x;
}

bool has_inertia(const StepPlan& plan) {
  const auto all = [](const std::vector<Stage>& stages) {
    return std::all_of(stages.begin(), stages.end(), [](const Stage& stage) {
      return stage.matrix.M != 0 || (stage.matrix.C == 0 && stage.matrix.K == 0);
    });
  };
  return all(plan.start) && all(plan.stages);
}

// Two masses, one at rest at 1 m, one at a speed that makes 1 m per step, stage by stage through one step.
class Uniform {
 public:
  Uniform(const StepPlan& plan, double h) : rest_(plan, 1, 0), moving_(plan, 0, 1), h_(h) {}
  explicit Uniform(const StepPlan& plan) : Uniform(plan, 0) {
    moving_.advance(plan.start, 0);
    rest_.advance(plan.start, 0);
    const double before = moving_.slots[0];
    UnitMass next = moving_;
    next.advance(plan.stages, 0);
    h_ = next.slots[0] - before;
  }
  double h() const { return h_; }
  const UnitMass& rest() const { return rest_; }
  const UnitMass& moving() const { return moving_; }

  /// Before the first stage of a set that begins now.
  void begin() { origin_ = moving_.slots[0]; }
  void look(const Stage& stage) {
    rest_z_ = rest_.unknown(stage, 0, 0);
    moving_z_ = moving_.unknown(stage, 0, 0);
  }
  void pass(const Stage& stage) {
    rest_.update(stage, rest_z_);
    moving_.update(stage, moving_z_);
  }
  /// Where the position stands, in steps from begin().
  double place() const { return (moving_.slots[0] - origin_) / h_; }
  /// Σ of the combination's weights over positions.
  double weight(const Combination& c) const { return combined(c, rest_.slots, rest_z_); }
  /// Its first moment over time, in steps from begin().
  double moment(const Combination& c) const {
    return (combined(c, moving_.slots, moving_z_) - weight(c) * origin_) / h_;
  }
  /// What a rate gives at 1 m/s.
  double rate(const Combination& c) const { return combined(c, moving_.slots, moving_z_); }

 private:
  UnitMass rest_, moving_;
  double h_ = 0, origin_ = 0, rest_z_ = 0, moving_z_ = 0;
};

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

// Where in time the momentum of a plan stands after a step, in steps: found under the force F = t from its increase
// over a step, to which no start rule and no first-order error of the positions contributes.
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

// The share that moves with the new position stands where that stands; what is left, at the place where it is found on
// a motion at constant speed.
Levels levels_of(const Uniform& motion, const Stage& stage, const StageFacts& facts, const Combination& c) {
  const Combination& position = stage.update[0];
  const double share = position.z != 0 && facts.to != facts.from ? c.z / position.z : 0.0;
  const double weight = motion.weight(c) - share, moment = motion.moment(c) - share * facts.to;
  Levels levels;
  add_level(levels, facts.to, share);
  if (!is_zero(weight)) {
    add_level(levels, moment / weight, weight);
  } else if (!is_zero(moment)) {
    add_level(levels, facts.to, moment / (facts.to - facts.from));
    add_level(levels, facts.from, -moment / (facts.to - facts.from));
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

// Rates of stages that start a motion stand where their weights say; nothing has settled there.
void fill_levels(Stage& stage, StageFacts& facts, const Uniform& motion, const Accelerated* settled,
                 std::size_t index) {
  const auto stands = [&](Levels& levels, const Combination& c) {
    if (levels.empty()) levels = levels_of(motion, stage, facts, c);
  };
  const auto moves = [&](Levels& levels, const Combination& rate) {
    if (levels.empty() && !is_zero(motion.rate(rate)))
      levels = {{settled ? settled->place_of(rate, index) : facts.to, simple(motion.rate(rate))}};
  };
  if (stage.impact) {
    if (stage.impact->gate) {
      moves(stage.impact->bound, stage.impact->value);
      stands(stage.impact->gate->predictor_bound, stage.impact->gate->predictor);
      moves(stage.impact->gate->approach_bound, stage.impact->gate->approach);
    } else {
      stands(stage.impact->bound, stage.impact->value);
    }
  }
  double instant = stage.impact ? latest(stage.impact->bound) : -1;
  for (auto& compliance : stage.compliance) {
    if (!compliance) continue;
    stands(compliance->bound, compliance->displacement);
    moves(compliance->rate_bound, compliance->rate);
    if (compliance->before) stands(compliance->before_bound, *compliance->before);
    if (!stage.impact) instant = std::max(instant, latest(compliance->bound));
  }
  if (stage.work) stands(stage.work->support, stage.work->displacement);
  const bool moves_position = !is_zero(facts.to - facts.from);
  facts.instant = moves_position || instant < 0 ? facts.to : simple(instant);
}

std::vector<StageFacts> derive_stages(std::vector<Stage>& stages, Uniform& motion, const Accelerated* settled) {
  std::vector<StageFacts> all;
  motion.begin();
  for (std::size_t k = 0; k < stages.size(); ++k) {
    StageFacts facts;
    facts.increment = position_increment(stages[k]);
    motion.look(stages[k]);
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
    if (stage.work && stage.work->support.empty()) stage.work->support = {{1, 1}, {0, -1}};
    all.push_back({0, 1, 1, position_increment(stage)});
  }
  return all;
}

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
    is_rate(stage.work->rate, "work rate");
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

double step_of(const StepPlan& plan) {
  return has_inertia(plan) ? Uniform(plan).h() : 0.0;
}

DerivedPlan derive(StepPlan plan) {
  DerivedPlan derived;
  if (!has_inertia(plan)) {
    derived.start = at_the_end(plan.start);
    derived.stages = at_the_end(plan.stages);
    derived.plan = std::move(plan);
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
  return derived;
}

StageEfforts stage_efforts(const std::vector<Stage>& stages, const std::optional<Evaluation>& evaluation) {
  StageEfforts efforts;
  for (const Stage& stage : stages) {
    efforts.emplace_back();
    if (evaluation) {
      if (stage.at(*evaluation)) efforts.back() = stage.at(*evaluation)->effort;
    } else if (stage.impact) {
      efforts.back() = stage.impact->effort;
    }
  }
  return efforts;
}

namespace {

// Marches a mass until its velocity stays, under one effort of 1 N found by stage `source` of the first step; by one of
// the start rule where it is negative.
double settled_momentum(const StepPlan& plan, UnitMass mass, const StageEfforts& efforts, std::ptrdiff_t source) {
  constexpr int most_steps = 4096;
  const auto stages = static_cast<std::ptrdiff_t>(plan.stages.size());
  double speed = combined(plan.velocity, mass.slots), largest_change = std::abs(speed);
  int quiet = 0;
  for (int n = 0; n < most_steps && quiet < 4 + most_efforts; ++n) {
    for (std::ptrdiff_t k = 0; k < stages; ++k) {
      const std::ptrdiff_t back = n * stages + k - source;
      const auto& weights = efforts[static_cast<std::size_t>(k)];
      const bool acts = back >= 0 && back < static_cast<std::ptrdiff_t>(weights.size());
      const Stage& stage = plan.stages[static_cast<std::size_t>(k)];
      mass.update(stage, mass.unknown(stage, 0, acts ? weights[static_cast<std::size_t>(back)] : 0.0));
    }
    const double now = combined(plan.velocity, mass.slots), change = std::abs(now - speed);
    largest_change = std::max(largest_change, change);
    quiet = change <= 1e-14 * largest_change ? quiet + 1 : 0;
    speed = now;
  }
  return quiet > 0 || largest_change == 0 ? speed : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

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
    const bool acts = k >= stage && k - stage < start[k].size();
    mass.update(plan.start[k], mass.unknown(plan.start[k], 0, acts ? start[k][k - stage] : 0.0));
  }
  const double h = Uniform(plan).h();
  const auto source = static_cast<std::ptrdiff_t>(stage) - static_cast<std::ptrdiff_t>(plan.start.size());
  return h * simple(settled_momentum(plan, mass, efforts, source) / h);
}

}  // namespace ricochet
