// What is predicted is compared, never shown as a result: laws of it, and no figure of this machine.
#include <ricochet/engine/cost_model.hpp>

#include "tests/composed_plan.hpp"
#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

// Newmark–Dumont–Paoli without contact in as many sub-steps as given, and `idle` stages that solve nothing.
Program repeated(OperatorKind kind, int times, int idle) {
  const auto problem = problem_of(working_set(), 8, {"consistent"});
  auto law = make(registry().contact("none"), {"none"});
  auto plan = std::get<StepPlan>(plan_of({"newmark-dumont-paoli"}, 1e-4, problem_facts(*problem, *law)));
  plan = composed(plan, times);
  Stage nothing;
  nothing.update = {{.slots = {1}}, {.slots = {0, 1}}};
  plan.stages.insert(plan.stages.end(), static_cast<std::size_t>(idle), nothing);
  CompileOptions options;
  options.kind = kind;
  return std::get<Program>(
      compile(problem, std::move(plan), times * 1e-4, std::move(law), {scene_lane(*problem, {})}, options));
}

}  // namespace

TEST_CASE("a step that solves twice is predicted to cost twice as much") {
  const auto kind = GENERATE(OperatorKind::band, OperatorKind::modal, OperatorKind::sparse);
  const double once = repeated(kind, 1, 0).predicted_step_seconds;
  CHECK(once > 0);
  CHECK(repeated(kind, 2, 0).predicted_step_seconds / once == Approx(2).epsilon(1e-12));
  CHECK(repeated(kind, 1, 1).predicted_step_seconds == once);
}

TEST_CASE("modes are found once, factors once per stage that solves") {
  const double modes = repeated(OperatorKind::modal, 1, 0).predicted_setup_seconds;
  CHECK(repeated(OperatorKind::modal, 2, 0).predicted_setup_seconds == modes);
  const double factor = repeated(OperatorKind::band, 1, 0).predicted_setup_seconds;
  CHECK(repeated(OperatorKind::band, 2, 0).predicted_setup_seconds / factor == Approx(2).epsilon(1e-12));
}

TEST_CASE("a step costs more the more look at it, the more they read") {
  const Program program = repeated(OperatorKind::modal, 1, 0), twice = repeated(OperatorKind::modal, 2, 0);
  const double unseen = predict_watch(program, {}), seen = predict_watch(program, {.observers = 1});
  CHECK(unseen > 0);
  CHECK(unseen < seen);
  CHECK(seen < predict_watch(program, {.observers = 2}));
  CHECK(seen < predict_watch(program, {.observers = 1, .numbers = 100}));
  CHECK(seen < predict_watch(program, {.observers = 1, .samples = true}));
  CHECK(seen < predict_watch(twice, {.observers = 1}));
}

TEST_CASE("a step in contact costs more the more points push and the more iterations the law makes") {
  const auto problem = problem_of(working_set(), 8, {"consistent"});
  const Program program =
      std::get<Program>(compiled(problem, {{"consistent"}, {"signorini"}, {"newmark-dumont-paoli"}}, 1e-4));
  const auto touched = [&](double points, double iterations) {
    return predict_touched_step(program, {1, points, iterations});
  };
  CHECK(touched(1, 1) > 0);
  for (const double points : {2.0, 20.0, 120.0, 1000.0}) {
    CAPTURE(points);
    CHECK(touched(points, 1) > touched(points - 1, 1));
    CHECK(touched(points, 2) > touched(points, 1));
    CHECK(touched(points, 3) - touched(points, 2) == Approx(touched(points, 2) - touched(points, 1)));
  }
  // Among all steps as the share of those in contact.
  const auto all = [&](double share) {
    return predict_watch(program, {.observers = 1, .contact = ContactWork{share, 3, 2}});
  };
  CHECK(all(0.5) - all(0) == Approx(0.5 * touched(3, 2)));
  CHECK(all(1) - all(0) == Approx(touched(3, 2)));
}

TEST_CASE("the operator follows the number of contact points") {
  // Modal rows of H have no zeros: one point is cheap, all of them are not.
  SceneSpec scene = working_set();
  const auto tip = problem_of(scene, 50, {"consistent"});
  scene.stops.place = StopsSpec::Place::nodes;
  const auto nodes = problem_of(scene, 50, {"consistent"});
  for (const int solves : {1, 2, 6}) {
    CHECK(cheapest_kind(*tip, {2, solves, false}, 1, 100000000) == OperatorKind::modal);
    CHECK(cheapest_kind(*nodes, {2, solves, false}, 1, 100000000) == OperatorKind::band);
    // Not for a few steps: a dense eigenproblem is to be paid back.
    CHECK(cheapest_kind(*tip, {2, solves, false}, 1, 10) == OperatorKind::band);
  }
}

TEST_CASE("automatic marches count what flights cost before their first step") {
  // Half a second at the same step: the dense modes of 400 elements cost more than all steps of the band do.
  const auto flies = [](int elements, double h) {
    SceneSpec scene = working_set();
    scene.stops.place = StopsSpec::Place::nodes;
    CompileOptions options;
    options.march = MarchWay::automatic;
    options.expected_steps = std::llround(0.5 / h);
    const auto problem = problem_of(scene, elements, {"consistent"});
    const auto program = compiled(problem, {{"consistent"}, {"signorini"}, {"newmark-dumont-paoli"}}, h, options);
    return std::get<Program>(program).flight != nullptr;
  };
  CHECK_FALSE(flies(20, 1e-3));
  CHECK(flies(20, 1e-5));
  CHECK(flies(100, 1e-6));
  CHECK_FALSE(flies(400, 1e-5));
}

TEST_CASE("a step in modes with one contact point is predicted to cost less than one in the band") {
  // As bench_march counts: a fifth to a third at one lane, a half at eight.
  const auto tip = problem_of(working_set(), 50, {"consistent"});
  const auto ratio = [&](int width) {
    return predict_cost(OperatorKind::modal, *tip, {2, 1, false}, width).step_seconds /
           predict_cost(OperatorKind::band, *tip, {2, 1, false}, width).step_seconds;
  };
  CHECK(ratio(1) < 0.33);
  CHECK(ratio(8) < 0.7);
}
