#include "runners/kinds/continuation/run_continuation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/measure/orbits/shoot.hpp>

#include "runners/kinds/continuation/branch_tables.hpp"
#include "runners/kinds/continuation/continuation_study.hpp"
#include "runners/kinds/continuation/continued_map.hpp"
#include "runners/march/seconds.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

// Folds below this share of the parameter's scale are not listed where the study names no prominence.
constexpr double least_fold = 1e-4;
// Of the gap: an orbit this near to its own image is solved as one.
constexpr double image_tolerance = 1e-6;
// Pieces between two looks at the clock.
constexpr long long breath = 64;

class ContinuationRun {
 public:
  ContinuationRun(const StudyCase& study_case, const Registry& registry, const std::atomic<bool>& stop)
      : case_(study_case),
        stop_(stop),
        plan_(continuation_plan(study_case.settings)),
        continued_(study_case, registry, plan_) {}

  CaseRecord run() {
    const double begun = thread_seconds();
    record_.id = case_.id;
    record_.axes = case_.axes;
    if (!continued_.refusal().empty()) return refused(continued_.refusal());
    describe_march(record_, continued_.scenes(), case_);
    if (!continued_.no_pieces().empty()) return refused(continued_.no_pieces());
    map_ = continued_.map();
    record_.setup_seconds = thread_seconds() - begun;
    for (const WantedOrbit& orbit : plan_.orbits) follow(orbit);
    finish();
    record_.run_seconds = thread_seconds() - begun - record_.setup_seconds;
    return std::move(record_);
  }

 private:
  CaseRecord refused(std::string reason) {
    record_.status = "refused";
    record_.reason = std::move(reason);
    return std::move(record_);
  }

  // An orbit that was not found is a row that says so.
  void missing(const WantedOrbit& orbit, std::string why) {
    SpecialRow row;
    row.branch = orbit.name;
    row.point = 1;
    row.kind = "end";
    row.label = "EP";
    row.parameter = orbit.at;
    row.note = std::move(why);
    special_.push_back(std::move(row));
  }

  void follow(const WantedOrbit& orbit) {
    std::string reason;
    const int scene = continued_.scene_at(orbit.at, orbit.from == OrbitSource::state, reason);
    if (scene < 0) return missing(orbit, reason);
    if (orbit.symmetric == HalfMap::yes && !continued_.no_image().empty()) return missing(orbit, continued_.no_image());
    MapClock clock{case_.steps_per_period, orbit.period, orbit.symmetric == HalfMap::yes};
    Eigen::VectorXd x;
    if (orbit.from == OrbitSource::free) {
      const auto found = free_orbit(*map_, orbit.at, clock);
      if (!found) return missing(orbit, "the motion without contact is in resonance");
      x = *found;
    } else {
      LaneEnd end;
      const auto state = settle(continued_.program(scene), case_.steps_per_period, std::max(1, orbit.periods), end);
      if (!state) return missing(orbit, fmt::format("the transient stopped: {}", text(end)));
      x = map_->vector().read(*state);
    }
    ShotOrbit shot = solve(x, orbit.at, clock);
    if (orbit.symmetric == HalfMap::automatic && shot.found) use_image(shot, clock);
    if (!shot.found) return missing(orbit, not_found(orbit, shot));
    FollowedBranch first{orbit.name, clock, {}, {}, shot.iterations, {}};
    if (plan_.follow == Follow::none) {
      add_orbit(first, shot);
      return;
    }
    for (const int way : {1, -1}) {
      if (way < 0 && !plan_.both_ways) break;
      FollowedBranch branch = first;
      branch.name += way > 0 ? "+" : "-";
      run_branch(branch, shot, way);
    }
  }

  ShotOrbit solve(const Eigen::VectorXd& x, double parameter, const MapClock& clock) {
    round_off_ = std::max(round_off_, round_off_of_map(*map_, x, parameter, clock));
    return shoot(*map_, x, parameter, clock, round_offs * round_off_);
  }

  // Solves an orbit that is its own image by half its period.
  void use_image(ShotOrbit& shot, MapClock& clock) {
    if (!continued_.no_image().empty() || clock.period % 2 == 0) return;
    MapClock half = clock;
    half.half = true;
    const MapMarch made = map_->march(shot.x, shot.parameter, half);
    if (made.end || map_->metric().size(made.image - shot.x) > image_tolerance * continued_.gap()) return;
    ShotOrbit image = solve(shot.x, shot.parameter, half);
    if (!image.found) return;
    image.iterations += shot.iterations;
    shot = std::move(image);
    clock = half;
  }

  std::string not_found(const WantedOrbit& orbit, const ShotOrbit& shot) const {
    const char* from = orbit.from == OrbitSource::state ? "the scene's state" : "rest";
    std::string why = fmt::format(
        "no orbit of period {} within {} iterations from {} at {:g}; nearest return {:.3g} m "
        "after {} periods",
        orbit.period, shot.iterations, from, orbit.at, shot.nearest, orbit.periods);
    if (shot.end) why += "; " + text(shot.end);
    if (shot.step >= 0)
      why += fmt::format("; residuals alternate between two contact sets (step {} of {}, point {})", shot.step + 1,
                         case_.steps_per_period, map_->sets().place(shot.row).point + 1);
    return why;
  }

