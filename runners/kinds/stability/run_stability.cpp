
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <ricochet/measure/stability/observed_stability.hpp>
#include <ricochet/measure/stability/plan_restitution.hpp>
#include <ricochet/measure/stability/stability.hpp>
#include <ricochet/measure/stability/step_map.hpp>
#include <ricochet/scene/stop_parameters.hpp>

#include "runners/kinds/stability/stability.hpp"
#include "runners/kinds/stability/stability_side.hpp"
#include "runners/kinds/stability/stability_tables.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/march/seconds.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

constexpr const char* untouched_text = "not observed: the scene touches no stop";

void append(std::string& reason, const std::string& sentence) {
  if (!sentence.empty()) reason += (reason.empty() ? "" : "; ") + sentence;
}

class StabilityRun {
 public:
  StabilityRun(const StudyCase& study_case, const Registry& registry, const std::atomic<bool>& stop)
      : case_(study_case), registry_(registry), stop_(stop), steps_(steps_of(study_case)) {
    record_.id = study_case.id;
    record_.axes = study_case.axes;
  }

  CaseRecord run() {
    begin_ = thread_seconds();
    const auto law = make_law(case_, registry_);
    auto discretised =
        discretise(case_.scene, case_.elements, *make_mass(case_, registry_), law.get(), &case_.contact.parameters);
    if (const auto* refusal = std::get_if<Refusal>(&discretised)) return refused(refusal->sentence);
    problem_ = std::make_shared<const SemiDiscrete>(std::move(std::get<SemiDiscrete>(discretised)));
    record_.notes = problem_->notes;
    scheme_ = make_scheme(case_, registry_);
    facts_ = problem_facts(*problem_, *law);
    if (const auto refusal = refuse_own(*law, problem_->own, problem_->stops)) return refused(refusal->sentence);
    const LinearLaw linear = linear_law(*law, problem_->points(), case_.contact.parameters, problem_->own);
    if (law->reads_rate())
      record_.notes.push_back("closed contact is predicted without the law's own damping, which only its marches show");
    touches_ = !linear.absent && stops_somewhere();
    predictor_.emplace(problem_, linear);
    record_.notes.insert(record_.notes.end(), predictor_->notes().begin(), predictor_->notes().end());
    if (const auto refusal = refused_everywhere()) return refused(*refusal);

    std::vector<StabilitySide> sides(touches_ ? 2 : 1);
    if (touches_) sides[1].closed = true;
    for (StabilitySide& side : sides) predict(side);
    if (touches_ && !law->reads()) say_restitution();
    record_.setup_seconds = thread_seconds() - begin_;
    const bool observe = case_.settings.value("observe", true);
    if (observe) {
      say_horizon();
      try {
        for (StabilitySide& side : sides) this->observe(side, sides.front());
      } catch (const IndefiniteStep& wrong) {
        name_indefinite(wrong, case_, registry_);
      }
    }
    record_.run_seconds = thread_seconds() - begin_ - record_.setup_seconds;
    record_.status = Status::done;
    tabulate(sides, observe);
    measure(sides);
    compare_declared(sides.front());
    return std::move(record_);
  }

 private:
  bool stops_somewhere() const {
    for (int i = 0; i < problem_->points(); ++i)
      if (std::isfinite(problem_->lower[i]) || std::isfinite(problem_->upper[i])) return true;
    return false;
  }

  PlanOrRefusal plan(double h) const { return scheme_->plan(h, facts_); }

  // Keeps the plan of the smallest step of the range that has one. The sentence, when none has.
  std::optional<Said> refused_everywhere() {
    std::optional<Said> sentence;
    for (const double h : steps_) {
      auto made = plan(h);
      if (auto* step = std::get_if<StepPlan>(&made)) {
        some_plan_.emplace(std::move(*step), h);
        return std::nullopt;
      }
      sentence = std::get<Refusal>(made).sentence;
    }
    return sentence;
  }

  CaseRecord refused(const Said& sentence) {
    record_.status = Status::refused;
    record_.reasons = {sentence};
    std::vector<StabilityRow> rows;
    for (const double h : steps_) rows.push_back({h, false, {}, "", {}, {}, StepStatus::refused, sentence.text});
    record_.tables.push_back(stability_type().with(rows));
    return std::move(record_);
  }

  void check_stop() const {
    if (stop_) throw Interrupted{};
  }
  bool spent() const { return thread_seconds() - begin_ > budget_of(case_); }

  SpectrumOrRefusal spectrum(const StabilitySide& side, double h, Detail detail) const {
    check_stop();
    const auto made = plan(h);
    if (const auto* refusal = std::get_if<Refusal>(&made)) return *refusal;
    const StepPlan& step = std::get<StepPlan>(made);
    return side.closed ? predictor_->worst_closed(step, h, detail) : predictor_->open(step, h, detail);
  }

