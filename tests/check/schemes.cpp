// Each declared fact and each field of a plan, made wrong in turn, is caught by the check that measures it.
#include <catch2/catch.hpp>

#include "runners/check/checks.hpp"
#include "tests/check/sound_schemes.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;
using checking::CheckResult;
using checking::Finding;

namespace {

CheckResult of_scheme(const Entry<TimeScheme>& entry, const std::string& check) {
  return one_check(checking::scheme_checks(), entry, check);
}

// The check fails, and its first sentence says so.
void caught(const Entry<TimeScheme>& entry, const std::string& check, const std::string& words) {
  const CheckResult result = of_scheme(entry, check);
  INFO(text_of({result}));
  CHECK(result.finding == Finding::fails);
  REQUIRE_FALSE(result.sentences.empty());
  CHECK_THAT(result.sentences.front(), Contains(words));
}

Stage& step(StepPlan& plan) {
  return plan.stages.front();
}

}  // namespace

TEST_CASE("check: schemes that declare what is true pass every check") {
  for (const auto& entry : {newmark_entry(0.25, 0.5), newmark_entry(0.4, 0.7), newmark_entry(0, 0.5),
                            three_level_entry(0), three_level_entry(0.5), restoring_entry()}) {
    const auto results = checking::check_scheme(entry, {.child = false});
    INFO(text_of(results));
    for (const auto& result : results) CHECK(result.finding != checking::Finding::fails);
    // And the floating-point state.
    CHECK(results.size() == checking::scheme_checks().size() + 1);
  }
}

TEST_CASE("check: slots that the equation does not use change nothing, however many") {
  for (const int extra : {1, 2, 5}) {
    const auto wide = newmark_entry(0.25, 0.5, [extra](StepPlan& plan, double) {
      for (int k = 0; k < extra; ++k) {
        plan.slots.push_back("unused" + std::to_string(k));
        plan.initial.push_back({0, 0});
        for (auto* stages : {&plan.start, &plan.stages})
          for (Stage& stage : *stages) stage.update.push_back({.slots = {1}});
      }
    });
    for (const char* check : {"well-formed", "march = plan", "march = spectrum", "order and start"}) {
      const CheckResult result = of_scheme(wide, check);
      INFO(text_of({result}));
      CHECK(result.finding == Finding::ok);
    }
  }
}

TEST_CASE("check: a wrong order, in either direction, and a wrong start rule are caught") {
  caught(newmark_entry(0.25, 0.5, [](StepPlan& plan, double) { plan.facts.order = 3; }), "order and start",
         "declares order 3");
  caught(newmark_entry(0.25, 0.5, [](StepPlan& plan, double) { plan.facts.order = 1; }), "order and start",
         "declare what it has");
  caught(newmark_entry(0.25, 0.5, [](StepPlan& plan, double) { plan.start.clear(); }), "order and start",
         "with this start rule");
}

TEST_CASE("check: wrong numbers of a step are caught") {
  caught(newmark_entry(0.25, 0.5, [](StepPlan& plan, double h) { step(plan).update[1].z = 0.6 * h; }),
         "order and start", "declares order 2");
  caught(newmark_entry(0.25, 0.5, [](StepPlan& plan, double h) { step(plan).history[1].K = -0.8 * h; }),
         "order and start", "declares order 2");
  caught(newmark_entry(0.25, 0.5, [](StepPlan& plan, double) { step(plan).update[1].slots[1] = 1.001; }), "well-formed",
         "velocity is 1.001 m/s");
  caught(newmark_entry(0.25, 0.5, [](StepPlan& plan, double) { step(plan).matrix.K *= -1; }), "stability limit",
         "spectral radius");
}

TEST_CASE("check: a load half a step off, and a velocity that is none, are caught") {
  const auto early = newmark_entry(0.25, 0.5, [](StepPlan& plan, double) { step(plan).load = {{0.5, 1}}; });
  caught(early, "loads", "a load spoils the order");
  caught(early, "moving support", "a moving support spoils the order");
  caught(newmark_entry(0.25, 0.5,
                       [](StepPlan& plan, double h) {
                         plan.velocity = {.slots = {0, 1, 0.3 * h}};
                       }),
         "velocity", "no velocity at the time where it stands");
}

