#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/measure/orbits/section_march.hpp>
#include <ricochet/measure/stability/linear_response.hpp>

#include "runners/kinds/bifurcation/bifurcation.hpp"
#include "runners/kinds/sweep/orbit_checkpoints.hpp"
#include "runners/kinds/sweep/orbit_exponents.hpp"
#include "runners/kinds/sweep/orbit_rows.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/march/case_context.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/march/seconds.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

constexpr int most_refinements = 80;       // halvings
constexpr int most_marched_on = 8;         // times that chains are marched on over their changes of class
constexpr std::size_t most_brackets = 48;  // per start, that are refined at once

class BifurcationRun {
 public:
  BifurcationRun(const StudyCase& study_case, const Registry& registry, const CaseContext& context,
                 const std::atomic<bool>& stop)
      : case_(study_case),
        registry_(registry),
        context_(context),
        stop_(stop),
        scenes_(study_case, registry),
        starts_(starts_of(study_case.settings)),
        values_(parameter_values(study_case.settings)),
        pointer_(study_case.settings.at("parameter").at("pointer").get<std::string>()) {}

  CaseRecord run() {
    const double begun = thread_seconds();
    record_.id = case_.id;
    record_.axes = case_.axes;
    for (const double value : values_) add_value(value);
    section_ = section_plan(case_, scenes_);
    if (scenes_.groups() == 0) return refused();
    describe_methods();
    record_.setup_seconds = thread_seconds() - begun;
    OrbitScheduler scheduler(
        scenes_, {.section = section_, .budget = budget_of(case_), .blocks = context_.blocks, .case_id = case_.id});
    scheduler_ = &scheduler;
    OrbitCheckpoints checkpoints(context_.checkpoints, context_.key);
    ExponentCheckpoints batches(context_.checkpoints, context_.key);
    saved_ = checkpoints.find();
    const auto keep = [&](const MarchedOrbits& marched) {
      checkpoints.save(marched);
      show_partial();
    };
    add_tasks();
    scheduler.restore(saved_);
    scheduler.run(stop_, keep);
    refine(keep);
    record_.run_seconds = scheduler.seconds();
    finish(batches);
    checkpoints.forget();
    batches.forget();
    return std::move(record_);
  }

 private:
  // One value of the parameter: its scenes, at rest and as the study says, where starts ask for them.
  struct Value {
    double value = 0;
    int rest = -1, state = -1;  // scenes
    std::vector<int> tasks;     // per start; −1: none
  };

  void add_value(double value) {
    Value one;
    one.value = value;
    if (any_start(starts_, false)) one.rest = scenes_.add(pointer_, value, false);
    if (any_start(starts_, true)) one.state = scenes_.add(pointer_, value, true);
    one.tasks.assign(starts_.size(), -1);
    known_.push_back(std::move(one));
  }

  int scene_of(const Value& value, const StartSpec& start) const {
    return start.own_state() ? value.state : value.rest;
  }

  OrbitTask task_at(const Value& value, const StartSpec& start) const {
    OrbitTask task;
    task.scene = scene_of(value, start);
    task.lane = scenes_[task.scene].lane;
    if (start.kind == StartSpec::random) {
      const int group = scenes_[task.scene].group;
      set_random_state(task.lane, scenes_.problem(group), start.seed, start.index);
    }
    return task;
  }

  void add_tasks() {
    for (std::size_t s = 0; s < starts_.size(); ++s) {
      const bool down = starts_[s].kind == StartSpec::down, chain = down || starts_[s].kind == StartSpec::up;
      int last = -1;
      for (std::size_t i = 0; i < known_.size(); ++i) {
        Value& value = known_[down ? known_.size() - 1 - i : i];
        if (!scenes_[scene_of(value, starts_[s])].refusal.empty()) continue;
        OrbitTask task = task_at(value, starts_[s]);
        if (chain) task.after = last;
        last = value.tasks[s] = scheduler_->add(std::move(task));
      }
    }
  }

  void describe_methods() {
    describe_march(record_, scenes_, case_);
    record_.notes.push_back(fmt::format(
        "section at step {} of {} per period; recurrence within {:g} of {:g} m and of {:g} m/s", section_.strobe,
        section_.steps_per_period, recurrence_tolerance, section_.scale, section_.scale * section_.pulsation));
    // At a depth of a thousandth of the room: whoever compares cases orders them by it.
    const auto one = make_law(case_, registry_);
    if (one->changes_problem()) {
      const StudyCase met = with_parameters(at_rest(case_), scenes_[scenes_.reference_scene()].variant.values);
      discretise(met.scene, case_.elements, *make_mass(case_, registry_), one.get(), &case_.contact.parameters);
    }
    const auto compliance = contact_compliance(*one, case_.contact.parameters, 1e-3 * section_.scale);
    NumberTable law = contact_law_type().head();
    law.add({compliance.value_or(std::numeric_limits<double>::quiet_NaN())});
    record_.numbers.push_back(std::move(law));
    analyse_groups();
  }

