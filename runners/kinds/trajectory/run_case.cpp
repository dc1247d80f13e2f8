#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/engine/cost_model.hpp>
#include <ricochet/engine/flight/flight.hpp>
#include <ricochet/engine/jamming.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/measure/contact/friction_watch.hpp>
#include <ricochet/measure/contact/stop_contacts.hpp>
#include <ricochet/measure/contact/stop_places.hpp>
#include <ricochet/measure/energy/energy_audit.hpp>
#include <ricochet/scene/whole_load.hpp>

#include "runners/kinds/trajectory/outputs.hpp"
#include "runners/kinds/trajectory/snapshot_taker.hpp"
#include "runners/kinds/trajectory/stop_tables.hpp"
#include "runners/kinds/trajectory/trajectory.hpp"
#include "runners/kinds/trajectory/window_means.hpp"
#include "runners/march/contact_steps.hpp"
#include "runners/march/load_changes.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/march/seconds.hpp"
#include "runners/march/struck_together.hpp"
#include "runners/march/trial_march.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

// A step that is left out in contact, s: one of a compliant law is made without a reading, others are composed.
// 0.05 to 0.3 µs are measured of these.
constexpr double made_step = 2.5e-7, composed_step = 1e-7;
// Where none was counted, shares of time in contact. Of shaken or loaded scenes whose contact is left out, and of
// flights that march it: 0.05 to 0.4 measured of shaken scenes, 0.01 to 0.2 of others.
constexpr double held_driven = 0.5, marched_in_contact_driven = 0.15, marched_in_contact_free = 0.05;

// The sampled series of one lane, in the columns of a trajectory's curve, with the extremes of every step between two
// samples. Audit and recorder look at a step before it.
class Sampler final : public StepObserver {
 public:
  Sampler(const Marcher& marcher, const EnergyAudit& audit, StopContacts& contacts)
      : audit_(audit),
        contacts_(contacts),
        gaps_(marcher),
        points_(marcher, marcher.program().problem->observed),
        fields_(marcher, marcher.program().problem->fields) {
    const SemiDiscrete& problem = *marcher.program().problem;
    for (const Column& column : curves_head(problem.observed.names, problem.fields.names).columns)
      curve_.names.push_back(column.name);
    row_.resize(curve_.names.size());
    curve_.columns.resize(curve_.names.size());
    asks_.next_shown = never;
    asks_.tip = true;
  }
  void stage_solved(const Marcher&, const StageView&) override {}
  void step_done(Marcher& marcher) override {
    if (!marcher.status(0).running) return;
    const double tip = marcher.tip(0);
    low_ = std::min(low_, tip);
    high_ = std::max(high_, tip);
    see_depth(marcher, audit_.penetration(0));
  }
  void interval(Marcher& marcher, const StepInterval& steps) override {
    if (!marcher.status(0).running) return;
    steps.tip_extremes(low_, high_);
    if (steps.flight) see_depth(marcher, steps.penetration);
  }
  void take(const Marcher& marcher) {
    largest_tip_ = largest_tip();
    const EnergySample& energy = audit_.energy(0);
    const ContactTotals& contact = audit_.contact(0);
    const double row[] = {marcher.time(),
                          marcher.tip(0),
                          audit_.tip_velocity(0),
                          energy.kinetic,
                          energy.elastic,
                          energy.contact,
                          energy.load,
                          energy.common(),
                          energy.scheme,
                          contacts_.merges() ? contacts_.upwards() : contact.force,
                          audit_.penetration(0),
                          static_cast<double>(contact.active),
                          contacts_.force(),
                          contacts_.take_peak(),
                          low_,
                          high_,
                          deepest_};
    auto next = std::copy(std::begin(row), std::end(row), row_.begin());
    for (int i = 0; i < points_.count(); ++i) {
      *next++ = points_.displacement(marcher, i);
      *next++ = points_.velocity(marcher, audit_, i);
    }
    for (int i = 0; i < fields_.count(); ++i) *next++ = fields_.displacement(marcher, i);
    low_ = infinity;
    high_ = -infinity;
    deepest_ = 0;
    for (const double value : row_)
      if (!std::isfinite(value)) return;
    for (std::size_t c = 0; c < curve_.columns.size(); ++c) curve_.columns[c].push_back(row_[c]);
  }
  Curve finish() { return std::move(curve_); }
  double largest_tip() const {
    return low_ > high_ ? largest_tip_ : std::max({largest_tip_, std::abs(low_), std::abs(high_)});
  }
  const GapWatch& gaps() const { return gaps_; }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  void see_depth(const Marcher& marcher, double penetration) {
    deepest_ = std::max(deepest_, penetration);
    gaps_.see(marcher, penetration);
  }

