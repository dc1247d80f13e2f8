// Tangent columns are taken along by flights: what they are multiplied by is the same step.
#include <ricochet/engine/flight/flight.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

SceneSpec shaken(double amplitude) {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-4;
  scene.support.amplitude = amplitude;
  scene.stops.place = StopsSpec::Place::nodes;
  scene.initial.displacement = Formula(0.0);
  scene.initial.velocity = Formula(0.0);
  return scene;
}

// A beam with two tangents after some steps: no contact yet, then with tangents in it.
Marcher with_tangents(const SceneSpec& scene, const Methods& methods, double h, MarchWay way) {
  CompileOptions options;
  options.kind = OperatorKind::modal;
  options.march = way;
  options.expected_steps = 1000000;
  options.tangents = 2;
  Marcher beam = marcher(scene, 6, methods, h, options);
  beam.start();
  for (int k = 0; k < 2; ++k) {
    LaneState column = beam.lane_state(0);
    for (std::size_t i = 0; i < column.slots.size(); ++i)
      column.slots[i] = 1 + std::sin(static_cast<double>(i + 1) * (k + 1));
    beam.set_tangent(0, k, column);
  }
  return beam;
}

double distance(const LaneState& a, const LaneState& b) {
  double sum = 0, size = 0;
  for (std::size_t i = 0; i < a.slots.size(); ++i) {
    sum += (a.slots[i] - b.slots[i]) * (a.slots[i] - b.slots[i]);
    size += b.slots[i] * b.slots[i];
  }
  return std::sqrt(sum / size);
}

}  // namespace

TEST_CASE("tangents that fly are those of every step, through contact and between") {
  const double h = 2e-5;
  const auto methods =
      GENERATE(Methods{{"singular", {{"velocity", std::string("P1")}}}, {"signorini"}, {"newmark-dumont-paoli"}},
               Methods{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli", {{"beta", 0.25}}}},
               Methods{{"consistent"}, {"penalty", {{"stiffness", 1e4}}}, {"newmark-dumont-paoli"}},
               Methods{{"consistent"}, {"signorini"}, {"moreau-jean", {{"theta", 0.6}}}});
  const SceneSpec scene = shaken(0.09);
  Marcher flown = with_tangents(scene, methods, h, MarchWay::flights),
          marched = with_tangents(scene, methods, h, MarchWay::every_step);
  // What the other order of the same operations makes of the last digits of the orbit and of its derivative: a twin.
  Marcher twin = with_tangents(scene, methods, h, MarchWay::every_step);
  LaneState beside = twin.lane_state(0);
  for (double& x : beside.slots) x *= 1 + 1e-12;
  twin.set_lane(0, LaneSpec(twin.program().lanes[0]), beside);
  for (int k = 0; k < 2; ++k) twin.set_tangent(0, k, marched.tangent(0, k));
  for (int part = 0; part < 4; ++part) {
    flown.march(10000);
    marched.march(10000);
    twin.march(10000);
    INFO("part " << part << ", visited " << flown.steps_visited());
    for (int k = 0; k < 2; ++k) {
      const double apart = distance(flown.tangent(0, k), marched.tangent(0, k)),
                   own = distance(twin.tangent(0, k), marched.tangent(0, k));
      CHECK(apart < 30 * own + 1e-9);
      // A derivative that has met no contact, or forgotten it, would be far away.
      CHECK(apart < 1e-3);
    }
  }
  CHECK(flown.steps_visited() < 20000);
}

TEST_CASE("tangents without their orbit's drive: a column that is zero stays zero, whatever flies") {
  Marcher beam = with_tangents(shaken(0.09), {}, 2e-5, MarchWay::flights);
  LaneState zero = beam.tangent(0, 0);
  std::fill(zero.slots.begin(), zero.slots.end(), 0.0);
  beam.set_tangent(0, 0, zero);
  beam.march(40000);
  CHECK(beam.steps_visited() < 20000);
  for (const double x : beam.tangent(0, 0).slots) CHECK(x == 0);
  double largest = 0;
  for (const double x : beam.tangent(0, 1).slots) largest = std::max(largest, std::abs(x));
  CHECK(largest > 0);
}

TEST_CASE("taking tangents along leaves the orbit what it is") {
  CompileOptions options;
  options.march = MarchWay::flights;
  options.expected_steps = 1000000;
  Marcher alone = marcher(shaken(0.09), 6, {}, 2e-5, options);
  alone.start();
  Marcher along = with_tangents(shaken(0.09), {}, 2e-5, MarchWay::flights);
  alone.march(20000);
  along.march(20000);
  CHECK(distance(along.lane_state(0), alone.lane_state(0)) < 1e-8);
}
