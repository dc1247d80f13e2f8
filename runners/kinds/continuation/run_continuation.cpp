#include "runners/kinds/continuation/run_continuation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <ricochet/measure/orbits/shoot.hpp>
#include <ricochet/measure/orbits/switch_branch.hpp>

#include "runners/kinds/continuation/branch_checkpoints.hpp"
#include "runners/kinds/continuation/branch_tables.hpp"
#include "runners/kinds/continuation/continuation_study.hpp"
#include "runners/kinds/continuation/continued_map.hpp"
#include "runners/kinds/continuation/first_orbit.hpp"
#include "runners/kinds/continuation/reference_case.hpp"
#include "runners/kinds/continuation/run_steps.hpp"
#include "runners/march/seconds.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

// Pieces between two readings of the clock.
constexpr long long breath = 64;

class ContinuationRun {
 public:
  ContinuationRun(const StudyCase& study_case, const Registry& registry, const CaseContext& context,
                  const std::atomic<bool>& stop)
      : case_(study_case),
        stop_(stop),
        checkpoints_(context.checkpoints, context.key),
        plan_(continuation_plan(study_case.settings)),
        continued_(study_case, registry, plan_) {}

  CaseRecord run() {
    const double begun = thread_seconds();
    record_.id = case_.id;
    record_.axes = case_.axes;
    if (!continued_.refusal().empty()) return refused(continued_.refusal());
    describe_march(record_, continued_.scenes(), case_);
    if (!continued_.no_pieces().empty() || plan_.follow == Follow::steps) {
      if (!continued_.no_pieces().empty()) record_.notes.push_back("followed by steps: " + continued_.no_pieces());
      run_by_steps(continued_, case_, plan_, stop_, record_);
      record_.run_seconds = thread_seconds() - begun;
      return std::move(record_);
    }
    map_ = continued_.map();
    record_.setup_seconds = thread_seconds() - begun;
    for (const WantedOrbit& orbit : plan_.orbits) follow(orbit);
    finish();
    checkpoints_.forget();
    record_.run_seconds = thread_seconds() - begun - record_.setup_seconds;
    return std::move(record_);
  }

 private:
  CaseRecord refused(std::string reason) {
    record_.status = "refused";
    record_.reason = std::move(reason);
    return std::move(record_);
  }

  void follow(const WantedOrbit& orbit) {
    const FirstOrbit found = first_orbit(continued_, *map_, case_.steps_per_period, orbit, round_off_);
    if (!found.why.empty()) return results_.add_missing(orbit.name, orbit.at, found.why);
    const ShotOrbit& shot = found.shot;
    FollowedBranch first{orbit.name, found.clock, {}, {}, shot.iterations, {}};
    if (plan_.follow == Follow::none) {
      add_orbit(first, shot);
      return;
    }
    for (const int way : {1, -1}) {
      if (way < 0 && !plan_.both_ways) break;
      FollowedBranch branch = first;
      branch.name += way > 0 ? "+" : "-";
      run_branch(branch, shot, way, 0);
    }
  }

  void add_orbit(FollowedBranch& branch, const ShotOrbit& shot) {
    BranchRow row = orbit_row(*map_, branch.clock, shot.x, shot.parameter);
    const auto all = multipliers_of(map_->derivative(shot.sets, branch.clock));
    row.branch = branch.name;
    row.arc = 0;
    put_multipliers(all, outside(all), plan_.multipliers, row);
    row.iterations = shot.iterations;
    row.pieces = 0;
    results_.add(std::move(row));
  }

  BranchRun begin(const FollowedBranch& branch, const ShotOrbit& shot, int way) {
    BranchLimits limits{plan_.from, plan_.to, plan_.most_pieces, plan_.longest, plan_.marks, plan_.multipliers};
    limits.ends_at_image = !branch.clock.half && branch.clock.period % 2 != 0 && continued_.no_image().empty() &&
                           !is_image(map_->sets(), shot.sets);
    // A residual that several steps of Newton's method leave.
    const double drift = std::max(100 * round_off_, 1e-15);
    if (const auto kept = checkpoints_.find(branch.name, map_->sets()))
      return {*map_,  branch.clock, PieceFollower(*map_, branch.clock, kept->entry, drift),
              limits, kept->trace,  kept->first};
    return {*map_, branch.clock,
            PieceFollower(*map_, branch.clock, branch_start(shot.x, shot.parameter, shot.sets, way), drift), limits};
  }