  // What the plan alone says of the groups that are not known yet.
  void analyse_groups() {
    while (static_cast<int>(marginal_.size()) < scenes_.groups()) {
      const int group = static_cast<int>(marginal_.size());
      marginal_.push_back(marginal_roots(scenes_, group));
      viscosity_.push_back(numerical_viscosity(scenes_, group, case_, registry_));
    }
  }

  CaseRecord refused() {
    record_.status = Status::refused;
    record_.reasons = {"no value of the parameter can be marched"};
    for (const Value& value : known_)
      for (const int scene : {value.rest, value.state})
        if (scene >= 0 && !scenes_[scene].refusal.empty()) {
          record_.reasons = {
              said("no value of the parameter can be marched; at {:g}: {}", value.value, scenes_[scene].refusal)};
          return std::move(record_);
        }
    return std::move(record_);
  }

  void refine(const std::function<void(const MarchedOrbits&)>& keep) {
    const Json& wanted = case_.settings.value("refine", Json(nullptr));
    if (!wanted.is_number() || scheduler_->over_budget()) return;
    const auto tolerance = wanted.get<double>();
    const auto march = [&] {
      analyse_groups();
      scheduler_->restore(saved_);
      scheduler_->run(stop_, keep);
    };
    int marched_on = 0;
    for (int round = 0; round < most_refinements; ++round) {
      int added = 0;
      for (const Middle& middle : middles(tolerance)) added += add_middle(middle);
      if (added > 0) {
        march();
        continue;
      }
      const std::vector<Ending> endings = chain_endings();
      if (endings.empty() || ++marched_on > most_marched_on) return;
      march();
      for (const Ending& one : endings) settle(one);
    }
  }

  // The far side of a change of class of a chain, marched on from the near side. What it did from farther off may be
  // the jump of the parameter's doing, where another motion exists beside.
  struct Ending {
    std::size_t start;
    double value;
    int task;
  };

  std::vector<std::optional<MotionClass>> classes_of(std::size_t start) const {
    std::vector<std::optional<MotionClass>> classes;
    for (const Value& value : known_)
      classes.push_back(value.tasks[start] < 0 ? std::nullopt
                                               : rough_class(scheduler_->orbit(value.tasks[start]), section_));
    return classes;
  }

  std::vector<Ending> chain_endings() {
    std::vector<Ending> all;
    for (std::size_t s = 0; s < starts_.size(); ++s) {
      const bool up = starts_[s].kind == StartSpec::up;
      if (!up && starts_[s].kind != StartSpec::down) continue;
      for (const auto& [below, above] : class_changes(classes_of(s))) {
        Value &near = known_[up ? below : above], &far = known_[up ? above : below];
        if (scheduler_->task(far.tasks[s]).after == near.tasks[s]) continue;
        OrbitTask task = task_at(far, starts_[s]);
        task.after = near.tasks[s];
        all.push_back({s, far.value, scheduler_->add(std::move(task))});
      }
    }
    return all;
  }

  // The orbit from the near side stands for its value from here on.
  void settle(const Ending& one) {
    if (!scheduler_->finished(one.task)) return;
    for (Value& value : known_)
      if (value.value == one.value) value.tasks[one.start] = one.task;
  }

  // Half way between two neighbours from one start whose classes differ.
  struct Middle {
    std::size_t start;
    double value;
    int left, right;  // tasks
  };

  std::vector<Middle> middles(double tolerance) {
    std::vector<Middle> all;
    for (std::size_t s = 0; s < starts_.size(); ++s) {
      std::size_t brackets = 0;
      for (const auto& [below, above] : class_changes(classes_of(s))) {
        const Value &left = known_[below], &right = known_[above];
        if (right.value - left.value <= tolerance) continue;
        if (brackets++ < most_brackets)
          all.push_back({s, 0.5 * (left.value + right.value), left.tasks[s], right.tasks[s]});
        else
          crowded_ = true;
      }
    }
    return all;
  }

