#include "runners/check/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/contract/plugin_call.hpp>

#include "runners/check/bench.hpp"
#include "runners/check/law_checks.hpp"
#include "runners/check/mass_checks.hpp"
#include "runners/check/scheme_checks.hpp"
#include "runners/plan_files/plan_file.hpp"

namespace ricochet::checking {

const std::vector<Check<ContactLaw>>& law_checks() {
  static const std::vector<Check<ContactLaw>> all = {
      {"manual", [](const Law& law) { return manual_complete(law.entry->manual); }},
      {"arrays", solve_stays_within},
      {"complementarity", complementarity_holds},
      {"force law", force_law_is_one},
      {"solution", solution_answers_the_force_law},
      {"constant stiffness", stiffness_as_declared},
      {"slopes", slopes_are_derivatives},
      {"potential", potential_stores_the_force},
      {"energy over a step", energy_over_a_step},
      {"dissipation", dissipation_is_reported},
      {"changed problem", changed_problem_is_sound},
      {"memory", answers_follow_from_memory},
      {"no allocation", solve_allocates_nothing},
      {"lanes independent", lanes_are_independent},
      {"unlike lanes", unlike_lanes_are_their_own},
      {"untouched lanes", untouched_lanes_are_left_alone},
      {"warm start", warm_start_changes_nothing},
      {"sets of points", points_have_own_sets},
  };
  return all;
}

std::vector<CheckResult> check_law(const Entry<ContactLaw>& entry, const Isolation& isolation) {
  return run_checks(law_checks(), entry, isolation);
}

const std::vector<Check<MassStrategy>>& mass_checks() {
  static const std::vector<Check<MassStrategy>> all = {
      {"manual", [](const Mass& mass) { return manual_complete(mass.entry->manual); }},
      {"refusals", some_structure_is_accepted},
      {"symmetric", matrix_is_symmetric},
      {"semidefinite", matrix_is_semidefinite},
      {"kernel", kernel_as_declared},
      {"total mass", total_mass_is_right},
      {"rotations", rotations_have_their_inertia},
      {"both ends alike", ends_are_treated_alike},
      {"frequencies", frequencies_converge},
  };
  return all;
}

std::vector<CheckResult> check_mass(const Entry<MassStrategy>& entry, const Isolation& isolation) {
  return run_checks(mass_checks(), entry, isolation);
}

namespace {

ReferenceOrRefusal solved(const Reference& reference, const ReferenceScene& scene) {
  const PluginIdentity identity{"reference", reference.entry->manual.name, reference.entry->file};
  const PluginCallScope scope(identity, "solve");
  return reference.make()->solve(scene.problem, scene.grid);
}

double size_of(const std::vector<double>& values) {
  double size = 0;
  for (const double x : values) size = std::max(size, std::abs(x));
  return size;
}
double gap_of(const std::vector<double>& a, const std::vector<double>& b) {
  double gap = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) gap = std::max(gap, std::abs(a[i] - b[i]));
  return gap;
}

// What does not fit the grid, or is no number.
std::string misfit(const SampledMotion& motion, const SampleGrid& grid) {
  const std::size_t times = grid.times.size(), field = times * grid.places.size();
  const struct {
    const char* name;
    const std::vector<double>& values;
    std::size_t size;
  } all[] = {{"tip", motion.tip, times},
             {"tip velocity", motion.tip_velocity, times},
             {"energy", motion.energy, times},
             {"impulse", motion.impulse, times},
             {"displacement", motion.displacement, field},
             {"strain", motion.strain, field},
             {"velocity", motion.velocity, field}};
  for (const auto& [name, values, size] : all) {
    if (values.size() != size) return fmt::format("{} has {} numbers, the grid {}", name, values.size(), size);
    if (!std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); }))
      return fmt::format("{} has a value that is not finite", name);
  }
  double last = 0;
  for (const ContactEvent& event : motion.events) {
    if (!(event.time >= last)) return "its events are not in order of time";
    last = event.time;
  }
  return {};
}

// Every scene that is accepted.
Verdict everywhere(const Reference& reference,
                   std::string (*wrong)(const ReferenceScene&, const ReferenceMotion&, std::string& found)) {
  std::string found;
  int count = 0;
  for (const ReferenceScene& scene : reference_scenes()) {
    const ReferenceOrRefusal answer = solved(reference, scene);
    const auto* motion = std::get_if<ReferenceMotion>(&answer);
    if (!motion) continue;
    if (std::string sentence = wrong(scene, *motion, found); !sentence.empty())
      return fails(scene.name + ": " + sentence);
    ++count;
  }
  return count == 0 ? not_applicable("no scene of the checks is accepted") : fine(found);
}

