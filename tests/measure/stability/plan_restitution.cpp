// The restitution of a plan against the parameter that it was made from, and against a mass that is marched.
#include <ricochet/measure/stability/plan_restitution.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

/// A free mass of 1 kg above a stop at 0, falling at 1 m/s.
SceneSpec thrown(double height) {
  SceneSpec scene;
  scene.structure = OscillatorSpec{1, 0, 0, {}};
  scene.stops.lower = Formula(0.0);
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.displacement = Formula(height);
  scene.initial.velocity = Formula(-1.0);
  return scene;
}

StepPlan plan_of(const Choice& time, double h) {
  const auto problem = problem_of(thrown(1), 1, {"consistent"});
  const auto law = make(registry().contact("signorini"), {"signorini"});
  auto plan = testing::plan_of(time, h, problem_facts(*problem, *law));
  REQUIRE(std::holds_alternative<StepPlan>(plan));
  return std::get<StepPlan>(plan);
}

/// Speed at which the marched mass leaves, m/s.
double rebound(const Choice& time, double h, double height) {
  Marcher ball = marcher(thrown(height), 1, {{"consistent"}, {"signorini"}, time}, h);
  ball.start();
  ball.march(12 - ball.step());
  const double before = ball.tip(0);
  ball.march(1);
  return (ball.tip(0) - before) / h;
}

}  // namespace

TEST_CASE("the restitution of a plan is the parameter of its scheme, at any step") {
  const double e = GENERATE(0.0, 0.3, 0.8, 1.0), h = GENERATE(1e-7, 1e-4, 1e-1);
  const std::string start = GENERATE("first-order", "second-order");
  const double beta = GENERATE(0.0, 0.25, 0.5);
  INFO("e = " << e << ", h = " << h);
  const auto paoli =
      plan_restitution(plan_of({"newmark-dumont-paoli", {{"restitution", e}, {"beta", beta}, {"start", start}}}, h), h);
  REQUIRE(paoli);
  // Sums of a dozen numbers of order h, over h.
  CHECK(*paoli == Approx(e).margin(1e-12));
  const auto moreau = plan_restitution(plan_of({"moreau-jean", {{"restitution", e}, {"theta", 0.5 + beta}}}, h), h);
  REQUIRE(moreau);
  CHECK(*moreau == Approx(e).margin(1e-12));
}

TEST_CASE("the restitution of a plan is what a marched mass shows") {
  const double h = GENERATE(1e-5, 1e-2);
  const auto time =
      GENERATE(Choice{"newmark"}, Choice{"newmark", {{"beta", 0.5}, {"gamma", 0.8}}},
               Choice{"newmark-dumont-paoli", {{"restitution", 0.7}}}, Choice{"moreau-jean", {{"restitution", 0.7}}},
               Choice{"nonsmooth-generalised-alpha", {{"restitution", 0.7}}}, Choice{"kane", {{"beta", 0.4}}});
  INFO(time.name << ", h = " << h);
  const auto found = plan_restitution(plan_of(time, h), h);
  REQUIRE(found);
  // The height of which the function speaks; its mass is this one, so nothing but round-off lies between.
  CHECK(*found == Approx(rebound(time, h, 2.3 * h)).margin(1e-9));
}

TEST_CASE("a plan without impact measure, or with one that no effort moves, restitutes nothing") {
  // Newmark's displacement at β = 0 does not see the effort of its own step.
  CHECK_FALSE(plan_restitution(plan_of({"newmark", {{"beta", 0.0}}}, 1e-3), 1e-3));

  StepPlan plan = plan_of({"newmark-dumont-paoli"}, 1e-3);
  for (Stage& stage : plan.stages) stage.impact.reset();
  for (Stage& stage : plan.start) stage.impact.reset();
  CHECK_FALSE(plan_restitution(plan, 1e-3));
}