  PointSearch search(const FollowedBranch& branch) const {
    return {branch.clock.half, plan_.prominence.value_or(least_fold * continued_.parameter_scale())};
  }

  // The first point of a kind at which branches stop, once nothing that follows can change it.
  std::optional<SpecialPoint> stopping_point(const FollowedBranch& branch, const BranchTrace& trace) const {
    if (plan_.stop_at.empty()) return std::nullopt;
    for (SpecialPoint& point : special_points(trace, search(branch))) {
      if (point.kind == "end" ||
          std::find(plan_.stop_at.begin(), plan_.stop_at.end(), point.kind) == plan_.stop_at.end())
        continue;
      const auto last = static_cast<long long>(trace.corners.size()) - 1;
      const bool settled = trace.ended() || (last - point.corner > 2 * group_pieces &&
                                             trace.corners.back().arc - point.arc > 2 * group_arc);
      return settled ? std::optional(std::move(point)) : std::nullopt;
    }
    return std::nullopt;
  }

  void run_branch(FollowedBranch& branch, const ShotOrbit& shot, int way, int depth) {
    BranchRun run = begin(branch, shot, way);
    std::optional<SpecialPoint> stopping;
    bool more = !run.trace().ended();
    for (long long round = 0; more; ++round) {
      more = run.advance(breath);
      checkpoints_.keep_sometimes(branch.name, run, map_->sets());
      if (stop_) {
        checkpoints_.keep(branch.name, run, map_->sets());
        throw Interrupted{};
      }
      if (thread_seconds() - begun_ > budget_of(case_)) over_budget_ = true;
      if (over_budget_) break;
      if (round % 8 == 7) stopping = stopping_point(branch, run.trace());
      if (stopping) break;
    }
    branch.trace = run.trace();
    if (!stopping && !over_budget_) stopping = stopping_point(branch, branch.trace);
    if (stopping) cut_at(branch.trace, *stopping);
    if (over_budget_) branch.trace.end = fmt::format("the budget of {:g} s was spent", budget_of(case_));
    checkpoints_.keep(branch.name, run, map_->sets());
    pieces_ += run.state().pieces;
    branch.points = special_points(branch.trace, search(branch));
    const std::size_t number = followed_.size();
    followed_.push_back(branch);
    if (depth < plan_.depth && !over_budget_) switch_at(number, depth);
  }

  // Follows what begins at the points of a branch.
  void switch_at(std::size_t number, int depth) {
    for (std::size_t i = 0; i < followed_[number].points.size(); ++i) {
      const SpecialPoint point = followed_[number].points[i];
      if (std::find(plan_.branch_at.begin(), plan_.branch_at.end(), point.kind) == plan_.branch_at.end()) continue;
      const std::string name = fmt::format("{}.{}", followed_[number].name, i + 1);
      const MapClock clock = followed_[number].clock;
      const double tolerance = round_offs * round_off_;
      const auto switched = switch_branch(*map_, clock, point, continued_.gap(), tolerance, [&](double parameter) {
        return shoot(*map_, near(followed_[number].trace, point.corner, parameter), parameter, clock, tolerance);
      });
      if (!switched) {
        SpecialPoint& failed = followed_[number].points[i];
        failed.note += (failed.note.empty() ? "" : "; ") + std::string("switch failed: no orbit was found near it");
        continue;
      }
      if (const std::string known = branch_through(*switched); !known.empty()) {
        followed_[number].leaves.emplace_back(point.corner, known);
        continue;
      }
      for (const int way : {1, -1}) {
        FollowedBranch branch{name + (way > 0 ? "+" : "-"), switched->clock, {}, {}, switched->orbit.iterations, {}};
        followed_[number].leaves.emplace_back(point.corner, branch.name);
        run_branch(branch, switched->orbit, way, depth + 1);
        // A branch that closes has been followed both ways.
        if (followed_.back().trace.end.starts_with("closed") || over_budget_) break;
      }
      if (over_budget_) return;
    }
  }

