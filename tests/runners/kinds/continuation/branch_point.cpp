// An orbit of a branch that is solved again: its row, its neighbours, its motion.
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "runners/kinds/bifurcation/bifurcation.hpp"
#include "runners/kinds/continuation/branch_orbits.hpp"
#include "runners/kinds/continuation/continuation.hpp"
#include "runners/kinds/sweep/orbit_rows.hpp"
#include "runners/run/study_cases.hpp"
#include "tests/places.hpp"
#include "tests/runners/kinds/continuation/tube_study.hpp"
#include "tests/runners/kinds/sweep/sweep_case.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

struct Solved {
  std::string text;
  std::vector<std::array<double, 4>> period;  // t, tip, velocity, force

  /// The number behind these words.
  double value(const std::string& name) const {
    const auto at = text.find("\n  " + name + " ");
    REQUIRE(at != std::string::npos);
    return std::stod(text.substr(at + name.size() + 3));
  }
};

/// What a case leaves, as a folder of results holds it.
struct RunResults {
  ScratchFolder here;
  OpenedContinuation opened;
  StudyResults results;

  explicit RunResults(const Json& text) : opened(opened_continuation(text)), results(results_header(opened.study)) {
    ::setenv("RICOCHET_PLUGIN_PATH", tests::places().plugins.c_str(), 1);
    const std::atomic<bool> stop{false};
    results.cases = {run_continuation(opened.study.cases.front(), *opened.registry, {}, stop)};
  }
  PointRequest asked(const std::string& branch, double arc) const {
    PointRequest asked;
    asked.case_id = results.cases.front().id;
    asked.branch = branch;
    asked.arc = arc;
    asked.out = here / "period.csv";
    return asked;
  }
  Solved solve(const std::string& branch, double arc) const {
    std::ostringstream out;
    REQUIRE(solve_branch_point(results, asked(branch, arc), out) == 0);
    Solved solved{out.str(), {}};
    std::ifstream file(here / "period.csv");
    std::string line;
    std::getline(file, line);
    CHECK(line == "t,tip_displacement,tip_velocity,contact_force");
    for (std::array<double, 4> row{}; std::getline(file, line); solved.period.push_back(row)) {
      std::replace(line.begin(), line.end(), ',', ' ');
      std::istringstream(line) >> row[0] >> row[1] >> row[2] >> row[3];
    }
    return solved;
  }
};

}  // namespace

TEST_CASE("an orbit at a row's arc is that row, and its period closes") {
  const RunResults kept(tube_continuation());
  const auto rows = rows_of(kept.results.cases.front());
  REQUIRE(rows.size() > 20);
  for (std::size_t k = 0; k < rows.size(); k += 1 + rows.size() / 15) {
    const BranchRow& row = rows[k];
    INFO(row.branch << " " << row.row << " at " << *row.arc);
    const Solved solved = kept.solve(row.branch, *row.arc);
    CHECK(std::abs(solved.value("parameter") - *row.parameter) < 1e-12);
    CHECK(std::abs(solved.value("tip displacement") - *row.tip_displacement) < 1e-12);
    CHECK(solved.value("impacts per period") == *row.impacts_per_period);
    CHECK(solved.value("residual") < 1e-11);
    // Eigenvalues of products of 100 steps: to the root of round-off where two are close.
    CHECK(solved.value("multiplier 1") == Approx(row.multipliers.front()->real()).margin(1e-6));
    REQUIRE(solved.period.size() == 201);
    CHECK(solved.period.front()[1] == Approx(*row.tip_displacement).margin(1e-12));
    CHECK(solved.period.front()[2] == Approx(*row.tip_velocity).margin(1e-9));
    // Of two half periods the first leaves the residual, the second at most a multiplier times as much.
    const double grows = row.multipliers.front() ? 1 + std::abs(*row.multipliers.front()) : 1;
    CHECK(std::abs(solved.period.back()[1] - solved.period.front()[1]) < 1e-11 * grows);
  }
}

TEST_CASE("between two rows the orbit stands at its arc, whichever state it is followed from") {
  const RunResults kept(tube_continuation());
  const auto rows = rows_of(kept.results.cases.front());
  int between = 0;
  for (std::size_t k = 1; k < rows.size(); k += 1 + rows.size() / 15) {
    const BranchRow &a = rows[k - 1], &b = rows[k];
    if (a.branch != b.branch || *b.arc - *a.arc < 1e-7) continue;
    ++between;
    INFO(a.branch << " " << a.row << " at " << *a.arc);
    const double arc = *a.arc + 0.3 * (*b.arc - *a.arc);
    const Solved solved = kept.solve(a.branch, arc);
    CHECK(solved.value("arc") == arc);
    CHECK(solved.value("residual") < 1e-11);
    // Where one piece joins them the branch is a line.
    if (*b.pieces != 1) continue;
    CHECK(std::abs(solved.value("parameter") - *a.parameter - 0.3 * (*b.parameter - *a.parameter)) < 1e-12);
    CHECK(std::abs(solved.value("tip displacement") - *a.tip_displacement -
                   0.3 * (*b.tip_displacement - *a.tip_displacement)) < 1e-12);
  }
  CHECK(between > 5);
}

