#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>
#include <ricochet/contract/errors.hpp>
#include <ricochet/measure/orbits/branch.hpp>

#include "runners/kinds/continuation/branch_tables.hpp"
#include "runners/kinds/continuation/continuation.hpp"
#include "runners/kinds/continuation/continued_map.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/kinds/stored_study.hpp"
#include "runners/kinds/sweep/march_point.hpp"
#include "runners/kinds/trajectory/snapshot_taker.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/number_rows.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

/// An orbit that was solved at an arc.
struct BranchPoint {
  Eigen::VectorXd x;
  double parameter = 0, residual = 0;
  std::vector<std::complex<double>> multipliers;
  std::optional<CornerRoots> half_step;  ///< by the half-step rule; none where contact sets are not known
  std::string way;                       ///< how it was come to
};

/// The rows of one branch.
std::vector<BranchRow> branch_named(const CaseRecord& record, const std::string& name) {
  std::vector<std::string> names;
  std::vector<BranchRow> found;
  for (BranchRow& row : branch_rows_in(stored_table(record, branches_name))) {
    if (names.empty() || names.back() != row.branch) names.push_back(row.branch);
    if (row.branch == name) found.push_back(std::move(row));
  }
  if (!found.empty()) return found;
  const std::string nearest = nearest_name(name, names);
  throw PointRefused(fmt::format("--branch \"{}\": the case {} has no such branch{}; its branches are {}", name,
                                 record.id, nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?",
                                 fmt::join(names, ", ")));
}

// The sets of an orbit at a corner: what changed there is as it is behind it.
SetSequence sets_behind(PeriodicMap& map, const BranchStart& start, const MapClock& clock) {
  MapMarch made = map.march(start.x, start.parameter, clock);
  if (made.end) throw PointRefused("the stored orbit cannot be marched: " + text(made.end));
  const SetChange& change = start.change;
  if (change.step < 0) return made.sets;
  int& set = made.sets.at(static_cast<std::size_t>(change.step));
  const int side = map.sets()[set].side.at(static_cast<std::size_t>(change.row));
  const int wanted = change.closes ? (change.upper ? 1 : -1) : 0;
  if (side != wanted) set = map.sets().toggled(set, change.row, change.upper);
  return made.sets;
}

BranchPoint by_pieces(PeriodicMap& map, const ContinuationPlan& plan, const MapClock& clock, const BranchStart& start,
                      double arc) {
  // A residual that several steps of Newton's method leave, as the run has it.
  const double drift = std::max(100 * round_off_of_map(map, start.x, start.parameter, clock), 1e-15);
  BranchState entry = branch_start(start.x, start.parameter, sets_behind(map, start, clock), start.way);
  entry.change = start.change;
  entry.arc = start.arc;
  PieceFollower follower(map, clock, std::move(entry), drift);
  BranchState there = follower.state();
  double along = 0;                   // on the piece that holds the arc
  constexpr double same_arc = 1e-12;  // m, what round-off leaves of one over some pieces
  while (arc > start.arc) {
    const Piece piece = follower.end_of_piece(plan.from, plan.to);
    if (piece.end == BranchEnd::unresolved)
      throw PointRefused(fmt::format("the branch was lost at an arc of {} m: {}", follower.state().arc, piece.why));
    along = std::clamp(arc - follower.state().arc, 0.0, piece.length);
    there = follower.at(along);
    // At a corner multipliers are those of the piece behind it, as rows have them.
    if (arc - follower.state().arc < piece.length - same_arc || piece.end != BranchEnd::none) break;
    if (follower.state().pieces > plan.most_pieces) throw PointRefused("the arc is not come to on this branch");
    follower.go(piece);
  }
  BranchPoint point;
  point.multipliers = multipliers_of(map, clock, follower.derivative());
  const SetSequence& sets = follower.state().sets;
  PeriodicMap::Measures measures = follower.measures();
  for (std::size_t k = 0; k < measures.value.size(); ++k) measures.value[k] += along * measures.slope[k];
  point.half_step = roots_at(multipliers_of(
      map, clock, half_step_derivative(map, follower.derivative(), sets, clock, there.parameter, measures)));
  const long long pieces = follower.state().pieces;
  point.way = pieces == 0 && along == 0 ? "a kept orbit"
                                        : fmt::format("on piece {} behind the kept orbit at an arc of {} m", pieces + 1,
                                                      csv_number(start.arc));
  point.residual = map.metric().size(map.march(there.x, there.parameter, clock).image - there.x);
  point.x = std::move(there.x);
  point.parameter = there.parameter;
  return point;
}