  const EnergyAudit& audit_;
  StopContacts& contacts_;
  double low_ = infinity, high_ = -infinity, deepest_ = 0;  // since the last sample
  double largest_tip_ = 0;                                  // until then
  GapWatch gaps_;
  RowReadings points_, fields_;
  std::vector<double> row_;  // of the curve
  Curve curve_;
};

/// What looks at the steps of a trajectory, in turn; only what is asked for is among `observers`.
struct Watched {
  EnergyAudit audit;
  TangentWatch tangents;
  FrictionWatch friction;
  ImpactRecorder recorder;
  StopContacts contacts;
  StruckTogether struck;
  OutputWatch outputs;
  WindowMeans means;
  ForceWindow forces;
  OrbitTaker orbits;
  SnapshotTaker snapshots;
  Sampler sampler;
  Observers observers;
  Watched(const StudyCase& study_case, const Marcher& marcher, long long steps)
      : audit(marcher, SamplingMode::seldom),
        tangents(marcher, asked_outputs(study_case).window),
        friction(marcher, audit, asked_outputs(study_case).window),
        recorder(marcher),
        contacts(marcher, recorder),
        struck(marcher),
        outputs(study_case, marcher, contacts),
        means(study_case.settings, marcher, audit, steps, &contacts),
        forces(study_case.settings, marcher),
        orbits(marcher, asked_outputs(study_case).window, steps),
        snapshots(study_case.scene, marcher, steps, snapshots_asked(study_case.settings)),
        sampler(marcher, audit, contacts),
        observers{&audit} {
    // Before the recorder, which tells it what a step gave.
    if (tangents.any()) {
      observers.add(&tangents);
      contacts.tell(&tangents);
    }
    if (friction.any()) observers.add(&friction);
    observers.add(&recorder);
    recorder.tell(&struck);
    if (outputs.any()) observers.add(&outputs);
    if (means.asked()) observers.add(&means);
    if (has_window(study_case.settings)) observers.add(&forces);
    if (orbits.any()) observers.add(&orbits);
    if (snapshots.taken()) observers.add(&snapshots);
    observers.add(&sampler);
  }
};

// Steady loads have a potential; its zero is where it is lowest, or where the motion begins.
void count_steady_load(Marcher& marcher, EnergyAudit& audit, std::vector<std::string>& notes) {
  const SemiDiscrete& problem = *marcher.program().problem;
  Eigen::VectorXd load(problem.dofs());
  if (!marcher.program().load || !problem.load->assemble_steady(load.data()) || !load.allFinite()) return;
  const std::optional<double> lowest =
      lowest_potential(problem, load, marcher.program().contact ? &marcher.law() : nullptr);
  if (!lowest)
    notes.push_back(
        "nothing holds the structure against its steady load: the potential of that load has no lowest value, and is "
        "counted from the initial state");
  audit.count_load(marcher, load, lowest.value_or(-load.dot(marcher.program().lanes.front().position)));
}

// From a contact point of the undeformed structure to its nearest stop, m; infinite without.
double smallest_gap(const Marcher& marcher) {
  double gap = std::numeric_limits<double>::infinity();
  if (!marcher.program().contact) return gap;
  const LaneSpec& lane = marcher.program().lanes.front();
  for (const Eigen::VectorXd* bounds : {&lane.lower, &lane.upper})
    for (const double bound : *bounds) gap = std::min(gap, std::abs(bound));
  return gap;
}

