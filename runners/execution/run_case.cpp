#include "runners/execution/run_case.hpp"

#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/measure/energy_audit.hpp>

namespace ricochet {
namespace {

// Processor time of this thread: what a case costs, whatever else the machine does. A case runs on one thread from
// start to end.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Steps that fit in the duration; what is left over is said.
long long whole_steps(const StudyCase& study_case, std::vector<std::string>& notes) {
  const double ratio = study_case.duration / study_case.step;
  const auto nearest = std::llround(ratio);
  // A ratio of two decimal numbers is whole up to a few roundings.
  if (std::abs(ratio - static_cast<double>(nearest)) <= 1e-9 * ratio) return nearest;
  const auto steps = static_cast<long long>(std::floor(ratio));
  notes.push_back(
      fmt::format("the duration {:g} s is no multiple of the step {:g} s: the run ends at the last whole step, "
                  "t = {:.9g} s",
                  study_case.duration, study_case.step, static_cast<double>(steps) * study_case.step));
  return steps;
}

template <class Found>
const Found& registered(const Found* found, Role role, const std::string& name) {
  if (!found) throw std::logic_error(fmt::format("{} '{}' is not registered", role_name(role), name));
  return *found;
}

struct Prepared {
  std::shared_ptr<const SemiDiscrete> problem;
  std::optional<Program> program;
  std::string refusal;
  long long steps = 0;
  std::vector<std::string> notes;
};

Prepared prepare(const StudyCase& study_case, const Registry& registry) {
  Prepared prepared;
  prepared.steps = whole_steps(study_case, prepared.notes);
  const auto& mass_entry = registered(registry.mass(study_case.mass.name), Role::mass, study_case.mass.name);
  const auto& law_entry = registered(registry.contact(study_case.contact.name), Role::contact, study_case.contact.name);
  const auto& scheme_entry = registered(registry.time(study_case.time.name), Role::time, study_case.time.name);
  const auto mass = mass_entry.make(study_case.mass.parameters);
  auto law = law_entry.make(study_case.contact.parameters);
  const auto scheme = scheme_entry.make(study_case.time.parameters);

  auto discretised = discretise(study_case.scene, study_case.elements, *mass);
  if (const auto* refusal = std::get_if<Refusal>(&discretised)) {
    prepared.refusal = refusal->sentence;
    return prepared;
  }
  prepared.problem = std::make_shared<const SemiDiscrete>(std::move(std::get<SemiDiscrete>(discretised)));
  prepared.notes.insert(prepared.notes.end(), prepared.problem->notes.begin(), prepared.problem->notes.end());
  auto plan = scheme->plan(study_case.step, problem_facts(*prepared.problem, *law));
  if (const auto* refusal = std::get_if<Refusal>(&plan)) {
    prepared.refusal = refusal->sentence;
    return prepared;
  }
  const StepPlan& steps = std::get<StepPlan>(plan);
  if (law->reads() && steps.facts.restitution != Restitution::ignored)
    for (const auto& [key, value] : study_case.time.parameters.values())
      if (key == "restitution" && std::holds_alternative<double>(value) && std::get<double>(value) != 0)
        prepared.notes.push_back(
            "a compliant law rebounds by its own stiffness: the scheme's restitution has no part in it");
  CompileOptions options;
  options.expected_steps = prepared.steps;
  auto compiled = compile(prepared.problem, steps, study_case.step, std::move(law),
                          {scene_lane(*prepared.problem, study_case.contact.parameters)}, options);
  if (const auto* refusal = std::get_if<Refusal>(&compiled))
    prepared.refusal = refusal->sentence;
  else
    prepared.program.emplace(std::move(std::get<Program>(compiled)));
  return prepared;
}

std::vector<std::pair<std::string, std::string>> left_out_pairs(const Program& program) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const LeftOut& item : program.left_out) pairs.emplace_back(item.item, item.reason);
  return pairs;
}

// The audit of every step costs about this much more than the step alone.
constexpr double audit_seconds_per_step = 6e-7;

// The sampled series of one lane, in the columns of a trajectory's curve.
class Sampler {
 public:
  Sampler() {
    curve_.names = {"t",      "tip_displacement", "tip_velocity",  "kinetic",     "elastic", "contact",
                    "energy", "scheme_energy",    "contact_force", "penetration", "active"};
    curve_.columns.resize(curve_.names.size());
  }
  void take(const Marcher& marcher, const EnergyAudit& audit) {
    const EnergySample& energy = audit.energy(0);
    const ContactTotals& contact = audit.contact(0);
    const double row[] = {marcher.time(),
                          marcher.tip(0),
                          audit.tip_velocity(0),
                          energy.kinetic,
                          energy.elastic,
                          energy.contact,
                          energy.common(),
                          energy.scheme,
                          contact.force,
                          audit.penetration(0),
                          static_cast<double>(contact.active)};
    for (const double value : row)
      if (!std::isfinite(value)) return;
    for (std::size_t c = 0; c < curve_.columns.size(); ++c) curve_.columns[c].push_back(row[c]);
  }
  Curve finish() { return std::move(curve_); }

