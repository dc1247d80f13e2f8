#include <catch2/catch.hpp>
#include <functional>
#include <limits>
#include <ricochet/contract/step_plan.hpp>

using namespace ricochet;
using Catch::Matchers::Contains;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

// A plan that fills everything that a plan may say; the numbers mean nothing.
StepPlan full_plan() {
  StepPlan plan;
  plan.slots = {"q", "d"};
  plan.initial = {{1, 0}, {0, 0.1}};
  plan.velocity = {.slots = {0, 10}};
  Stage stage;
  stage.matrix = {100, 5, 0.25};
  stage.history = {{0, 0, -1}, {0, -10, 0}};
  stage.load = {{1, 0.25}, {0, 0.5}, {-1, 0.25}};
  stage.impact = {{.slots = {1, 1}, .z = 1}, {{1, 1}}, std::nullopt};
  for (auto& compliance : stage.compliance)
    compliance = {{.slots = {1, 1}, .z = 1}, {{1, 0.5}, {0, 0.5}}, {.slots = {0, 10}}, {{0, 1}}, {0.25, 0.5, 0.25}};
  stage.update = {{.slots = {1, 1}, .z = 1}, {.slots = {0, 1}, .z = 1}};
  stage.increment = {.slots = {0, 1}, .z = 1};
  stage.work = {{.slots = {0, 1}, .z = 0.5}, {.slots = {0, 10}}, {{0, 1}}, {1}, {{1, 1}, {0, -1}}};
  plan.stages = {stage};
  Stage start;
  start.update = {{.slots = {1, 1}}, {.slots = {0, 1}}};
  start.increment = {.slots = {0, 1}};
  plan.start = {start};
  plan.start_advances = true;
  plan.energy = {{QuadraticTerm::Matrix::M, 50, {0, 1}}, {QuadraticTerm::Matrix::K, 0.5, {1, -0.5}}};
  plan.facts.stability_limit = 2;
  return plan;
}

StepPlan gated_plan() {
  StepPlan plan = full_plan();
  ImpactMeasure& impact = *plan.stages[0].impact;
  impact.gate = VelocityGate{{.slots = {1, 0.05}}, {{0.5, 1}}, {.slots = {0, 1}}, {{0, 1}}, 0.8};
  return plan;
}

struct Fault {
  const char* sentence;
  std::function<void(StepPlan&)> make;
};

std::string wrong(StepPlan plan, const Fault& fault) {
  fault.make(plan);
  return check_plan(plan).value_or("nothing");
}

}  // namespace

TEST_CASE("a plan that holds together passes") {
  CHECK_FALSE(check_plan(full_plan()));
  CHECK_FALSE(check_plan(gated_plan()));
  StepPlan bare = full_plan();
  bare.start.clear();
  bare.energy.clear();
  bare.facts.stability_limit.reset();
  bare.stages[0].impact.reset();
  bare.stages[0].work.reset();
  bare.stages[0].compliance = {};
  CHECK_FALSE(check_plan(bare));
}

TEST_CASE("what is wrong with the shape of a plan is told") {
  const std::vector<Fault> faults = {
      {"the first slot of a plan is the position q", [](StepPlan& p) { p.slots.clear(); }},
      {"the first slot of a plan is the position q", [](StepPlan& p) { p.slots[0] = "v"; }},
      {"for each slot how it starts", [](StepPlan& p) { p.initial.pop_back(); }},
      {"one to three stages", [](StepPlan& p) { p.stages.clear(); }},
      {"one to three stages", [](StepPlan& p) { p.stages.resize(4, p.stages[0]); }},
      {"stage 1: update must give one combination per slot", [](StepPlan& p) { p.stages[0].update.pop_back(); }},
      {"start: update must give one combination per slot", [](StepPlan& p) { p.start[0].update.pop_back(); }},
      {"stage 2: update must", [](StepPlan& p) { p.stages.emplace_back(); }},
      {"stage 1: history names more slots", [](StepPlan& p) { p.stages[0].history.resize(3); }},
      {"stage 1: increment combines more slots", [](StepPlan& p) { p.stages[0].increment.slots.resize(3); }},
      {"stage 1: update combines more slots", [](StepPlan& p) { p.stages[0].update[1].slots.resize(3); }},
      {"stage 1: impact measure combines more slots", [](StepPlan& p) { p.stages[0].impact->value.slots.resize(3); }},
      {"energy: more slots", [](StepPlan& p) { p.energy[1].slots.resize(3); }},
      {"velocity combines more slots", [](StepPlan& p) { p.velocity.slots.resize(3); }},
      {"velocity combines slots after the step, not z", [](StepPlan& p) { p.velocity.z = 1; }},
      {"compliance has one to three effort weights", [](StepPlan& p) { p.stages[0].compliance[1]->effort.clear(); }},
      {"compliance has one to three effort weights", [](StepPlan& p) { p.stages[0].compliance[1]->effort.resize(4); }},
      {"work has one to three effort weights", [](StepPlan& p) { p.stages[0].work->effort.clear(); }},
      {"the order is positive", [](StepPlan& p) { p.facts.order = 0; }},
      {"the stability limit is positive", [](StepPlan& p) { p.facts.stability_limit = 0; }},
  };
  for (const Fault& fault : faults) CHECK_THAT(wrong(full_plan(), fault), Contains(fault.sentence));
}

