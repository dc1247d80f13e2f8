#include "runners/kinds/continuation/branch_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/measure/orbits/own_march.hpp>

#include "runners/store/record_values.hpp"

namespace ricochet {

std::optional<SpecialPoint> first_of(std::vector<SpecialPoint> points, const std::vector<PointKind>& kinds) {
  const auto found = std::find_if(points.begin(), points.end(), [&](const SpecialPoint& point) {
    return point.kind != PointKind::end && std::find(kinds.begin(), kinds.end(), point.kind) != kinds.end();
  });
  return found == points.end() ? std::nullopt : std::optional(std::move(*found));
}

void cut_at(BranchTrace& trace, const SpecialPoint& point) {
  // A mark lies behind its corner.
  const long long last = point.corner + (point.kind == PointKind::mark);
  const auto left = static_cast<std::size_t>(std::max(last, 1LL)) + 1;
  if (left < trace.corners.size()) trace.corners.resize(left);
  std::erase_if(trace.states, [&](const auto& one) { return one.first >= static_cast<long long>(left); });
  std::erase_if(trace.marks, [&](const MarkedOrbit& one) { return one.corner >= static_cast<long long>(left); });
  trace.end_by(TraceEnd::asked, fmt::format("stopped at the first {}, at {:.10g}", word(point.kind), point.parameter));
}

namespace {

// Runs of contact, and those of them that never end.
std::pair<int, int> runs_of(const PeriodicMap& map, const MapMarch& made, bool half) {
  const ContactRuns runs = contact_runs(map.sets(), made.sets, half);
  return {runs.count, runs.held};
}
std::pair<int, int> runs_of(const SteppedMap&, const SteppedMap::Image& made, bool) {
  return {made.runs, made.held};
}

void put_runs(int runs, int held, const MapClock& clock, BranchRow& row) {
  const int times = clock.half ? 2 : 1;
  row.contact_runs = times * runs;
  row.impacts_per_period = static_cast<double>(times * (runs - held)) / clock.period;
}

template <class Map, class March>
BranchRow row_of(const Map& map, const March& made, const MapClock& clock, const Eigen::VectorXd& x, double parameter) {
  BranchRow row;
  row.parameter = parameter;
  row.tip_displacement = made.tip;
  row.period = clock.period;
  row.symmetric = clock.half;
  if (made.end) return row;
  row.tip_velocity = made.tip_velocity;
  row.penetration = made.penetration;
  row.residual = map.metric().size(made.image - x);
  const auto [runs, held] = runs_of(map, made, clock.half);
  put_runs(runs, held, clock, row);
  return row;
}

BranchRow with_march(BranchRow row, const OwnMarch& own) {
  if (own.end) return row;
  row.march_displacement = own.displacement;
  row.march_velocity = own.velocity;
  return row;
}

}  // namespace

BranchRow orbit_row(PeriodicMap& map, const MapClock& clock, const Eigen::VectorXd& x, double parameter) {
  return with_march(row_of(map, map.march(x, parameter, clock, true), clock, x, parameter),
                    own_march(map, x, parameter, clock, told_periods));
}

BranchRow orbit_row(SteppedMap& map, const MapClock& clock, const Eigen::VectorXd& x, double parameter) {
  const QuietOrbit quiet = quiet_orbit(map, x, parameter, clock);
  return with_march(row_of(map, map.march(quiet.x, parameter, quiet.clock), clock, quiet.x, parameter),
                    own_march(map, x, parameter, clock, told_periods));
}

void put_multipliers(const std::vector<std::complex<double>>& multipliers, const Outside& outside, int most,
                     BranchRow& row) {
  row.stable = outside.total == 0;
  row.unstable = outside.total;
  row.multipliers.assign(multipliers.begin(), multipliers.end());
  row.multipliers.resize(static_cast<std::size_t>(most));
}

std::vector<BranchRow> corner_rows_of(const FollowedBranch& branch, int multipliers) {
  std::map<long long, int> numbers;  // of special points, by corner
  for (std::size_t i = 0; i < branch.points.size(); ++i)
    if (branch.points[i].kind != PointKind::mark) numbers.emplace(branch.points[i].corner, static_cast<int>(i) + 1);
  std::vector<BranchRow> rows;
  long long last = 0;
  for (const auto& [number, x] : branch.trace.states) {
    const BranchCorner& corner = branch.trace.corners[static_cast<std::size_t>(number)];
    BranchRow row;
    row.branch = branch.name;
    row.row = static_cast<long long>(rows.size());
    row.arc = corner.arc;
    row.parameter = corner.parameter;
    row.tip_displacement = corner.tip;
    row.period = branch.clock.period;
    row.symmetric = branch.clock.half;
    put_multipliers(corner.leading, corner.raw.outside, multipliers, row);
    put_runs(corner.runs, corner.held, branch.clock, row);
    row.iterations = number == 0 ? branch.iterations : 0;
    row.residual = corner.residual;
    row.pieces = number - last;
    row.direction = corner.way;
    if (const auto found = numbers.find(number); found != numbers.end()) row.point = found->second;
    last = number;
    rows.push_back(std::move(row));
  }
  return rows;
}

namespace {

/// The multipliers nearest the circle by the half-step rule.
void put_half_step(const CornerRoots& roots, BranchRow& row) {
  if (roots.real != 0) row.half_step_real = roots.real;
  if (roots.modulus != 0) row.half_step_pair = std::polar(roots.modulus, roots.angle);
}

// The row of an orbit between two corners, where it belongs.
template <class Map>
void add_mark(Map& map, const FollowedBranch& branch, const MarkedOrbit& mark, int multipliers,
              std::vector<BranchRow>& rows) {
  const BranchCorner& corner = branch.trace.corners[static_cast<std::size_t>(mark.corner)];
  BranchRow row = orbit_row(map, branch.clock, mark.x, mark.parameter);
  row.branch = branch.name;
  row.arc = mark.arc;
  if (mark.leading.empty())
    put_multipliers(corner.leading, corner.raw.outside, multipliers, row);
  else
    put_multipliers(mark.leading, mark.outside, multipliers, row);
  row.iterations = 0;
  row.pieces = 0;
  row.direction = corner.way;
  for (std::size_t i = 0; i < branch.points.size(); ++i)
    if (branch.points[i].kind == PointKind::mark && branch.points[i].arc == mark.arc)
      row.point = static_cast<int>(i) + 1;
  const auto place = std::upper_bound(rows.begin(), rows.end(), mark.arc,
                                      [](double arc, const BranchRow& one) { return arc < *one.arc; });
  rows.insert(place, std::move(row));
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].row = static_cast<long long>(i);
}

}  // namespace