BranchPoint by_steps(SteppedMap& map, const ContinuationPlan& plan, const MapClock& clock, const KeptStarts& kept,
                     double arc) {
  BranchPoint point;
  point.x = kept.at->x;
  point.parameter = kept.at->parameter;
  point.way = "a kept orbit";
  if (arc > kept.at->arc && kept.next) {
    ArcSteps limits;
    limits.branch.least = plan.from;
    limits.branch.largest = plan.to;
    limits.tolerance = round_offs * round_off_of_map(map, point.x, point.parameter, clock);
    StepFollower follower(map, clock, point.x, point.parameter, 1, limits);
    ShotOrbit shot = follower.towards(kept.next->x, kept.next->parameter, arc - kept.at->arc);
    if (!shot.found)
      throw PointRefused(fmt::format("no orbit was found there within {} iterations, between the rows at {} and {} m",
                                     shot.iterations, csv_number(kept.at->arc), csv_number(kept.next->arc)));
    point.x = std::move(shot.x);
    point.parameter = shot.parameter;
    point.way = fmt::format("{} iterations from the rows at {} and {} m", shot.iterations, csv_number(kept.at->arc),
                            csv_number(kept.next->arc));
  }
  const QuietOrbit quiet = quiet_orbit(map, point.x, point.parameter, clock);
  const SteppedMap::Image made = map.march(quiet.x, point.parameter, quiet.clock, true);
  if (made.end) throw PointRefused("the orbit cannot be marched: " + text(made.end));
  point.multipliers = multipliers_of(made.derivative);
  point.residual = map.metric().size(made.image - quiet.x);
  return point;
}

std::string complex_text(const std::complex<double>& value) {
  if (value.imag() == 0) return csv_number(value.real());
  return fmt::format("{} {} {}i", csv_number(value.real()), value.imag() < 0 ? "-" : "+",
                     csv_number(std::abs(value.imag())));
}

class PointWriter {
 public:
  PointWriter(const BranchRow& row, const BranchPoint& point, const BranchMotion& made, int steps_per_period,
              double pulsation)
      : row_(row), point_(point), made_(made), steps_(steps_per_period), pulsation_(pulsation) {}

  std::string facts(const std::string& pointer, double arc, int most) const {
    const OrbitMotion& motion = made_.motion;
    TextTable table({"", "", ""});
    const auto put = [&](std::string name, std::string value, std::string more = "") {
      table.add({std::move(name), std::move(value), std::move(more)});
    };
    put("arc", csv_number(arc), "m");
    put("parameter", csv_number(point_.parameter), pointer);
    put("tip displacement", csv_number(motion.displacement.front()), "m");
    put("tip velocity", csv_number(motion.velocity.front()), "m/s");
    put("period", fmt::format("{}", row_.period), row_.period == 1 ? "forcing period" : "forcing periods");
    put("symmetric", row_.symmetric.value_or(false) ? "yes" : "no");
    const int outside = ricochet::outside(point_.multipliers).total;
    put("stability", outside == 0 ? "stable" : "unstable", fmt::format("{} outside the unit circle", outside));
    const char* of = row_.symmetric.value_or(false) ? "of half a period" : "";
    for (std::size_t k = 0; k < point_.multipliers.size() && k < static_cast<std::size_t>(most); ++k)
      put(fmt::format("multiplier {}", k + 1), complex_text(point_.multipliers[k]),
          fmt::format("modulus {:.6g} {}", std::abs(point_.multipliers[k]), of));
    if (point_.half_step && point_.half_step->real != 0)
      put("half-step rule", csv_number(point_.half_step->real), "the real one nearest -1");
    if (point_.half_step && point_.half_step->modulus != 0)
      put("half-step rule", complex_text(std::polar(point_.half_step->modulus, point_.half_step->angle)),
          fmt::format("the pair nearest the circle, modulus {:.6g}", point_.half_step->modulus));
    const auto runs = static_cast<double>(motion.runs.size());
    put("impacts per period", csv_number(runs / row_.period));
    put("penetration", csv_number(motion.penetration), "m");
    put("residual", fmt::format("{:.3g}", point_.residual), "m");
    return table.text(2);
  }

