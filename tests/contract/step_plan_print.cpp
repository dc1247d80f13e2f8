#include <catch2/catch.hpp>
#include <ricochet/contract/step_plan.hpp>

#include "tests/contract/full_plan.hpp"

namespace step_plan_tests {

TEST_CASE("a plan is printed as the equations with their numbers") {
  const std::string text = print_plan(full_plan());
  INFO(text);
  CHECK_THAT(text, Contains("slots: q, d"));
  CHECK_THAT(text, Contains("start (moves time by h)"));
  CHECK_THAT(text, Contains("stage 1: S z = b + Hᵀp"));
  CHECK_THAT(text, Contains("S = 100 M + 5 C + 0.25 K"));
  CHECK_THAT(text, Contains("b = (−K) q + (−10 C) d + 0.25 F(t+1h) + 0.5 F(t) + 0.25 F(t−1h)"));
  CHECK_THAT(text, Contains("y = H(q + d + z), bounded by bound(t+1h)"));
  CHECK_THAT(text,
             Contains("g (implicit) = H(q + 0.5 d + 0.5 z) against 0.5 bound(t+1h) + 0.5 bound(t), effort 0.25 p + "
                      "0.5 p₋₁ + 0.25 p₋₂"));
  CHECK_THAT(text, Contains("g (averaged)") && Contains("g (explicit)") && Contains("g (conserving)"));
  CHECK_THAT(text, Contains("one step before H(q − 0.5 d) against 0.5 bound(t) + 0.5 bound(t−1h)"));
  CHECK_THAT(text, Contains("rate H(10 d) against bound'(t)"));
  CHECK_THAT(text, Contains("work: s = d + 0.5 z, r = 10 d, load F(t), effort p, stops move by φ(t+1h) − φ(t)"));
  CHECK_THAT(text, Contains("dissipated by the scheme: 0.1 |d + z|²_K"));
  CHECK_THAT(text, Contains("velocity: 10 d, which stands at t+0.5h"));
  CHECK_THAT(text, Contains("q ← q + d + z") && Contains("d ← d + z"));
  CHECK_THAT(text, Contains("scheme energy: 50 |d|²_M + 0.5 |q − 0.5 d|²_K"));
}

TEST_CASE("a velocity-level plan is printed with its gap test and rebound") {
  const std::string text = print_plan(gated_plan());
  INFO(text);
  CHECK_THAT(text, Contains("bounded by bound'(t+1h)"));
  CHECK_THAT(text, Contains("closed where H(q + 0.5 d) passes bound(t+0.5h)"));
  CHECK_THAT(text, Contains("rebound e = 0.8 of an approaching H(10 d) against bound'(t)"));
}

TEST_CASE("what a plan leaves out is not printed") {
  StepPlan plan = full_plan();
  plan.start.clear();
  plan.energy.clear();
  plan.stages[0].impact.reset();
  plan.stages[0].compliance = {};
  plan.stages[0].work.reset();
  plan.stages[0].loss.clear();
  plan.stages[0].matrix = {0, 0, 0};
  plan.start_advances = false;
  const std::string text = print_plan(plan);
  INFO(text);
  CHECK_THAT(text, !Contains("start") && Contains("scheme energy: none is declared") && !Contains("y =") &&
                       !Contains("g (") && !Contains("S =") && !Contains("work:") && !Contains("dissipated"));
}

TEST_CASE("an ill-formed plan is printed as far as it goes, with what is wrong") {
  const std::vector<Fault> faults = {
      {"the first slot of a plan", [](StepPlan& p) { p.slots.clear(); }},
      {"how it starts", [](StepPlan& p) { p.initial.clear(); }},
      {"one to 6 are marched", [](StepPlan& p) { p.stages.clear(); }},
      {"update must give one combination per slot", [](StepPlan& p) { p.stages[0].update.clear(); }},
      {"update must give one combination per slot", [](StepPlan& p) { p.start[0].update.resize(1); }},
      {"history names more slots",
       [](StepPlan& p) {
         p.stages[0].history.resize(3, {1, 1, 1});
       }},
      {"impact measure combines more slots", [](StepPlan& p) { p.stages[0].impact->value.slots.resize(3, 1.0); }},
      {"energy: more slots", [](StepPlan& p) { p.energy[0].slots.resize(3, 1.0); }},
      {"120 effort weights", [](StepPlan& p) { p.stages[0].impact->effort.resize(120, 1.0); }},
      {"is not finite", [](StepPlan& p) { p.stages[0].matrix.M = not_a_number; }},
  };
  for (const Fault& fault : faults) {
    StepPlan plan = full_plan();
    fault.make(plan);
    CHECK_THAT(print_plan(plan), Contains("slots: ") && Contains("ill-formed: ") && Contains(fault.sentence));
  }
}

}  // namespace step_plan_tests