TEST_CASE("check: stability limits that are missing, too large or too small are caught") {
  const auto limited = [](std::optional<double> limit) {
    return newmark_entry(0, 0.5, [limit](StepPlan& plan, double) { plan.facts.stability_limit = limit; });
  };
  caught(limited(std::nullopt), "stability limit", "declares no limit on the step");
  caught(limited(3.0), "stability limit", "the limit h·ω ≤ 3");
  caught(limited(1.0), "stability limit", "the limit is larger");
}

TEST_CASE("check: a wrong energy, a missing loss and a wrong work form are caught") {
  caught(newmark_entry(0.25, 0.5, [](StepPlan& plan, double) { plan.energy[1].coefficient = 0.55; }), "energy",
         "declared energy");
  caught(newmark_entry(0.4, 0.7, [](StepPlan& plan, double) { step(plan).loss.clear(); }), "energy",
         "the declared losses are 0 J");
  caught(newmark_entry(0.25, 0.5, [](StepPlan& plan, double) { step(plan).work->effort = {1}; }), "work form",
         "at rigid stops");
  caught(newmark_entry(0.25, 0.5,
                       [](StepPlan& plan, double) {
                         step(plan).work->load = {{1, 1}};
                       }),
         "work form", "with a load");
  caught(newmark_entry(0.25, 0.5,
                       [](StepPlan& plan, double) {
                         step(plan).work->rate = {.slots = {0, 1}};
                       }),
         "work form", "with damping");
  caught(newmark_entry(0.25, 0.5,
                       [](StepPlan& plan, double) {
                         for (double& w : step(plan).work->displacement.slots) w *= 1.1;
                         step(plan).work->displacement.z *= 1.1;
                       }),
         "work form", "does not close");
}

TEST_CASE("check: facts about contact that are wrong are caught") {
  caught(newmark_entry(0.25, 0.5, [](StepPlan& plan, double) { plan.facts.restitution = Restitution::exact; }),
         "restitution", "declares its restitution exact");
  caught(three_level_entry(0.5, [](StepPlan& plan, double h) { plan = three_level_plan(h, 0); }), "restitution",
         "e = 0.5");
  caught(newmark_entry(0.25, 0.5, [](StepPlan& plan, double) { plan.facts.contact_never_gains = true; }),
         "energy at contact", "declares that its energy never grows");
  // q₋₁ tied to a q₁ that contact moves, and a first step that contact leaves alone.
  caught(three_level_entry(0.5,
                           [](StepPlan& plan, double) {
                             plan.start[0].impact = ImpactMeasure{.value = {.slots = {1, 1.0 / 3}, .z = 0.5}};
                           }),
         "start at a stop", "moving in: the error is");
  caught(three_level_entry(0, [](StepPlan& plan, double) { plan.start[0].impact.reset(); }), "start at a stop",
         "moving in: the error is");
  caught(three_level_entry(0, [](StepPlan& plan, double) { plan.facts.contact_order = 3; }), "order at contact",
         "declares order 3 at rigid stops");
  caught(newmark_entry(0.25, 0.5,
                       [](StepPlan& plan, double) {
                         step(plan).impact->bound = {{1.5, 1}};
                       }),
         "well-formed", "impact bound stands at t + 1.5h");
  caught(three_level_entry(0,
                           [](StepPlan& plan, double) {
                             step(plan).impact->value = {.slots = {1, 1}};
                           }),
         "rigid stops", "no effort can move");
  caught(
      newmark_entry(0.25, 0.5, [](StepPlan& plan, double) { step(plan).at(Evaluation::implicit_end)->effort = {1.2}; }),
      "compliant contact", "does not tend to its closed form");
}

TEST_CASE("check: a contact force that is not what presses is caught, though the momentum is right") {
  for (const double weight : {0.9, 1.2})
    caught(newmark_entry(0.25, 0.5, [=](StepPlan& plan, double) { step(plan).impact->effort = {weight}; }),
           "force at rest", "a contact force of");
  const CheckResult shared = of_scheme(newmark_entry(0.25, 0.5,
                                                     [](StepPlan& plan, double) {
                                                       step(plan).impact->effort = {0.5, 0.5};
                                                     }),
                                       "force at rest");
  INFO(text_of({shared}));
  CHECK(shared.finding == Finding::ok);
}