  std::string runs() const {
    if (made_.motion.runs.empty()) return "  no contact\n";
    TextTable table({"stop", "name", "x (m)", "begin (step)", "end (step)", "begin (rad)", "end (rad)",
                     "length (steps)", "length (s)", "impulse (N s)"});
    const double h = 2 * std::numbers::pi / (pulsation_ * steps_), turn = 2 * std::numbers::pi * row_.period;
    const auto steps = static_cast<long long>(row_.period) * steps_;
    for (const ContactRun& run : made_.motion.runs) {
      const auto at = static_cast<std::size_t>(run.point);
      // Pushed from the beginning of its first step to the end of its last.
      const auto phase = [&](long long step) {
        return fmt::format("{:.6f}", turn * static_cast<double>(step) / static_cast<double>(steps));
      };
      const long long last = (run.begin + run.steps - 2) % steps + 1;
      table.add({run.upper ? "upper" : "lower", at < made_.stops.size() ? made_.stops[at] : "",
                 at < made_.x.size() ? csv_number(made_.x[at]) : "", fmt::format("{}", run.begin),
                 fmt::format("{}", last), phase(run.begin - 1), phase(last), fmt::format("{}", run.steps),
                 fmt::format("{:.6g}", h * static_cast<double>(run.steps)), fmt::format("{:.6g}", run.impulse)});
    }
    return table.text(2);
  }

  std::string csv() const {
    const OrbitMotion& motion = made_.motion;
    std::string out = "t,tip_displacement,tip_velocity,contact_force\n";
    for (std::size_t k = 0; k < motion.time.size(); ++k) {
      const double columns[] = {motion.time[k], motion.displacement[k], motion.velocity[k], motion.force[k]};
      for (const double value : columns) {
        append_csv_number(value, out);
        out += ',';
      }
      out.back() = '\n';
    }
    return out;
  }

 private:
  const BranchRow& row_;
  const BranchPoint& point_;
  const BranchMotion& made_;
  int steps_;
  double pulsation_;
};

std::filesystem::path csv_file(const std::filesystem::path& folder, const std::string& id, const PointRequest& asked) {
  if (asked.out) return *asked.out;
  std::string name = fmt::format("{}_{}_{}.csv", id, asked.branch, csv_number(*asked.arc));
  for (char& letter : name)
    if (letter == '/' || letter == '\\') letter = '_';
  const std::filesystem::path beside = folder / "points";
  std::error_code ignored;
  std::filesystem::create_directories(beside, ignored);
  return beside / name;
}

/// What is asked for lies on the branch, and the case has kept states of it.
KeptStarts starts_of(const CaseRecord& record, const PointRequest& asked, const std::vector<BranchRow>& rows) {
  const double arc = *asked.arc, first = rows.front().arc.value_or(0), last = rows.back().arc.value_or(0);
  if (!(arc >= first && arc <= last))
    throw PointRefused(fmt::format("--arc {}: the branch {} goes from {} to {} m", csv_number(arc), asked.branch,
                                   csv_number(first), csv_number(last)));
  KeptStarts kept = kept_starts(record, asked.branch, arc);
  if (!kept.at)
    throw PointRefused(fmt::format("the case {} keeps no states of the branch {}: run the study again with --fresh",
                                   record.id, asked.branch));
  return kept;
}

