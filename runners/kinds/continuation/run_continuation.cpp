#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <ricochet/measure/orbits/periodic_map.hpp>
#include <ricochet/measure/orbits/special_points.hpp>
#include <type_traits>

#include "runners/kinds/continuation/branch_checkpoints.hpp"
#include "runners/kinds/continuation/branch_tables.hpp"
#include "runners/kinds/continuation/continuation.hpp"
#include "runners/kinds/continuation/continuation_study.hpp"
#include "runners/kinds/continuation/continued_map.hpp"
#include "runners/kinds/continuation/first_orbit.hpp"
#include "runners/march/seconds.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

// Pieces, and steps, between two readings of the clock.
constexpr long long breath_of(const PeriodicMap&) {
  return pieces_updated;
}
constexpr long long breath_of(const SteppedMap&) {
  return 1;
}

double tip_of(PeriodicMap& map, const Eigen::VectorXd& x, double parameter) {
  return map.tip(x, parameter);
}
double tip_of(SteppedMap& map, const Eigen::VectorXd& x, double parameter) {
  return map.march(x, parameter, {8, 1, false}).tip;
}

SetSteps* sets_of(PeriodicMap& map) {
  return &map.sets();
}
SetSteps* sets_of(SteppedMap&) {
  return nullptr;
}

// The branch of an orbit, or of one that was stopped.
BranchRun begin_branch(PeriodicMap& map, const MapClock& clock, const ShotOrbit& shot, int way, BranchLimits limits,
                       double round_off, std::optional<KeptBranch> kept) {
  limits.ends_at_image = limits.ends_at_image && !is_image(map.sets(), shot.sets);
  limits.ends_sooner = !clock.half && repeats_sooner(shot.sets, clock.period) == 0;
  // A residual that several steps of Newton's method leave.
  const double drift = std::max(100 * round_off, 1e-15);
  if (kept) return {map, clock, PieceFollower(map, clock, kept->entry, drift), limits, kept->trace, kept->first};
  return {map, clock, PieceFollower(map, clock, branch_start(shot.x, shot.parameter, shot.sets, way), drift), limits};
}
StepFollower begin_branch(SteppedMap& map, const MapClock& clock, const ShotOrbit& shot, int way,
                          const BranchLimits& limits, double round_off, std::optional<KeptBranch> kept) {
  ArcSteps steps;
  steps.branch = limits;
  steps.branch.ends_sooner = !clock.half && clock.period > 1;
  steps.tolerance = round_offs * round_off;
  if (kept) return {map, clock, kept->entry, steps, std::move(kept->trace)};
  return {map, clock, shot.x, shot.parameter, way, steps};
}

// An orbit and its twins, 1e-6, 1e-7 and 1e-8 of the gap apart, are marched for one period. The derivative predicts how
// far apart they are then: the result is the least relative error of that. It holds as far as no contact changes.
template <class Map>
double twin_error(Map& map, ShotOrbit shot, const MapClock& told, double gap) {
  const auto [x, clock] = quiet_orbit(map, shot.x, shot.parameter, told);
  shot.x = x;
  const Eigen::MatrixXd derivative = derivative_at(map, shot, clock);
  const Eigen::VectorXd own = map.march(shot.x, shot.parameter, clock).image;
  Eigen::VectorXd by = derivative * Eigen::VectorXd::Ones(shot.x.size());
  by *= gap / map.metric().size(by);
  const Eigen::VectorXd expected = derivative * by;
  double least = 1;
  for (const double share : {1e-6, 1e-7, 1e-8}) {
    const auto twin = map.march(shot.x + share * by, shot.parameter, clock);
    if (twin.end) continue;
    const double error = map.metric().size((twin.image - own) / share - expected) / map.metric().size(expected);
    if (error < least) least = error;
  }
  return least;
}

template <class Map>
class ContinuationRun {
  static constexpr bool by_steps = std::is_same_v<Map, SteppedMap>;
  static constexpr std::size_t most_states = by_steps ? all_branch_states : most_branch_states;

 public:
  ContinuationRun(ContinuedMap& continued, Map& map, const StudyCase& study_case, const ContinuationPlan& plan,
                  const CaseContext& context, const std::atomic<bool>& stop)
      : case_(study_case),
        stop_(stop),
        checkpoints_(context.checkpoints, context.key),
        plan_(plan),
        continued_(continued),
        map_(map) {}