void fill_energies(CaseRecord& record, const Marcher& marcher, const EnergyAudit& audit) {
  const EnergyTotals& energy = audit.totals(0);
  const ContactTotals& contact = audit.contact(0);
  const auto put = [&](const char* name, double value) { put_measure(record, name, value); };
  const double start = energy.first.common(), end = energy.last.common();
  const StepPlan& plan = marcher.program().plan;
  const bool balances = audit.balances();
  if (!plan.energy.empty()) {
    put("scheme_energy_start", energy.scheme_start);
    put("scheme_energy_end", energy.last.scheme);
  } else {
    record.notes.push_back("the scheme declares no energy of its own: its steps are judged by the common one");
  }
  put("energy_start", start);
  put("energy_end", end);
  const double brought_in = energy.brought_in(), round_off = 0x1p-52 * static_cast<double>(record.steps);
  // A start that round-off of the run may be larger than is none.
  if (start > round_off * brought_in) put("energy_ratio", end / start);
  if (balances || !energy.driven) {
    put("energy_brought_in", brought_in);
    // Less than round-off of the energies that it is made of, K q of many elements among them, is nothing.
    if (brought_in > 0x1p-33 * (std::abs(start) + std::abs(energy.first.load) + std::abs(energy.first.elastic)))
      put("energy_left", end / brought_in);
    put("largest_step_gain", energy.largest_step_gain);
  }
  if (!balances)
    record.notes.push_back(
        "the scheme declares no work form: the works of damping and loads, what contact dissipates and the balance are "
        "not known");
  if (contact.impacts > 0 && balances)
    put("drift_per_impact", (energy.last.scheme - energy.scheme_start - energy.work_of_loads + energy.work_of_damping) /
                                static_cast<double>(contact.impacts));
  if (balances) {
    put("work_of_damping", energy.work_of_damping);
    put("work_of_loads", energy.work_of_loads);
    put("work_of_steady_loads", energy.work_of_loads - energy.work_of_driving());
    // What the stops give back (a spring's potential) is not dissipated.
    const double stored = energy.last.contact - energy.first.contact;
    put("dissipated_at_contact", -energy.work_of_contact - stored);
    if (marcher.program().friction)
      put("dissipated_by_friction", -energy.work_of_friction - marcher.stored_by_friction(0));
    put("stored_at_stops", stored);
    put("balance_residual", energy.balance_residual());
  }
}

void fill_measures(CaseRecord& record, const Marcher& marcher, const EnergyAudit& audit, const SemiDiscrete& problem,
                   const StopContacts& contacts) {
  fill_energies(record, marcher, audit);
  const EnergyTotals& energy = audit.totals(0);
  const ContactTotals& contact = audit.contact(0);
  const auto put = [&](const char* name, double value) { put_measure(record, name, value); };
  if (const double gap = smallest_gap(marcher); std::isfinite(gap)) put("smallest_gap", gap);
  put("projection_energy", problem.projection_energy);
  put("kernel_energy", problem.kernel_energy);
  put("deepest_penetration", contact.deepest_penetration);
  put("contact_instants", static_cast<double>(contact.contact_steps));
  put("active_set_changes", static_cast<double>(contact.active_set_changes));
  put("impulse", contacts.merges() ? contacts.impulse() : contact.impulse);
  put("complementarity_residual", contact.residual);
  put("law_iterations", contact.most_iterations);
  if (marcher.law().reads()) put("dissipated_by_law", energy.work_of_law);
  const std::vector<Stage>& stages = marcher.program().plan.stages;
  if (std::any_of(stages.begin(), stages.end(), [](const Stage& stage) { return !stage.loss.empty(); }))
    put("dissipated_by_scheme", energy.work_of_scheme);
  if (contact.first_impact >= 0) put("first_impact", contact.first_impact);
  if (contact.first_release >= 0) put("first_release", contact.first_release);
  if (marcher.status(0).running) put("tip_displacement_end", marcher.tip(0));
  if (record.steps > 0) put("microseconds_per_step", 1e6 * record.run_seconds / static_cast<double>(record.steps));
}

}  // namespace

// What a row with its measures takes in the store, and a sample of its curve: sixteen numbers. Measured.
constexpr double bytes_of_row = 3000, bytes_of_sample = 128;

