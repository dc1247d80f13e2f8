#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <ricochet/contract/friction_facts.hpp>
#include <ricochet/contract/momentum_weights.hpp>
#include <ricochet/contract/unit_mass.hpp>

namespace ricochet {
namespace {

using free_motion::is_zero;

// A unit mass under the force 1 and efforts of friction.
class RubbedMass {
 public:
  RubbedMass(const DerivedPlan& derived, double velocity, double force, StageEfforts start, StageEfforts stages)
      : derived_(derived), mass_(derived.plan, 0, velocity), force_(force), start_(start), stages_(stages) {}
  /// `effort`(rate before it, what 1 N moves it by) of each stage that reads contact.
  template <class Effort>
  void pass(bool starting, const Effort& effort) {
    const std::vector<Stage>& stages = starting ? derived_.plan.start : derived_.plan.stages;
    const std::vector<StageFacts>& facts = starting ? derived_.start : derived_.stages;
    const StageEfforts& weights = starting ? start_ : stages_;
    for (std::size_t k = 0; k < stages.size(); ++k) {
      const Stage& stage = stages[k];
      double p = 0;
      const StageEffort& weight = weights[k];
      const double own = friction_weight(weight);
      const auto z_of = [&](double push) {
        const double w = UnitMass::jump(stage, weight.impulse * push);
        return std::pair(mass_.unknown(stage, force_, own * push, w), w);
      };
      if (!weight.weights.empty() && facts[k].end_rate.known()) {
        const auto rate = [&](double push) {
          const auto [z, w] = z_of(push);
          return combined(facts[k].end_rate.rate, mass_.slots, z, w);
        };
        const double free = rate(0);
        p = effort(free, rate(1) - free);
      }
      const auto [z, w] = z_of(p);
      mass_.update(stage, z, w);
    }
  }
  double velocity() const { return combined(derived_.plan.velocity, mass_.slots); }

 private:
  const DerivedPlan& derived_;
  UnitMass mass_;
  double force_;
  StageEfforts start_, stages_;
};

}  // namespace

double friction_weight(const StageEffort& normal) {
  if (normal.weights.empty()) return 0;
  if (normal.impulse != 0) return normal.weights[0];
  return std::accumulate(normal.weights.begin(), normal.weights.end(), 0.0);
}

namespace {

// The factor by which the efforts of a point that sticks come nearer to what they must be in each step, below 0 where
// they alternate.
double root_of_held(const DerivedPlan& derived, const StageEfforts& start, const StageEfforts& stages) {
  // Efforts that are off by less than this are right.
  constexpr double right = 1e-12;
  constexpr int most_steps = 400;
  RubbedMass held(derived, 0, 1, start, stages);
  std::vector<double> off, signs;
  const auto hold = [&](double free, double by) {
    const double p = by != 0 ? -free / by : 0.0;
    if (by != 0) signs.push_back(p + 1);
    return p;
  };
  // A start that knows no friction disturbs them.
  held.pass(true, [](double, double) { return 0.0; });
  for (int n = 0; n < most_steps; ++n) {
    signs.clear();
    held.pass(false, hold);
    double most = 0;
    for (const double one : signs)
      if (std::abs(one) > std::abs(most)) most = one;
    off.push_back(most);
    if (std::abs(most) < right) break;
  }
  // The last steps whose efforts are known better than round-off.
  std::size_t last = off.size();
  while (last > 0 && std::abs(off[last - 1]) < right) --last;
  if (last < 4) return 0;
  const double first = off[last / 2], end = off[last - 1];
  const double size = std::pow(std::abs(end / first), 1.0 / static_cast<double>(last - 1 - last / 2));
  return off[last - 1] * off[last - 2] < 0 ? -size : size;
}

// By how much a mass of 1 kg slows that slides against 1 N, m/s².
double slowed(const DerivedPlan& derived, const StageEfforts& start, const StageEfforts& stages) {
  RubbedMass slides(derived, 1, 0, start, stages);
  const auto push = [](double, double) { return -1.0; };
  slides.pass(true, push);
  constexpr int settling_steps = 200, steps = 8;
  for (int n = 0; n < settling_steps; ++n) slides.pass(false, push);
  const double before = slides.velocity();
  for (int n = 0; n < steps; ++n) slides.pass(false, push);
  return (before - slides.velocity()) / (steps * derived.h);
}

}  // namespace

FrictionFacts friction_facts(const DerivedPlan& derived, const std::optional<Evaluation>& evaluation) {
  const StepPlan& plan = derived.plan;
  FrictionFacts facts;
  if (derived.h == 0) {
    facts.why_none = "it solves a stage without mass";
    return facts;
  }
  if (!evaluation && std::any_of(plan.stages.begin(), plan.stages.end(),
                                 [](const Stage& stage) { return stage.impact && stage.impact->restores > 0; })) {
    facts.why_none = "it gives back what contact takes, and friction must not come back";
    return facts;
  }
  const StageEfforts start = stage_efforts(plan.start, evaluation), stages = stage_efforts(plan.stages, evaluation);
  const EffortMomenta momenta = effort_momenta(plan, start, stages);
  if (!momenta.why_none.empty()) {
    facts.why_none = "a normal effort gives no definite momentum, as " + momenta.why_none;
    return facts;
  }
  for (std::size_t k = 0; k < stages.size(); ++k) {
    if (stages[k].weights.empty() || is_zero(momenta.stages[k] / derived.h)) continue;
    const Stage& stage = plan.stages[k];
    const EndRate& end = derived.stages[k].end_rate;
    const double moved = (end.rate.z != 0 && stage.matrix.M != 0) || (end.rate.w != 0 && stages[k].impulse != 0);
    if (end.known() && moved) continue;
    facts.why_none = fmt::format("its stage {} gives momentum at contact and has no rate of its own", k + 1);
    return facts;
  }
  facts.held_root = root_of_held(derived, start, stages);
  if (std::abs(facts.held_root) >= 1 - 1e-9) {
    facts.rings = fmt::format("it {} the effort of a point that sticks (by the factor {:.4g} a step)",
                              facts.held_root < 0 ? "alternates" : "does not find", facts.held_root);
  }
  if (!is_zero(slowed(derived, start, stages) - 1))
    facts.why_none = "a constant friction of 1 N does not slow a mass of 1 kg by 1 m/s²";
  return facts;
}

}  // namespace ricochet