  void run(CaseRecord& record) {
    for (const WantedOrbit& orbit : plan_.orbits) follow(orbit);
    for (const FollowedBranch& branch : followed_) {
      std::vector<BranchRow> rows = rows_of(map_, branch, plan_.multipliers);
      results_.keep_orbits(branch, rows, marches_of(map_), most_states);
      results_.add(branch, std::move(rows), x_of_rows(map_), continued_.parameter_scale());
    }
    results_.put(record, plan_, pieces_, over_budget_ ? std::optional(budget_of(case_)) : std::nullopt);
    record.steps = pieces_ * case_.steps_per_period;
    constexpr double near = 0.01;
    if (twins_ > near)
      record.notes.push_back(fmt::format(
          "multipliers differ from twins of the first orbits by {:.2g} of them: a contact changes beside", twins_));
    else if (twins_ > 0)
      record.notes.push_back(fmt::format("multipliers agree with twins of the first orbits to {:.1g}", twins_));
    if (ties_ > 0)
      record.notes.push_back(
          fmt::format("two bounds were met at once, to 1e-12 of the range, {} time{}: they change one after the other",
                      ties_, ties_ == 1 ? "" : "s"));
    if (rebounds_ > 0)
      record.notes.push_back(fmt::format(
          "stops give back speed: orbits are known to {:.3g} m, what a step places their impacts to", rebounds_));
    checkpoints_.forget();
  }

 private:
  double tolerance() const { return round_offs * round_off_; }

  void follow(const WantedOrbit& orbit) {
    const FirstOrbit found = first_orbit(continued_, map_, case_.steps_per_period, orbit, round_off_);
    if (!found.why.empty()) return results_.add_missing(orbit.name, orbit.at, found.why);
    const ShotOrbit& shot = found.shot;
    FollowedBranch first{orbit.name, found.clock, {}, {}, shot.iterations, {}};
    if (plan_.follow == Follow::none) {
      add_orbit(first, shot);
      return;
    }
    follow_ways(first, shot, 0);
  }

  // Follows a branch from an orbit, both ways where the study says so, then what begins at its points.
  void follow_ways(const FollowedBranch& begun, const ShotOrbit& shot, int depth) {
    const std::size_t first = followed_.size();
    for (const int way : {1, -1}) {
      if (way < 0 && depth == 0 && !plan_.both_ways) break;
      FollowedBranch branch = begun;
      branch.name += way > 0 ? "+" : "-";
      if (way < 0) branch.other = &followed_[first];
      run_branch(branch, shot, way, depth);
      // A branch that closes has been followed both ways.
      if (followed_.back().trace.ends == TraceEnd::closed) break;
      if (over_budget_ && depth > 0) break;
    }
    const std::size_t behind = followed_.size();
    if (behind - first > 1) {
      followed_[first].other = &followed_[first + 1];
      tell(followed_[first]);
    }
    for (std::size_t number = first; number < behind && depth < plan_.depth && !over_budget_; ++number)
      switch_at(number, depth);
  }

  void tell(FollowedBranch& branch) const { branch.points = special_points(branch.trace, search(branch)); }

  void add_orbit(FollowedBranch& branch, const ShotOrbit& shot) {
    BranchRow row = orbit_row(map_, branch.clock, shot.x, shot.parameter);
    std::vector<std::complex<double>> all;
    if constexpr (by_steps) {
      const auto [x, clock] = quiet_orbit(map_, shot.x, shot.parameter, branch.clock);
      all = multipliers_of(map_.march(x, shot.parameter, clock, true).derivative);
    } else {
      all = multipliers_of(map_, branch.clock, derivative_at(map_, shot, branch.clock));
    }
    row.branch = branch.name;
    row.arc = 0;
    put_multipliers(all, outside(all), plan_.multipliers, row);
    row.iterations = shot.iterations;
    row.pieces = 0;
    branch.trace.corners.resize(1);
    branch.trace.corners.front().parameter = shot.parameter;
    branch.trace.states = {{0, shot.x}};
    results_.keep_orbits(branch, {row}, marches_of(map_), most_states);
    results_.add(std::move(row));
  }