 private:
  Curve curve_;
};

void fill_measures(CaseRecord& record, const Marcher& marcher, const EnergyAudit& audit, const SemiDiscrete& problem) {
  const EnergyTotals& energy = audit.totals(0);
  const ContactTotals& contact = audit.contact(0);
  const auto put = [&](const char* name, double value) {
    if (std::isfinite(value)) record.measures.emplace_back(name, value);
  };
  const double start = energy.first.common(), end = energy.last.common();
  put("scheme_energy_start", energy.scheme_start);
  put("scheme_energy_end", energy.last.scheme);
  put("energy_start", start);
  put("energy_end", end);
  if (start > 0) put("energy_ratio", end / start);
  put("largest_step_gain", energy.largest_step_gain);
  if (contact.impacts > 0)
    put("drift_per_impact", (energy.last.scheme - energy.scheme_start - energy.work_of_loads + energy.work_of_damping) /
                                static_cast<double>(contact.impacts));
  put("work_of_damping", energy.work_of_damping);
  put("work_of_loads", energy.work_of_loads);
  // What the stops give back (a spring's potential) is not dissipated.
  put("dissipated_at_contact", -energy.work_of_contact - (energy.last.contact - energy.first.contact));
  put("balance_residual", energy.balance_residual());
  put("projection_energy", problem.projection_energy);
  put("kernel_energy", problem.kernel_energy);
  put("deepest_penetration", contact.deepest_penetration);
  put("impacts", static_cast<double>(contact.impacts));
  put("active_set_changes", static_cast<double>(contact.active_set_changes));
  put("impulse", contact.impulse);
  put("complementarity_residual", contact.residual);
  if (contact.first_impact >= 0) put("first_impact", contact.first_impact);
  if (contact.first_release >= 0) put("first_release", contact.first_release);
  if (marcher.status(0).running) put("tip_displacement_end", marcher.tip(0));
  if (record.steps > 0) put("microseconds_per_step", 1e6 * record.run_seconds / static_cast<double>(record.steps));
}

}  // namespace

CasePlan plan_case(const StudyCase& study_case, const Registry& registry) {
  CasePlan plan;
  const Prepared prepared = prepare(study_case, registry);
  plan.refusal = prepared.refusal;
  plan.steps = prepared.steps;
  plan.notes = prepared.notes;
  if (!prepared.program) return plan;
  plan.operator_name = operator_name(prepared.program->kind);
  plan.left_out = left_out_pairs(*prepared.program);
  plan.predicted_seconds =
      prepared.program->predicted_setup_seconds +
      static_cast<double>(prepared.steps) * (prepared.program->predicted_step_seconds + audit_seconds_per_step);
  return plan;
}

CaseRecord run_case(const StudyCase& study_case, const Registry& registry, const std::atomic<bool>& stop) {
  CaseRecord record;
  record.id = study_case.id;
  record.axes = study_case.axes;
  const double set_up = thread_seconds();
  Prepared prepared = prepare(study_case, registry);
  record.notes = prepared.notes;
  if (!prepared.program) {
    record.status = "refused";
    record.reason = prepared.refusal;
    return record;
  }
  record.operator_name = operator_name(prepared.program->kind);
  record.left_out = left_out_pairs(*prepared.program);
  const std::shared_ptr<const SemiDiscrete> problem = prepared.problem;
  Marcher marcher(std::move(*prepared.program));
  EnergyAudit audit(marcher);
  Sampler sampler;
  record.setup_seconds = thread_seconds() - set_up;

  const double run = thread_seconds();
  marcher.start(&audit);
  if (marcher.step() > 0) sampler.take(marcher, audit);
  const long long samples = std::min<long long>(std::max(study_case.samples, 1), prepared.steps);
  for (long long k = 1; k <= samples && marcher.any_running(); ++k) {
    // Samples at equal fractions of the run, on whole steps.
    const auto target = static_cast<long long>(
        std::llround(static_cast<double>(prepared.steps) * static_cast<double>(k) / static_cast<double>(samples)));
    while (marcher.step() < target && marcher.any_running()) {
      if (stop) throw Interrupted{};
      marcher.march(std::min<long long>(target - marcher.step(), 20000), &audit);
    }
    if (marcher.any_running() && marcher.step() == target) sampler.take(marcher, audit);
  }
  record.run_seconds = thread_seconds() - run;
  record.steps = marcher.step();
  record.curve = sampler.finish();
  const LaneStatus& status = marcher.status(0);
  if (status.running) {
    record.status = "done";
  } else {
    const bool law = status.cause.starts_with("the contact law");
    record.status = law ? "failed" : "diverged";
    record.reason = fmt::format("step {}, t = {:.6g} s: {}", status.step, status.time, status.cause);
    record.steps = status.step;
  }
  fill_measures(record, marcher, audit, *problem);
  if (marcher.delassus_columns() > 0)
    record.notes.push_back(
        fmt::format("Delassus columns computed: {} of {}", marcher.delassus_columns(), problem->points()));
  return record;
}

}  // namespace ricochet