  void predict(StabilitySide& side) const {
    for (const double h : steps_)
      side.spectra.push_back(spent() ? std::nullopt : std::optional(spectrum(side, h, Detail::full)));
    // The limit is searched with radii alone; the spectrum beyond it is told whole.
    side.predicted = step_limit(
        [&](double h) -> SpectrumOrRefusal {
          if (spent()) return Refusal{"the budget is spent"};
          return spectrum(side, h, Detail::radius);
        },
        steps_);
    if (side.predicted.step) {
      const double beyond = *side.predicted.step * (1 + 1e-4);
      const auto whole = spectrum(side, beyond, Detail::full);
      if (const auto* known = std::get_if<StepSpectrum>(&whole)) side.predicted.beyond = *known;
    }
  }

  long long scene_steps(double h) const {
    const double ratio = duration_ / h;
    if (!(ratio < static_cast<double>(most_scene_steps))) return most_scene_steps;
    return std::max(least_scene_steps, static_cast<long long>(std::ceil(ratio)));
  }

  void say_horizon() {
    record_.notes.push_back(
        fmt::format("open cells are marched {} steps without loads from a state that excites every mode: a growth "
                    "of 3.5e-4 per step shows",
                    free_steps));
    if (!touches_) return;
    const double first = predictor_->first_pulsation();
    duration_ = case_.duration > 0 ? case_.duration : first > 0 ? 3 * 2 * std::numbers::pi / first : 0;
    record_.notes.push_back(fmt::format(
        "closed cells are the scene itself, marched {}{} at most {} steps{}", duration_ > 0 ? "" : "for ",
        duration_ > 0 ? fmt::format("to t = {:.4g} s,", duration_) : fmt::format("{} steps,", least_scene_steps),
        most_scene_steps,
        duration_ > 0 && steps_.front() * static_cast<double>(most_scene_steps) < duration_
            ? fmt::format(" (steps below {:.3g} s do not get there)", duration_ / static_cast<double>(most_scene_steps))
            : std::string()));
  }

  std::optional<ObservedCell> march(const StabilitySide& side, double h) {
    check_stop();
    const auto made = plan(h);
    if (spent() || std::holds_alternative<Refusal>(made)) return std::nullopt;
    const StepPlan& step = std::get<StepPlan>(made);
    Horizon horizon;
    horizon.steps = side.closed ? scene_steps(h) : free_steps;
    bool whole = true;
    horizon.go_on = [&] {
      check_stop();
      return whole = !spent();
    };
    const auto seen = side.closed ? observe_scene(
                                        problem_, step, h, [&] { return make_law(case_, registry_); },
                                        case_.contact.parameters, horizon)
                                  : observe_free(problem_, step, h, predictor_->excitation(h), horizon);
    const auto* cell = std::get_if<ObservedCell>(&seen);
    if (!cell) return std::nullopt;
    record_.steps += cell->steps;
    return whole ? std::optional(*cell) : std::nullopt;
  }

  void observe(StabilitySide& side, const StabilitySide& open) {
    for (const double h : steps_) side.cells.push_back(march(side, h));
    side.forget_untouched(open.cells);
    // Below the range a scene would be cut short before anything happens in it.
    side.observed = observed_limit(
        steps_, side.cells, [&](double h) { return march(side, h); }, !side.closed);
    if (side.untouched)
      record_.notes.push_back(
          "closed: the scene touches no stop at any stable step, so contact is predicted and not observed; give it an "
          "initial "
          "state or a load that brings it there");
    if (spent())
      record_.notes.push_back(
          fmt::format("the budget of {:g} s was spent: some cells were not observed", budget_of(case_)));
  }

