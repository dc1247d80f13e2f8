#include "runners/march/prepare_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/contract/plugin_call.hpp>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/measure/stability/stability.hpp>
#include <ricochet/measure/stability/step_map.hpp>

#include "runners/march/load_changes.hpp"
#include "runners/march/seconds.hpp"

namespace ricochet {

bool explicit_step(const StepPlan& plan) {
  return std::all_of(plan.stages.begin(), plan.stages.end(), [](const Stage& stage) { return stage.matrix.K == 0; });
}

Said beyond_explicit_limit(const std::shared_ptr<const SemiDiscrete>& problem, const StepPlan& plan, double h,
                           const std::function<PlanOrRefusal(double)>& plan_at) {
  if (!explicit_step(plan)) return {};
  LinearLaw open;
  open.absent = true;
  const StabilityPredictor predictor(problem, open);
  const auto radius_of = [&](const StepPlan& step, double length) -> std::optional<double> {
    const auto spectrum = predictor.open(step, length, Detail::radius);
    const auto* known = std::get_if<StepSpectrum>(&spectrum);
    return known ? std::optional(known->radius) : std::nullopt;
  };
  const auto radius = radius_of(plan, h);
  if (!radius || *radius <= 1 + growth_tolerance) return {};
  // The largest stable step lies below h; twelve decades below it there is none.
  double stable = 0, grows = h;
  const auto is_stable = [&](double length) {
    const PlanOrRefusal made = plan_at(length);
    const auto* step = std::get_if<StepPlan>(&made);
    const auto found = step ? radius_of(*step, length) : std::nullopt;
    return found && *found <= 1 + growth_tolerance;
  };
  for (double length = h / 2; length > 1e-12 * h && stable == 0; length /= 2)
    if (is_stable(length))
      stable = length;
    else
      grows = length;
  constexpr int halvings = 20;
  for (int k = 0; k < halvings && stable > 0; ++k) {
    const double middle = 0.5 * (stable + grows);
    (is_stable(middle) ? stable : grows) = middle;
  }
  const Said remedy = stable > 0
                          ? said(
                                "its largest stable step there is {:.5g} s: use a smaller step, a mass with lower "
                                "highest frequencies, or an implicit scheme",
                                stable)
                          : Said("no smaller step is stable either: use an implicit scheme");
  return said(
      "the step of {:.5g} s is beyond the limit of an explicit scheme on this structure, whose free motion grows "
      "{:.4g} times per step: {}",
      h, *radius, remedy);
}

namespace {

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

// Random loads that say the same twice.
void note_repeats(const StudyCase& study_case, std::vector<std::string>& notes) {
  const std::vector<LoadTerm>& terms = study_case.scene.load.terms;
  for (std::size_t k = 0; k < terms.size(); ++k)
    if (terms[k].period > 0 && study_case.duration > terms[k].period)
      notes.push_back(
          fmt::format("the random load {} repeats after {:.6g} s, and the run takes {:.6g} s: {:.2g} times as "
                      "many lines would last",
                      k, terms[k].period, study_case.duration, study_case.duration / terms[k].period));
}

// What has no mass and no viscosity is known to a step as the highest frequencies are.
bool is_marginal(const SemiDiscrete& problem, const StepPlan& plan) {
  if (problem.inertia.kernel_dimension == 0 || problem.damping.stiffness != 0 || problem.damping.matrix) return false;
  constexpr double round_off = 1e-6;  // roots that coincide are known to its square root or less
  const auto root = root_at_infinity(plan);
  return root && std::abs(*root - 1) < round_off;
}

template <class Found>
const Found& registered(const Found* found, Role role, const std::string& name) {
  if (!found) throw std::logic_error(fmt::format("{} '{}' is not registered", role_name(role), name));
  return *found;
}

}  // namespace

double budget_of(const StudyCase& study_case) {
  return study_case.settings.is_object() ? study_case.settings.value("budget", std::numeric_limits<double>::infinity())
                                         : std::numeric_limits<double>::infinity();
}

MarchWay march_way(const StudyCase& study_case) {
  if (study_case.march == "flights") return MarchWay::flights;
  return study_case.march == "auto" ? MarchWay::automatic : MarchWay::every_step;
}

std::unique_ptr<MassStrategy> make_mass(const StudyCase& study_case, const Registry& registry) {
  return registered(registry.mass(study_case.mass.name), Role::mass, study_case.mass.name)
      .make(study_case.mass.parameters);
}
std::unique_ptr<ContactLaw> make_law(const StudyCase& study_case, const Registry& registry) {
  return registered(registry.contact(study_case.contact.name), Role::contact, study_case.contact.name)
      .make(study_case.contact.parameters);
}
std::unique_ptr<TimeScheme> make_scheme(const StudyCase& study_case, const Registry& registry) {
  return registered(registry.time(study_case.time.name), Role::time, study_case.time.name)
      .make(study_case.time.parameters);
}

std::function<std::unique_ptr<FrictionLaw>()> friction_maker(const StudyCase& study_case, const Registry& registry) {
  if (study_case.friction.name.empty()) return {};
  const auto& law = registered(registry.friction(study_case.friction.name), Role::friction, study_case.friction.name);
  return [&law, parameters = study_case.friction.parameters] { return law.make(parameters); };
}

void name_indefinite(const IndefiniteStep& wrong, const StudyCase& study_case, const Registry& registry) {
  const auto fault = [&](Role role, const std::string& name, const char* function) {
    throw PluginFault({role_name(role), name, registry.file(role, name)}, function, wrong.what());
  };
  if (wrong.of == IndefiniteStep::Of::scheme) fault(Role::time, study_case.time.name, "plan");
  if (wrong.of == IndefiniteStep::Of::law) fault(Role::contact, study_case.contact.name, "prepare_problem");
  throw wrong;
}

std::optional<double> scheme_restitution(const StudyCase& study_case, const Registry& registry) {
  const auto& scheme = registered(registry.time(study_case.time.name), Role::time, study_case.time.name);
  return value_of_role(scheme.manual.parameters, study_case.time.parameters, ParameterRole::restitution);
}

std::optional<double> largest_restitution(const StudyCase& study_case, const SemiDiscrete& problem,
                                          const Registry& registry) {
  const std::optional<double> common = scheme_restitution(study_case, registry);
  if (!common || problem.own.empty()) return common;
  double largest = 0;
  for (const StopParameters& own : problem.own) largest = std::max(largest, own.restitution.value_or(*common));
  return largest;
}

Prepared prepare_case(const StudyCase& study_case, const Registry& registry, bool audited) {
  Prepared prepared;
  prepared.steps = whole_steps(study_case, prepared.notes);
  note_repeats(study_case, prepared.notes);
  for (std::string& note : table_notes(study_case)) prepared.notes.push_back(std::move(note));
  const auto mass = make_mass(study_case, registry);
  auto law = make_law(study_case, registry);
  const auto scheme = make_scheme(study_case, registry);

  auto discretised =
      discretise(study_case.scene, study_case.elements, *mass, law.get(), &study_case.contact.parameters);
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
  if (is_marginal(*prepared.problem, steps))
    prepared.notes.push_back(
        "marginal: a step leaves all of the highest frequencies (ρ∞ = 1), and what has no mass here has no viscosity "
        "either. Once disturbed, it goes on from step to step. Use a scheme that damps them, or a stiffness damping");
  const double asked = thread_seconds();
  prepared.refusal = beyond_explicit_limit(prepared.problem, steps, study_case.step, [&](double h) {
    return scheme->plan(h, problem_facts(*prepared.problem, *law));
  });
  prepared.aside_seconds = thread_seconds() - asked;
  if (!prepared.refusal.empty()) return prepared;
  if (law->reads() && steps.facts.restitution != Restitution::ignored &&
      scheme_restitution(study_case, registry).value_or(0) != 0)
    prepared.notes.push_back(
        "a compliant law rebounds by its own stiffness: the scheme's restitution has no part in it");
  CompileOptions options;
  options.make_friction = friction_maker(study_case, registry);
  options.expected_steps = prepared.steps;
  options.march = march_way(study_case);
  options.audited = audited;
  try {
    auto compiled = compile(prepared.problem, steps, study_case.step, std::move(law),
                            {scene_lane(*prepared.problem, study_case.contact.parameters)}, options);
    if (const auto* refusal = std::get_if<Refusal>(&compiled))
      prepared.refusal = refusal->sentence;
    else
      prepared.program.emplace(std::move(std::get<Program>(compiled)));
  } catch (const IndefiniteStep& wrong) {
    name_indefinite(wrong, study_case, registry);
  }
  return prepared;
}

CaseRecord begin_record(const StudyCase& study_case, const Prepared& prepared) {
  CaseRecord record;
  record.id = study_case.id;
  record.axes = study_case.axes;
  record.notes = prepared.notes;
  if (prepared.program) {
    record.operator_name = operator_name(prepared.program->kind);
    record.left_out = left_out_pairs(prepared.program->left_out);
    if (!prepared.program->every_step_because.empty())
      record.notes.push_back("every step is marched: " + prepared.program->every_step_because);
  } else {
    record.status = Status::refused;
    record.reasons = {prepared.refusal};
  }
  return record;
}

void record_early_end(CaseRecord& record, const Marcher& marcher, long long steps, double budget) {
  const LaneStatus& status = marcher.status(0);
  if (status.running) {
    record.status = Status::failed;
    record.reasons = {said("the budget of {:g} s was spent at step {} of {}, t = {:.6g} s", budget, marcher.step(),
                           steps, marcher.time())};
    return;
  }
  record.status = status.end.failed() ? Status::failed : Status::diverged;
  record.reasons = {said("step {}, t = {:.6g} s: {}", status.step, status.time, told(status.end))};
  record.steps = status.step;
}

void add_doubts(CaseRecord& record, const std::vector<Said>& doubts) {
  for (const Said& doubt : doubts) {
    if (doubt.empty()) continue;
    if (record.status == Status::done)
      record.reasons.push_back(doubt);
    else
      record.notes.push_back(doubt.text);
  }
}

std::vector<std::pair<std::string, std::string>> left_out_pairs(const std::vector<LeftOut>& items) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const LeftOut& item : items) pairs.emplace_back(item.item, item.reason);
  return pairs;
}

}  // namespace ricochet