  void add_orbit(FollowedBranch& branch, const ShotOrbit& shot) {
    BranchRow row = orbit_row(*map_, branch.clock, shot.x, shot.parameter);
    const auto all = multipliers_of(map_->derivative(shot.sets, branch.clock));
    const Outside count = outside(all);
    row.branch = branch.name;
    row.arc = 0;
    row.stable = count.total == 0;
    row.unstable = count.total;
    row.multipliers.assign(all.begin(), all.end());
    row.multipliers.resize(static_cast<std::size_t>(plan_.multipliers));
    row.iterations = shot.iterations;
    row.pieces = 0;
    rows_.push_back(std::move(row));
  }

  void run_branch(FollowedBranch& branch, const ShotOrbit& shot, int way) {
    BranchLimits limits{plan_.from, plan_.to, plan_.most_pieces, plan_.longest, plan_.marks, plan_.multipliers};
    // Newton's method leaves more than the round-off of one period where multipliers are near 1.
    const double drift = std::max(100 * round_off_, 1e-15);
    BranchRun run(*map_, branch.clock,
                  PieceFollower(*map_, branch.clock, shot.x, shot.parameter, shot.sets, way, drift), limits);
    while (run.advance(breath)) {
      if (stop_) throw Interrupted{};
      if (thread_seconds() - begun_ > budget_of(case_)) over_budget_ = true;
      if (over_budget_) break;
    }
    branch.trace = run.trace();
    if (over_budget_) branch.trace.end = fmt::format("the budget of {:g} s was spent", budget_of(case_));
    pieces_ += run.state().pieces;
    branch.points = special_points(
        branch.trace, {branch.clock.half, plan_.prominence.value_or(least_fold * continued_.parameter_scale())});
    add_branch(branch);
  }

  void add_branch(const FollowedBranch& branch) {
    for (BranchRow& row : rows_of(*map_, branch, plan_.multipliers)) rows_.push_back(std::move(row));
    for (SpecialRow& row : special_rows_of(*map_, branch)) {
      found_ += row.kind != "end";
      special_.push_back(std::move(row));
    }
    for (TurnRow& row : turn_rows_of(branch, continued_.parameter_scale())) turns_.push_back(std::move(row));
    ++branches_;
  }

  void finish() {
    record_.tables.push_back(branches_table(plan_.multipliers, rows_));
    record_.tables.push_back(special_points_type().with(special_));
    record_.tables.push_back(turns_type().with(turns_));
    put_measure(record_, "branches", branches_);
    put_measure(record_, "pieces", static_cast<double>(pieces_));
    put_measure(record_, "special_points", found_);
    record_.steps = pieces_ * case_.steps_per_period;
    record_.status = "done";
    if (over_budget_) {
      record_.status = "failed";
      record_.reason = fmt::format("the budget of {:g} s was spent", budget_of(case_));
    }
  }

  const StudyCase& case_;
  const std::atomic<bool>& stop_;
  ContinuationPlan plan_;
  ContinuedMap continued_;
  std::unique_ptr<PeriodicMap> map_;
  CaseRecord record_;
  double round_off_ = 0, begun_ = thread_seconds();
  std::vector<BranchRow> rows_;
  std::vector<SpecialRow> special_;
  std::vector<TurnRow> turns_;
  int branches_ = 0, found_ = 0;
  long long pieces_ = 0;
  bool over_budget_ = false;
};

}  // namespace

CasePlan plan_continuation(const StudyCase& study_case, const Registry& registry) {
  CasePlan out;
  const ContinuationPlan plan = continuation_plan(study_case.settings);
  ContinuedMap continued(study_case, registry, plan);
  out.refusal = continued.refusal().empty() ? continued.no_pieces() : continued.refusal();
  if (!out.refusal.empty()) return out;
  describe_march(out, continued.scenes(), study_case);
  const double steps = study_case.steps_per_period, branches = static_cast<double>(plan.orbits.size());
  double transient = 0;
  for (const WantedOrbit& orbit : plan.orbits) transient += orbit.periods * steps;
  out.steps = static_cast<long long>(transient);
  out.predicted_seconds = transient * continued.scenes().predicted_step_seconds(0, 1);
  widen_steps(out, study_case);
  if (plan.follow == Follow::none) return out;
  // Measured on the shaken tube: as many pieces as steps per period both ways. A piece marches two columns over half a
  // period and takes two spectra.
  const auto unknowns =
      static_cast<double>(continued.scenes().plan(0).slots.size()) * continued.scenes().problem(0).dofs();
  const double pieces = branches * steps * (plan.both_ways ? 2 : 1);
  out.predicted_seconds += pieces * (1.5e-10 * steps * unknowns * unknowns + 1.2e-8 * unknowns * unknowns * unknowns);
  out.steps += static_cast<long long>(pieces * steps);
  out.bytes = branches * 2 * 2000 * 200;
  return out;
}

CaseRecord run_continuation(const StudyCase& study_case, const Registry& registry, const CaseContext&,
                            const std::atomic<bool>& stop) {
  return ContinuationRun(study_case, registry, stop).run();
}

}  // namespace ricochet