  // Status and reason of one row: the prediction, what was seen, and whether they agree. A scene is open now and then:
  // what grows there grows in it.
  static std::pair<StepStatus, std::string> verdict(const StabilitySide& open, const StabilitySide& side, std::size_t i,
                                                    bool observed) {
    std::optional<StepStatus> status;
    std::string reason;
    bool grows = false;
    if (const StepSpectrum* known = side.spectrum(i)) {
      const StepSpectrum* apart = side.closed ? open.spectrum(i) : nullptr;
      const bool grows_open = apart && !apart->stable();
      grows = !known->stable() || grows_open;
      status = grows ? StepStatus::unstable : known->marginal.empty() ? StepStatus::stable : StepStatus::marginal;
      if (!known->stable())
        append(reason, growth_text(*known, side.closed));
      else if (side.closed && !known->marginal.empty())
        append(reason, known->contact + " closed");
      if (grows_open) append(reason, "open, it " + growth_text(*apart, false));
    } else if (side.spectra[i]) {
      status = StepStatus::refused;
      append(reason, "not predicted: " + std::get<Refusal>(*side.spectra[i]).sentence.text);
    } else {
      append(reason, "not predicted: the budget was spent");
    }
    const auto& cell = observed ? side.cells[i] : std::optional<ObservedCell>();
    if (!cell) {
      if (observed && status != StepStatus::refused)
        append(reason, side.untouched ? untouched_text : "not observed: the budget was spent");
      return {status.value_or(StepStatus::failed), reason};
    }
    const StepStatus seen = cell->behaviour == Behaviour::failed ? StepStatus::failed
                            : cell->stable()                     ? StepStatus::stable
                                                                 : StepStatus::unstable;
    if (seen != StepStatus::stable) append(reason, "observed: " + cell->cause);
    if (side.spectrum(i) && grows != (seen != StepStatus::stable))
      append(reason, grows ? fmt::format("not observed in {} steps", cell->steps) : "the spectrum does not see it");
    if (cell->chatters())
      append(reason, fmt::format("chatter: {:.0f} % of the force's power is fast, {:.3g} changes of the active set per "
                                 "impact",
                                 100 * cell->fast_share, cell->changes_per_impact));
    if (seen != StepStatus::stable || status.value_or(StepStatus::refused) == StepStatus::refused) status = seen;
    return {*status, reason};
  }

  void tabulate(const std::vector<StabilitySide>& sides, bool observed) {
    std::vector<StabilityRow> rows;
    std::vector<ObservedRow> seen;
    std::vector<RootRow> roots;
    for (const StabilitySide& side : sides)
      for (std::size_t i = 0; i < steps_.size(); ++i) {
        const StepSpectrum* known = side.spectrum(i);
        if (known) add_roots(roots, side.closed, steps_[i], steps_.size(), *known);
        const auto [status, reason] = verdict(sides.front(), side, i, observed);
        rows.push_back({steps_[i], side.closed, known ? std::optional(known->radius) : std::nullopt,
                        known ? known->marginal : "", side.predicted.step, side.observed.step, status, reason});
        if (!observed || !side.cells[i]) continue;
        const ObservedCell& cell = *side.cells[i];
        const bool touched = cell.impacts > 0;
        ObservedRow& row = seen.emplace_back();
        row = {.step = steps_[i], .closed = side.closed, .behaviour = cell.behaviour};
        row.growth = cell.growth;
        if (side.closed) row.gain = cell.gain;
        if (side.closed) row.impacts = cell.impacts;
        if (touched) row.changes_per_impact = cell.changes_per_impact;
        if (touched) row.fast_share = cell.fast_share;
        row.chatter = cell.chatters();
        if (cell.first_bad_step >= 0) row.first_bad_step = cell.first_bad_step;
        row.steps = cell.steps;
        row.cause = cell.cause;
      }
    record_.tables.push_back(stability_type().with(rows));
    record_.tables.push_back(stability_roots_type().with(roots));
    if (observed) record_.tables.push_back(stability_observed_type().with(seen));
    for (const StabilitySide& side : sides) say_limits(sides, side, observed);
    if (observed) say_contradictions(sides.front());
  }

  void say_contradictions(const StabilitySide& open) {
    std::vector<double> where;
    for (std::size_t i = 0; i < steps_.size(); ++i)
      if (open.contradicts(i)) where.push_back(steps_[i]);
    if (where.empty()) return;
    record_.measures.emplace_back("contradictions", static_cast<double>(where.size()));
    record_.notes.push_back(fmt::format(
        "open: spectrum and march disagree without contact at {} of {} steps, first at h = {:g} s: an error of the "
        "method, not of the step",
        where.size(), steps_.size(), where.front()));
  }

  // The smaller of what is predicted for the contact state and, for scenes, for the open structure.
  static std::optional<double> expected(const std::vector<StabilitySide>& sides, const StabilitySide& side) {
    const auto &own = side.predicted.step, &open = sides.front().predicted.step;
    return own && open ? std::optional(std::min(*own, *open)) : own ? own : open;
  }

