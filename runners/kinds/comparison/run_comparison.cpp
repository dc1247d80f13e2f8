#include <fmt/format.h>

#include <ricochet/measure/motion/motion_errors.hpp>
#include <ricochet/measure/motion/motion_sampler.hpp>

#include "runners/kinds/comparison/comparison.hpp"
#include "runners/kinds/comparison/references.hpp"
#include "runners/kinds/trajectory/stop_tables.hpp"
#include "runners/march/load_changes.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/march/seconds.hpp"
#include "runners/march/struck_together.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

// A quantity below so many units of round-off of the motion is none.
constexpr double not_observed = 16;

std::vector<std::string> errors_of(const StudyCase& study_case) {
  return study_case.settings.at("errors").get<std::vector<std::string>>();
}

void say_references(CaseRecord& record, const ReferenceSet& set) {
  for (std::size_t i = 0; i < set.applicable.size(); ++i) {
    const KnownReference& known = *set.applicable[i];
    record.notes.push_back(
        fmt::format("{} {}: {}", i == 0 ? "reference" : "second reference", known.name, known.found.how));
    for (const std::string& note : known.found.notes) record.notes.push_back(known.name + ": " + note);
  }
  for (const Said& refusal : set.refusals) record.notes.push_back(refused_reference + refusal.text);
  record.notes.push_back(fmt::format("compared up to t = {:g} s: {}", set.horizon, set.horizon_why));
}

void compare(CaseRecord& record, const SampledMotion& motion, const ReferenceSet& set,
             const std::vector<std::string>& names) {
  const ReferenceMotion& reference = set.applicable.front()->found;
  const auto found = motion_errors(motion, reference.motion, set.grid, set.horizon, names);
  const auto sizes = motion_sizes(reference.motion, set.grid, set.horizon, names);
  std::vector<double> floors;
  for (const MotionSize& size : sizes) floors.push_back(size.resolution);
  const auto raise = [&](const SampledMotion& other, bool of_another) {
    if (other.tip.empty()) return;
    const auto gaps = motion_errors(other, reference.motion, set.grid, set.horizon, names);
    // What lies beyond the motion itself is no reference: a scheme that makes energy on finer steps.
    for (std::size_t i = 0; i < names.size(); ++i)
      if (gaps[i].value && !(of_another && *gaps[i].value > sizes[i].size))
        floors[i] = std::max(floors[i], *gaps[i].value);
  };
  raise(reference.coarser, false);
  for (std::size_t i = 1; i < set.applicable.size(); ++i) raise(set.applicable[i]->found.motion, true);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!found[i].value) {
      record.left_out.emplace_back("error." + names[i], found[i].reason);
      continue;
    }
    if (sizes[i].size > 0 && sizes[i].size <= not_observed * sizes[i].resolution) {
      record.left_out.emplace_back(
          "error." + names[i],
          fmt::format("at most {:.2g} in the reference itself, which is round-off of a motion of this size",
                      sizes[i].size));
      continue;
    }
    put_measure(record, "error." + names[i], *found[i].value);
    put_measure(record, "size." + names[i], sizes[i].size);
    put_measure(record, "floor." + names[i], floors[i]);
  }
}

void put_ends(CaseRecord& record, const SampledMotion& motion) {
  put_measure(record, "tip_displacement_end", motion.tip.back());
  put_measure(record, "energy_start", motion.energy.front());
  put_measure(record, "energy_end", motion.energy.back());
  put_measure(record, "microseconds_per_step",
              1e6 * record.run_seconds / static_cast<double>(std::max(record.steps, 1LL)));
}

}  // namespace

CaseRecord run_comparison(const StudyCase& study_case, const Registry& registry, References& references,
                          const std::atomic<bool>& stop) {
  const double set_up = thread_seconds();
  Prepared prepared = prepare_case(study_case, registry);
  CaseRecord record = begin_record(study_case, prepared);
  if (!prepared.program) return record;
  const bool rigid = !prepared.program->law->reads();
  const SchemeFacts facts = prepared.program->plan.facts;
  const bool point_mass = prepared.problem->space.elements.empty();
  Marcher marcher(std::move(*prepared.program));
  record.setup_seconds = thread_seconds() - set_up - prepared.aside_seconds;

  const ReferenceSet set = references.of(study_case, stop);
  if (set.applicable.empty()) {
    record.status = Status::refused;
    Said reason = "no reference applies: ";
    for (const Said& refusal : set.refusals) reason += (&refusal == &set.refusals.front() ? "" : "; ") + refusal;
    record.reasons = {reason};
    return record;
  }
  say_references(record, set);

  const double run = thread_seconds(), budget = budget_of(study_case);
  ImpactRecorder recorder(marcher);
  StopContacts contacts(marcher, recorder);
  StruckTogether struck(marcher);
  recorder.tell(&struck);
  MotionSampler sampler(marcher, set.grid, &recorder);
  sampler.march([&] {
    if (stop) throw Interrupted{};
    return thread_seconds() - run <= budget;
  });
  record.run_seconds = thread_seconds() - run;
  record.steps = std::min(marcher.step(), prepared.steps);
  const bool whole = sampler.sampled() == set.grid.times.size();
  put_measure(record, "horizon", set.horizon);
  put_measure(record, "velocity_order", sampler.velocity_order());
  put_measure(record, "steps_visited", static_cast<double>(marcher.steps_visited()));
  const bool of_the_mesh = set.applicable.front()->of_the_mesh;
  put_measure(record, "reference_of_mesh", of_the_mesh ? 1 : 0);
  put_measure(record, "reference_of_law", rigid || meets_own_stops(study_case, of_the_mesh) ? 1 : 0);
  recorder.finish(marcher);
  contacts.finish();
  const auto restitution = largest_restitution(study_case, *marcher.program().problem, registry);
  add_contact(record, contacts, marcher, restitution);
  put_measure(record, "active_set_changes", static_cast<double>(sampler.contact().changes()));
  if (whole) {
    record.status = Status::done;
    // Reversals of friction under load are as late as a step.
    const double smooth = study_case.friction.name.empty() ? facts.order : std::min(facts.order, 1.0);
    if (sampler.contact().events().empty())
      put_measure(record, "declared_order", smooth);
    else if (rigid && point_mass && facts.contact_order)
      put_measure(record, "declared_order", std::min(smooth, *facts.contact_order));
    put_ends(record, sampler.motion());
    compare(record, sampler.finish(), set, errors_of(study_case));
  } else {
    record_early_end(record, marcher, prepared.steps, budget);
  }
  std::vector<Said> doubts = run_doubts(study_case, prepared);
  doubts.push_back(GapWatch::crossed(marcher, recorder));
  doubts.push_back(struck.told(marcher, restitution));
  add_doubts(record, doubts);
  return record;
}

std::optional<double> time_case(const StudyCase& study_case, const Registry& registry, const std::atomic<bool>& stop) {
  Prepared prepared = prepare_case(study_case, registry);
  if (!prepared.program) return std::nullopt;
  Marcher marcher(std::move(*prepared.program));
  const double begin = thread_seconds();
  marcher.start();
  constexpr long long chunk = 200000;
  while (marcher.step() < prepared.steps && marcher.any_running()) {
    if (stop) throw Interrupted{};
    marcher.march(std::min(chunk, prepared.steps - marcher.step()));
  }
  const double seconds = thread_seconds() - begin;
  if (!marcher.any_running()) return std::nullopt;
  return seconds;
}

}  // namespace ricochet
