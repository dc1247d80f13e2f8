#include "runners/kinds/continuation/branch_orbits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "runners/kinds/continuation/branch_tables.hpp"

namespace ricochet {
namespace {

const Column branch_number{"branch", "", "The branch."};
const Column row_number{"row", "1", "Row of the orbit on its branch."};
constexpr char states_name[] = "branch_states";
// Columns before x.
constexpr std::size_t state_heads = 8;

NumberTable states_head() {
  NumberTable table =
      number_table(states_name, {branch_number,
                                 {"arc", "m", "Length of the branch up to the orbit."},
                                 {"parameter", "", "Its parameter."},
                                 {"way", "1", "Sign of the parameter's change behind it."},
                                 {"change_step", "1", "Step whose contact set changed there; −1: none."},
                                 {"change_row", "1", "The measure that changed."},
                                 {"closes", "1", "Whether the point closes."},
                                 {"upper", "1", "Whether by its upper stop."}});
  table.exported = false;
  return table;
}

// The contact point whose row of H is that of the tip.
int point_at_tip(const SemiDiscrete& problem) {
  if (problem.tip.rows() == 0) return -1;
  const Eigen::RowVectorXd tip = problem.tip.row(0);
  for (int point = 0; point < problem.points(); ++point)
    if ((Eigen::RowVectorXd(problem.contact.row(point)) - tip).cwiseAbs().maxCoeff() <= 1e-12) return point;
  return -1;
}

double or_none(double bound) {
  return std::isfinite(bound) ? bound : NAN;
}

// An even choice of at most `most` of these rows, by arc.
std::vector<std::size_t> evenly(const std::vector<std::size_t>& of, const std::vector<BranchRow>& rows,
                                std::size_t most) {
  if (of.size() <= most) return of;
  std::set<std::size_t> chosen;
  const auto arc = [&](std::size_t k) { return rows[k].arc.value_or(0); };
  const double first = arc(of.front()), length = arc(of.back()) - first;
  for (std::size_t i = 0; i < most; ++i) {
    const double wanted =
        first + length * static_cast<double>(i) / static_cast<double>(std::max<std::size_t>(1, most - 1));
    chosen.insert(*std::min_element(of.begin(), of.end(), [&](std::size_t a, std::size_t b) {
      return std::abs(arc(a) - wanted) < std::abs(arc(b) - wanted);
    }));
  }
  return {chosen.begin(), chosen.end()};
}

// Rows to draw: special points first, changes of contact after the others, then orbits evenly along the branch.
std::set<std::size_t> drawn_rows(const FollowedBranch& branch, const std::vector<BranchRow>& rows) {
  std::vector<std::size_t> special, contacts, all;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    all.push_back(k);
    if (!rows[k].point) continue;
    const SpecialPoint& point = branch.points.at(static_cast<std::size_t>(*rows[k].point) - 1);
    const bool change = point.kind == PointKind::contact && point.runs_before > 0 && point.runs_after > 0;
    (change ? contacts : special).push_back(k);
  }
  std::set<std::size_t> chosen;
  // Of each what leaves room for the next.
  for (const auto& [of, most] : {std::pair(&special, most_branch_portraits / 2),
                                 {&contacts, most_branch_portraits * 2 / 3},
                                 {&all, most_branch_portraits}}) {
    if (chosen.size() >= most) continue;
    for (const std::size_t k : evenly(*of, rows, most - chosen.size())) chosen.insert(k);
  }
  return chosen;
}

}  // namespace

BranchMotion branch_motion(Marcher& marcher, const LaneSpec& lane, long long steps, StepObserver* beside) {
  BranchMotion out;
  const SemiDiscrete& problem = *marcher.program().problem;
  out.lower = lane.lower;
  out.upper = lane.upper;
  out.x = problem.contact_x;
  out.stops = problem.stops;
  out.tip_point = point_at_tip(problem);
  out.motion = march_orbit(marcher, steps, beside);
  return out;
}