  // Whether there is a new orbit to march.
  bool add_middle(const Middle& middle) {
    const auto place = std::lower_bound(known_.begin(), known_.end(), middle.value,
                                        [](const Value& value, double at) { return value.value < at; });
    const auto index = place - known_.begin();
    if (place == known_.end() || place->value != middle.value) {
      add_value(middle.value);
      std::rotate(known_.begin() + index, known_.end() - 1, known_.end());
    }
    Value& value = known_[static_cast<std::size_t>(index)];
    const StartSpec& start = starts_[middle.start];
    if (value.tasks[middle.start] >= 0 || !scenes_[scene_of(value, start)].refusal.empty()) return false;
    OrbitTask task = task_at(value, start);
    if (start.kind == StartSpec::up) task.after = middle.left;
    if (start.kind == StartSpec::down) task.after = middle.right;
    value.tasks[middle.start] = scheduler_->add(std::move(task));
    return true;
  }

  std::vector<OrbitView> views() const {
    std::vector<OrbitView> all;
    for (std::size_t s = 0; s < starts_.size(); ++s)
      for (const Value& value : known_) {
        const int scene = scene_of(value, starts_[s]), task = value.tasks[s];
        const bool original = std::binary_search(values_.begin(), values_.end(), value.value);
        if (task < 0 && (!original || scenes_[scene].refusal.empty())) continue;
        OrbitView view;
        view.value = value.value;
        view.start = s;
        view.scene = scene;
        view.refusal = scenes_[scene].refusal.text;
        if (task >= 0) {
          if (!scheduler_->finished(task)) continue;
          view.orbit = &scheduler_->orbit(task);
          view.group = scenes_[scene].group;
          view.problem = &scenes_.problem(view.group);
          view.marginal = marginal_[static_cast<std::size_t>(view.group)].sentence;
          view.viscosity = viscosity_[static_cast<std::size_t>(view.group)];
        }
        all.push_back(view);
      }
    return all;
  }

  void show_partial() {
    if (!context_.checkpoints.show || !pace_.due()) return;
    CaseRecord partial = record_;
    std::vector<OrbitView> all = views();
    classify_all(all);
    write_tables(partial, all);
    partial.status = Status::done;
    partial.reasons = {said("under way: {} of {} orbits", all.size(), scheduler_->count())};
    pace_.take([&] { context_.checkpoints.show(partial); });
  }

  void classify_all(std::vector<OrbitView>& all) const {
    for (OrbitView& view : all) judge(view, section_);
  }

  std::vector<std::string> start_names() const {
    std::vector<std::string> names;
    for (const StartSpec& start : starts_) names.push_back(start.name);
    return names;
  }

  void write_tables(CaseRecord& record, const std::vector<OrbitView>& all) const {
    add_orbit_tables(record, all, start_names(), exponents(), section_);
  }

  int exponents() const { return case_.settings.value("exponents", 0); }

  void finish(ExponentCheckpoints& batches) {
    std::vector<OrbitView> all = views();
    give_exponents(all, batches);
    classify_all(all);
    write_tables(record_, all);
    add_portraits(record_, scenes_, all, section_);
    add_entries(record_, all, start_names());
    add_grazing();
    if (crowded_)
      record_.notes.push_back(fmt::format("only {} changes of class per start were refined at a time", most_brackets));
    for (int one = 0; one < scheduler_->count(); ++one)
      if (scheduler_->finished(one)) record_.steps += scheduler_->marched_periods(one) * section_.steps_per_period;
    const auto marched = std::count_if(all.begin(), all.end(), [](const OrbitView& view) { return view.complete(); });
    put_measure(record_, "orbits", static_cast<double>(marched));
    for (const OrbitView& view : all) lost_ += view.orbit && view.orbit->end.cause == EndCause::process_ended;
    if (lost_ > 0) put_measure(record_, "orbits_lost", static_cast<double>(lost_));
    add_shares(record_, all);
    if (scheduler_->lane_periods() > 0)
      put_measure(record_, "lane_steps_per_second",
                  static_cast<double>(scheduler_->lane_periods() * section_.steps_per_period) /
                      std::max(1e-9, scheduler_->seconds()));
    conclude(all, marched);
  }

