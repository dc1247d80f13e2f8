// A plan whose stage has a second unknown, R w = ι Hᵀp: what is wrong with it is told. What is derived of it is right.
#include <catch2/catch.hpp>
#include <functional>
#include <limits>
#include <ricochet/contract/momentum_weights.hpp>
#include <ricochet/contract/stage_facts.hpp>

using namespace ricochet;

namespace impulse_plan_tests {
using Catch::Matchers::Contains;

namespace {

constexpr double h = 0.1;

// Positions move by h/2 w, velocities by w; z, an acceleration, is that of a spring that has moved.
StepPlan impulsive() {
  StepPlan plan;
  plan.slots = {"q", "v"};
  plan.initial = {{1, 0}, {0, 1}};
  plan.velocity = {.slots = {0, 1}};
  Stage stage;
  stage.matrix = {1, h / 2, h * h / 4};
  stage.history = {{0, 0, -1}, {0, -1, -h / 2}};
  stage.load = {{0.5, 1}};
  stage.impulse = {.R = {1 / h, 0, 0}, .feed = {0, -0.5, -h / 4}};
  stage.update = {{.slots = {1, h}, .z = h * h / 2, .w = h / 2}, {.slots = {0, 1}, .z = h, .w = 1}};
  stage.impact = {.value = stage.update[0], .effort = {0}};
  stage.at(Evaluation::implicit_end) = {.displacement = stage.update[0], .rate = stage.update[1], .impulse = 0};
  stage.work = {.displacement = {.slots = {0, h}, .z = h * h / 2, .w = h / 2},
                .rate = {.slots = {0, 1}, .z = h / 2, .w = 0.5},
                .load = {{0.5, 1}},
                .impulse = 1};
  stage.loss = {{EnergyMatrix::M, 0.1, {.slots = {}, .z = h, .w = 1}}};
  plan.stages = {stage};
  return plan;
}

std::string wrong(const std::function<void(Stage&)>& change) {
  StepPlan plan = impulsive();
  change(plan.stages[0]);
  return check_plan(plan).value_or("nothing");
}

}  // namespace

TEST_CASE("a plan with an impulse that holds together passes") {
  CHECK(check_plan(impulsive(), h).value_or("nothing") == "nothing");
  CHECK(wrong([](Stage& stage) { stage.impulse->feed = {}; }) == "nothing");
  CHECK(wrong([](Stage& stage) { stage.impulse->R = {0, 0, 1}; }) == "nothing");
}

TEST_CASE("an impulse without solution is told") {
  CHECK_THAT(wrong([](Stage& stage) { stage.impulse->R = {}; }), Contains("stage 1: R of the impulse is zero"));
  CHECK_THAT(wrong([](Stage& stage) { stage.matrix = {}; }), Contains("an impulse in a stage that solves nothing"));
  StepPlan plan = impulsive();
  plan.start = plan.stages;
  plan.start_advances = true;
  plan.start[0].impulse->R = {};
  CHECK_THAT(check_plan(plan).value_or("nothing"), Contains("start: R of the impulse is zero"));
}

TEST_CASE("w is weighed only where there is one, and after the effort") {
  const auto without = [](const std::function<void(Stage&)>& change) {
    return wrong([&](Stage& stage) {
      // Nothing weighs w; the change puts one weight back.
      for (Combination* c : {&stage.update[0], &stage.update[1], &stage.impact->value, &stage.work->displacement,
                             &stage.work->rate, &stage.loss[0].value, &stage.at(Evaluation::implicit_end)->displacement,
                             &stage.at(Evaluation::implicit_end)->rate})
        c->w = 0;
      stage.impulse.reset();
      change(stage);
    });
  };
  CHECK(without([](Stage&) {}) == "nothing");
  const std::vector<std::pair<const char*, std::function<void(Stage&)>>> weights = {
      {"stage 1: update weighs w", [](Stage& stage) { stage.update[1].w = 1; }},
      {"stage 1: impact measure weighs w", [](Stage& stage) { stage.impact->value.w = 1; }},
      {"stage 1: compliance weighs w", [](Stage& stage) { stage.at(Evaluation::implicit_end)->displacement.w = 1; }},
      {"stage 1: compliance rate weighs w", [](Stage& stage) { stage.at(Evaluation::implicit_end)->rate.w = 1; }},
      {"stage 1: work displacement weighs w", [](Stage& stage) { stage.work->displacement.w = 1; }},
      {"stage 1: work rate weighs w", [](Stage& stage) { stage.work->rate.w = 1; }},
      {"stage 1: loss weighs w", [](Stage& stage) { stage.loss[0].value.w = 1; }}};
  for (const auto& [sentence, change] : weights) CHECK_THAT(without(change), Contains(sentence));
  // Where there is one, it is not known before its effort is, nor after the step.
  CHECK_THAT(wrong([](Stage& stage) {
               stage.impact = {.value = stage.update[1],
                               .gate = VelocityGate{{.slots = {1}, .w = 1}, {}, {.slots = {0, 1}}, {}, 0}};
             }),
             Contains("stage 1: gate predictor weighs w"));
  CHECK_THAT(wrong([](Stage& stage) {
               stage.impact = {.value = stage.update[1],
                               .gate = VelocityGate{{.slots = {1}}, {}, {.slots = {0, 1}, .w = 1}, {}, 0}};
             }),
             Contains("stage 1: gate approach weighs w"));
  CHECK_THAT(
      wrong([](Stage& stage) { stage.at(Evaluation::implicit_end)->before = Combination{.slots = {1}, .w = 1}; }),
      Contains("stage 1: compliance before the step weighs w"));
  StepPlan plan = impulsive();
  plan.velocity.w = 1;
  CHECK_THAT(check_plan(plan).value_or("nothing"), Contains("velocity weighs w"));
}

TEST_CASE("a number of an impulse that is not finite is found") {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const std::vector<std::pair<const char*, std::function<void(Stage&)>>> faults = {
        {"stage 1: R of the impulse", [&](Stage& stage) { stage.impulse->R.M = bad; }},
        {"stage 1: R of the impulse", [&](Stage& stage) { stage.impulse->R.K = bad; }},
        {"stage 1: feed of the impulse", [&](Stage& stage) { stage.impulse->feed.C = bad; }},
        {"stage 1: impact impulse", [&](Stage& stage) { stage.impact->impulse = bad; }},
        {"stage 1: compliance impulse", [&](Stage& stage) { stage.at(Evaluation::implicit_end)->impulse = bad; }},
        {"stage 1: work impulse", [&](Stage& stage) { stage.work->impulse = bad; }},
        {"stage 1: update", [&](Stage& stage) { stage.update[0].w = bad; }},
        {"stage 1: loss", [&](Stage& stage) { stage.loss[0].value.w = bad; }}};
    for (const auto& [sentence, change] : faults)
      CHECK_THAT(wrong(change), Contains(sentence) && Contains("is not finite"));
  }
}

