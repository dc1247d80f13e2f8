#pragma once
#include "tests/marching.hpp"

/// \file
/// Masses thrown at a stop, and what is kept of their energy.
namespace ricochet::testing {

inline const Choice midpoint_like{"newmark-dumont-paoli", {{"beta", 0.25}}};

/// 1 kg at 1 m/s, a stop below at 0, let go at `height`.
inline SceneSpec thrown_mass(double height = 0.0123, double speed = 1) {
  SceneSpec scene;
  scene.structure = OscillatorSpec{1, 0, 0, {}};
  scene.stops.lower = Formula(0.0);
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.displacement = Formula(height);
  scene.initial.velocity = Formula(-speed);
  return scene;
}

inline std::string word(const char* text) {
  return text;
}

struct Bounce {
  double speed = 0, place = 0, deepest = 0, contact = 0, taken = 0;
  EnergyTotals energy;
};

inline Bounce bounce(const Choice& law, double h, double duration = 0.25, const SceneSpec& scene = thrown_mass(),
                     const Choice& time = midpoint_like) {
  Marcher mass = marcher(scene, 1, {{"consistent"}, law, time}, h);
  const EnergyAudit audit = audited(mass, duration);
  REQUIRE(mass.status(0).running);
  const ContactTotals& contact = audit.contact(0);
  REQUIRE(contact.impacts == 1);
  return {audit.tip_velocity(0),       mass.tip(0),
          contact.deepest_penetration, contact.first_release - contact.first_impact,
          audit.totals(0).work_of_law, audit.totals(0)};
}

/// E + U over a run, E the energy of the scheme. How far it moves from its first value, its largest gain in a step, its
/// change at the end. Also the largest share of it that the stops held. `losses`: what the law says that it dissipated
/// counts too.
class EnergyDrift final : public StepObserver {
 public:
  explicit EnergyDrift(const Marcher& marcher, bool losses = false) : audit_(marcher), losses_(losses) {}
  void stage_solved(const Marcher& marcher, const StageView& view) override { audit_.stage_solved(marcher, view); }
  void step_done(Marcher& marcher) override {
    audit_.step_done(marcher);
    double now = audit_.energy(0).scheme + audit_.energy(0).contact;
    if (losses_) now += audit_.totals(0).work_of_law;
    if (first < 0) first = last_ = now;
    drift = std::max(drift, std::abs(now / first - 1));
    gain = std::max(gain, (now - last_) / first);
    change = now / first - 1;
    deepest = std::max(deepest, audit_.energy(0).contact / now);
    last_ = now;
  }
  const EnergyAudit& audit() const { return audit_; }
  double first = -1, drift = 0, gain = 0, change = 0, deepest = 0;

 private:
  EnergyAudit audit_;
  bool losses_;
  double last_ = 0;
};

}  // namespace ricochet::testing
