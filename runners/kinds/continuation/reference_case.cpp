#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <ricochet/measure/orbits/special_points.hpp>
#include <ricochet/measure/orbits/stepped_map.hpp>

#include "runners/kinds/comparison/references.hpp"
#include "runners/kinds/continuation/branch_tables.hpp"
#include "runners/kinds/continuation/continuation.hpp"
#include "runners/kinds/continuation/continuation_study.hpp"
#include "runners/kinds/continuation/continued_map.hpp"
#include "runners/kinds/continuation/first_orbit.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/march/seconds.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/store/record_values.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/study/fields.hpp"

namespace ricochet {
namespace {

// Steps between two looks for a point at which a branch stops.
constexpr std::size_t look_every = 16;
// Of the gap: to which residuals an orbit is solved.
constexpr double solved = 1e-11;

class ReferenceRun {
 public:
  ReferenceRun(const StudyCase& study_case, const Registry& registry)
      : case_(study_case),
        registry_(registry),
        plan_(continuation_plan(study_case.settings)),
        solver_(registry.reference(case_.references.front().name)->make(case_.references.front().parameters)) {
    const ReferenceProblem problem = problem_at(plan_.orbits.front().at, false);
    const auto place = [](const ReferenceProblem& of, const std::function<double(double)>& stop) {
      return stop ? stop(of.length) : HUGE_VAL;
    };
    const double lower = place(problem, problem.lower), upper = place(problem, problem.upper);
    const bool both = std::isfinite(lower) && std::isfinite(upper);
    gap_ = both ? 0.5 * std::abs(upper - lower) : std::min(std::abs(lower), std::abs(upper));
    if (!std::isfinite(gap_) || gap_ <= 0)
      gap_ = problem.support_amplitude != 0 ? std::abs(problem.support_amplitude) : 1;
    const double largest = std::max(std::abs(plan_.from), std::abs(plan_.to));
    metres_ = is_length(plan_.pointer) || largest == 0 ? 1 : gap_ / largest;
    for (const double value : {plan_.from, plan_.to, plan_.orbits.front().at}) {
      const ReferenceProblem one = problem_at(value, false);
      if (!one.load_zero || std::abs(place(one, one.lower) + place(one, one.upper)) > solved * gap_)
        no_image_ = "the scene is not its own image: stops of other distances, or a load";
    }
  }

  int size() { return orbits_at(plan_.orbits.front()).size(); }

  CaseRecord run(const std::atomic<bool>& stop) {
    stop_ = &stop;
    record_.id = case_.id;
    record_.axes = case_.axes;
    record_.notes.push_back(fmt::format("the reference {}", content_of(case_.references.front()).dump()));
    if (!plan_.marks.empty()) record_.notes.push_back("steps of arclength do not solve the values of mark");
    for (const WantedOrbit& orbit : plan_.orbits) try {
        follow(orbit);
      } catch (const Refusal& refusal) {
        results_.add_missing(orbit.name, orbit.at, refusal.sentence.text);
      }
    results_.put(record_, plan_, steps_, over_budget_ ? std::optional(budget_of(case_)) : std::nullopt);
    record_.run_seconds = thread_seconds() - begun_;
    return std::move(record_);
  }

 private:
  ReferenceProblem problem_at(double value, bool own_state) const {
    const StudyCase at = with_parameter(own_state ? case_ : at_rest(case_), plan_.pointer, value);
    auto problem = seen_by_reference(at, registry_, solver_->of_the_mesh());
    if (auto* refusal = std::get_if<Refusal>(&problem)) throw std::move(*refusal);
    return std::get<ReferenceProblem>(std::move(problem));
  }

  // The map of the scene that an orbit begins in, with its stops or without.
  ReferenceOrbits orbits_at(const WantedOrbit& orbit, bool open = false) const {
    const bool own = orbit.from == OrbitSource::state;
    return {[this, own, open](double at) {
              ReferenceProblem problem = problem_at(at, own);
              problem.contact_absent = problem.contact_absent || open;
              auto made = solver_->map(problem);
              if (auto* refusal = std::get_if<Refusal>(&made)) throw std::move(*refusal);
              return ReferenceOrbits::Scene{std::get<std::unique_ptr<ReferenceMap>>(std::move(made)),
                                            2 * std::numbers::pi / problem.support_pulsation};
            },
            orbit.at, metres_};
  }

