// Tangent columns are the derivative of the discrete step; a lane's state is all that it needs to go on.
#include <ricochet/measure/orbits/impact_jump.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

SceneSpec forced_scene(StopsSpec::Place place, double alpha = 1e-4) {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = alpha;
  scene.support.amplitude = 0.09;
  scene.stops.place = place;
  scene.initial.displacement = Formula(0.0);
  scene.initial.velocity = Formula(0.0);
  return scene;
}

LaneState shifted(LaneState state, const LaneState& direction, double by) {
  for (std::size_t i = 0; i < state.slots.size(); ++i) state.slots[i] += by * direction.slots[i];
  for (std::size_t i = 0; i < state.efforts.size(); ++i) state.efforts[i] += by * direction.efforts[i];
  return state;
}

double size(const LaneState& state) {
  double sum = 0;
  for (const double x : state.slots) sum += x * x;
  return std::sqrt(sum);
}

// A smooth direction: the state itself, which all slots share.
LaneState direction_of(const LaneState& state) {
  LaneState direction = state;
  std::fill(direction.efforts.begin(), direction.efforts.end(), 0.0);
  return direction;
}

}  // namespace

TEST_CASE("tangent columns are the derivative of the step, contacts included") {
  const auto place = GENERATE(StopsSpec::Place::tip, StopsSpec::Place::nodes);
  const auto methods = GENERATE(
      Methods{{"singular", {{"velocity", std::string("P1")}}}, {"signorini"}, {"newmark-dumont-paoli"}},
      Methods{{"consistent"}, {"penalty", {{"stiffness", 1e4}}}, {"newmark-dumont-paoli"}},
      Methods{{"consistent"}, {"penalty", {{"stiffness", 1e4}, {"evaluation", std::string("averaged")}}}, {"newmark"}},
      Methods{{"singular", {{"velocity", std::string("P0")}}}, {"signorini"}, {"moreau-jean", {{"theta", 0.6}}}});
  const SceneSpec scene = forced_scene(place);
  const double h = 1e-4;
  CompileOptions options;
  options.tangents = 1;
  const auto three = [](const LaneSpec& lane) { return std::vector<LaneSpec>(3, lane); };
  // None of these is refused: marcher() requires a program.
  Marcher block = marcher(scene, 6, methods, h, options, three);
  block.start();
  block.march(4000);
  const LaneState base = block.lane_state(0);
  const LaneState direction = direction_of(base);
  // Lane 0 with its tangent, lanes 1 and 2 to either side: a central difference. Over a short integration the same
  // steps are in contact on both sides, as the offset is small enough. The exception is a contact that begins or ends
  // between them.
  const double offset = 1e-7;
  const LaneSpec spec = block.program().lanes[0];
  block.set_tangent(0, 0, direction);
  block.set_lane(1, spec, shifted(base, direction, offset));
  block.set_lane(2, spec, shifted(base, direction, -offset));
  block.march(2000);
  const LaneState tangent = block.tangent(0, 0);
  LaneState difference = shifted(block.lane_state(1), block.lane_state(2), -1);
  for (double& x : difference.slots) x /= 2 * offset;
  INFO(methods.mass.name << " " << methods.contact.name << " " << methods.time.name);
  CHECK(block.delassus_columns() > 0);
  // Round-off over the offset (1e-16 · size / 1e-7), and the curvature of penalties that open within a step
  // (O(offset)). A step more or less in contact costs the step's share of a contact, O(h/contact time).
  const double wrong = size(shifted(tangent, difference, -1)) / size(difference);
  CHECK(wrong < 2e-2);
}

TEST_CASE("loads do not enter tangents") {
  SceneSpec scene = forced_scene(StopsSpec::Place::tip);
  scene.load = Formula(-3.0);
  CompileOptions options;
  options.tangents = 1;
  const auto kind = GENERATE(OperatorKind::band, OperatorKind::modal, OperatorKind::sparse);
  options.kind = kind;
  Marcher loaded = marcher(scene, 6, {}, 1e-4, options);
  scene.load = Formula(0.0);
  scene.support.amplitude = 0;
  Marcher still = marcher(scene, 6, {}, 1e-4, options);
  for (Marcher* one : {&loaded, &still}) {
    one->start();
    LaneState direction = one->lane_state(0);
    std::fill(direction.efforts.begin(), direction.efforts.end(), 0.0);
    for (std::size_t i = 0; i < direction.slots.size(); ++i) direction.slots[i] = 1e-3 * (1 + double(i % 5));
    one->set_tangent(0, 0, direction);
    one->march(50);  // before any contact
  }
  const LaneState a = loaded.tangent(0, 0), b = still.tangent(0, 0);
  CHECK(size(shifted(a, b, -1)) < 1e-9 * size(b));
}

