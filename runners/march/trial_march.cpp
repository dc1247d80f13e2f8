#include "runners/march/trial_march.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <ricochet/engine/flight/flight.hpp>

namespace ricochet {
namespace {

constexpr long long trial_steps = 2000;

// Of the first mode that swings, s; 0 where the march has no modes, or none swings.
double first_period(const Program& program) {
  if (!program.model->modal()) return 0;
  const Eigen::VectorXd stiffness = program.model->stiffness().diagonal(),
                        mass = program.model->inertia().mass.diagonal();
  double period = 0;
  for (Eigen::Index i = 0; i < mass.size(); ++i)
    if (stiffness[i] > 0 && mass[i] > 0)
      period = std::max(period, 2 * std::numbers::pi * std::sqrt(mass[i] / stiffness[i]));
  return period;
}

// A step of somebody's method may never come to an end, and a plan has to. The program's own methods stand in one
// folder: what calls one from another folder is not tried.
bool from_one_folder(const StudyCase& study_case, const Registry& registry) {
  const auto methods = methods_of(study_case);
  const auto folder = [&](const auto& one) {
    return std::filesystem::path(registry.file(one.first, one.second->name)).parent_path();
  };
  return std::all_of(methods.begin(), methods.end(),
                     [&](const auto& one) { return folder(one) == folder(methods.front()); });
}

// The step of the trial, s: the whole duration in so many steps where the first mode sees no difference.
double trial_step(const StudyCase& study_case, const Prepared& prepared) {
  constexpr double steps_of_mode = 100;
  const Program& program = *prepared.program;
  const double whole = study_case.step * static_cast<double>(prepared.steps) / static_cast<double>(trial_steps);
  if (explicit_step(program.plan)) return study_case.step;
  return std::max(study_case.step, std::min(whole, first_period(program) / steps_of_mode));
}

}  // namespace

void StepCounts::stage_solved(const Marcher&, const StageView& view) {
  if (view.starting || (view.contact_lanes & 1U) == 0) return;
  touches_ = true;
  ++solves_;
  points_ += static_cast<double>(view.pushed.size());
  if ((view.touched_lanes & 1U) != 0) iterations_ += view.outcome[0].iterations;
}

void StepCounts::step_done(Marcher&) {
  ++visited_;
  touched_ += touches_ ? 1 : 0;
  see(touches_);
  touches_ = false;
}

void StepCounts::interval(Marcher&, const StepInterval& told) {
  const auto steps = static_cast<double>(told.steps);
  (told.flight ? left_out_ : visited_) += steps;
  if (told.flight && !told.closed.empty()) held_ += steps;
  see(told.flight && !told.closed.empty());
}

ContactWork StepCounts::contact() const {
  ContactWork work{in_contact()};
  if (solves_ > 0) work = {work.touched, points_ / solves_, iterations_ / solves_};
  return work;
}

std::optional<StepCounts> trial_march(const StudyCase& study_case, const Prepared& prepared, const Registry& registry,
                                      double seconds) {
  constexpr long long fewest_steps = 200, together = 100;
  constexpr double long_share = 0.02, short_share = 0.2, short_seconds = 5e-3;
  const Program& program = *prepared.program;
  if (!program.contact || prepared.steps < fewest_steps || !from_one_folder(study_case, registry)) return std::nullopt;
  const double step = trial_step(study_case, prepared),
               allowed = std::max(long_share * seconds, std::min(short_share * seconds, short_seconds));
  const auto most = std::min(trial_steps, static_cast<long long>(study_case.duration / step));
  auto law = make_law(study_case, registry);
  const PlanOrRefusal made = make_scheme(study_case, registry)->plan(step, problem_facts(*prepared.problem, *law));
  if (!std::holds_alternative<StepPlan>(made)) return std::nullopt;
  CompileOptions options;
  options.make_friction = friction_maker(study_case, registry);
  options.expected_steps = most;
  options.march = program.flight ? MarchWay::flights : MarchWay::every_step;
  options.kind = program.kind == OperatorKind::diagonal ? OperatorKind::band : program.kind;
  // Seconds of a step that is made, as long as nothing is touched.
  StepWork work{static_cast<int>(program.plan.slots.size()), static_cast<int>(program.plan.stages.size())};
  const Cost cost = predict_cost(program.kind, *program.problem, work, 1);
  if (cost.setup_seconds > allowed) return std::nullopt;
  try {
    auto compiled = compile(prepared.problem, std::get<StepPlan>(made), step, std::move(law),
                            {scene_lane(*prepared.problem, study_case.contact.parameters)}, options);
    if (!std::holds_alternative<Program>(compiled)) return std::nullopt;
    Marcher marcher(std::move(std::get<Program>(compiled)));
    StepCounts counts(study_case.step / step);
    marcher.start(&counts);
    double spent = cost.setup_seconds;
    while (marcher.step() < most && spent < allowed) {
      marcher.march(std::min(together, most - marcher.step()), &counts);
      if (!marcher.status(0).running) return std::nullopt;
      const ContactWork contact = counts.contact();
      const double touched = cost.step_seconds + predict_touched_step(program, contact);
      spent = cost.setup_seconds + counts.steps() * (counts.open() * cost.step_seconds + contact.touched * touched);
    }
    constexpr double nearly = 0.9;
    counts.end(static_cast<double>(marcher.step()) * step > nearly * study_case.duration);
    return counts;
  } catch (const IndefiniteStep&) {
    return std::nullopt;
  }
}

}  // namespace ricochet