  auto begin(const FollowedBranch& branch, const ShotOrbit& shot, int way) {
    BranchLimits limits{continued_.from(), continued_.to(),
                        plan_.most_pieces, plan_.longest_arc(continued_.gap(), continued_.parameter_metres()),
                        plan_.marks,       plan_.multipliers};
    limits.ends_at_image = !branch.clock.half && branch.clock.period % 2 != 0 && continued_.no_image().empty();
    return begin_branch(map_, branch.clock, shot, way, std::move(limits), round_off_,
                        checkpoints_.find(branch.name, sets_of(map_)));
  }

  PointSearch search(const FollowedBranch& branch) const {
    PointSearch search;
    search.half = branch.clock.half;
    search.prominence = plan_.prominence.value_or(least_fold * continued_.parameter_scale());
    search.by_steps = by_steps;
    search.gap = continued_.gap();
    search.metres = map_.metric().parameter_metres();
    search.before = branch.before();
    return search;
  }

  // The first point of a kind at which branches stop, once nothing that follows can change it.
  std::optional<SpecialPoint> stopping_point(const FollowedBranch& branch, const BranchTrace& trace) const {
    if (plan_.stop_at.empty()) return std::nullopt;
    auto point = first_of(special_points(trace, search(branch)), plan_.stop_at);
    if (!point || trace.ended()) return point;
    const auto last = static_cast<long long>(trace.corners.size()) - 1;
    const bool settled = by_steps ? last > point->corner + 1
                                  : last - point->corner > 2 * group_pieces &&
                                        trace.corners.back().arc - point->arc > 2 * group_arc * continued_.gap();
    return settled ? point : std::nullopt;
  }

  void run_branch(FollowedBranch& branch, const ShotOrbit& shot, int way, int depth) {
    auto run = begin(branch, shot, way);
    if (depth == 0 && way > 0 && run.trace().rebounds == 0)
      twins_ = std::max(twins_, twin_error(map_, shot, branch.clock, continued_.gap()));
    std::optional<SpecialPoint> stopping;
    bool more = !run.trace().ended();
    for (long long round = 0; more; ++round) {
      more = run.advance(breath_of(map_));
      if (stop_ || checkpoints_.due()) checkpoints_.keep(branch.name, kept(run), sets_of(map_));
      if (stop_) throw Interrupted{};
      if (thread_seconds() - begun_ > budget_of(case_)) over_budget_ = true;
      if (over_budget_) break;
      if (round % 8 == 7) stopping = stopping_point(branch, run.trace());
      if (stopping) break;
    }
    branch.trace = run.trace();
    if (!stopping && !over_budget_) stopping = stopping_point(branch, branch.trace);
    if (stopping) cut_at(branch.trace, *stopping);
    if (branch.trace.ends == TraceEnd::range && !branch.trace.corners.empty())
      if (const std::string& why = continued_.impossible(branch.trace.corners.back().parameter); !why.empty())
        branch.trace.end += "; " + why;
    if (over_budget_)
      branch.trace.end_by(TraceEnd::limit, fmt::format("the budget of {:g} s was spent", budget_of(case_)));
    checkpoints_.keep(branch.name, kept(run), sets_of(map_));
    pieces_ += run.pieces();
    ties_ += branch.trace.ties;
    rebounds_ = std::max(rebounds_, branch.trace.rebounds);
    tell(branch);
    followed_.push_back(branch);
  }