  void follow(const WantedOrbit& orbit) {
    ReferenceOrbits map = orbits_at(orbit);
    const auto tolerance = [&](const Eigen::VectorXd&, const MapClock&) { return solved * gap_; };
    const auto state = [&](int periods, const MapClock& clock) -> Eigen::VectorXd {
      if (orbit.from == OrbitSource::stored)
        throw Refusal{"a stored orbit is a state of a method; expected rest, state or free of a reference"};
      if (orbit.from != OrbitSource::free) return map.settle(orbit.at, periods);
      ReferenceOrbits open = orbits_at(orbit, true);
      return shoot(open, Eigen::VectorXd::Zero(map.size()), orbit.at, clock, solved * gap_).x;
    };
    const auto [shot, clock, why] = first_orbit(map, {0, gap_, no_image_, state, tolerance}, orbit);
    if (!why.empty()) return results_.add_missing(orbit.name, orbit.at, why);
    std::array<FollowedBranch, 2> ways;
    std::size_t followed = 0;
    for (const int way : {1, -1}) {
      if (way < 0 && (!plan_.both_ways || plan_.follow == Follow::none)) break;
      FollowedBranch& branch = ways[followed];
      branch = {orbit.name, clock, {}, {}, shot.iterations, {}};
      if (plan_.follow != Follow::none) branch.name += way > 0 ? "+" : "-";
      if (way < 0) branch.other = ways.data();
      follow_branch(map, branch, shot, way);
      ++followed;
    }
    if (followed > 1) ways[0].other = &ways[1];
    for (std::size_t i = 0; i < followed; ++i) tell(map, ways[i]);
  }

  PointSearch search(const FollowedBranch& branch) const {
    constexpr double contacts = 1e-9;  // of the range
    PointSearch search;
    search.half = branch.clock.half;
    search.prominence = plan_.prominence.value_or(least_fold * gap_ / metres_);
    search.by_steps = true;
    search.gap = gap_;
    search.contacts = contacts * plan_.range();
    search.metres = metres_;
    search.before = branch.before();
    return search;
  }

  // The first point of a kind at which branches stop.
  std::optional<SpecialPoint> stopping(const FollowedBranch& branch, const BranchTrace& trace) const {
    if (plan_.stop_at.empty()) return std::nullopt;
    return first_of(special_points(trace, search(branch)), plan_.stop_at);
  }

  void follow_branch(ReferenceOrbits& map, FollowedBranch& branch, const ShotOrbit& shot, int way) {
    ArcSteps limits;
    limits.branch = {plan_.from, plan_.to, plan_.most_pieces, plan_.longest_arc(gap_, metres_), {}, plan_.multipliers};
    limits.tolerance = solved * gap_;
    constexpr double located = 2.5e-5;
    limits.located = located;
    limits.smooth = true;
    StepFollower follower(map, branch.clock, shot.x, shot.parameter, way, limits);
    std::string failure;
    try {
      while (plan_.follow != Follow::none && follower.advance(1)) {
        if (*stop_) throw Interrupted{};
        if (thread_seconds() - begun_ > budget_of(case_)) over_budget_ = true;
        if (over_budget_ || (follower.trace().corners.size() % look_every == 0 && stopping(branch, follower.trace())))
          break;
      }
    } catch (const Refusal& refusal) {  // no state where the branch would go on
      failure = refusal.sentence.text;
    }
    branch.trace = follower.trace();
    if (!failure.empty()) branch.trace.end_by(TraceEnd::left, failure);
    if (over_budget_)
      branch.trace.end_by(TraceEnd::limit, fmt::format("the budget of {:g} s was spent", budget_of(case_)));
    if (const auto point = stopping(branch, branch.trace)) cut_at(branch.trace, *point);
    steps_ += static_cast<long long>(branch.trace.corners.size());
  }