TEST_CASE("an orbit goes on bitwise equal in another lane of another block") {
  const auto time =
      GENERATE(Choice{"newmark-dumont-paoli"}, Choice{"newmark"}, Choice{"moreau-jean", {{"theta", 0.6}}});
  const Methods methods{{"singular", {{"velocity", std::string("P1")}}}, {"signorini"}, time};
  const SceneSpec scene = forced_scene(StopsSpec::Place::nodes);
  const double h = 1e-4;
  CompileOptions options;
  options.kind = GENERATE(OperatorKind::band, OperatorKind::modal);  // states are in the coordinates of the operator
  Marcher alone = marcher(scene, 6, methods, h, options);
  alone.start();
  alone.march(3000);
  const LaneState state = alone.lane_state(0);
  const LaneSpec spec = alone.program().lanes[0];
  const long long clock = alone.step();
  Marcher block = marcher(scene, 6, methods, h, options, [](const LaneSpec& lane) {
    std::vector<LaneSpec> lanes(5, lane);
    for (int k = 0; k < 5; ++k) lanes[static_cast<std::size_t>(k)].amplitude = 0.05 + 0.01 * k;
    return lanes;
  });
  block.start();
  block.march(1234);
  block.freeze(3, {.cause = EndCause::idle});
  block.set_clock(clock);
  block.set_lane(3, spec, state);
  alone.march(3000);
  block.march(3000);
  const LaneState a = alone.lane_state(0), b = block.lane_state(3);
  CHECK(a.slots == b.slots);
  CHECK(a.efforts == b.efforts);
}

TEST_CASE("the jump at an impact with inertia is that of the motion, at any step") {
  // A ball dropped from rest at x0 under G, restitution e, one bounce; τ after it:
  // ∂x/∂x0 = −e + (1+e)Gτ/w, ∂v/∂x0 = (1+e)G/w, w = √(2G x0).
  const double G = 9.81, x0 = 0.4, e = 0.8, w = std::sqrt(2 * G * x0), impact = w / G;
  const double h = GENERATE(1e-3, 3.1e-4, 1e-4);
  const auto time =
      GENERATE(Choice{"newmark-dumont-paoli", {{"restitution", 0.8}}}, Choice{"moreau-jean", {{"restitution", 0.8}}});
  SceneSpec scene;
  scene.structure = OscillatorSpec{1, 0, 0, {}};
  scene.load = Formula(-G);
  scene.stops.lower = Formula(0.0);
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.displacement = Formula(x0);
  scene.initial.velocity = Formula(0.0);
  CompileOptions options;
  options.tangents = 2;
  options.kind = OperatorKind::band;
  Marcher ball = marcher(scene, 1, {{"consistent"}, {"signorini"}, time}, h, options);
  ImpactJump jump(ball);
  REQUIRE(jump.needed());
  ball.start();
  // ∂/∂x0: every displacement of the start moves by one, velocities by nothing.
  LaneState direction = ball.lane_state(0);
  std::fill(direction.slots.begin(), direction.slots.end(), 0.0);
  std::fill(direction.efforts.begin(), direction.efforts.end(), 0.0);
  direction.slots[0] = 1;
  ball.set_tangent(0, 0, direction);
  const long long steps = std::llround((impact + 0.1) / h);
  ball.march(steps - ball.step(), &jump);
  const double tau = ball.time() - impact;
  const LaneState found = ball.tangent(0, 0);
  const double velocity_slot = ball.program().plan.initial[1][1];
  INFO(time.name << " h = " << h);
  CHECK(jump.applied(0) == 1);
  // The orbit itself is first order: its start and its impact are up to a step off, and w with them.
  CHECK(found.slots[0] == Approx(-e + (1 + e) * G * tau / w).margin(40 * h));
  CHECK(found.slots[1] / velocity_slot == Approx((1 + e) * G / w).margin(40 * h));
}
