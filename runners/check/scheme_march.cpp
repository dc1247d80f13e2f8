#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/check/dense_march.hpp"
#include "runners/check/scheme_checks.hpp"

namespace ricochet::checking {
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
  if (!marcher.status(0).running) return where + ": the march stopped: " + text(marcher.status(0).end);
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
