// Which impacts with inertia a step resolves, and what a derivative knows of the others.
#include <numbers>
#include <ricochet/measure/orbits/impact_jump.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

TEST_CASE("an oscillator's impact is resolved where hω is at most a tenth") {
  SceneSpec scene;
  scene.structure = OscillatorSpec{2, 50, 0, {}};  // ω = 5
  scene.stops.lower = Formula(-1.0);
  scene.stops.place = StopsSpec::Place::tip;
  const auto problem = problem_of(scene, 1, {"consistent"});
  CHECK(resolved_points(*problem, 0.0999 / 5) == std::vector<bool>{true});
  CHECK(resolved_points(*problem, 0.1001 / 5) == std::vector<bool>{false});
  scene.structure = OscillatorSpec{2, 0, 0, {}};  // a free mass goes on as it was pushed
  CHECK(resolved_points(*problem_of(scene, 1, {"consistent"}), 10) == std::vector<bool>{true});
}

TEST_CASE("the mass of one node of a beam needs steps below those of central differences") {
  SceneSpec scene = working_set();
  scene.stops.place = StopsSpec::Place::nodes;
  const Choice mass = GENERATE(Choice{"consistent"}, Choice{"lumped"});
  const int elements = 20;
  const auto problem = problem_of(scene, elements, mass);
  // 2/ω of the highest mode of the consistent mass; an impulse on a node moves about the upper half of the modes.
  const double length = 1.501 / elements, limit = 0.0334014193 * length * length / std::sqrt(282.8125);
  const std::vector<bool> all(static_cast<std::size_t>(elements), true),
      none(static_cast<std::size_t>(elements), false);
  INFO(mass.name);
  CHECK(resolved_points(*problem, limit / 40) == all);
  CHECK(resolved_points(*problem, 4 * limit) == none);
  // Points without mass never are: what they move in an instant vanishes with the instant.
  CHECK(resolved_points(*problem_of(scene, elements, {"singular"}), limit / 40) != all);
}

namespace {

constexpr double shaken_at = 10;  // rad/s

/// The shaken beam of chaotic motion, begun with nudge·x².
Marcher shaken(double nudge, const Methods& methods, double h) {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-4;
  scene.support = {0.0909, shaken_at, 0};
  scene.initial.displacement = Formula(std::to_string(nudge * 1e9) + "*1e-9*x^2", "/scene/initial/displacement", "x");
  scene.initial.velocity = Formula(0.0);
  CompileOptions options;
  options.moving_support = true;
  return marcher(scene, 10, methods, h, options);
}

/// How far apart two runs are after 30 periods that begin so far apart at x = 1 m.
double apart(double nudge, const Methods& methods) {
  constexpr int periods = 30, steps = 8000;
  const double h = 2 * std::numbers::pi / shaken_at / steps;
  Marcher one = shaken(0, methods, h), other = shaken(nudge, methods, h);
  double largest = 0;
  for (Marcher* each : {&one, &other}) {
    each->start();
    each->march(static_cast<long long>(periods) * steps);
    REQUIRE(each->status(0).running);
  }
  const LaneState a = one.lane_state(0), b = other.lane_state(0);
  for (std::size_t i = 0; i < a.slots.size(); ++i) largest = std::max(largest, std::abs(a.slots[i] - b.slots[i]));
  return largest;
}

}  // namespace

TEST_CASE(
    "where stops are met at whole steps, runs nearby share their impacts and say nothing of those farther apart") {
  const Methods velocity_level{{"consistent"}, {"signorini"}, {"moreau-jean"}};
  const Methods position_level{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli", {{"beta", 0.5}}}};
  CHECK(tangents_miss_impacts(shaken(0, velocity_level, 1e-4).program()));
  CHECK_FALSE(tangents_miss_impacts(shaken(0, position_level, 1e-4).program()));
  CHECK(twins_miss_impacts(shaken(0, velocity_level, 1e-4).program()));
  CHECK_FALSE(
      twins_miss_impacts(shaken(0, {{"singular"}, {"signorini"}, {"moreau-jean", {{"theta", 0.6}}}}, 1e-4).program()));
  // A law that reads where the point is: no gate decides.
  CHECK_FALSE(stops_met_at_steps(
      shaken(0, {{"consistent"}, {"penalty", {{"stiffness", 1e5}}}, {"moreau-jean"}}, 1e-4).program()));
  // Chaos: what begins a millionth apart is soon as far apart as motions are. Not so within one step's way, 1e-8 m,
  // of a scheme at velocity level: between the same gates its step only damps.
  CHECK(apart(1e-8, velocity_level) < 1e-12);
  CHECK(apart(1e-5, velocity_level) > 1e-4);
  CHECK(apart(1e-8, position_level) > 1e-4);
}