TEST_CASE("a bound of positions weights its levels to one, a bound of rates need not") {
  const std::vector<Fault> faults = {
      {"position-level impact bound must weight its levels to one",
       [](StepPlan& p) {
         p.stages[0].impact->bound = {{1, 0.5}};
       }},
      {"compliance bound must weight its levels to one",
       [](StepPlan& p) {
         p.stages[0].compliance[2]->bound = {{1, 2}};
       }},
      {"bound must weight its levels to one", [](StepPlan& p) { p.stages[0].compliance[0]->bound.clear(); }},
  };
  for (const Fault& fault : faults) CHECK_THAT(wrong(full_plan(), fault), Contains(fault.sentence));
  CHECK_THAT(wrong(gated_plan(), {"",
                                  [](StepPlan& p) {
                                    p.stages[0].impact->gate->predictor_bound = {{1, 2}};
                                  }}),
             Contains("gate predictor bound must weight its levels to one"));
  CHECK(wrong(gated_plan(), {"", [](StepPlan& p) { p.stages[0].impact->bound = {{1, 2}}; }}) == "nothing");
}

TEST_CASE("a number that is not finite is found wherever it stands") {
  double bad = not_a_number;
  const std::vector<Fault> faults = {
      {"initial", [&](StepPlan& p) { p.initial[1][1] = bad; }},
      {"stage 1: S", [&](StepPlan& p) { p.stages[0].matrix.M = bad; }},
      {"stage 1: S", [&](StepPlan& p) { p.stages[0].matrix.C = bad; }},
      {"stage 1: S", [&](StepPlan& p) { p.stages[0].matrix.K = bad; }},
      {"stage 1: history", [&](StepPlan& p) { p.stages[0].history[1].C = bad; }},
      {"stage 1: load", [&](StepPlan& p) { p.stages[0].load[2].at = bad; }},
      {"stage 1: load", [&](StepPlan& p) { p.stages[0].load[2].weight = bad; }},
      {"stage 1: update", [&](StepPlan& p) { p.stages[0].update[0].slots[1] = bad; }},
      {"stage 1: update", [&](StepPlan& p) { p.stages[0].update[0].z = bad; }},
      {"start: update", [&](StepPlan& p) { p.start[0].update[0].z = bad; }},
      {"stage 1: increment", [&](StepPlan& p) { p.stages[0].increment.z = bad; }},
      {"stage 1: impact measure", [&](StepPlan& p) { p.stages[0].impact->value.z = bad; }},
      {"stage 1: impact bound", [&](StepPlan& p) { p.stages[0].impact->bound[0].at = bad; }},
      {"stage 1: gate predictor", [&](StepPlan& p) { p.stages[0].impact->gate->predictor.z = bad; }},
      {"stage 1: gate approach", [&](StepPlan& p) { p.stages[0].impact->gate->approach.slots[0] = bad; }},
      {"stage 1: gate approach bound", [&](StepPlan& p) { p.stages[0].impact->gate->approach_bound[0].at = bad; }},
      {"stage 1: restitution", [&](StepPlan& p) { p.stages[0].impact->gate->restitution = bad; }},
      {"stage 1: compliance", [&](StepPlan& p) { p.stages[0].compliance[1]->displacement.z = bad; }},
      {"stage 1: compliance rate", [&](StepPlan& p) { p.stages[0].compliance[1]->rate.z = bad; }},
      {"stage 1: compliance rate bound", [&](StepPlan& p) { p.stages[0].compliance[1]->rate_bound[0].weight = bad; }},
      {"stage 1: compliance", [&](StepPlan& p) { p.stages[0].compliance[1]->effort[2] = bad; }},
      {"stage 1: work displacement", [&](StepPlan& p) { p.stages[0].work->displacement.z = bad; }},
      {"stage 1: work rate", [&](StepPlan& p) { p.stages[0].work->rate.slots[1] = bad; }},
      {"stage 1: work load", [&](StepPlan& p) { p.stages[0].work->load[0].weight = bad; }},
      {"stage 1: work", [&](StepPlan& p) { p.stages[0].work->effort[0] = bad; }},
      {"stage 1: work support", [&](StepPlan& p) { p.stages[0].work->support[0].weight = bad; }},
      {"energy", [&](StepPlan& p) { p.energy[0].coefficient = bad; }},
      {"energy", [&](StepPlan& p) { p.energy[0].slots[1] = bad; }},
      {"velocity", [&](StepPlan& p) { p.velocity.slots[1] = bad; }},
  };
  for (const double value : {not_a_number, infinity, -infinity}) {
    bad = value;
    for (const Fault& fault : faults) {
      INFO(fault.sentence << ": " << bad);
      CHECK_THAT(wrong(gated_plan(), fault), Contains(fault.sentence) && Contains("is not finite"));
    }
  }
}