TEST_CASE("check: levels of a support that agree at constant speed alone are caught") {
  for (const Levels& wrong : {Levels{{1.5, 1}, {0.5, -1}}, Levels{{0, -1}, {2, 0.5}, {0, 0.5}}})
    caught(newmark_entry(0.25, 0.5, [=](StepPlan& plan, double) { step(plan).work->support = wrong; }), "work form",
           "work support misses the test displacement");
  for (const double gamma : {0.5, 0.7}) {
    const CheckResult right = of_scheme(newmark_entry(0.36, gamma,
                                                      [](StepPlan& plan, double) {
                                                        step(plan).work->support = {{1, 1}, {0, -1}};
                                                      }),
                                        "work form");
    INFO(text_of({right}));
    CHECK(right.finding == Finding::ok);
  }
}

TEST_CASE("check: work of contact that is not what is given back is caught") {
  // The way of the stops that the engine reads is no longer the one that the work form has.
  caught(restoring_entry([](StepPlan& plan, double) {
           plan.stages[1].impact->bound = {{1, 1}, {0, -1}};
         }),
         "march = plan", "are given back");
  caught(restoring_entry([](StepPlan& plan, double h) {
           plan.stages[1].work->displacement.z = plan.stages[1].impact->value.z = 0.45 * h;
         }),
         "energy at contact", "declares that its energy never grows");
  caught(restoring_entry([](StepPlan& plan, double) {
           plan.stages.pop_back();
           plan.facts.restitution = Restitution::exact;
         }),
         "restitution", "a free mass rebounds with");
}

TEST_CASE("check: without an impact measure the report says that rigid laws are refused") {
  const auto blind = newmark_entry(0.25, 0.5, [](StepPlan& plan, double) { step(plan).impact.reset(); });
  const CheckResult result = of_scheme(blind, "rigid stops");
  CHECK(result.finding == Finding::not_declared);
  REQUIRE_FALSE(result.sentences.empty());
  CHECK_THAT(result.sentences.front(), Contains("no impact measure: rigid laws are refused"));
}

TEST_CASE("check: what a scheme says of singular masses, and how it refuses, is looked at") {
  caught(newmark_entry(0.25, 0.5, [](StepPlan& plan, double) { plan.facts.needs_regular_mass = true; }),
         "singular mass", "yet gives a plan");
  caught(newmark_entry(0, 0.5, [](StepPlan& plan, double) { plan.facts.needs_regular_mass = false; }), "singular mass",
         "yet refuses a kernel");
  const auto curt = scheme_entry([](double h, const ProblemFacts& facts) -> PlanOrRefusal {
    if (facts.mass_kernel_dimension > 0) return Refusal{"no"};
    return newmark_plan(h, 0.25, 0.5);
  });
  caught(curt, "refusals", "neither cause nor remedy");
  const auto vague = scheme_entry([](double h, const ProblemFacts& facts) -> PlanOrRefusal {
    if (facts.mass_kernel_dimension > 0) return Refusal{"this unfortunately cannot be done at all"};
    return newmark_plan(h, 0.25, 0.5);
  });
  caught(vague, "refusals", "names no parameter");
}

TEST_CASE("check: a plan that changes from call to call, and one that throws, are caught") {
  int calls = 0;
  const auto fickle = scheme_entry([&calls](double h, const ProblemFacts&) -> PlanOrRefusal {
    return newmark_plan(h, ++calls % 2 ? 0.25 : 0.3, 0.5);
  });
  caught(fickle, "same plan twice", "two different plans");
  const auto thrower =
      scheme_entry([](double, const ProblemFacts&) -> PlanOrRefusal { throw std::runtime_error("my plan failed"); });
  caught(thrower, "well-formed", "my plan failed");
  const auto odd = scheme_entry([](double, const ProblemFacts&) -> PlanOrRefusal { throw 42; });
  caught(odd, "well-formed", "an exception that says nothing");
}

TEST_CASE("check: a manual with a gap is told") {
  Entry<TimeScheme> entry = newmark_entry(0.25, 0.5);
  entry.manual.source.clear();
  caught(entry, "manual", "no source");
}
