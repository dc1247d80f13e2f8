// Dashpots that act one way: a stop of a dashpot alone, and a spring beside one.
#include "tests/plugins/contact/impacts.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

Choice damper(const std::string& evaluation) {
  return {"damper", {{"viscosity", 40.0}, {"evaluation", evaluation}}};
}

Choice kelvin_voigt(bool one_way, const std::string& evaluation) {
  return {"kelvin-voigt", {{"stiffness", 1e4}, {"viscosity", 40.0}, {"one_way", one_way}, {"evaluation", evaluation}}};
}

/// What the law took in steps after which the tip moved down, and in those after which it moved up, J.
class TakenBothWays final : public StepObserver {
 public:
  explicit TakenBothWays(const Marcher& marcher) : audit_(marcher) {}
  void stage_solved(const Marcher& marcher, const StageView& view) override { audit_.stage_solved(marcher, view); }
  void step_done(Marcher& marcher) override {
    audit_.step_done(marcher);
    const double taken = audit_.totals(0).work_of_law - last_;
    (audit_.tip_velocity(0) < 0 ? down : up) += taken;
    last_ += taken;
  }
  double down = 0, up = 0;

 private:
  EnergyAudit audit_;
  double last_ = 0;
};

}  // namespace

TEST_CASE("a dashpot alone: the speed falls as e^(−ct/m), and the mass stops v m/c beyond") {
  const auto evaluation = GENERATE(word("implicit"), word("averaged"), word("explicit"), word("midpoint"),
                                   word("conserving"), word("hybrid"));
  constexpr double c = 40, height = 0.0123;
  const auto error = [&](double h) {
    Marcher mass = marcher(thrown_mass(height), 1, {{"consistent"}, damper(evaluation), {"midpoint"}}, h);
    const EnergyAudit audit = audited(mass, 0.06);
    REQUIRE(mass.status(0).running);
    CHECK(audit.contact(0).impacts == 1);
    CHECK(audit.energy(0).contact == 0);
    // What is gone is what the law took, to the order of the scheme.
    const double v = audit.tip_velocity(0);
    CHECK(audit.totals(0).work_of_law == Approx(0.5 * (1 - v * v)).margin(c * h));
    return std::abs(v + std::exp(-c * (0.06 - height)));
  };
  const double coarse = error(1e-4), fine = error(2.5e-5);
  INFO(evaluation << ": " << coarse << " and " << fine);
  // First order where the step that enters feels the jump of the force: c h/m of the speed.
  CHECK(coarse < c * 1e-4);
  CHECK(fine < c * 2.5e-5);
  CHECK((fine < 0.5 * coarse || fine < 1e-5));
  Marcher mass = marcher(thrown_mass(height), 1, {{"consistent"}, damper(evaluation), {"midpoint"}}, 1e-4);
  run(mass, 1);
  // e^−40 of the way is left.
  CHECK(mass.tip(0) == Approx(-1 / c).epsilon(2 * c * 1e-4));
}

TEST_CASE("evaluated conserving, a dashpot alone takes m Δv = c δ and what is lost, whatever the step") {
  const double h = GENERATE(1e-4, 7e-3);
  Marcher mass = marcher(thrown_mass(), 1, {{"consistent"}, damper("conserving"), {"midpoint"}}, h);
  EnergyDrift kept(mass, true);
  mass.start(&kept);
  for (int step = 0; step < 20; ++step) {
    mass.march(static_cast<long long>(0.004 / h) + 1, &kept);
    // The velocity at the end of the step: a slot of the mid-point rule. Sums of 1 of a thousand steps.
    const double speed = mass.lane_state(0).slots[1];
    CHECK(speed - 40 * std::min(0.0, mass.tip(0)) * -1 == Approx(-1).margin(1e-12));
  }
  CHECK(mass.tip(0) < -0.01);
  CHECK(kept.drift < 1e-12);
}

TEST_CASE("a dashpot alone is not felt on the way out") {
  // From rest 0.1 m beyond the stop, drawn out by the oscillator's spring: half of a free swing.
  const auto evaluation = GENERATE(word("implicit"), word("averaged"), word("explicit"), word("midpoint"),
                                   word("conserving"), word("hybrid"));
  SceneSpec scene;
  scene.structure = OscillatorSpec{1, 100, 0, {}};
  scene.stops.lower = Formula(0.0);
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.displacement = Formula(-0.1);
  INFO(evaluation);
  Marcher mass = marcher(scene, 1, {{"consistent"}, damper(evaluation), {"midpoint"}}, 1e-4);
  EnergyAudit audit(mass);
  mass.start(&audit);
  mass.march(3000, &audit);
  CHECK(mass.tip(0) == Approx(-0.1 * std::cos(3.0)).epsilon(1e-5));
  CHECK(audit.contact(0).impulse == 0);
  CHECK(audit.totals(0).work_of_law == 0);
  // And is on the way in.
  mass.march(6000, &audit);
  CHECK(audit.contact(0).impulse > 0);
  CHECK(audit.totals(0).work_of_law > 0.1 * 0.5);
}

TEST_CASE("a spring beside a dashpot that acts one way: the restitution in closed form, lost while closing alone") {
  // x = v/w e^(−bt) sin wt until t = atan2(w, b)/w, then the spring alone: e = e^(−bt).
  const double k = 1e4, b = 20, w = std::sqrt(k - b * b), e = std::exp(-b * std::atan2(w, b) / w);
  REQUIRE(e == Approx(0.756135).epsilon(1e-6));
  const auto evaluation = GENERATE(word("averaged"), word("midpoint"), word("conserving"), word("hybrid"));
  INFO(evaluation);
  for (const double h : {1e-4, 2.5e-5}) {
    const Bounce one = bounce(kelvin_voigt(true, evaluation), h, 0.25, thrown_mass(), {"midpoint"});
    // First order where the step that enters feels the jump of the force: c h/m of the speed at most.
    CHECK(std::abs(one.speed - e) < b * h);
    CHECK(one.taken == Approx(0.5 * (1 - e * e)).margin(2 * b * h));
  }
  for (const bool one_way : {true, false}) {
    Marcher mass = marcher(thrown_mass(), 1, {{"consistent"}, kelvin_voigt(one_way, evaluation), {"midpoint"}}, 1e-4);
    TakenBothWays taken(mass);
    mass.start(&taken);
    mass.march(2000, &taken);
    CHECK(taken.down > 0.1);
    // The step of the turn may close on its mean and open at its end: its share of a speed near 0.
    CHECK((one_way ? taken.up < 1e-6 : taken.up > 0.05));
  }
}

TEST_CASE("one way or both, no dashpot is the penalty's spring") {
  const auto evaluation = GENERATE(word("implicit"), word("conserving"));
  const auto place = [&](const Choice& law) { return bounce(law, 1e-4, 0.1, thrown_mass(), {"midpoint"}).place; };
  const double spring = place({"penalty", {{"stiffness", 1e4}, {"evaluation", evaluation}}});
  for (const bool one_way : {true, false}) {
    Choice law = kelvin_voigt(one_way, evaluation);
    law.values["viscosity"] = 0.0;
    CHECK(place(law) == Approx(spring).epsilon(1e-12));
  }
}