namespace {

// What a reader should know of a stop that rubs: coupling, how soon a held effort settles, how fast it creeps.
std::string rubbing_note(const Program& program, std::size_t number, double scheme_restitution) {
  constexpr double left = 0.01;
  const RubbingPoint& one = program.problem->rubbing[number];
  const auto point = static_cast<std::size_t>(one.point);
  const double root = std::abs(program.held_root), creeps = program.friction->creeps(1);
  std::string text = fmt::format("stop {} rubs, μ {:g}: normal and tangent are coupled by {:.2g} (jam number {:.2g})",
                                 program.problem->stops[point], one.given.largest(), program.jam[number].coupling,
                                 program.jam[number].number);
  const std::vector<StopParameters>& own = program.problem->own;
  const double e = own.empty() ? scheme_restitution : own[point].restitution.value_or(scheme_restitution);
  const double gain = largest_gain(program.jam[number], e);
  if (gain > 5e-4)
    text += fmt::format("; with restitution {:g} an impact may give up to {:.3g} % more energy than it finds", e,
                        100 * gain);
  if (creeps > 0) return text + fmt::format("; held, it creeps by up to {:.3g} m/s", creeps);
  if (const double way = program.friction->gives_way(); way > 0)
    return text + fmt::format("; held, it gives way by {:.3g} m per N", way);
  if (root >= 1) return text + "; a disturbance of a held effort stays";
  const double steps = root > 0 ? std::ceil(std::log(left) / std::log(root)) : 0;
  return text + (steps > 0 ? fmt::format("; a held effort forgets 99 % of a disturbance in {:g} steps", steps)
                           : "; a held effort is right at once");
}

// What a case asks of each step beside its energies and impacts.
WatchWork watch_work(const StudyCase& study_case, const Program& program) {
  const SemiDiscrete& problem = *program.problem;
  const auto row = [&](Eigen::Index all, Eigen::Index rows) {
    return rows > 0 ? static_cast<double>(program.model->modal() ? rows * problem.dofs() : all) : 0.0;
  };
  const auto of = [&](const auto& rows) { return row(rows.nonZeros(), rows.rows()); };
  const AskedOutputs asked = asked_outputs(study_case);
  WatchWork watch;
  const auto add = [&](double numbers) {
    ++watch.observers;
    watch.numbers += numbers;
  };
  if (problem.tangents.rows.rows() > 0) add(of(problem.tangents.rows));
  if (program.contact && asked.windowed && (asked.any || !problem.stops.empty())) add(of(problem.contact));
  for (const AskedSpectrum& one : asked.spectra)
    if (!one.force) add(0);
  if (has_window(study_case.settings)) {
    add(0);
    const Json& window = study_case.settings.at("window");
    watch.samples = window.contains("parts") && program.law->reads();
  }
  return watch;
}

// Seconds of a step beside what compiling predicts: who watches it, and what contact costs. `counts`: of a trial, where
// there is one.
double seconds_beside(const StudyCase& study_case, const Program& program, const std::optional<StepCounts>& counts) {
  WatchWork watch = watch_work(study_case, program);
  const bool counted = counts && counts->in_contact() > 0;
  if (counted) watch.contact = counts->contact();
  if (!program.flight) return predict_watch(program, watch);
  if (program.problem->points() == 0) return 0;
  // Flights make steps of contact alone, or leave these out as well.
  if (counted) watch.contact->touched = 1;
  const StepWork work{static_cast<int>(program.plan.slots.size()), static_cast<int>(program.plan.stages.size()), false};
  const double made =
      predict_watch(program, watch) + predict_cost(OperatorKind::modal, *program.problem, work, 1).step_seconds;
  const bool driven = is_driven(study_case.scene), composed = program.flight->closed_cause().empty();
  const double held = composed ? composed_step : made_step;
  const bool leaves_out = composed || program.flight->steps_cause().empty();
  if (counted) return counts->in_contact() * (leaves_out ? held : made);
  if (leaves_out) return driven ? held_driven * held : 0;
  return (driven ? marched_in_contact_driven : marched_in_contact_free) * made;
}

}  // namespace

CasePlan plan_case(const StudyCase& study_case, const Registry& registry) {
  CasePlan plan;
  const Prepared prepared = prepare_case(study_case, registry, true);
  plan.refusal = prepared.refusal.text;
  plan.steps = prepared.steps;
  plan.notes = prepared.notes;
  if (!prepared.program) return plan;
  for (Said& doubt : run_doubts(study_case, prepared))
    if (!doubt.text.empty()) plan.notes.push_back(std::move(doubt.text));
  for (std::size_t i = 0; i < prepared.program->jam.size(); ++i)
    plan.notes.push_back(rubbing_note(*prepared.program, i, scheme_restitution(study_case, registry).value_or(0)));
  plan.coarsest_step = plan.finest_step = study_case.step;
  plan.operator_name = operator_name(prepared.program->kind);
  plan.left_out = left_out_pairs(prepared.program->left_out);
  const Program& program = *prepared.program;
  const auto seconds = [&](const std::optional<StepCounts>& counts) {
    return program.predicted_setup_seconds +
           static_cast<double>(prepared.steps) *
               (program.predicted_step_seconds + seconds_beside(study_case, program, counts));
  };
  const double begun = thread_seconds();
  const double assumed = seconds(std::nullopt);
  const auto counts = trial_march(study_case, prepared, registry, assumed);
  // A beginning may not have come to its stops yet.
  plan.predicted_seconds = counts && counts->whole() ? seconds(counts) : std::max(assumed, seconds(counts));
  plan.trial_seconds = thread_seconds() - begun;
  plan.bytes = bytes_of_row + bytes_of_sample * study_case.samples;
  return plan;
}