TEST_CASE("the first fault is the one told") {
  StepPlan plan = full_plan();
  plan.stages[0].matrix.M = not_a_number;
  plan.initial.clear();
  CHECK_THAT(*check_plan(plan), Contains("how it starts"));
}

TEST_CASE("a plan is printed as the equations with their numbers") {
  const std::string text = print_plan(full_plan());
  INFO(text);
  CHECK_THAT(text, Contains("slots: q, d"));
  CHECK_THAT(text, Contains("start (moves time by h)"));
  CHECK_THAT(text, Contains("stage 1: S z = b + Hᵀp"));
  CHECK_THAT(text, Contains("S = 100 M + 5 C + 0.25 K"));
  CHECK_THAT(text, Contains("b = (−K) q + (−10 C) d + 0.25 F(t+1h) + 0.5 F(t) + 0.25 F(t−1h)"));
  CHECK_THAT(text, Contains("y = H(q + d + z), bounded by bound(t+1h)"));
  CHECK_THAT(text, Contains("g (implicit) = H(q + d + z), effort 0.25 p + 0.5 p₋₁ + 0.25 p₋₂"));
  CHECK_THAT(text, Contains("g (averaged)") && Contains("g (explicit)"));
  CHECK_THAT(text, Contains("q ← q + d + z") && Contains("d ← d + z"));
  CHECK_THAT(text, Contains("scheme energy: 50 |d|²_M + 0.5 |q − 0.5 d|²_K"));
}

TEST_CASE("a velocity-level plan is printed with its gap test and rebound") {
  const std::string text = print_plan(gated_plan());
  INFO(text);
  CHECK_THAT(text, Contains("bounded by bound'(t+1h)"));
  CHECK_THAT(text, Contains("closed where H(q + 0.05 d) passes bound(t+0.5h)"));
  CHECK_THAT(text, Contains("rebound e = 0.8 of an approaching H(d)"));
}

TEST_CASE("what a plan leaves out is not printed") {
  StepPlan plan = full_plan();
  plan.start.clear();
  plan.energy.clear();
  plan.stages[0].impact.reset();
  plan.stages[0].compliance = {};
  plan.stages[0].matrix = {0, 0, 0};
  const std::string text = print_plan(plan);
  INFO(text);
  CHECK_THAT(text,
             !Contains("start") && !Contains("energy") && !Contains("y =") && !Contains("g (") && !Contains("S ="));
}
