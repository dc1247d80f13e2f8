// What would run for a case, and how long it takes.
#include <algorithm>
#include <cmath>
#include <ricochet/engine/cost_model.hpp>
#include <ricochet/measure/orbits/stepped_map.hpp>

#include "runners/kinds/continuation/continuation.hpp"
#include "runners/kinds/continuation/continuation_study.hpp"
#include "runners/kinds/continuation/continued_map.hpp"

namespace ricochet {
namespace {

// A march of so many steps with its derivative: its programs made, and blocks of tangent columns beside the lane.
double derivative_seconds(ContinuedMap& continued, int unknowns, double steps) {
  const ForcedScenes& scenes = continued.scenes();
  const Program program = scenes.program(0, {scenes[scenes.reference_scene()].lane}, 1);
  constexpr double compiled = 2e-4;
  const double made = compiled + program.predicted_setup_seconds, watched = predict_watch(program, {.observers = 1});
  double seconds = 0;
  for (int first = 0; first < unknowns; first += SteppedMap::most_tangents) {
    const int lanes = 1 + std::min(SteppedMap::most_tangents, unknowns - first);
    seconds += made + steps * (watched + scenes.predicted_step_seconds(0, lanes));
  }
  return seconds;
}

}  // namespace

CasePlan plan_continuation(const StudyCase& study_case, const Registry& registry) {
  if (study_case.of_reference) return plan_reference(study_case, registry);
  CasePlan out;
  const ContinuationPlan plan = continuation_plan(study_case.settings);
  ContinuedMap continued(study_case, registry, plan);
  out.refusal = continued.refusal().text;
  if (!out.refusal.empty()) return out;
  if (!continued.no_pieces().empty()) out.notes.push_back("followed by steps: " + continued.no_pieces());
  const auto notes = out.notes;
  describe_march(out, continued.scenes(), study_case);
  out.notes.insert(out.notes.end(), notes.begin(), notes.end());
  const double steps = study_case.steps_per_period, branches = static_cast<double>(plan.orbits.size());
  double transient = 0;
  for (const WantedOrbit& orbit : plan.orbits) transient += orbit.periods * steps;
  out.steps = static_cast<long long>(transient);
  out.predicted_seconds = transient * continued.scenes().predicted_step_seconds(0, 1);
  widen_steps(out, study_case);
  if (plan.follow == Follow::none) return out;
  const auto unknowns =
      static_cast<double>(continued.scenes().plan(0).slots.size()) * continued.scenes().problem(0).dofs();
  // Branches at points of branches: none, or five times as much.
  const double leaves = plan.branch_at.empty() || plan.depth == 0 ? 1 : 2.5;
  const auto followed = [&](double each) {
    return branches * leaves * std::min(each * (plan.both_ways ? 1.4 : 1), static_cast<double>(plan.most_pieces));
  };
  const double of_map = continued.no_image().empty() ? steps / 2 : steps;
  double pieces = 0;
  if (continued.by_pieces()) {
    // Measured on the shaken tube and on bilinear oscillators: about as many pieces as steps per period. A piece looks
    // at the measures of its steps, carries vectors over its changes and takes two spectra. Loads make each step.
    pieces = followed(0.8 * steps);
    const double squares = unknowns * unknowns;
    const double each_step = continued.scenes().problem(0).load ? 5e-7 + 5e-10 * squares : 7e-8;
    out.predicted_seconds += pieces * (of_map * each_step + 2.7e-7 * squares + 3e-10 * squares * unknowns);
  } else {
    // Measured on oscillators that rebound and on shaken tubes at Hertz's stops: so many orbits for each mode that
    // takes part, as contacts come and go, each of a score of marches with all tangent columns.
    constexpr double orbits = 30, marches = 18, most_modes = 20;
    pieces = followed(orbits * std::min<double>(most_modes, continued.scenes().problem(0).dofs()));
    out.predicted_seconds += pieces * marches * derivative_seconds(continued, static_cast<int>(unknowns), of_map);
  }
  out.steps += static_cast<long long>(pieces * steps);
  out.bytes = branches * 2 * 2000 * 200;
  return out;
}

}  // namespace ricochet
