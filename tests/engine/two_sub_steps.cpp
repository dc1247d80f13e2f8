// Schemes against what they are known for: Bathe's two sub-steps, HHT that is Newmark, the mid-point rule's energies.
#include <ricochet/measure/motion/motion_sampler.hpp>
#include <ricochet/measure/stability/plan_restitution.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

const Choice bathe{"bathe", {{"split", 0.5}}};

SceneSpec free_mass(double place, double speed) {
  SceneSpec scene;
  scene.structure = OscillatorSpec{.mass = 1, .stiffness = 0, .damping = 0, .force = {}};
  scene.stops.lower = Formula(0.0);
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.displacement = Formula(place);
  scene.initial.velocity = Formula(speed);
  return scene;
}

SceneSpec oscillator() {
  SceneSpec scene;
  scene.structure = OscillatorSpec{.mass = 1, .stiffness = 4, .damping = 0, .force = {}};
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.displacement = Formula(1.0);
  return scene;
}

SceneSpec impacting_beam() {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-5;
  scene.stops.place = StopsSpec::Place::nodes;
  return scene;
}

double slope(const std::vector<double>& h, const std::vector<double>& errors) {
  std::vector<double> x, y;
  for (std::size_t k = 0; k < h.size(); ++k) {
    x.push_back(std::log(h[k]));
    y.push_back(std::log(errors[k]));
  }
  return fitted_slope(x, y);
}

}  // namespace

TEST_CASE("a free oscillator gains nothing under Bathe: energies are taken where they have no bias") {
  for (const double rho : {0.0, 0.5, 0.8})
    for (const double h : {0.05, 0.2, 0.5}) {
      Marcher made = marcher(oscillator(), 1, {{"consistent"}, {"none"}, {"bathe", {{"rho_inf", rho}}}}, h);
      EnergyAudit audit(made);
      made.start(&audit);
      INFO("ρ = " << rho << ", h = " << h);
      double before = 2;
      for (int n = 0; n < 200; ++n) {
        made.march(1, &audit);
        // Bathe damps a little more in one phase of the motion than in another, and never gives back: round-off.
        CHECK(audit.energy(0).common() <= before * (1 + 1e-13));
        before = audit.energy(0).common();
      }
      CHECK(audit.totals(0).first.common() == Approx(2).epsilon(1e-13));
      CHECK_FALSE(audit.balances());
    }
}

TEST_CASE("Bathe's impulse is the momentum that the mass takes, at a rigid stop and on a spring") {
  for (const double h : {1e-2, 1e-3}) {
    Marcher rigid = marcher(free_mass(2.3 * h, -1), 1, {{"consistent"}, {"signorini"}, bathe}, h);
    const EnergyAudit audit = audited(rigid, 40 * h);
    const double thrown = rigid.slot(1)[0];
    // e depends on the phase at which the mass meets the stop; its momentum does not lie.
    CHECK(audit.contact(0).impulse == Approx(thrown + 1).epsilon(1e-12));
    CHECK(plan_restitution(rigid.program().plan, h).value_or(0) == Approx(thrown).epsilon(1e-9));
  }
  std::vector<double> steps, errors;
  for (const double h : {2e-3, 1e-3, 5e-4}) {
    Marcher spring = marcher(free_mass(0.1, -1), 1, {{"consistent"}, {"penalty", {{"stiffness", 1e3}}}, bathe}, h);
    EnergyAudit audit(spring);
    spring.start(&audit);
    spring.march(std::llround(0.4 / h), &audit);
    CHECK(audit.contact(0).impulse == Approx(spring.slot(1)[0] + 1).epsilon(1e-12));
    steps.push_back(h);
    errors.push_back(std::abs(audit.contact(0).impulse - 2));  // 2 m v
  }
  CHECK(errors.back() < 2e-3);
}

TEST_CASE("impacts under Bathe are dated to second order, in whichever sub-step they fall") {
  // A mass thrown at a spring from 0.1 m under gravity: the time of the parabola.
  const double fall = (std::sqrt(1 + 2 * 9.81 * 0.1) - 1) / 9.81;
  std::vector<double> steps, errors;
  for (const double h : {8e-3, 4e-3, 2e-3, 1e-3}) {
    double worst = 0;
    for (int phase = 0; phase < 16; ++phase) {
      const double height = 0.1 + 2 * h * phase / 16;  // at some 1.7 m/s: over more than a step
      SceneSpec scene = free_mass(height, -1);
      scene.load = Formula(-9.81);
      const double exact = (std::sqrt(1 + 2 * 9.81 * height) - 1) / 9.81;
      Marcher made = marcher(scene, 1, {{"consistent"}, {"penalty", {{"stiffness", 1e3}}}, bathe}, h);
      ContactLog log(made);
      made.start(&log);
      made.march(std::llround(1.2 * fall / h) + 3, &log);
      REQUIRE_FALSE(log.events().empty());
      worst = std::max(worst, std::abs(log.events()[0].time - exact));
    }
    steps.push_back(h);
    errors.push_back(worst);
  }
  // Carried on at its velocity from the state before the sub-step: ½ g (h/2)²/v at most.
  CHECK(slope(steps, errors) == Approx(2).margin(0.2));
  CHECK(errors.back() < 0.5 * 9.81 * 2.5e-7 / 1.7 * 1.1);
}

