// What is derived of a plan: when its stages stand, the levels of its stops, what momentum its efforts give.
#include <ricochet/contract/momentum_weights.hpp>
#include <ricochet/contract/plan_algebra.hpp>
#include <ricochet/contract/stage_facts.hpp>

#include "tests/composed_plan.hpp"
#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

constexpr double h = 1e-3;

StepPlan plan(const Choice& time) {
  auto made = plan_of(time, h, {});
  REQUIRE(std::holds_alternative<StepPlan>(made));
  return std::get<StepPlan>(made);
}

std::vector<Choice> of_second_order() {
  const std::string weighted = "weighted", middle = "middle", first = "first-order";
  return {{"newmark"},
          {"newmark", {{"beta", 0.1}}},
          {"newmark-dumont-paoli"},
          {"newmark-dumont-paoli", {{"beta", 0.0}, {"restitution", 0.8}}},
          {"newmark-dumont-paoli", {{"beta", 0.25}, {"restitution", 1.0}, {"start", first}}},
          {"moreau-jean"},
          {"moreau-jean", {{"restitution", 0.8}}},
          {"midpoint"},
          {"midpoint", {{"constraint", middle}}},
          {"hht-alpha"},
          {"hht-alpha", {{"alpha", -0.3}, {"contact", weighted}}},
          {"nonsmooth-generalised-alpha"},
          {"bathe"},
          {"bathe", {{"rho_inf", 0.8}, {"split", 0.4}}}};
}

}  // namespace

TEST_CASE("levels of stops that are left out are those that every method of the tree declares") {
  for (const Choice& time : of_second_order()) {
    const StepPlan declared = plan(time), bare = without_stop_levels(declared);
    INFO(time.name);
    CHECK(check_plan(bare).value_or("nothing") == "nothing");
    const auto given = derive(steps_of(declared)).plan.stages, found = derive(steps_of(bare)).plan.stages;
    for (std::size_t k = 0; k < given.size(); ++k) check_same_stops(given[k], found[k]);
  }
  // With θ or γ above ½ velocities stand O(h) off the positions, by a rate or by the other: positions are the same.
  for (const Choice& time :
       {Choice{"moreau-jean", {{"theta", 0.8}}}, Choice{"newmark", {{"beta", 0.36}, {"gamma", 0.7}}}}) {
    INFO(time.name);
    const StepPlan declared = plan(time);
    check_same_stops(derive(declared).plan.stages[0], derive(without_stop_levels(declared)).plan.stages[0], false);
  }
}

TEST_CASE("in a start stage a rate of slots alone stands where the stage begins, one that it finds where it ends") {
  using namespace plan_algebra;
  const auto [q, v] = slots<2>();
  StepPlan plan;
  plan.slots = {"q", "v"};
  plan.initial = {{1, 0}, {0, 1}};
  plan.velocity = v;
  Stage stage;
  stage.matrix = M / (h * h);
  stage.history = -(K * q);
  stage.load = at(0);
  stage.impact = ImpactMeasure{.value = q + h * v + z};
  stage.at(Evaluation::implicit_end) = ComplianceMeasure{.displacement = q + h * v + z, .rate = v + 1 / h * z};
  stage.at(Evaluation::explicit_start) = ComplianceMeasure{.displacement = q, .rate = v};
  stage.update = {q + h * v + z, v + 1 / h * z};
  plan.start = plan.stages = {stage};
  plan.start_advances = true;
  const Stage start = derive(plan).plan.start[0];
  const Levels &begins = start.at(Evaluation::explicit_start)->rate_bound,
               &ends = start.at(Evaluation::implicit_end)->rate_bound;
  REQUIRE(begins.size() == 1);
  REQUIRE(ends.size() == 1);
  CHECK(begins[0].at == 0);
  CHECK(ends[0].at == 1);
}

TEST_CASE("a stage stands where it leads the position") {
  for (const Choice& time : of_second_order()) {
    INFO(time.name);
    const DerivedPlan derived = derive(plan(time));
    CHECK(derived.h == Approx(h).epsilon(1e-9));  // found as a difference of positions of some steps
    const std::size_t stages = derived.stages.size();
    CHECK(derived.stages.front().from == Approx(0).margin(1e-12));
    CHECK(derived.stages.back().to == Approx(1).margin(1e-12));
    for (std::size_t k = 1; k < stages; ++k) CHECK(derived.stages[k].from == derived.stages[k - 1].to);
    for (const StageFacts& facts : derived.stages) CHECK(facts.instant == facts.to);
  }
  CHECK(derive(plan({"bathe", {{"split", 0.5}}})).stages[0].to == 0.5);
  CHECK(derive(plan({"bathe"})).stages[0].to == Approx(2 - std::sqrt(2)).epsilon(1e-12));
  // A start rule that moves time ends at h, one that only finds an acceleration where it began.
  CHECK(derive(plan({"newmark-dumont-paoli"})).start[0].to == Approx(1).margin(1e-12));
  CHECK(derive(plan({"newmark"})).start[0].to == Approx(0).margin(1e-12));
}

TEST_CASE("a stage that does not move the position asks when its stop is looked at") {
  // A projection after the step: the position is there already, and stays on a free motion.
  StepPlan projected = plan({"midpoint"});
  Stage projection;
  projection.matrix = {1 / (h * h), 0, 0};
  projection.impact = {.value = {.slots = {1}, .z = 1}};
  projection.update = {{.slots = {1}, .z = 1}, {.slots = {0, 1}}};
  projected.stages.push_back(projection);
  CHECK(check_plan(projected).value_or("nothing") == "nothing");
  const DerivedPlan derived = derive(projected);
  CHECK(derived.stages[1].from == 1);
  CHECK(derived.stages[1].to == 1);
  CHECK(derived.stages[1].instant == 1);
  const auto momentum = effort_momenta(derived.plan, std::nullopt).stages;
  CHECK(momentum[0] == Approx(h));
  CHECK(momentum[1] == 0);  // it changes no velocity
}