namespace {

// Marches to the last step, with samples at equal fractions of the run, on whole steps; ends sooner once `budget` (s of
// this thread) is spent.
void march_sampled(Marcher& marcher, Watched& watched, long long steps, long long samples, double budget,
                   const std::atomic<bool>& stop) {
  const double run = thread_seconds();
  double before = run;
  bool spent = false;
  // Steps between two readings of the clock; those that are left out cost it nothing.
  long long chunk = 16;
  const long long longest_chunk = marcher.program().flight ? 1000000 : 20000;
  marcher.start(watched.observers);
  const auto sample = [&] {
    watched.sampler.take(marcher);
    watched.audit.mark_brought_in(0);
  };
  if (marcher.step() > 0) sample();
  for (long long k = 1; k <= samples && marcher.any_running() && !spent; ++k) {
    const auto target = static_cast<long long>(
        std::llround(static_cast<double>(steps) * static_cast<double>(k) / static_cast<double>(samples)));
    watched.audit.sample_after(target);
    while (marcher.step() < target && marcher.any_running() && !spent) {
      if (stop) throw Interrupted{};
      marcher.march(std::min(target - marcher.step(), chunk), watched.observers);
      const double now = thread_seconds();
      spent = now - run > budget;
      // Long enough to cost nothing, short enough to stop soon.
      chunk = now - before < 0.01 ? std::min(2 * chunk, longest_chunk)
                                  : (now - before > 0.1 ? std::max(chunk / 2, 1LL) : chunk);
      before = now;
    }
    if (marcher.any_running() && marcher.step() == target) sample();
  }
}

}  // namespace

CaseRecord run_case(const StudyCase& study_case, const Registry& registry, const std::atomic<bool>& stop) {
  const double set_up = thread_seconds();
  Prepared prepared = prepare_case(study_case, registry, true);
  CaseRecord record = begin_record(study_case, prepared);
  if (!prepared.program) return record;
  std::vector<Said> doubts = run_doubts(study_case, prepared);
  const std::shared_ptr<const SemiDiscrete> problem = prepared.problem;
  Marcher marcher(std::move(*prepared.program));
  Watched watched(study_case, marcher, prepared.steps);
  auto& [audit, tangents, friction, recorder, contacts, struck, outputs, means, forces, orbits, snapshots, sampler,
         observers] = watched;
  count_steady_load(marcher, audit, record.notes);
  record.setup_seconds = thread_seconds() - set_up - prepared.aside_seconds;

  const double run = thread_seconds(), budget = budget_of(study_case);
  march_sampled(marcher, watched, prepared.steps, std::min<long long>(std::max(study_case.samples, 1), prepared.steps),
                budget, stop);
  record.run_seconds = thread_seconds() - run;
  record.steps = marcher.step();
  record.curve = sampler.finish();
  if (marcher.status(0).running && marcher.step() >= prepared.steps)
    record.status = Status::done;
  else
    record_early_end(record, marcher, prepared.steps, budget);
  tangents.finish(marcher);
  recorder.finish(marcher);
  contacts.finish();
  outputs.finish(marcher);
  fill_measures(record, marcher, audit, *problem, contacts);
  if (friction.any()) {
    put_measure(record, "friction_residual", friction.residual());
    put_measure(record, "friction_turns", friction.most_turns());
  }
  const auto restitution = largest_restitution(study_case, *problem, registry);
  add_contact(record, contacts, marcher, restitution, {&outputs, &tangents, &friction});
  doubts.push_back(GapWatch::crossed(marcher, recorder));
  if (const PluginManual* law = registry.manual(Role::contact, study_case.contact.name))
    doubts.push_back(beyond_table(study_case.contact, *law, measure(record, "deepest_penetration").value_or(0)));
  doubts.push_back(struck.told(marcher, restitution));
  const auto resolved =
      contact_steps(study_case, marcher, recorder, measure(record, "deepest_penetration").value_or(0), registry);
  if (resolved) put_measure(record, contact_steps_measure, resolved->steps);
  doubts.push_back(unresolved(resolved));
  doubts.push_back(sampler.gaps().passed(resolved && resolved->steps >= fewest_contact_steps));
  add_doubts(record, doubts);
  if (orbits.any()) record.numbers.push_back(orbits.finish());
  if (snapshots.taken()) record.numbers.push_back(table_of(snapshots.finish()));
  put_measure(record, "largest_tip_displacement", sampler.largest_tip());
  put_measure(record, "steps_visited", static_cast<double>(marcher.steps_visited()));
  means.put(record);
  if (forces.told()) {
    put_measure(record, "contact_force_mean", forces.mean());
    put_measure(record, "contact_force_deviation", forces.deviation());
  }
  if (marcher.delassus_columns() > 0)
    record.notes.push_back(
        fmt::format("Delassus columns computed: {} of {}", marcher.delassus_columns(), problem->points()));
  return record;
}

}  // namespace ricochet