TEST_CASE("Bathe with ρ∞ = 1 is the trapezoidal rule of half the step") {
  const double h = 2e-4;
  for (const Choice& law : {Choice{"signorini"}, Choice{"penalty", {{"stiffness", 1e3}}}}) {
    SceneSpec scene = impacting_beam();
    scene.support.amplitude = 0.02;
    scene.load = Formula("-0.3*x*cos(11*t)", "/scene/load");
    Marcher two = marcher(scene, 5, {{"consistent"}, law, {"bathe", {{"rho_inf", 1.0}}}}, h);
    Marcher one = marcher(scene, 5, {{"consistent"}, law, {"newmark"}}, h / 2);
    // Newmark's rigid impacts throw a point back faster than it came: round-off grows by as much with each.
    const double duration = law.name == "signorini" ? 0.05 : 0.1;
    const EnergyAudit a = audited(two, duration), b = audited(one, duration);
    INFO(law.name);
    // The matrices are the same, their rows are not summed in the same order: round-off through some impacts.
    CHECK(two.tip(0) == Approx(one.tip(0)).margin(1e-9));
    CHECK(a.energy(0).common() == Approx(b.energy(0).common()).epsilon(1e-7));
    CHECK(a.contact(0).impulse == Approx(b.contact(0).impulse).epsilon(1e-7));
    CHECK(a.contact(0).impacts == b.contact(0).impacts);
    CHECK(a.contact(0).active_set_changes == b.contact(0).active_set_changes);
    CHECK(a.contact(0).first_impact == Approx(b.contact(0).first_impact).epsilon(1e-9));
    CHECK(a.contact(0).first_release == Approx(b.contact(0).first_release).epsilon(1e-9));
  }
}

TEST_CASE("HHT with α = 0 is Newmark (¼, ½), bit for bit") {
  for (const Choice& law : {Choice{"signorini"}, Choice{"penalty", {{"stiffness", 1e3}}}})
    for (const std::string contact : {"end", "weighted"}) {
      SceneSpec scene = impacting_beam();
      scene.load = Formula("-0.3*x*cos(11*t)", "/scene/load");
      Marcher hht =
          marcher(scene, 5, {{"consistent"}, law, {"hht-alpha", {{"alpha", 0.0}, {"contact", contact}}}}, 1e-4);
      Marcher newmark = marcher(scene, 5, {{"consistent"}, law, {"newmark"}}, 1e-4);
      const EnergyAudit a = audited(hht, 0.1), b = audited(newmark, 0.1);
      CHECK(hht.lane_state(0).slots == newmark.lane_state(0).slots);
      CHECK(a.energy(0).scheme == b.energy(0).scheme);
      CHECK(a.totals(0).work_of_damping == Approx(b.totals(0).work_of_damping).epsilon(1e-14));
      CHECK(a.contact(0).impulse == b.contact(0).impulse);
    }
}

TEST_CASE("the mid-point rule gives no energy at a stop, HHT and the constraint at the middle do") {
  SceneSpec scene = working_set();
  scene.stops.place = StopsSpec::Place::nodes;
  const auto gain = [&](const Choice& time) {
    Marcher beam = marcher(scene, 10, {{"consistent"}, {"signorini"}, time}, 1e-4);
    const EnergyAudit audit = audited(beam, 0.3);
    CHECK(audit.contact(0).impacts > 0);
    return audit.totals(0).largest_step_gain / audit.totals(0).scheme_start;
  };
  CHECK(gain({"midpoint"}) <= 1e-9);
  CHECK(gain({"midpoint", {{"constraint", std::string("middle")}}}) > 1e-3);
  CHECK(gain({"hht-alpha"}) > 1e-3);
}

TEST_CASE("the restitution of each scheme, over the phases at which a mass meets its stop") {
  const double h = 1e-3;
  const auto range = [&](const Choice& time) {
    return restitution_range(std::get<StepPlan>(plan_of(time, h, {})), h).value_or(RestitutionRange{});
  };
  struct Known {
    Choice time;
    double least, mean, most;
  };
  // The multiplier at position level throws a mass back with up to (1−α_m)/(βπ₀) − 1 times its speed.
  for (const Known& known :
       {Known{{"midpoint"}, 0, 0.5, 1}, Known{{"midpoint", {{"constraint", std::string("middle")}}}, 0.34, 1.67, 3},
        Known{{"hht-alpha"}, 0.26, 1.28, 2.31}, Known{{"hht-alpha", {{"alpha", -0.3}}}, 0.14, 0.75, 1.37},
        Known{bathe, 0.27, 1.10, 2}}) {
    INFO(known.time.name);
    const RestitutionRange found = range(known.time);
    // 64 phases, two printed digits.
    CHECK(found.least == Approx(known.least).margin(0.03));
    CHECK(found.mean == Approx(known.mean).margin(0.02));
    CHECK(found.most == Approx(known.most).margin(0.05));
  }
}