  void give_exponents(std::vector<OrbitView>& all, ExponentCheckpoints& batches) {
    ExponentTask task;
    std::vector<std::size_t> places;
    std::vector<OrbitPeriod> periods;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!all[i].complete()) continue;
      task.orbits.push_back(all[i].orbit);
      task.groups.push_back(all[i].group);
      task.scenes.push_back(all[i].scene);
      const OrbitPeriod& period = periods.emplace_back(orbit_period(*all[i].orbit, section_));
      task.rounds.push_back(period.doubtful > 0 ? period.doubtful : period.recurrence.period);
      places.push_back(i);
    }
    if (exponents() == 0 || places.empty()) return;
    for (const MarginalRoots& roots : marginal_) task.sawtooth.push_back(roots.sawtooth);
    task.count = exponents();
    task.blocks = context_.blocks;
    task.case_id = case_.id;
    task.lost = [this](const std::string& cause) {
      ++lost_;
      record_.notes.push_back("no exponents of an orbit: " + cause);
    };
    batches.serve(task);
    double seconds = 0;
    auto found = measure_exponents(scenes_, task, section_, seconds, stop_);
    for (std::size_t i = 0; i < found.size(); ++i)
      if (found[i].method == "tangent+jump" && !found[i].values.empty() &&
          outlives(periods[i], found[i].values.front(), section_)) {
        found[i] = {};
        found[i].outlived = true;
      }
    record_.run_seconds += seconds;
    for (std::size_t i = 0; i < found.size(); ++i) all[places[i]].exponents = found[i];
    put_measure(record_, "exponent_seconds", seconds);
    const auto none_where = [&](bool OrbitExponents::*fact, const char* which, const char* why) {
      const auto count = std::count_if(found.begin(), found.end(), [&](const auto& one) { return one.*fact; });
      if (count == 0) return;
      record_.notes.push_back(fmt::format("no exponents of {} orbit{}{}: {}", count, &"s"[count == 1], which, why));
    };
    none_where(&OrbitExponents::saturated, "", why_saturated);
    none_where(&OrbitExponents::blind, " with impacts", why_blind);
    none_where(&OrbitExponents::untold, "", why_untold);
    none_where(&OrbitExponents::outlived, "", why_outlived);
    none_where(&OrbitExponents::superstable, "", why_superstable);
  }

  void conclude(const std::vector<OrbitView>& all, std::ptrdiff_t marched) {
    const auto bad = static_cast<std::ptrdiff_t>(all.size()) - marched;
    record_.status = marched > 0 ? Status::done : Status::diverged;
    if (scheduler_->over_budget()) {
      record_.status = Status::failed;
      record_.reasons = {said("the budget of {:g} s was spent: {} of {} orbits are complete", budget_of(case_), marched,
                              scheduler_->count())};
    } else if (marched == 0) {
      for (const OrbitView& view : all)
        if (view.orbit)
          record_.reasons = {said("no orbit was completed; {}",
                                  view.orbit->end_words.empty() ? told(view.orbit->end) : Said(view.orbit->end_words))};
    } else if (bad > 0) {
      record_.notes.push_back(
          fmt::format("{} of {} orbits were refused or stopped; their rows say why", bad, all.size()));
    }
  }

  // Where the periodic motion without contact first touches a stop, from the scheme's own linear response.
  void add_grazing() {
    ForcedScenes probes(case_, registry_);
    std::map<int, std::optional<LinearResponse>> responses;  // per group: it does not depend on amplitude and stops
    const auto excess = [&](double value) -> std::optional<double> {
      const ForcedScene& scene = probes[probes.add(pointer_, value, false)];
      if (!scene.refusal.empty() || probes.problem(scene.group).points() == 0) return std::nullopt;
      const auto [known, added] = responses.try_emplace(scene.group);
      if (added)
        known->second =
            linear_response(probes.problem(scene.group), probes.plan(scene.group), probes.step(scene.group));
      if (!known->second) return std::nullopt;
      return overlap(*known->second, scene.lane);
    };
    for (const Grazing& one : find_grazings(values_, excess)) add_grazing_row(record_, one);
  }

  const StudyCase& case_;
  const Registry& registry_;
  const CaseContext& context_;
  const std::atomic<bool>& stop_;
  ForcedScenes scenes_;
  std::vector<StartSpec> starts_;
  std::vector<double> values_;  // of the study
  std::string pointer_;
  std::vector<Value> known_;  // ascending; refined ones among them
  SectionPlan section_;
  std::vector<MarginalRoots> marginal_;  // per group
  std::vector<std::optional<EquivalentViscosity>> viscosity_;
  OrbitScheduler* scheduler_ = nullptr;
  MarchedOrbits saved_;
  CaseRecord record_;
  bool crowded_ = false;
  int lost_ = 0;  // orbits whose processes ended
  PartialPace pace_;
};

}  // namespace

CaseRecord run_bifurcation(const StudyCase& study_case, const Registry& registry, const CaseContext& context,
                           const std::atomic<bool>& stop) {
  return BifurcationRun(study_case, registry, context, stop).run();
}

}  // namespace ricochet