Verdict some_scene_is_accepted(const Reference& reference) {
  std::string accepted, last;
  for (const ReferenceScene& scene : reference_scenes()) {
    const ReferenceOrRefusal answer = solved(reference, scene);
    if (const auto* refusal = std::get_if<Refusal>(&answer)) {
      last = refusal->sentence.text;
      if (std::string poor = poor_refusal(last, reference.entry->manual); !poor.empty())
        return fails(scene.name + ": " + poor);
    } else {
      accepted += (accepted.empty() ? "" : ", ") + scene.name;
    }
  }
  if (accepted.empty()) return fails("refuses every scene: " + last);
  return fine("accepts " + accepted);
}

Verdict motions_fit_the_grid(const Reference& reference) {
  return everywhere(reference, [](const ReferenceScene& scene, const ReferenceMotion& found, std::string&) {
    if (found.how.empty()) return std::string("does not say how its motion was found");
    return misfit(found.motion, scene.grid);
  });
}

Verdict motions_begin_as_given(const Reference& reference) {
  return everywhere(reference, [](const ReferenceScene& scene, const ReferenceMotion& found, std::string&) {
    const double given = scene.problem.displacement(scene.tip);
    const double gap = std::abs(found.motion.tip.front() - given);
    // Modes of a continuous structure represent its initial state up to what they leave out.
    if (gap <= 0.01 * std::max(std::abs(given), size_of(found.motion.tip))) return std::string();
    return fmt::format("the tip begins at {:.6g} m, the scene says {:.6g}", found.motion.tip.front(), given);
  });
}

Verdict gap_is_honest(const Reference& reference) {
  return everywhere(reference, [](const ReferenceScene& scene, const ReferenceMotion& found, std::string& text) {
    const double size = size_of(found.motion.tip);
    double gap = 0;
    if (!found.coarser.tip.empty()) {
      if (std::string wrong = misfit(found.coarser, scene.grid); !wrong.empty()) return "its coarser motion: " + wrong;
      gap = gap_of(found.motion.tip, found.coarser.tip);
      if (!(gap <= 0.1 * size))
        return fmt::format("its two settings differ by {:.3g} m in motions of {:.3g} m: it knows nothing", gap, size);
    }
    text = found.coarser.tip.empty() ? "a closed form" : fmt::format("its settings differ by {:.2g} m", gap);
    if (!scene.exact) return std::string();
    double error = 0;
    for (std::size_t i = 0; i < scene.grid.times.size(); ++i)
      error = std::max(error, std::abs(found.motion.tip[i] - scene.exact(scene.grid.times[i])));
    if (!(error <= 10 * gap + 1e-8 * size))
      return fmt::format("it is {:.3g} m away from the closed form and says that it is known to {:.3g} m", error, gap);
    text += fmt::format(", {:.2g} m away from a closed form", error);
    return std::string();
  });
}

// A plan in a file may leave out all but its name.
Verdict manual_of_scheme(const Scheme& scheme) {
  const Verdict verdict = manual_complete(scheme.entry->manual);
  if (verdict.finding != Finding::fails || !is_plan_file(scheme.entry->file)) return verdict;
  return not_declared(verdict.sentence);
}

}  // namespace

std::vector<CheckResult> check_reference(const Entry<ReferenceSolver>& entry, const Isolation& isolation) {
  static const std::vector<Check<ReferenceSolver>> all = {
      {"manual", [](const Reference& reference) { return manual_complete(reference.entry->manual); }},
      {"refusals", some_scene_is_accepted},
      {"grid", motions_fit_the_grid},
      {"initial state", motions_begin_as_given},
      {"estimate", gap_is_honest},
  };
  return run_checks(all, entry, isolation);
}

const std::vector<Check<TimeScheme>>& scheme_checks() {
  static const std::vector<Check<TimeScheme>> all = {
      {"manual", manual_of_scheme},
      {"well-formed", plan_is_well_formed},
      {"same plan twice", plan_is_the_same_twice},
      {"refusals", refusals_name_cause},
      {"singular mass", singular_mass_as_declared},
      {"march = plan", march_is_the_plan},
      {"march = spectrum", spectrum_is_the_march},
      {"stability limit", stability_as_declared},
      {"order and start", order_as_declared},
      {"velocity", velocity_stands_right},
      {"loads", loads_at_their_times},
      {"moving support", supports_at_their_times},
      {"compliant contact", compliance_is_right},
      {"rigid stops", rigid_stops_hold},
      {"restitution", restitution_as_declared},
      {"start at a stop", start_at_a_stop},
      {"order at contact", contact_order_as_declared},
      {"impulse", impulse_is_momentum},
      {"force at rest", force_at_rest},
      {"energy", energy_in_free_flight},
      {"work form", work_form_closes},
      {"energy at contact", contact_gains_as_declared},
  };
  return all;
}

std::vector<CheckResult> check_scheme(const Entry<TimeScheme>& entry, const Isolation& isolation) {
  return run_checks(scheme_checks(), entry, isolation);
}

}  // namespace ricochet::checking