TEST_CASE("by steps an orbit at a row's arc is that row, and between two rows the one in the plane there") {
  Json study = tube_continuation();
  study["follow"] = "steps";
  study["parameter"] = {{"pointer", "/scene/support/amplitude"}, {"from", 0.084}, {"to", 0.086}};
  study["at_most"] = {{"pieces", 12}};
  const RunResults kept(study);
  REQUIRE(kept.results.cases.front().status == Status::done);
  const auto rows = rows_of(kept.results.cases.front());
  REQUIRE(rows.size() > 4);
  for (std::size_t k = 0; k < rows.size(); k += 1 + rows.size() / 6) {
    const Solved solved = kept.solve(rows[k].branch, *rows[k].arc);
    INFO(rows[k].branch << " " << rows[k].row);
    CHECK(std::abs(solved.value("parameter") - *rows[k].parameter) < 1e-12);
    CHECK(std::abs(solved.value("tip displacement") - *rows[k].tip_displacement) < 1e-12);
    if (k + 1 == rows.size() || rows[k + 1].branch != rows[k].branch) continue;
    const double share = 0.4, arc = *rows[k].arc + share * (*rows[k + 1].arc - *rows[k].arc);
    const Solved middle = kept.solve(rows[k].branch, arc);
    CHECK(middle.value("residual") < 1e-11);
    const double a = *rows[k].parameter, b = *rows[k + 1].parameter;
    // The secant is off by its curvature: less than a tenth of a step.
    CHECK(std::abs(middle.value("parameter") - (a + share * (b - a))) < 0.1 * std::abs(b - a) + 1e-9);
  }
}

TEST_CASE("a stable orbit that is solved is the one that a bifurcation study marches, at any phase") {
  Json study = tube_continuation();
  study["follow"] = "none";
  const RunResults kept(study);
  const auto rows = rows_of(kept.results.cases.front());
  REQUIRE(rows.size() == 1);
  const Solved solved = kept.solve(rows[0].branch, 0);
  Json sweep = beam_sweep({0.085});
  sweep["scene"] = study["scene"];
  sweep["mesh"] = study["mesh"];
  sweep["transient"] = {{"periods", 400}, {"at_most", 400}};
  for (const int step : {0, 50, 130}) {
    sweep["phase"] = 2 * 3.14159265358979323846 * step / 200;
    const OpenedSweep opened = opened_sweep(sweep);
    REQUIRE(opened.first().steps_per_period == 200);
    const std::atomic<bool> stop{false};
    const CaseRecord marched = run_bifurcation(opened.first(), *opened.registry, {}, stop);
    const auto strobes = orbit_numbers(marched, points_type(), &SectionColumns::displacement, 0.085, "rest");
    REQUIRE_FALSE(strobes.empty());
    REQUIRE(orbits_of(marched).front().regime == "periodic");
    CHECK(std::abs(strobes.back() - solved.period[static_cast<std::size_t>(step)][1]) < 1e-9);
  }
}

TEST_CASE("what is asked of a branch in vain names what there is") {
  const RunResults kept(tube_continuation());
  const auto rows = rows_of(kept.results.cases.front());
  const auto refused = [&](const PointRequest& asked) {
    std::ostringstream out;
    try {
      solve_branch_point(kept.results, asked, out);
    } catch (const PointRefused& why) {
      CHECK(out.str().empty());
      return std::string(why.what());
    }
    return std::string("nothing");
  };
  using Catch::Matchers::Contains;
  CHECK_THAT(refused(kept.asked("orbit-1*", 0)), Contains("did you mean \"orbit-1"));
  CHECK_THAT(refused(kept.asked("orbit-1+", -1)), Contains("--arc -1: the branch orbit-1+ goes from 0 to "));
  CHECK_THAT(refused(kept.asked("orbit-1+", 1e9)), Contains("goes from 0 to "));
  CHECK_THAT(refused(kept.asked("orbit-1+", NAN)), Contains("goes from 0 to "));
  PointRequest other = kept.asked("orbit-1+", 0);
  other.case_id = "zz";
  CHECK_THAT(refused(other), Contains("there is no case \"zz\""));
  other = kept.asked("", 0);
  other.parameter = 0.08;
  CHECK_THAT(refused(other), Contains("kind continuation; expected --branch NAME and --arc S"));
}

TEST_CASE("a case draws at most sixty orbits of a branch, special points among them") {
  const RunResults kept(tube_continuation());
  const CaseRecord& record = kept.results.cases.front();
  const NumberTable *portraits = branch_portraits_type().find(record.numbers),
                    *samples = branch_samples_type().find(record.numbers);
  REQUIRE(portraits);
  REQUIRE(samples);
  const BranchPortraitColumns of = branch_portraits_type().read(*portraits);
  const auto& names = *portraits->words_of("branch");
  double total = 0;
  for (std::size_t b = 0; b < names.size(); ++b) {
    std::size_t count = 0;
    for (std::size_t k = 0; k < portraits->rows(); ++k) count += (*of.branch)[k] == static_cast<double>(b);
    CHECK(count > 10);
    CHECK(count <= most_branch_portraits);
  }
  for (const double one : *of.samples) total += one;
  CHECK(total == static_cast<double>(samples->rows()));
  for (const double bound : *of.upper) CHECK(bound == 0.1);
  for (const SpecialRow& point : points_of(record)) {
    if (point.kind != PointKind::end && point.kind != PointKind::fold) continue;
    INFO(point.branch << " " << point.point);
    const auto rows = rows_of(record);
    bool drawn = false;
    for (std::size_t k = 0; k < portraits->rows(); ++k)
      for (const BranchRow& row : rows)
        drawn =
            drawn || (row.branch == names[static_cast<std::size_t>((*of.branch)[k])] && row.branch == point.branch &&
                      static_cast<double>(row.row) == (*of.row)[k] && row.point == point.point);
    CHECK(drawn);
  }
}
