#include <algorithm>
#include <array>
#include <cmath>
#include <ricochet/contact_solvers/restoring_solver.hpp>
#include <ricochet/contract/unit_mass.hpp>
#include <ricochet/measure/stability/plan_restitution.hpp>

namespace ricochet {
namespace {

// A free unit mass above a rigid stop at 0, with the efforts that its plan looks back to.
class BouncingMass {
 public:
  BouncingMass(const StepPlan& plan, double height) : mass_(plan, height, -1), past_(most_efforts, 0.0) {}

  double position() const { return mass_.slots[0]; }
  /// Returns whether an effort of the stop could have moved an impact measure.
  bool step(const std::vector<Stage>& stages) {
    bool measured = false;
    std::array<double, most_stages> works{};
    for (std::size_t n = 0; n < stages.size(); ++n) {
      const Stage& stage = stages[n];
      double effort = 0, found = 0;
      const double S = stage.matrix.M;
      if (stage.impact)
        for (std::size_t k = 1; k < stage.impact->effort.size(); ++k) effort += stage.impact->effort[k] * past_[k - 1];
      double z = mass_.unknown(stage, 0, effort);
      double w = stage.impact ? UnitMass::jump(stage, stage.impact->impulse) : 0.0;
      const double weight = (stage.impact ? stage.impact->effort[0] : 0.0) + (w != 0 ? stage.impulse->feed.M * w : 0.0);
      double reach = stage.impact && S != 0 ? stage.impact->value.z * weight / S : 0.0;
      if (w != 0) reach += stage.impact->value.w * w;
      if (reach > 0) {
        measured = true;
        const int restores = stage.impact->restores;
        found = restores > 0 ? RestoringSolver::alone(combined(stage.impact->value, mass_.slots, z), reach,
                                                      std::max(0.0, -works[n - static_cast<std::size_t>(restores)]))
                             : push(*stage.impact, z) / reach;
        z += weight * found / S;
      }
      w *= found;
      if (stage.work) works[n] = found * combined(stage.work->displacement, mass_.slots, z, w);
      std::rotate(past_.begin(), past_.end() - 1, past_.end());
      past_[0] = found;
      mass_.update(stage, z, w);
    }
    return measured;
  }

 private:
  // What the measure lacks to its bound; 0 where it lies above, or the gate is open.
  double push(const ImpactMeasure& impact, double z) const {
    double lower = 0;
    if (const auto& gate = impact.gate) {
      if (combined(gate->predictor, mass_.slots, z) > 0) return 0;
      const double approach = combined(gate->approach, mass_.slots, z);
      lower = approach > 0 ? -approach : -gate->restitution * approach;
    }
    return std::max(0.0, lower - combined(impact.value, mass_.slots, z));
  }
  UnitMass mass_;
  std::vector<double> past_;
};

// Downwards at one unit per second from two steps and a share of a third above the stop.
std::optional<double> rebound(const StepPlan& plan, double h, double share) {
  BouncingMass mass(plan, (2 + share) * h);
  mass.step(plan.start);
  bool measured = false;  // by the steps: the start may see what they do not
  for (int n = 0; n < 12; ++n) measured = mass.step(plan.stages) || measured;
  if (!measured) return std::nullopt;
  // The rebound over one more step, whatever the scheme keeps as its velocity.
  const double before = mass.position();
  mass.step(plan.stages);
  return (mass.position() - before) / h;
}

}  // namespace

std::optional<double> plan_restitution(const StepPlan& plan, double h) {
  return rebound(plan, h, 0.3);
}

std::optional<RestitutionRange> restitution_range(const StepPlan& plan, double h) {
  constexpr int phases = 64;
  // Of positions of a few steps, over one of them.
  constexpr double round_off = 1e-12;
  RestitutionRange range;
  for (int k = 0; k < phases; ++k) {
    // Mid-points: at 0 and 1 the mass meets its stop exactly at a step.
    auto e = rebound(plan, h, (k + 0.5) / phases);
    if (!e) return std::nullopt;
    if (std::abs(*e) < round_off) *e = 0;
    range.least = k == 0 ? *e : std::min(range.least, *e);
    range.most = k == 0 ? *e : std::max(range.most, *e);
    range.mean += *e / phases;
  }
  return range;
}

}  // namespace ricochet