MarchBranchOrbit marches_of(PeriodicMap& map) {
  return [&map](const Eigen::VectorXd& x, double parameter, long long steps) {
    return branch_motion(map.begin(x, parameter), map.lanes().lane(parameter), steps);
  };
}

MarchBranchOrbit marches_of(SteppedMap& map) {
  return [&map](const Eigen::VectorXd& x, double parameter, long long steps) {
    Marcher marcher = map.begin(x, parameter).first;
    return branch_motion(marcher, LaneSpec(marcher.program().lanes[0]), steps);
  };
}

NumberType<BranchPortraitColumns> branch_portraits_type() {
  NumberType<BranchPortraitColumns> type("branch_portraits", "", false);
  type.add(branch_number, &BranchPortraitColumns::branch)
      .add(row_number, &BranchPortraitColumns::row)
      .add({"samples", "1", "Number of its samples."}, &BranchPortraitColumns::samples)
      .add({"lower", "m", "Lower stop of the tip; empty: none."}, &BranchPortraitColumns::lower)
      .add({"upper", "m", "Upper stop of the tip; empty: none."}, &BranchPortraitColumns::upper);
  return type;
}

NumberType<BranchSampleColumns> branch_samples_type() {
  NumberType<BranchSampleColumns> type("branch_samples", "", false);
  type.add({"tip_displacement", "m", "Absolute displacement of the tip."}, &BranchSampleColumns::displacement)
      .add({"tip_velocity", "m/s", "Velocity of the tip."}, &BranchSampleColumns::velocity);
  return type;
}

NumberType<BranchRunColumns> branch_runs_type() {
  NumberType<BranchRunColumns> type("branch_runs", "", false);
  type.add(branch_number, &BranchRunColumns::branch)
      .add(row_number, &BranchRunColumns::row)
      .add({"x", "m", "Place of the point."}, &BranchRunColumns::x)
      .add({"upper", "1", "Whether it is pushed by its upper stop."}, &BranchRunColumns::upper)
      .add({"bound", "m", "Where that stop is."}, &BranchRunColumns::bound)
      .add({"begin", "1", "Where the run begins, in forcing periods from the strobe."}, &BranchRunColumns::begin)
      .add({"length", "1", "How long it lasts, in forcing periods."}, &BranchRunColumns::length);
  return type;
}

BranchOrbits::BranchOrbits()
    : states_(states_head()),
      portraits_(branch_portraits_type().head()),
      samples_(branch_samples_type().head()),
      runs_(branch_runs_type().head()) {}

void BranchOrbits::keep(double branch, const BranchStart& start) {
  for (auto k = states_.columns.size() - state_heads; k < static_cast<std::size_t>(start.x.size()); ++k) {
    states_.columns.push_back({fmt::format("x_{}", k + 1), "", "One number of the state at the strobe."});
    states_.values.emplace_back();
  }
  const SetChange& change = start.change;
  std::size_t column = 0;
  for (const double value :
       {branch, start.arc, start.parameter, static_cast<double>(start.way), static_cast<double>(change.step),
        static_cast<double>(change.row), change.closes ? 1.0 : 0.0, change.upper ? 1.0 : 0.0})
    states_.values[column++].push_back(value);
  for (const double value : start.x) states_.values[column++].push_back(value);
}

void BranchOrbits::draw(double branch, const FollowedBranch& of, const BranchRow& row, const Eigen::VectorXd& x,
                        const MarchBranchOrbit& march) {
  const long long steps = static_cast<long long>(of.clock.period) * of.clock.steps_per_period;
  const BranchMotion made = march(x, *row.parameter, steps);
  const OrbitMotion& motion = made.motion;
  if (motion.end) return;
  const long long part = of.clock.steps(),
                  samples = std::min<long long>(part, branch_samples / (of.clock.half ? 2 : 1));
  const auto number = static_cast<double>(row.row);
  for (long long i = 0; i < samples; ++i) {
    const auto k = static_cast<std::size_t>(i * part / samples);
    samples_.add({motion.displacement[k], motion.velocity[k]});
  }
  const int tip = made.tip_point;
  portraits_.add({branch, number, static_cast<double>(samples), tip < 0 ? NAN : or_none(made.lower[tip]),
                  tip < 0 ? NAN : or_none(made.upper[tip])});
  const double turn = of.clock.steps_per_period;
  for (const ContactRun& run : motion.runs) {
    const auto point = static_cast<std::size_t>(run.point);
    runs_.add({branch, number, point < made.x.size() ? made.x[point] : NAN, run.upper ? 1.0 : 0.0,
               (run.upper ? made.upper : made.lower)[run.point], static_cast<double>(run.begin - 1) / turn,
               static_cast<double>(run.steps) / turn});
  }
}