template <class Map>
std::vector<BranchRow> rows_of(Map& map, const FollowedBranch& branch, int multipliers) {
  std::vector<BranchRow> rows = corner_rows_of(branch, multipliers);
  auto row = rows.begin();
  for (const auto& [number, x] : branch.trace.states) {
    const BranchRow marched = orbit_row(map, branch.clock, x, *row->parameter);
    row->tip_displacement = marched.tip_displacement;
    row->tip_velocity = marched.tip_velocity;
    row->penetration = marched.penetration;
    row->residual = marched.residual;
    row->march_displacement = marched.march_displacement;
    row->march_velocity = marched.march_velocity;
    put_half_step(branch.trace.corners[static_cast<std::size_t>(number)].smooth, *row);
    ++row;
  }
  for (const MarkedOrbit& mark : branch.trace.marks) add_mark(map, branch, mark, multipliers, rows);
  return rows;
}

template std::vector<BranchRow> rows_of(PeriodicMap&, const FollowedBranch&, int);
template std::vector<BranchRow> rows_of(SteppedMap&, const FollowedBranch&, int);

std::vector<double> x_of_rows(const SteppedMap&) {
  return {};
}

std::vector<double> x_of_rows(const PeriodicMap& map) {
  const auto& x = map.program().problem->contact_x;
  std::vector<double> all;
  for (int row = 0; row < map.sets().measure_rows(); ++row)
    if (const auto point = static_cast<std::size_t>(map.sets().place(row).point); point < x.size())
      all.push_back(x[point]);
  return all;
}