  void say_limits(const std::vector<StabilitySide>& sides, const StabilitySide& side, bool observed) {
    const auto say = [&](std::string sentence) { record_.notes.push_back(std::string(side.name()) + ": " + sentence); };
    if (const auto& limit = side.predicted.step)
      say(fmt::format(
          "stable up to h = {:.6g} s; beyond, {} grows{}", *limit,
          side.predicted.beyond ? side.predicted.beyond->mode : "a mode",
          side.closed && side.predicted.beyond ? " with " + side.predicted.beyond->contact + " closed" : ""));
    else if (side.predicted.beyond)
      say("no stable step is predicted");
    if (!observed) return;
    const auto limit = expected(sides, side);
    if (side.observed.step && limit)
      say(fmt::format("observed up to h = {:.4g} s, {:.4g} times the prediction", *side.observed.step,
                      *side.observed.step / *limit));
    else if (side.observed.step)
      say(fmt::format("observed up to h = {:.4g} s, where the spectrum sees no limit", *side.observed.step));
    else if (side.never_stable())
      say("unstable at every step marched");
    else if (side.observed.below_range)
      say("unstable already at the smallest step of the range");
    else if (limit && *limit < steps_.back() && !side.predicted.below_range)
      say("no limit was observed");
    if (side.observed.returns) say("beyond the observed limit some steps are stable again");
  }

  void measure(const std::vector<StabilitySide>& sides) {
    const double none = std::numeric_limits<double>::infinity();
    double predicted = none, observed = none, radius = -1, agreement = none;
    for (const StabilitySide& side : sides) {
      predicted = std::min(predicted, side.predicted.step.value_or(none));
      for (std::size_t i = 0; i < steps_.size(); ++i)
        if (const StepSpectrum* known = side.spectrum(i)) radius = std::max(radius, known->radius);
      const auto limit = expected(sides, side);
      if (limit && side.observed.step && !std::isfinite(agreement)) agreement = *side.observed.step / *limit;
    }
    // An open limit is that of the scene unless contact is predicted to lower it.
    const double open = sides.front().predicted.step.value_or(none);
    const bool unseen =
        sides.back().untouched && (predicted < (1 - limit_tolerance) * open || sides.back().predicted.below_range);
    double half = 0;
    for (const StabilitySide& side : sides)
      if (!unseen && side.observed.step.value_or(none) < observed)
        observed = *side.observed.step, half = side.observed.half;
    put_limit("limit_predicted", predicted, sides, false);
    put_limit("limit_observed", observed, sides, true);
    if (std::isfinite(observed)) put_measure(record_, "limit_resolution", half);
    if (radius >= 0) put_measure(record_, "largest_radius", radius);
    put_measure(record_, "agreement", agreement);
  }

  // Or why there is none.
  void put_limit(const char* name, double limit, const std::vector<StabilitySide>& sides, bool marched) {
    put_measure(record_, name, limit);
    if (std::isfinite(limit)) return;
    if (marched && sides.back().untouched) {
      record_.left_out.emplace_back(name, untouched_text);
      return;
    }
    if (std::all_of(sides.begin(), sides.end(), [&](const StabilitySide& side) {
          return marched ? side.marched_stably() : side.predicted_stable();
        })) {
      record_.left_out.emplace_back(name, "every step of the range is stable");
      put_measure(record_, std::string("least.") + name, *std::max_element(steps_.begin(), steps_.end()));
    } else if (marched &&
               std::any_of(sides.begin(), sides.end(), [](const StabilitySide& side) { return side.never_stable(); }))
      record_.left_out.emplace_back(name, "no step of the range is stable");
  }

  void compare_declared(const StabilitySide& open) {
    const StepLimit& limit = open.predicted;
    const bool unstable = limit.below_range || open.observed.below_range || open.never_stable();
    const double growing = limit.beyond ? limit.beyond->pulsation : 0;
    const auto seen = open.observed.step ? open.observed.step : limit.step;
    if (some_plan_ && !spent())
      compare_with_declared(some_plan_->first, *problem_, {seen, growing, steps_.back(), unstable}, record_);
  }

  void say_restitution() {
    if (!some_plan_) return;
    const auto& [step, h] = *some_plan_;
    const auto range = restitution_range(step, h);
    if (!range) return;
    record_.tables.push_back(
        restitution_type().with({{"", h, range->least, range->mean, range->most, root_at_infinity(step)}}));
  }

  const StudyCase& case_;
  const Registry& registry_;
  const std::atomic<bool>& stop_;
  std::vector<double> steps_;
  CaseRecord record_;
  std::shared_ptr<const SemiDiscrete> problem_;
  std::unique_ptr<TimeScheme> scheme_;
  ProblemFacts facts_;
  std::optional<std::pair<StepPlan, double>> some_plan_;  // and its step: what is read of it depends on no length
  std::optional<StabilityPredictor> predictor_;
  bool touches_ = false;
  double duration_ = 0, begin_ = 0;
};

}  // namespace

CaseRecord run_stability(const StudyCase& study_case, const Registry& registry, const std::atomic<bool>& stop) {
  return StabilityRun(study_case, registry, stop).run();
}

}  // namespace ricochet
