#include <catch2/catch.hpp>
#include <ricochet/contract/step_plan.hpp>

#include "tests/contract/full_plan.hpp"

namespace step_plan_tests {

TEST_CASE("a plan that holds together passes") {
  CHECK_FALSE(check_plan(full_plan()));
  CHECK_FALSE(check_plan(gated_plan()));
  StepPlan bare = full_plan();
  bare.start.clear();
  bare.start_advances = false;
  bare.energy.clear();
  bare.facts.stability_limit.reset();
  bare.stages[0].impact.reset();
  bare.stages[0].work.reset();
  bare.stages[0].compliance = {};
  CHECK(check_plan(bare).value_or("") == "");
}

TEST_CASE("what is wrong with the shape of a plan is told") {
  const std::vector<Fault> faults = {
      {"the first slot of a plan is the position q", [](StepPlan& p) { p.slots.clear(); }},
      {"the first slot of a plan is the position q", [](StepPlan& p) { p.slots[0] = "v"; }},
      {"for each slot how it starts", [](StepPlan& p) { p.initial.pop_back(); }},
      {"the plan has 9 slots, at most 8 are marched",
       [](StepPlan& p) {
         p.slots.resize(9, "x");
         p.initial.resize(9);
       }},
      {"slot 2 has no name", [](StepPlan& p) { p.slots[1].clear(); }},
      {"two slots have the name q", [](StepPlan& p) { p.slots[1] = "q"; }},
      {"the plan has 0 stages, one to 6 are marched", [](StepPlan& p) { p.stages.clear(); }},
      {"the plan has 7 stages, one to 6 are marched", [](StepPlan& p) { p.stages.resize(7, p.stages[0]); }},
      {"the start has 7 stages, at most 6 are marched", [](StepPlan& p) { p.start.resize(7, p.start[0]); }},
      {"stage 1: update must give one combination per slot", [](StepPlan& p) { p.stages[0].update.pop_back(); }},
      {"start: update must give one combination per slot", [](StepPlan& p) { p.start[0].update.pop_back(); }},
      {"stage 2: update must", [](StepPlan& p) { p.stages.emplace_back(); }},
      {"stage 1: history names more slots", [](StepPlan& p) { p.stages[0].history.resize(3); }},
      {"stage 1: loss combines more slots", [](StepPlan& p) { p.stages[0].loss[0].value.slots.resize(3); }},
      {"stage 1: loss has a negative coefficient: it would be a gain",
       [](StepPlan& p) { p.stages[0].loss[0].coefficient = -1; }},
      {"stage 1: compliance before the step combines more slots",
       [](StepPlan& p) { p.stages[0].compliance[3]->before->slots.resize(3); }},
      {"stage 1: update combines more slots", [](StepPlan& p) { p.stages[0].update[1].slots.resize(3); }},
      {"stage 1: impact measure combines more slots", [](StepPlan& p) { p.stages[0].impact->value.slots.resize(3); }},
      {"energy: more slots", [](StepPlan& p) { p.energy[1].slots.resize(3); }},
      {"velocity combines more slots", [](StepPlan& p) { p.velocity.slots.resize(3); }},
      {"velocity combines slots after the step, not z", [](StepPlan& p) { p.velocity.z = 1; }},
      {"impact has 0 effort weights, one to 13 are marched", [](StepPlan& p) { p.stages[0].impact->effort.clear(); }},
      {"compliance has 0 effort weights", [](StepPlan& p) { p.stages[0].compliance[1]->effort.clear(); }},
      {"compliance has 14 effort weights", [](StepPlan& p) { p.stages[0].compliance[1]->effort.resize(14); }},
      {"work has 0 effort weights", [](StepPlan& p) { p.stages[0].work->effort.clear(); }},
      {"stage 1: load has 9 time levels, at most 8 are marched", [](StepPlan& p) { p.stages[0].load.resize(9); }},
      {"stage 1: impact bound has 9 time levels", [](StepPlan& p) { p.stages[0].impact->bound.resize(9); }},
      {"stage 1: work support has 9 time levels", [](StepPlan& p) { p.stages[0].work->support.resize(9); }},
      {"the order at contact is positive, where it is known", [](StepPlan& p) { p.facts.contact_order = 0; }},
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
  };
  for (const Fault& fault : faults) CHECK_THAT(wrong(full_plan(), fault), Contains(fault.sentence));
  CHECK_THAT(wrong(gated_plan(), {"",
                                  [](StepPlan& p) {
                                    p.stages[0].impact->gate->predictor_bound = {{1, 2}};
                                  }}),
             Contains("gate predictor bound must weight its levels to one"));
  // The rate of a stop that is asked twice, for a velocity that is asked twice.
  CHECK(wrong(gated_plan(), {"", [](StepPlan& p) { p.stages[0].impact->bound = {{1, 2}, {0, -1}}; }}) == "nothing");
}

TEST_CASE("a stage gives back the work of a stage that has done some, once") {
  CHECK(check_plan(restoring_plan()).value_or("nothing") == "nothing");
  const auto clear = [](Levels& levels) { levels.clear(); };
  const std::vector<Fault> faults = {
      {"stage 1: gives back the work of the stage 1 before it, which is none of the same step",
       [](StepPlan& p) { std::swap(p.stages[0], p.stages[1]); }},
      {"stage 2: gives back the work of the stage -1 before it",
       [](StepPlan& p) { p.stages[1].impact->restores = -1; }},
      {"stage 2: a stage that gives work back has a work form", [](StepPlan& p) { p.stages[1].work.reset(); }},
      {"stage 2: a stage that gives work back has a work form, its own effort alone and no gate",
       [](StepPlan& p) {
         p.stages[1].impact->effort = {0.5, 0.5};
       }},
      {"and no gate", [](StepPlan& p) { p.stages[1].impact->gate = gated_plan().stages[0].impact->gate; }},
      {"stage 2: what a stage that gives work back measures is its test displacement",
       [](StepPlan& p) { p.stages[1].impact->value.z = 1; }},
      {"which its effort moves",
       [](StepPlan& p) { p.stages[1].impact->value.z = p.stages[1].work->displacement.z = 0; }},
      {"stage 2: the stage whose work is given back measures positions",
       [](StepPlan& p) { p.stages[0].impact.reset(); }},
      {"stage 2: the stage whose work is given back",
       [](StepPlan& p) {
         p.stages[0].work->effort = {0.5, 0.5};
       }},
      {"stage 3: the work that it gives back was given back before",
       [](StepPlan& p) {
         p.stages.push_back(p.stages[1]);
         p.stages[2].impact->restores = 2;
       }},
      {"stage 3: the stage whose work is given back measures positions",
       [](StepPlan& p) { p.stages.push_back(p.stages[1]); }},
      {"start: only a stage of a step gives work back",
       [&](StepPlan& p) {
         p.start = {p.stages[0], p.stages[1]};
         clear(p.start[1].impact->bound);
       }},
      {"stage 2: bound of the work given back stands at t + 2h",
       [](StepPlan& p) {
         p.stages[1].impact->bound = {{2, 1}, {0, -1}};
       }},
      // A stage without C needs no rate in its work form; one with C does.
      {"stage 1: work rate is 0 m/s", [](StepPlan& p) { p.stages[0].work->rate = {}; }},
  };
  for (const Fault& fault : faults) CHECK_THAT(wrong(restoring_plan(), fault), Contains(fault.sentence));
  const std::string text = print_plan(restoring_plan());
  INFO(text);
  CHECK_THAT(text, Contains("y = H(d + 0.5 z) against bound(t+1.5h) − bound(t+0.5h), p y gives back the work of "
                            "contact in the stage before"));
}

TEST_CASE("levels of stops may be left to be derived") {
  for (StepPlan plan : {full_plan(), gated_plan()}) {
    Stage& stage = plan.stages[0];
    stage.impact->bound.clear();
    if (stage.impact->gate) stage.impact->gate->predictor_bound.clear(), stage.impact->gate->approach_bound.clear();
    for (auto& compliance : stage.compliance) {
      compliance->bound.clear();
      compliance->rate_bound.clear();
      compliance->before_bound.clear();
    }
    stage.work->support.clear();
    CHECK(check_plan(plan).value_or("nothing") == "nothing");
  }
}

TEST_CASE("a plan carries a free mass at rest and at constant speed") {
  const std::vector<Fault> faults = {
      {"a step moves a free mass at 1 m/s by 0 m: a plan carries it forward by h",
       [](StepPlan& p) { p.stages[0].update[0] = {.slots = {1}}; }},
      {"a free mass at rest at 1 m is at 1.1 m after 1 steps",
       [](StepPlan& p) { p.start[0].update[0].slots[0] = 1.1; }},
      {"a free mass at 1 m/s moves by 1.5 h in 1 steps of the plan",
       [](StepPlan& p) { p.start[0].update[0].slots[1] = 1.5; }},
      {"velocity: the plan's velocity is 0.5 m/s on a motion at 1 m/s", [](StepPlan& p) { p.velocity.slots[1] = 5; }},
      // A slot that grows shows in the second step.
      {"velocity: the plan's velocity is 1.5 m/s", [](StepPlan& p) { p.stages[0].update[1].slots[1] = 1.5; }},
  };
  for (const Fault& fault : faults) CHECK_THAT(wrong(full_plan(), fault), Contains(fault.sentence));
}

TEST_CASE("measures are positions or velocities, and levels stand where what they bound does") {
  const auto clear = [](Levels& levels) { levels.clear(); };
  const std::vector<Fault> positions = {
      {"stage 1: impact bound stands at t + 2h on a motion at constant speed, what it bounds at t + 1h",
       [](StepPlan& p) {
         p.stages[0].impact->bound = {{2, 1}};
       }},
      {"stage 1: impact bound weights its levels to 1, what it bounds weights positions to 2",
       [](StepPlan& p) { p.stages[0].impact->value.slots[0] = 2; }},
      {"stage 1: the impact measure of a mass at rest is 2 times its position",
       [&](StepPlan& p) {
         p.stages[0].impact->value.slots[0] = 2;
         clear(p.stages[0].impact->bound);
       }},
      {"stage 1: compliance bound stands at t + 1h",
       [](StepPlan& p) {
         p.stages[0].compliance[1]->bound = {{1, 1}};
       }},
      {"stage 1: the compliance measure of a mass at rest is 2 times its position",
       [&](StepPlan& p) {
         p.stages[0].compliance[1]->displacement.slots[0] = 2;
         clear(p.stages[0].compliance[1]->bound);
       }},
      {"stage 1: compliance rate bound weights its levels to 2, what it bounds is 1 m/s on a motion at 1 m/s",
       [](StepPlan& p) {
         p.stages[0].compliance[1]->rate_bound = {{0, 2}};
       }},
      {"stage 1: compliance rate is 0.5 m/s on a motion at 1 m/s",
       [&](StepPlan& p) {
         p.stages[0].compliance[1]->rate.slots[1] = 5;
         clear(p.stages[0].compliance[1]->rate_bound);
       }},
      {"stage 1: compliance bound before the step stands at t + 0h",
       [](StepPlan& p) {
         p.stages[0].compliance[3]->before_bound = {{0, 1}};
       }},
      {"stage 1: the displacement before the step is 0.5 steps behind, the test displacement is 1",
       [&](StepPlan& p) {
         p.stages[0].compliance[3]->before = Combination{.slots = {1}};
         clear(p.stages[0].compliance[3]->before_bound);
       }},
      {"stage 1: work support stands at t + 0.5h",
       [](StepPlan& p) {
         p.stages[0].work->support = {{1, 0.5}, {0, -0.5}};
       }},
      {"stage 1: work rate is 0.5 m/s on a motion at 1 m/s", [](StepPlan& p) { p.stages[0].work->rate.slots[1] = 5; }},
      {"stage 1: the work displacement of a mass at rest is 1 times its position",
       [&](StepPlan& p) {
         p.stages[0].compliance = {};
         p.stages[0].work->displacement.slots[0] = 1;
         clear(p.stages[0].work->support);
       }},
  };
  for (const Fault& fault : positions) CHECK_THAT(wrong(full_plan(), fault), Contains(fault.sentence));
  const std::vector<Fault> velocities = {
      {"stage 1: impact bound weights its levels to 2, what it bounds is 1 m/s on a motion at 1 m/s",
       [](StepPlan& p) {
         p.stages[0].impact->bound = {{1, 2}};
       }},
      {"stage 1: gate predictor bound stands at t + 1h",
       [](StepPlan& p) {
         p.stages[0].impact->gate->predictor_bound = {{1, 1}};
       }},
      {"stage 1: gate approach bound weights its levels to 2",
       [](StepPlan& p) {
         p.stages[0].impact->gate->approach_bound = {{0, 2}};
       }},
      {"stage 1: gate approach is 2 m/s on a motion at 1 m/s",
       [&](StepPlan& p) {
         p.stages[0].impact->gate->approach.slots[1] = 20;
         clear(p.stages[0].impact->gate->approach_bound);
       }},
      {"stage 1: impact measure is 2 m/s on a motion at 1 m/s",
       [&](StepPlan& p) {
         p.stages[0].impact->value.slots[1] = 20;
         clear(p.stages[0].impact->bound);
       }},
  };
  for (const Fault& fault : velocities) CHECK_THAT(wrong(gated_plan(), fault), Contains(fault.sentence));
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
      {"stage 1: loss", [&](StepPlan& p) { p.stages[0].loss[0].coefficient = bad; }},
      {"stage 1: loss", [&](StepPlan& p) { p.stages[0].loss[0].value.z = bad; }},
      {"stage 1: impact", [&](StepPlan& p) { p.stages[0].impact->effort[0] = bad; }},
      {"stage 1: compliance before the step", [&](StepPlan& p) { p.stages[0].compliance[3]->before->slots[1] = bad; }},
      {"stage 1: compliance bound before the step",
       [&](StepPlan& p) { p.stages[0].compliance[3]->before_bound[0].at = bad; }},
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

}  // namespace step_plan_tests