namespace {

/// `x_of_rows`: where the point of each row of v stands, m.
std::vector<SpecialRow> special_rows_of(const FollowedBranch& branch, const std::vector<double>& x_of_rows) {
  std::vector<SpecialRow> rows;
  for (const SpecialPoint& point : branch.points) {
    SpecialRow row;
    row.branch = branch.name;
    row.point = static_cast<int>(rows.size()) + 1;
    row.kind = point.kind;
    row.parameter = point.parameter;
    row.low = point.low;
    row.high = point.high;
    row.arc = point.arc;
    row.tip_displacement = point.tip;
    if (point.multiplier) {
      row.multiplier_re = point.multiplier->real();
      row.multiplier_im = point.multiplier->imag();
      if (point.kind == PointKind::torus) row.angle = std::abs(std::arg(*point.multiplier));
    }
    const bool switches = point.kind == PointKind::symmetry || point.kind == PointKind::flip;
    if (switches || point.kind == PointKind::torus) row.crossings = point.crossings;
    row.prominence = point.prominence;
    row.side = point.side;
    if (point.change) {
      const int period = branch.clock.steps_per_period;
      row.contact_phase = 2 * std::numbers::pi * static_cast<double>((point.change->step + 1) % period) / period;
      const auto place = static_cast<std::size_t>(point.change->row);
      if (place < x_of_rows.size()) row.contact_x = x_of_rows[place];
    }
    const int times = branch.clock.half ? 2 : 1;
    if (point.kind != PointKind::end && point.kind != PointKind::mark) {
      row.runs_before = times * point.runs_before;
      row.runs_after = times * point.runs_after;
      row.held_before = times * point.held_before;
      row.held_after = times * point.held_after;
    }
    for (const auto& [corner, name] : branch.leaves)
      if (corner == point.corner && switches) row.to_branch += (row.to_branch.empty() ? "" : " ") + name;
    row.ended = point.ends;
    row.note = point.note;
    rows.push_back(std::move(row));
  }
  return rows;
}

// Three prominences a decade, 1e-6 … 1e-2 of the scale.
std::vector<TurnRow> turn_rows_of(const FollowedBranch& branch, double scale) {
  std::vector<TurnRow> rows;
  const std::vector<Turn> turns = turns_of(branch.trace, branch.before());
  for (int k = -18; k <= -6; ++k) {
    TurnRow row;
    row.branch = branch.name;
    row.prominence = scale * std::pow(10.0, k / 3.0);
    row.folds = static_cast<int>(
        std::count_if(turns.begin(), turns.end(), [&](const Turn& turn) { return turn.prominence >= row.prominence; }));
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

void BranchResults::add(const FollowedBranch& branch, std::vector<BranchRow> rows, const std::vector<double>& x_of_rows,
                        double scale) {
  std::move(rows.begin(), rows.end(), std::back_inserter(rows_));
  for (SpecialRow& row : special_rows_of(branch, x_of_rows)) {
    found_ += row.kind != PointKind::end;
    special_.push_back(std::move(row));
  }
  for (TurnRow& row : turn_rows_of(branch, scale)) turns_.push_back(std::move(row));
  ++branches_;
}

void BranchResults::add_missing(const std::string& name, double at, std::string why) {
  SpecialRow& row = special_.emplace_back();
  row.branch = name;
  row.point = 1;
  row.kind = PointKind::end;
  row.parameter = at;
  row.ended = TraceEnd::missing;
  row.note = why;
  if (missing_.empty()) missing_ = std::move(why);
}

void BranchResults::put(CaseRecord& record, const ContinuationPlan& plan, long long pieces,
                        std::optional<double> spent) const {
  record.tables.push_back(branches_type(plan.multipliers).with(rows_));
  record.tables.push_back(special_points_type().with(special_));
  record.tables.push_back(turns_type().with(turns_));
  orbits_.put(record);
  put_measure(record, "branches", branches_);
  put_measure(record, "pieces", static_cast<double>(pieces));
  put_measure(record, "special_points", found_);
  if (spent)
    record.reasons = {said("the budget of {:g} s was spent", *spent)};
  else if (!missing_.empty())
    record.reasons = {missing_};
  record.status = record.reasons.empty() ? Status::done : Status::failed;
}

}  // namespace ricochet