  void tell(ReferenceOrbits& map, FollowedBranch& branch) {
    branch.points = special_points(branch.trace, search(branch));
    std::vector<BranchRow> rows = corner_rows_of(branch, plan_.multipliers);
    for (BranchRow& row : rows) {
      row.tip_velocity = map.tip(branch.trace.states.at(row.row), *row.parameter).second;
      row.penetration = 0;
    }
    results_.add(branch, std::move(rows), {}, gap_ / metres_);
  }

  const StudyCase& case_;
  const Registry& registry_;
  ContinuationPlan plan_;
  std::unique_ptr<ReferenceSolver> solver_;
  const std::atomic<bool>* stop_ = nullptr;
  double gap_ = 1, metres_ = 1, begun_ = thread_seconds();
  std::string no_image_;  // why orbits are not their own images; "" where they may be
  bool over_budget_ = false;
  CaseRecord record_;
  BranchResults results_;
  long long steps_ = 0;
};

// Axes of the scene: no role, no mesh, no step.
bool of_scene(const std::string& column) {
  static const std::vector<std::string> others = {"mass",  "contact",     "time", "elements",
                                                  "modes", residual_axis, "step", "steps_per_period"};
  return std::find(others.begin(), others.end(), axis_role(column)) == others.end();
}

}  // namespace

void add_reference_cases(const std::vector<MethodChoice>& references, Study& study) {
  if (references.empty() || study.cases.empty()) return;
  const auto pointer = study.cases.front().settings.at("parameter").at("pointer").get<std::string>();
  if (!pointer.starts_with("/scene/"))
    throw InputError("/reference", "a reference has no " + pointer + "; expected a parameter of the scene");
  std::vector<StudyCase> added;
  for (std::size_t r = 0; r < references.size(); ++r) {
    if (references[r].name == marched_reference)
      throw InputError(pointer_to("/reference", r),
                       "it marches the methods themselves and has no orbits of its own; expected a reference that is "
                       "exact between events");
    std::vector<std::vector<std::pair<std::string, Json>>> scenes;
    for (const StudyCase& one : study.cases) {
      std::vector<std::pair<std::string, Json>> axes;
      std::copy_if(one.axes.begin(), one.axes.end(), std::back_inserter(axes),
                   [](const auto& axis) { return of_scene(axis.first); });
      if (std::find(scenes.begin(), scenes.end(), axes) != scenes.end()) continue;
      scenes.push_back(axes);
      StudyCase& of_reference = added.emplace_back(one);
      of_reference.id = reference_id + (added.size() > 1 ? fmt::format("-{}", added.size()) : "");
      of_reference.axes = std::move(axes);
      of_reference.references = {references[r]};
      of_reference.of_reference = true;
      of_reference.excluded.reset();
      of_reference.settings["reference"] = content_of(references[r]);
    }
  }
  std::move(added.begin(), added.end(), std::back_inserter(study.cases));
}

CasePlan plan_reference(const StudyCase& study_case, const Registry& registry) {
  CasePlan out;
  const ContinuationPlan plan = continuation_plan(study_case.settings);
  try {
    // Measured on the shaken tube with stops at its tip.
    constexpr double seconds_per_number = 0.15;
    const double branches = static_cast<double>(plan.orbits.size()) * (plan.both_ways ? 2 : 1);
    out.predicted_seconds = seconds_per_number * ReferenceRun(study_case, registry).size() * branches;
  } catch (const Refusal& refusal) {
    out.refusal = refusal.sentence.text;
  }
  return out;
}

CaseRecord run_reference(const StudyCase& study_case, const Registry& registry, const std::atomic<bool>& stop) {
  try {
    ReferenceRun run(study_case, registry);
    run.size();  // refuses a reference without states before any orbit
    return run.run(stop);
  } catch (const Refusal& refusal) {
    CaseRecord record;
    record.id = study_case.id;
    record.axes = study_case.axes;
    record.status = Status::refused;
    record.reasons = {refusal.sentence};
    return record;
  }
}

}  // namespace ricochet
