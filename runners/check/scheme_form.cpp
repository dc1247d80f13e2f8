#include <fmt/format.h>

#include <algorithm>

#include "runners/check/scheme_checks.hpp"

namespace ricochet::checking {
namespace {

constexpr double usual_step = 1e-3;

// What a scheme may be asked.
std::vector<ProblemFacts> all_facts() {
  std::vector<ProblemFacts> all;
  for (const int kernel : {0, 3})
    for (const bool damped : {false, true})
      for (const bool contact : {false, true}) all.push_back({12, kernel, damped, contact});
  return all;
}

std::string facts_text(const ProblemFacts& facts) {
  return fmt::format("{} mass, {}, {}", facts.mass_kernel_dimension > 0 ? "a singular" : "a regular",
                     facts.damped ? "damped" : "undamped", facts.contact ? "with contact" : "without contact");
}

void append(std::vector<double>& numbers, const Combination& c) {
  numbers.insert(numbers.end(), c.slots.begin(), c.slots.end());
  numbers.push_back(c.z);
  numbers.push_back(c.w);
}
void append(std::vector<double>& numbers, const Levels& levels) {
  for (const Level& level : levels) {
    numbers.push_back(level.at);
    numbers.push_back(level.weight);
  }
}
void append(std::vector<double>& numbers, const OperatorWeights& w) {
  for (const double x : {w.M, w.C, w.K}) numbers.push_back(x);
}

// Every number that is marched.
std::vector<double> numbers_of(const StepPlan& plan) {
  std::vector<double> all;
  const auto stage_numbers = [&](const Stage& stage) {
    append(all, stage.matrix);
    for (const OperatorWeights& w : stage.history) append(all, w);
    append(all, stage.load);
    if (stage.impulse) {
      append(all, stage.impulse->R);
      append(all, stage.impulse->feed);
    }
    if (stage.impact) {
      append(all, stage.impact->value);
      append(all, stage.impact->bound);
      all.insert(all.end(), stage.impact->effort.begin(), stage.impact->effort.end());
      all.push_back(stage.impact->restores);
      all.push_back(stage.impact->impulse);
      if (const auto& gate = stage.impact->gate) {
        append(all, gate->predictor);
        append(all, gate->approach);
        all.push_back(gate->restitution);
      }
    }
    for (const auto& compliance : stage.compliance) {
      if (!compliance) continue;
      append(all, compliance->displacement);
      append(all, compliance->rate);
      all.insert(all.end(), compliance->effort.begin(), compliance->effort.end());
      all.push_back(compliance->impulse);
    }
    for (const Combination& c : stage.update) append(all, c);
    if (stage.work) {
      append(all, stage.work->displacement);
      append(all, stage.work->rate);
      append(all, stage.work->load);
    }
  };
  for (const auto& [position, velocity] : plan.initial) {
    all.push_back(position);
    all.push_back(velocity);
  }
  for (const Stage& stage : plan.start) stage_numbers(stage);
  for (const Stage& stage : plan.stages) stage_numbers(stage);
  append(all, plan.velocity);
  all.push_back(plan.facts.order);
  return all;
}

}  // namespace

Verdict plan_is_well_formed(const Scheme& scheme) {
  std::string limits;
  bool any = false;
  for (const double h : {usual_step, 1e-6, 0.25})
    for (const ProblemFacts& facts : all_facts()) {
      const PlanOrRefusal answer = ask_plan(scheme, h, facts);
      const auto* plan = std::get_if<StepPlan>(&answer);
      if (!plan) continue;
      any = true;
      if (const auto wrong = check_plan(*plan))
        return fails(fmt::format("h = {:g} s, {}: {}", h, facts_text(facts), *wrong));
      if (print_plan(*plan).find("S = ") == std::string::npos)
        return fails("no stage of the plan solves anything: there is no S");
      limits = fmt::format("{} slots, {} {}", plan->slots.size(), plan->stages.size(),
                           plan->stages.size() == 1 ? "stage" : "stages");
    }
  return any ? fine(limits) : not_applicable("every problem is refused");
}

Verdict plan_is_the_same_twice(const Scheme& scheme) {
  const auto made = scheme.make();
  for (const ProblemFacts& facts : all_facts()) {
    const PlanOrRefusal first = made->plan(usual_step, facts);
    made->plan(3 * usual_step, facts);
    const PlanOrRefusal second = made->plan(usual_step, facts), fresh = scheme.make()->plan(usual_step, facts);
    for (const PlanOrRefusal* other : {&second, &fresh}) {
      if (first.index() != other->index())
        return fails("asked twice for " + facts_text(facts) + ", it refuses once and gives a plan once");
      const auto* plan = std::get_if<StepPlan>(&first);
      if (plan && numbers_of(*plan) != numbers_of(std::get<StepPlan>(*other)))
        return fails("asked twice for the same step and problem (" + facts_text(facts) +
                     "), it gives two different plans");
    }
  }
  return fine();
}

Verdict refusals_name_cause(const Scheme& scheme) {
  int refused = 0;
  std::string last;
  for (const double h : {usual_step, 0.25})
    for (const ProblemFacts& facts : all_facts()) {
      const PlanOrRefusal answer = ask_plan(scheme, h, facts);
      const auto* refusal = std::get_if<Refusal>(&answer);
      if (!refusal) continue;
      ++refused;
      if (std::string poor = poor_refusal(refusal->sentence.text, scheme.entry->manual); !poor.empty())
        return fails(facts_text(facts) + ": " + poor);
      last = refusal->sentence.text;
    }
  if (refused == 0) return not_applicable("nothing is refused with these values");
  return fine(last);
}

Verdict singular_mass_as_declared(const Scheme& scheme) {
  const StepPlan regular = plan_of(scheme, usual_step, {});
  ProblemFacts massless{12, 3, false, true};
  const PlanOrRefusal answer = ask_plan(scheme, usual_step, massless);
  if (regular.facts.needs_regular_mass) {
    if (std::holds_alternative<Refusal>(answer)) return fine("needs a regular mass, and refuses a singular one");
    return fails("declares that it needs a regular mass, yet gives a plan for a kernel of dimension 3 with contact");
  }
  if (const auto* refusal = std::get_if<Refusal>(&answer))
    return fails("declares that the mass may be singular, yet refuses a kernel of dimension 3 with contact: \"" +
                 refusal->sentence.text + "\"");
  // A bar whose free end has no mass is thrown at a stop.
  const ProblemPointer bar = discretised(structure_scene({.stops = true}), 6, *massless_ends());
  const double h = sound_step(scheme, *bar, 1.0 / 200);
  StepPlan plan = plan_of(scheme, h, problem_facts(*bar, *rigid_stops()));
  const bool meets = measures(plan);
  Marcher marcher = marcher_of(bar, std::move(plan), h, meets ? rigid_stops() : no_contact());
  marcher.start();
  marcher.march(200);
  if (!marcher.status(0).running)
    return fails("declares that the mass may be singular; a bar whose free end has no mass fails at step " +
                 std::to_string(marcher.status(0).step) + ": " + text(marcher.status(0).end));
  const double reached = marcher.position(0).cwiseAbs().maxCoeff();
  if (!(reached < 10))
    return fails(
        fmt::format("declares that the mass may be singular. A bar whose free end has no mass begins at 0.04 m and is "
                    "at {:.3g} m after 200 steps",
                    reached));
  return fine("may be singular: a bar whose free end has no mass marches");
}

namespace {

// Lanes that differ in what lanes may differ in.
std::vector<LaneSpec> some_lanes(const SemiDiscrete& problem, int count) {
  std::vector<LaneSpec> lanes;
  for (int l = 0; l < count; ++l) {
    LaneSpec lane = scene_lane(problem, {});
    lane.position *= 1 - 0.1 * l;
    lane.velocity *= 1 + 0.3 * l;
    lane.amplitude *= 1 - 0.2 * (l % 3);
    lane.phase += 0.2 * l;
    lanes.push_back(std::move(lane));
  }
  return lanes;
}

struct Law {
  std::string name;
  std::unique_ptr<ContactLaw> law;
};

std::vector<Law> laws_of(const StepPlan& plan, double stiffness) {
  std::vector<Law> laws;
  laws.push_back({"no contact", no_contact()});
  const auto offers = [&](auto has) { return std::any_of(plan.stages.begin(), plan.stages.end(), has); };
  if (offers([](const Stage& stage) { return stage.impact.has_value(); }))
    laws.push_back({"rigid stops", rigid_stops()});
  for (const Evaluation evaluation : {Evaluation::implicit_end, Evaluation::averaged, Evaluation::explicit_start})
    if (offers([&](const Stage& stage) { return stage.at(evaluation).has_value(); }))
      laws.push_back({std::string("springs, ") + evaluation_word(evaluation), springs(evaluation, stiffness)});
  return laws;
}

std::string march_once(const Scheme& scheme, const ProblemPointer& problem, double h, Law law, int lanes,
                       OperatorKind kind) {
  constexpr int steps = 10;
  Marcher marcher = marcher_of(scheme, problem, h, std::move(law.law), some_lanes(*problem, lanes), kind);
  DenseMarch dense(marcher);
  marcher.start(&dense);
  marcher.march(steps, &dense);
  const std::string where =
      fmt::format("{}, {}, {} lane{}", problem->space.structure, law.name, lanes, lanes == 1 ? "" : "s");
  if (!marcher.status(0).running) return where + ": the integration stopped: " + text(marcher.status(0).end);
  if (const std::string wrong = dense.difference(); !wrong.empty()) return where + ": " + wrong;
  return {};
}

}  // namespace

Verdict march_is_the_plan(const Scheme& scheme) {
  std::vector<ProblemPointer> problems = {discretised(
      oscillator_scene({.damping = 0.4, .force = 3, .support = 0.02, .position = 0.3, .velocity = -1, .stop = true}))};
  for (const bool beam : {false, true})
    problems.push_back(discretised(
        structure_scene(
            {.beam = beam, .damping = 1e-3, .load = true, .support = true, .stops = true, .everywhere = !beam}),
        3));
  bool first = true;
  for (const ProblemPointer& problem : problems) {
    const double h = sound_step(scheme, *problem, 1.0 / 24);
    const StepPlan plan = plan_of(scheme, h, problem_facts(*problem, *rigid_stops()));
    const double slowest = pulsations(*problem).least;
    const double stiffness = 3 * slowest * slowest;
    const std::size_t laws = laws_of(plan, stiffness).size();
    for (std::size_t i = 0; i < laws; ++i)
      for (const int lanes : {1, 3, 8}) {
        if (lanes != 3 && !first && i > 1) continue;
        const OperatorKind kind = lanes == 8 && !first ? OperatorKind::modal : OperatorKind::band;
        if (std::string wrong = march_once(scheme, problem, h, std::move(laws_of(plan, stiffness)[i]), lanes, kind);
            !wrong.empty())
          return fails("ten marched steps are not the plan: " + wrong);
      }
    first = false;
  }
  return fine("ten steps with loads, damping, moving support and contact, 1, 3 and 8 lanes");
}

}  // namespace ricochet::checking