  // Follows what begins at the points of a branch.
  void switch_at(std::size_t number, int depth) {
    for (std::size_t i = 0; i < followed_[number].points.size(); ++i) {
      const SpecialPoint point = followed_[number].points[i];
      if (std::find(plan_.branch_at.begin(), plan_.branch_at.end(), point.kind) == plan_.branch_at.end()) continue;
      const std::string name = fmt::format("{}.{}", followed_[number].name, i + 1);
      const MapClock clock = followed_[number].clock;
      const auto switched = switch_branch(map_, clock, point, continued_.gap(), tolerance(), [&](double parameter) {
        if (parameter < continued_.from() || parameter > continued_.to()) return ShotOrbit{};
        return shoot(map_, near(followed_[number].trace, point.corner, parameter), parameter, clock, tolerance());
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
      const std::size_t first = followed_.size();
      follow_ways({name, switched->clock, {}, {}, switched->orbit.iterations, {}}, switched->orbit, depth + 1);
      for (std::size_t leaf = first; leaf < followed_.size(); ++leaf)
        if (followed_[leaf].name.size() == name.size() + 1)
          followed_[number].leaves.emplace_back(point.corner, followed_[leaf].name);
      if (over_budget_) return;
    }
  }

  // The kept state of a branch nearest to a corner, by the value that is wanted.
  Eigen::VectorXd near(const BranchTrace& trace, long long corner, double parameter) const {
    const auto at = [&](long long number) { return trace.corners[static_cast<std::size_t>(number)]; };
    auto best = trace.states.begin();
    double least = std::numeric_limits<double>::infinity();
    for (auto state = trace.states.begin(); state != trace.states.end(); ++state) {
      const bool beside = by_steps && std::abs(state->first - corner) <= 2;
      if (!beside && std::abs(at(state->first).arc - at(corner).arc) > 10 * group_arc * continued_.gap()) continue;
      if (const double far = std::abs(at(state->first).parameter - parameter); far < least) least = far, best = state;
    }
    return best->second;
  }

  // A branch that has been followed through this orbit or its image; "" where none was. Between corners the tip is
  // linear in the parameter.
  std::string branch_through(const SwitchedOrbit& switched) {
    constexpr double same_tip = 1e-7;  // of the gap
    const ShotOrbit& orbit = switched.orbit;
    std::vector<double> tips = {tip_of(map_, orbit.x, orbit.parameter)};
    if (continued_.no_image().empty()) {
      const auto image = map_.march(orbit.x, orbit.parameter, {case_.steps_per_period, 1, true});
      if (!image.end) tips.push_back(tip_of(map_, image.image, orbit.parameter));
    }
    for (const FollowedBranch& branch : followed_) {
      if (!(branch.clock == switched.clock)) continue;
      const auto& corners = branch.trace.corners;
      for (std::size_t i = 1; i < corners.size(); ++i) {
        const BranchCorner &a = corners[i - 1], &b = corners[i];
        if ((a.parameter - orbit.parameter) * (b.parameter - orbit.parameter) > 0 || a.parameter == b.parameter)
          continue;
        const double share = (orbit.parameter - a.parameter) / (b.parameter - a.parameter);
        double tip = a.tip + share * (b.tip - a.tip);
        if constexpr (by_steps) {  // a curve between two orbits: the one of this value is solved
          const Eigen::VectorXd &xa = branch.trace.states.at(static_cast<long long>(i) - 1),
                                &xb = branch.trace.states.at(static_cast<long long>(i));
          const ShotOrbit there = shoot(map_, xa + share * (xb - xa), orbit.parameter, branch.clock, tolerance());
          if (!there.found) continue;
          tip = tip_of(map_, there.x, orbit.parameter);
        }
        for (const double own : tips)
          if (std::abs(tip - own) < same_tip * continued_.gap()) return branch.name;
      }
    }
    return "";
  }

  const StudyCase& case_;
  const std::atomic<bool>& stop_;
  BranchCheckpoints checkpoints_;
  const ContinuationPlan& plan_;
  ContinuedMap& continued_;
  Map& map_;
  double round_off_ = 0, rebounds_ = 0, twins_ = 0, begun_ = thread_seconds();
  std::deque<FollowedBranch> followed_;
  BranchResults results_;
  long long pieces_ = 0, ties_ = 0;
  bool over_budget_ = false;
};

}  // namespace

CaseRecord run_continuation(const StudyCase& study_case, const Registry& registry, const CaseContext& context,
                            const std::atomic<bool>& stop) {
  if (study_case.of_reference) return run_reference(study_case, registry, stop);
  const double begun = thread_seconds();
  CaseRecord record;
  record.id = study_case.id;
  record.axes = study_case.axes;
  const ContinuationPlan plan = continuation_plan(study_case.settings);
  ContinuedMap continued(study_case, registry, plan);
  if (!continued.refusal().empty()) {
    record.status = Status::refused;
    record.reasons = {continued.refusal()};
    return record;
  }
  describe_march(record, continued.scenes(), study_case);
  const auto run = [&](auto map) {
    record.setup_seconds = thread_seconds() - begun;
    ContinuationRun(continued, *map, study_case, plan, context, stop).run(record);
    record.run_seconds = thread_seconds() - begun - record.setup_seconds;
  };
  if (!continued.no_pieces().empty()) record.notes.push_back("followed by steps: " + continued.no_pieces());
  if (continued.by_pieces())
    run(continued.map());
  else
    run(std::make_unique<SteppedMap>(continued.stepped_map(continued.reference_at())));
  return record;
}

}  // namespace ricochet
