#include "runners/kinds/continuation/run_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/measure/orbits/special_points.hpp>
#include <ricochet/measure/orbits/stepped_map.hpp>

#include "runners/kinds/continuation/branch_tables.hpp"
#include "runners/march/seconds.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

class StepsRun {
 public:
  StepsRun(ContinuedMap& continued, const StudyCase& study_case, const ContinuationPlan& plan,
           const std::atomic<bool>& stop, CaseRecord& record)
      : continued_(continued), case_(study_case), plan_(plan), stop_(stop), record_(record) {}

  void run() {
    for (const WantedOrbit& orbit : plan_.orbits) follow(orbit);
    if (rebounds_ > 0)
      record_.notes.push_back(
          fmt::format("stops give back speed: orbits are known to {:.3g} m, what a step places "
                      "their impacts to",
                      rebounds_));
    results_.put(record_, plan_, steps_, over_budget_ ? std::optional(budget_of(case_)) : std::nullopt);
  }

 private:
  void missing(const WantedOrbit& orbit, std::string why) {
    results_.add_missing(orbit.name, orbit.at, std::move(why));
  }

  void follow(const WantedOrbit& orbit) {
    std::string reason;
    const int scene = continued_.scene_at(orbit.at, orbit.from == OrbitSource::state, reason);
    if (scene < 0) return missing(orbit, reason);
    if (orbit.symmetric == HalfMap::yes && !continued_.no_image().empty()) return missing(orbit, continued_.no_image());
    if (orbit.from == OrbitSource::stored || orbit.from == OrbitSource::free)
      return missing(orbit, "steps begin from rest or from the scene's own state");
    SteppedMap map = continued_.stepped_map(orbit.at);
    LaneEnd end;
    const auto state = settle(continued_.program(scene), case_.steps_per_period, std::max(1, orbit.periods), end);
    if (!state) return missing(orbit, fmt::format("the transient stopped: {}", text(end)));
    const Eigen::VectorXd x = map.read(*state, continued_.scenes()[scene].group);
    MapClock clock{case_.steps_per_period, orbit.period, orbit.symmetric == HalfMap::yes};
    const double tolerance = round_offs * round_off_of_map(map, x, orbit.at, clock);
    ShotOrbit shot = shoot(map, x, orbit.at, clock, tolerance);
    if (orbit.symmetric == HalfMap::automatic && shot.found && continued_.no_image().empty() && clock.period % 2 != 0) {
      MapClock half = clock;
      half.half = true;
      const auto made = map.march(shot.x, orbit.at, half);
      if (!made.end && map.metric().size(made.image - shot.x) <= std::max(1e-6 * continued_.gap(), made.rebounds))
        if (ShotOrbit image = shoot(map, shot.x, orbit.at, half, tolerance); image.found) {
          shot = std::move(image);
          clock = half;
        }
    }
    if (!shot.found) {
      std::string why = fmt::format(
          "no orbit of period {} within {} iterations at {:g}; nearest return {:.3g} m after "
          "{} periods",
          orbit.period, shot.iterations, orbit.at, shot.nearest, orbit.periods);
      return missing(orbit, std::move(why));
    }
    ArcSteps limits;
    limits.branch = {plan_.from, plan_.to, plan_.most_pieces, plan_.longest, {}, plan_.multipliers};
    limits.tolerance = tolerance;
    if (plan_.follow == Follow::none) limits.branch.pieces = 0;
    for (const int way : {1, -1}) {
      if (way < 0 && (!plan_.both_ways || plan_.follow == Follow::none)) break;
      FollowedBranch branch{orbit.name, clock, {}, {}, shot.iterations, {}};
      if (plan_.follow != Follow::none) branch.name += way > 0 ? "+" : "-";
      run_branch(map, branch, shot, way, limits);
    }
  }

  void run_branch(SteppedMap& map, FollowedBranch& branch, const ShotOrbit& shot, int way, const ArcSteps& limits) {
    StepFollower follower(map, branch.clock, shot.x, shot.parameter, way, limits);
    while (limits.branch.pieces > 0 && follower.advance(1)) {
      if (stop_) throw Interrupted{};
      if (thread_seconds() - begun_ > budget_of(case_)) over_budget_ = true;
      if (over_budget_) break;
    }
    branch.trace = follower.trace();
    if (over_budget_) branch.trace.end = fmt::format("the budget of {:g} s was spent", budget_of(case_));
    rebounds_ = std::max(rebounds_, follower.rebounds());
    PointSearch search;
    search.half = branch.clock.half;
    search.prominence = plan_.prominence.value_or(least_fold * continued_.parameter_scale());
    search.by_steps = true;
    search.placed = follower.rebounds();
    branch.points = special_points(branch.trace, search);
    steps_ += static_cast<long long>(branch.trace.corners.size());
    record_.steps += static_cast<long long>(branch.trace.corners.size()) * case_.steps_per_period;
    std::vector<BranchRow> rows = corner_rows_of(branch, plan_.multipliers);
    for (BranchRow& row : rows) {
      const Eigen::VectorXd& x = branch.trace.states.at(row.row);
      const auto made = map.march(x, *row.parameter, branch.clock);
      if (!made.end) {
        row.tip_velocity = made.tip_velocity;
        row.penetration = made.penetration;
      }
    }
    results_.keep_orbits(branch, rows, marches_of(map), all_branch_states);
    results_.add(branch, std::move(rows), {}, continued_.parameter_scale());
  }

  ContinuedMap& continued_;
  const StudyCase& case_;
  const ContinuationPlan& plan_;
  const std::atomic<bool>& stop_;
  CaseRecord& record_;
  BranchResults results_;
  double begun_ = thread_seconds(), rebounds_ = 0;
  long long steps_ = 0;
  bool over_budget_ = false;
};

}  // namespace

void run_by_steps(ContinuedMap& continued, const StudyCase& study_case, const ContinuationPlan& plan,
                  const std::atomic<bool>& stop, CaseRecord& record) {
  StepsRun(continued, study_case, plan, stop, record).run();
}

}  // namespace ricochet