  // The kept state of a branch nearest to a corner, by the value that is wanted.
  static Eigen::VectorXd near(const BranchTrace& trace, long long corner, double parameter) {
    const auto at = [&](long long number) { return trace.corners[static_cast<std::size_t>(number)]; };
    auto best = trace.states.begin();
    double least = std::numeric_limits<double>::infinity();
    for (auto state = trace.states.begin(); state != trace.states.end(); ++state) {
      if (std::abs(at(state->first).arc - at(corner).arc) > 10 * group_arc) continue;
      if (const double far = std::abs(at(state->first).parameter - parameter); far < least) least = far, best = state;
    }
    return best->second;
  }

  // A branch that has been followed through this orbit or its image; "" where none was. Between corners the tip is
  // linear in the parameter.
  std::string branch_through(const SwitchedOrbit& switched) {
    constexpr double same_tip = 1e-7;  // of the gap
    const ShotOrbit& orbit = switched.orbit;
    std::vector<double> tips = {map_->tip(orbit.x, orbit.parameter)};
    if (continued_.no_image().empty())
      tips.push_back(map_->tip(mirrored(*map_, orbit.x, orbit.parameter, case_.steps_per_period), orbit.parameter));
    for (const FollowedBranch& branch : followed_) {
      if (!(branch.clock == switched.clock)) continue;
      const auto& corners = branch.trace.corners;
      for (std::size_t i = 1; i < corners.size(); ++i) {
        const BranchCorner &a = corners[i - 1], &b = corners[i];
        if ((a.parameter - orbit.parameter) * (b.parameter - orbit.parameter) > 0 || a.parameter == b.parameter)
          continue;
        const double tip = a.tip + (b.tip - a.tip) * (orbit.parameter - a.parameter) / (b.parameter - a.parameter);
        for (const double own : tips)
          if (std::abs(tip - own) < same_tip * continued_.gap()) return branch.name;
      }
    }
    return "";
  }

  void finish() {
    for (const FollowedBranch& branch : followed_)
      results_.add(branch, rows_of(*map_, branch, plan_.multipliers), x_of_rows(*map_), continued_.parameter_scale());
    results_.put(record_, plan_, pieces_, over_budget_ ? std::optional(budget_of(case_)) : std::nullopt);
    record_.steps = pieces_ * case_.steps_per_period;
  }

  const StudyCase& case_;
  const std::atomic<bool>& stop_;
  BranchCheckpoints checkpoints_;
  ContinuationPlan plan_;
  ContinuedMap continued_;
  std::unique_ptr<PeriodicMap> map_;
  CaseRecord record_;
  double round_off_ = 0, begun_ = thread_seconds();
  std::deque<FollowedBranch> followed_;
  BranchResults results_;
  long long pieces_ = 0;
  bool over_budget_ = false;
};

}  // namespace

CasePlan plan_continuation(const StudyCase& study_case, const Registry& registry) {
  if (study_case.of_reference) return plan_reference(study_case, registry);
  CasePlan out;
  const ContinuationPlan plan = continuation_plan(study_case.settings);
  ContinuedMap continued(study_case, registry, plan);
  out.refusal = continued.refusal();
  if (!out.refusal.empty()) return out;
  if (!continued.no_pieces().empty()) out.notes.push_back("followed by steps: " + continued.no_pieces());
  const auto notes = out.notes;
  describe_march(out, continued.scenes(), study_case);
  out.notes.insert(out.notes.end(), notes.begin(), notes.end());
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
  // Branches at points of branches took five times as much.
  const double leaves = plan.branch_at.empty() || plan.depth == 0 ? 1 : 6;
  const double pieces = branches * leaves * steps * (plan.both_ways ? 2 : 1);
  out.predicted_seconds += pieces * (1.5e-10 * steps * unknowns * unknowns + 1.2e-8 * unknowns * unknowns * unknowns);
  out.steps += static_cast<long long>(pieces * steps);
  out.bytes = branches * 2 * 2000 * 200;
  return out;
}

CaseRecord run_continuation(const StudyCase& study_case, const Registry& registry, const CaseContext& context,
                            const std::atomic<bool>& stop) {
  if (study_case.of_reference) return run_reference(study_case, registry, stop);
  return ContinuationRun(study_case, registry, context, stop).run();
}

}  // namespace ricochet