TEST_CASE("an impulse gives a free mass what it gives its velocity, its feed included") {
  const auto momentum = [](const StepPlan& plan, std::optional<Evaluation> evaluation) {
    return effort_momenta(plan, evaluation).stages[0];
  };
  StepPlan plan = impulsive();
  CHECK(momentum(plan, std::nullopt) == Approx(h).epsilon(1e-12));  // w = h p, without a share of z
  plan.stages[0].impact->impulse = 0.5;
  CHECK(momentum(plan, std::nullopt) == Approx(h / 2).epsilon(1e-12));
  plan.stages[0].impact->effort = {0.25};  // z takes h/4 p more
  CHECK(momentum(plan, std::nullopt) == Approx(0.75 * h).epsilon(1e-12));
  plan.stages[0].impulse->feed.M = 2;  // and h·2w
  CHECK(momentum(plan, std::nullopt) == Approx(h * (0.75 + 2 * h / 2)).epsilon(1e-12));
  // An evaluation that leaves w alone acts on z.
  CHECK(momentum(plan, Evaluation::implicit_end) == Approx(h).epsilon(1e-12));
  // The start rule's too.
  plan = impulsive();
  plan.start = plan.stages;
  plan.start_advances = true;
  CHECK(effort_momenta(plan, std::nullopt).start[0] == Approx(h).epsilon(1e-12));
  // Without inertia in R a mass gets an infinite speed: nothing is derived.
  plan.stages[0].impulse->R = {0, 0, 1};
  CHECK(derive(plan).h == 0);
}

TEST_CASE("levels of stops that weigh w stand where the position stands") {
  StepPlan plan = impulsive();
  // An explicit update, which w alone can move.
  plan.stages[0].update[0].z = plan.stages[0].impact->value.z = plan.stages[0].work->displacement.z = 0;
  plan.stages[0].at(Evaluation::implicit_end)->displacement = {.slots = {1, h / 2}, .w = h / 4};
  REQUIRE(check_plan(plan).value_or("nothing") == "nothing");
  const Stage stage = derive(plan).plan.stages[0];
  REQUIRE(stage.impact->bound.size() == 1);
  CHECK(stage.impact->bound[0].at == 1);
  const Levels& mean = stage.at(Evaluation::implicit_end)->bound;
  REQUIRE(mean.size() == 2);  // half with the new position, half with the old one
  CHECK(mean[0].at == 1);
  CHECK(mean[0].weight == 0.5);
  CHECK(mean[1].at == 0);
  CHECK(mean[1].weight == 0.5);
}

TEST_CASE("an impulse is printed with its equation and its weights") {
  const std::string text = print_plan(impulsive());
  INFO(text);
  CHECK_THAT(text, Contains("b = (−K) q + (−C − 0.05 K) v + (−0.5 C − 0.025 K) w + F(t+0.5h)"));
  CHECK_THAT(text, Contains("impulse: (10 M) w = Hᵀp"));
  CHECK_THAT(text, Contains("y = H(q + 0.1 v + 0.005 z + 0.05 w), bounded by bound(t+1h), effort 0, impulse p"));
  CHECK_THAT(text, Contains("effort p, impulse 0"));
  CHECK_THAT(text, Contains("v ← v + 0.1 z + w"));
  CHECK_THAT(text, Contains("effort p and 1 of the impulse"));
}

}  // namespace impulse_plan_tests