void BranchOrbits::add(const FollowedBranch& branch, const std::vector<BranchRow>& rows, const MarchBranchOrbit& march,
                       std::size_t most_states) {
  const auto name = static_cast<double>(names_.size());
  names_.push_back(branch.name);
  const std::set<std::size_t> drawn = drawn_rows(branch, rows);
  const std::size_t stride = 1 + branch.trace.states.size() / most_states;
  auto state = branch.trace.states.begin();
  std::size_t passed = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const BranchRow& row = rows[k];
    BranchStart start;
    bool kept = true;
    // Rows are the kept states in their order, with marks between them.
    const BranchCorner* corner =
        state == branch.trace.states.end() ? nullptr : &branch.trace.corners[static_cast<std::size_t>(state->first)];
    if (corner && corner->arc == row.arc && corner->parameter == row.parameter) {
      start.x = state->second;
      kept = passed % stride == 0;
      ++state;
      ++passed;
    } else {
      const auto mark = std::find_if(branch.trace.marks.begin(), branch.trace.marks.end(),
                                     [&](const MarkedOrbit& one) { return one.arc == row.arc; });
      if (mark == branch.trace.marks.end()) continue;
      start.x = mark->x;
      corner = &branch.trace.corners[static_cast<std::size_t>(mark->corner)];
    }
    start.arc = *row.arc;
    start.parameter = *row.parameter;
    start.way = corner->way;
    start.change = corner->change;
    if (kept || k + 1 == rows.size()) keep(name, start);
    if (drawn.count(k) > 0) draw(name, branch, row, start.x, march);
  }
}

void BranchOrbits::put(CaseRecord& record) const {
  for (const NumberTable* table : {&states_, &portraits_, &samples_, &runs_}) {
    if (table->rows() == 0) continue;
    record.numbers.push_back(*table);
    if (table != &samples_) record.numbers.back().words = {{branch_number.name, names_}};
  }
}

KeptStarts kept_starts(const CaseRecord& record, const std::string& branch, double arc) {
  KeptStarts found;
  const NumberTable* table = find_table(record.numbers, states_name);
  const auto* names = table ? table->words_of(branch_number.name) : nullptr;
  if (!names || table->values.size() <= state_heads) return found;
  const auto number = static_cast<double>(std::find(names->begin(), names->end(), branch) - names->begin());
  const std::vector<double>&branches = table->values[0], &arcs = table->values[1];
  const auto start = [&](std::size_t row) {
    const auto value = [&](std::size_t column) { return table->values[column][row]; };
    BranchStart one{value(1), value(2), value(3) < 0 ? -1 : 1, {}, {}};
    one.change = {std::llround(value(4)), static_cast<int>(value(5)), value(6) != 0, value(7) != 0};
    one.x.resize(static_cast<Eigen::Index>(table->values.size() - state_heads));
    for (Eigen::Index i = 0; i < one.x.size(); ++i) one.x[i] = value(state_heads + static_cast<std::size_t>(i));
    return one;
  };
  std::optional<std::size_t> at, next;
  for (std::size_t row = 0; row < branches.size(); ++row) {
    if (branches[row] != number) continue;
    if (arcs[row] <= arc)
      at = row;
    else if (!next)
      next = row;
  }
  if (at) found.at = start(*at);
  if (next) found.next = start(*next);
  return found;
}

}  // namespace ricochet