void keep_film(const SnapshotTaker& film, const PointRequest& asked, const CaseRecord& record, std::ostream& out) {
  Snapshots shots = film.finish();
  shots.of = fmt::format("{} at an arc of {} m", asked.branch, csv_number(*asked.arc));
  keep_numbers(asked.folder, record.id, table_of(shots));
  out << fmt::format("its film is kept beside the case: {} instants; `ricochet report {}` shows it\n", shots.t.size(),
                     asked.folder.string());
}

}  // namespace

int solve_branch_point(const StudyResults& results, const PointRequest& asked, std::ostream& out) {
  if (asked.branch.empty() || !asked.arc || asked.marches())
    throw PointRefused(
        "this is a study of kind continuation; expected --branch NAME and --arc S, as in "
        "branches.csv");
  const double arc = *asked.arc;
  const CaseRecord& record = find_case(results, asked.case_id);
  const std::vector<BranchRow> rows = branch_named(record, asked.branch);
  const KeptStarts kept = starts_of(record, asked, rows);
  const StoredStudy stored(results, asked.plugins);
  const StudyCase& study_case = stored.find(record.id);
  const ContinuationPlan plan = continuation_plan(study_case.settings);
  ContinuedMap continued(study_case, stored.registry, plan);
  if (!continued.refusal().empty()) throw PointRefused(continued.refusal().text);
  const MapClock clock{study_case.steps_per_period, rows.front().period, rows.front().symmetric.value_or(false)};
  const auto check = [&](int size) {
    if (size != kept.at->x.size())
      throw PointRefused(fmt::format("a stored state has {} numbers, expected {}: run the study again with --fresh",
                                     kept.at->x.size(), size));
  };
  std::unique_ptr<PeriodicMap> map;
  std::unique_ptr<SteppedMap> stepped;
  BranchPoint point;
  Marcher* marcher = nullptr;
  std::optional<Marcher> own;
  LaneSpec lane;
  if (continued.by_pieces()) {
    map = continued.map();
    check(map->size());
    point = by_pieces(*map, plan, clock, *kept.at, arc);
    marcher = &map->begin(point.x, point.parameter);
    lane = map->lanes().lane(point.parameter);
  } else {
    stepped = std::make_unique<SteppedMap>(continued.stepped_map(continued.reference_at()));
    check(stepped->size());
    point = by_steps(*stepped, plan, clock, kept, arc);
    own.emplace(stepped->begin(point.x, point.parameter).first);
    marcher = &*own;
    lane = LaneSpec(own->program().lanes[0]);
  }
  const long long steps = static_cast<long long>(clock.period) * clock.steps_per_period;
  SnapshotTaker film(study_case.scene, *marcher, lane, marcher->position(0), steps, asked.snapshots);
  const BranchMotion made = branch_motion(*marcher, lane, steps, film.taken() ? &film : nullptr);
  if (made.motion.end) throw PointRefused("the orbit cannot be marched: " + text(made.motion.end));

  const BranchRow& row =
      *std::find_if(rows.rbegin(), rows.rend(), [&](const BranchRow& one) { return *one.arc <= arc; });
  const double omega = 2 * std::numbers::pi / (marcher->program().h * clock.steps_per_period);
  const PointWriter writer(row, point, made, clock.steps_per_period, omega);
  out << fmt::format("orbit of the branch {}, case {} of {}: {}\n", asked.branch, record.id, results.name, point.way)
      << writer.facts(plan.pointer, arc, plan.multipliers) << "\ncontact runs:\n"
      << writer.runs();
  const std::filesystem::path file = csv_file(asked.folder, record.id, asked);
  write_file(file, writer.csv());
  out << "\nits period, step by step: " << file.string() << "\n";
  if (film.taken()) keep_film(film, asked, record, out);
  return 0;
}

}  // namespace ricochet
