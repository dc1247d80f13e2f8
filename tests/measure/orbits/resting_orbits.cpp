// Bodies that rest on a stop under a load that changes: a class of their own, without impacts, until the load lifts
// them.
#include <numbers>
#include <ricochet/measure/orbits/judge_orbit.hpp>
#include <ricochet/measure/orbits/section_march.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace resting_orbits_tests {

namespace {

constexpr double pulsation = 2 * std::numbers::pi;
constexpr int steps = 400;

/// A spring presses its mass on a stop with 1 N, and a force a cos ωt acts beside it. The mass lifts where a > 1. On
/// the upper stop everything is mirrored.
SceneSpec pressed(double a, bool upper = false) {
  const double sign = upper ? -1 : 1;
  SceneSpec scene;
  scene.structure = OscillatorSpec{1, 1, 0.1, {sign * a, pulsation, 0}};
  (upper ? scene.stops.upper : scene.stops.lower) = Formula(sign);
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.displacement = Formula(sign);
  scene.initial.velocity = Formula(0.0);
  return scene;
}

SectionPlan plan_of(int strobe) {
  SectionPlan plan;
  plan.pulsation = pulsation;
  plan.steps_per_period = steps;
  plan.strobe = strobe;
  plan.transient = plan.at_most = 60;
  plan.keep = 16;
  return plan;
}

Orbit orbit_of(const SceneSpec& scene, const Methods& methods, const SectionPlan& plan, int elements = 1) {
  CompileOptions options;
  options.moving_support = scene.support.amplitude != 0;
  const double h = 2 * std::numbers::pi / plan.pulsation / plan.steps_per_period;
  const auto make = [&] {
    auto program = compiled(problem_of(scene, elements, methods.mass), methods, h, options, one_lane);
    REQUIRE(std::holds_alternative<Program>(program));
    return std::move(std::get<Program>(program));
  };
  StartedOrbits started = start_orbits(make(), plan);
  REQUIRE_FALSE(started.ends[0]);
  Orbit orbit;
  orbit.lane = make().lanes[0];
  orbit.now = started.states[0];
  orbit.transient_periods = 1;
  SectionMarch march(make(), plan);
  march.load(0, orbit);
  std::vector<Orbit> ended;
  while (ended.empty()) ended = march.period();
  REQUIRE(ended[0].stage == Orbit::Stage::complete);
  return std::move(ended[0]);
}

}  // namespace

TEST_CASE("a mass that its stop holds is at rest and has no impacts, up to the load that lifts it") {
  const auto time = GENERATE(
      Choice{"moreau-jean", {{"restitution", 0.0}}}, Choice{"moreau-jean", {{"restitution", 0.5}}},
      Choice{"newmark-dumont-paoli", {{"restitution", 0.0}}}, Choice{"newmark-dumont-paoli", {{"restitution", 0.5}}},
      Choice{"paoli-schatzman", {{"restitution", 0.8}}}, Choice{"midpoint"},
      Choice{"nonsmooth-generalised-alpha", {{"restitution", 0.5}}});
  const bool upper = GENERATE(false, true);
  const int strobe = GENERATE(0, 77);
  const Methods methods{{"consistent"}, {"signorini"}, time};
  const SectionPlan plan = plan_of(strobe);
  INFO(time.name << (upper ? ", upper" : ", lower") << ", strobe " << strobe);
  // At a = 1 the stop pushes with nothing at one instant of a period.
  for (const double a : {0.0, 0.5, 0.99, 1.0}) {
    INFO("a = " << a);
    const Orbit orbit = orbit_of(pressed(a, upper), methods, plan);
    const JudgedOrbit judged = judge(orbit, plan, std::nullopt);
    INFO(judged.verdict.evidence);
    CHECK(judged.verdict.motion == MotionClass{Regime::at_rest});
    CHECK(rough_class(orbit, plan) == judged.verdict.motion);
    CHECK(judged.verdict.period == 1);
    CHECK(impacts_per_period(orbit) == 0);
    CHECK(orbit.impacts.empty());
  }
  for (const double a : {1.01, 1.2}) {
    INFO("a = " << a);
    const Orbit orbit = orbit_of(pressed(a, upper), methods, plan);
    const JudgedOrbit judged = judge(orbit, plan, std::nullopt);
    INFO(judged.verdict.evidence);
    CHECK(judged.verdict.motion != MotionClass{Regime::at_rest});
    CHECK(impacts_per_period(orbit) >= 1);
  }
}

TEST_CASE("a contact that is closed when the section is read is not begun once more") {
  // One hop and one landing per period, wherever the strobe lies; most of the period is spent on the stop.
  const Methods methods{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli", {{"restitution", 0.0}}}};
  for (const int strobe : {0, 60, 150, 200, 320}) {
    INFO("strobe " << strobe);
    const SectionPlan plan = plan_of(strobe);
    const Orbit orbit = orbit_of(pressed(1.05), methods, plan);
    CHECK(judge(orbit, plan, std::nullopt).verdict.motion == MotionClass{Regime::periodic, 1});
    CHECK(impacts_per_period(orbit) == 1);
  }
}

TEST_CASE("a mass that a stiff spring holds is at rest like one that a rigid stop holds") {
  // The spring's own motion is some 1e-4 of the hop: what decides is that the contact opens.
  const Methods methods{{"consistent"}, {"penalty", {{"stiffness", 1e5}}}, {"newmark-dumont-paoli", {{"beta", 0.25}}}};
  const SectionPlan plan = plan_of(0);
  for (const double a : {0.5, 0.9}) {
    const Orbit orbit = orbit_of(pressed(a), methods, plan);
    CHECK(judge(orbit, plan, std::nullopt).verdict.motion == MotionClass{Regime::at_rest});
    CHECK(impacts_per_period(orbit) == 0);
  }
  CHECK_FALSE(rests(orbit_of(pressed(1.2), methods, plan)));
}

TEST_CASE("a beam whose tip is pressed on a stop all the time is at rest there, however it swings behind it") {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-3;
  scene.stops.place = StopsSpec::Place::tip;
  scene.stops.lower = Formula(0.02);
  scene.stops.upper.reset();
  scene.initial.displacement = Formula("0.02*(x/1.501)^2", "/scene/initial/displacement", "x");
  scene.initial.velocity = Formula(0.0);
  SectionPlan plan = plan_of(0);
  plan.pulsation = 10;
  const Choice mass = GENERATE(Choice{"singular"}, Choice{"consistent"});
  const Methods methods{mass, {"signorini"}, {"newmark-dumont-paoli"}};
  INFO(mass.name);
  scene.support = {1e-3, 10, 0};
  const Orbit pressed_tip = orbit_of(scene, methods, plan, 4);
  CHECK(judge(pressed_tip, plan, std::nullopt).verdict.motion == MotionClass{Regime::at_rest});
  CHECK(impacts_per_period(pressed_tip) == 0);
  scene.support.amplitude = 0.05;
  const Orbit swinging = orbit_of(scene, methods, plan, 4);
  CHECK(touches(swinging));
  CHECK_FALSE(rests(swinging));
  CHECK(impacts_per_period(swinging) > 0);
}

}  // namespace resting_orbits_tests