TEST_CASE("the position moves by its increment, found without the digits that a difference loses") {
  for (const Choice& time : of_second_order())
    for (const StageFacts& facts : derive(plan(time)).stages) CHECK(facts.increment.slots[0] == 0);
  const Combination increment = derive(plan({"newmark-dumont-paoli"})).stages[0].increment;
  CHECK(increment.slots == std::vector<double>{0, 1});
  CHECK(increment.z == 1);
}

TEST_CASE("momenta of one effort: h in a plan of one stage whatever its weights, shares of h where there are more") {
  const auto momentum = [](const StepPlan& plan, std::optional<Evaluation> evaluation) {
    return effort_momenta(plan, evaluation).stages;
  };
  std::vector<Choice> times = of_second_order();
  times.push_back({"newmark", {{"beta", 0.36}, {"gamma", 0.7}}});
  times.push_back({"moreau-jean", {{"theta", 0.8}}});
  for (const Choice& time : times) {
    if (time.name == "bathe") continue;
    for (const std::optional<Evaluation>& evaluation :
         {std::optional<Evaluation>(), std::optional(Evaluation::implicit_end), std::optional(Evaluation::averaged)}) {
      INFO(time.name << (evaluation ? evaluation_word(*evaluation) : " rigid"));
      CHECK(momentum(plan(time), evaluation)[0] == Approx(h).epsilon(1e-9));
      for (const double share : momentum(composed(plan(time), 3), evaluation)) CHECK(share == Approx(h).epsilon(1e-9));
    }
  }
  const auto thirds = momentum(plan({"bathe", {{"split", 0.5}}}), std::nullopt);
  CHECK(thirds[0] == Approx(h / 3).epsilon(1e-12));
  CHECK(thirds[1] == Approx(2 * h / 3).epsilon(1e-12));
  for (const double rho : {0.0, 0.3, 0.8, 1.0})
    for (const double split : {0.3, 0.5, 0.7}) {
      const double q1 = (rho + 1) / (2 * split * (rho - 1) + 4);
      const auto shares = momentum(plan({"bathe", {{"rho_inf", rho}, {"split", split}}}), std::nullopt);
      CHECK(shares[0] == Approx(h * q1).epsilon(1e-9));
      CHECK(shares[1] == Approx(h * (1 - q1)).epsilon(1e-9));  // q₂ + q₀, as q₀ + q₁ + q₂ = 1
    }
}

TEST_CASE("the start rule's efforts give what they give to a mass that starts") {
  const auto given = [](const StepPlan& plan, std::size_t stage, std::optional<Evaluation> evaluation) {
    return effort_momenta(plan, evaluation).start.at(stage);
  };
  // Half a step: of the first trapezium, and of the symmetric start q₁ − q₋₁ = 2h v₀.
  CHECK(given(plan({"newmark"}), 0, std::nullopt) == Approx(h / 2).epsilon(1e-9));
  CHECK(given(plan({"newmark-dumont-paoli"}), 0, std::nullopt) == Approx(h / 2).epsilon(1e-9));
  for (const double beta : {0.25, 0.5})
    for (const std::optional<Evaluation>& evaluation :
         {std::optional<Evaluation>(), std::optional(Evaluation::averaged)}) {
      const StepPlan one = plan({"newmark-dumont-paoli", {{"beta", beta}}}), three = composed(one, 3);
      REQUIRE(three.start.size() == 3);
      CHECK(given(three, 0, evaluation) == Approx(given(one, 0, evaluation)).epsilon(1e-9));
      CHECK(given(three, 1, evaluation) == Approx(h).epsilon(1e-9));
      CHECK(given(three, 2, evaluation) == Approx(h).epsilon(1e-9));
    }
}

TEST_CASE("velocities stand at the end of a step, or in the middle of what they are the mean of") {
  for (const Choice& time : of_second_order()) {
    INFO(time.name);
    const bool mean = time.name == "newmark-dumont-paoli";  // its first-order start included
    CHECK(derive(plan(time)).velocity_offset == (mean ? -0.5 : 0.0));
  }
  CHECK(derive(plan({"moreau-jean", {{"theta", 1.0}}})).velocity_offset == 0);
  CHECK(derive(plan({"newmark", {{"beta", 0.36}, {"gamma", 0.7}}})).velocity_offset == 0);
  // Of the last of two sub-steps.
  CHECK(derive(composed(plan({"newmark-dumont-paoli"}), 2)).velocity_offset == -0.25);
}

TEST_CASE("without inertia nothing tells where a stage stands: everything is asked at the end of the step") {
  StepPlan massless = without_stop_levels(plan({"midpoint"}));
  massless.stages[0].matrix.M = 0;
  CHECK(inconsistent_motion(massless).empty());
  const DerivedPlan derived = derive(massless);
  CHECK(derived.h == 0);
  CHECK(derived.stages[0].to == 1);
  CHECK(derived.plan.stages[0].impact->bound.size() == 1);
  CHECK(derived.plan.stages[0].impact->bound[0].at == 1);
  CHECK(std::isnan(effort_momenta(massless, std::nullopt).stages[0]));
  CHECK(effort_momenta(massless, std::nullopt).why_none == "a stage of the plan solves without M");
  CHECK(print_plan(massless).find("stage 1") != std::string::npos);
}
