// Branches of a case, their rows, and what becomes of a case that is stopped.
#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <ricochet/measure/orbits/branch.hpp>

#include "runners/kinds/bifurcation/bifurcation.hpp"
#include "runners/kinds/sweep/orbit_rows.hpp"
#include "tests/runners/kinds/continuation/tube_study.hpp"
#include "tests/runners/kinds/sweep/sweep_case.hpp"

using namespace ricochet;
using namespace ricochet::testing;

TEST_CASE("an orbit at a given value is that of a bifurcation study") {
  Json study = tube_continuation();
  study["follow"] = "none";
  const CaseRecord record = continued(study);
  REQUIRE(record.status == Status::done);
  const auto rows = rows_of(record);
  REQUIRE(rows.size() == 1);
  CHECK(*rows[0].residual < 1e-12);
  Json sweep = beam_sweep({0.085});
  sweep["scene"] = study["scene"];
  sweep["mesh"] = study["mesh"];
  sweep["transient"] = {{"periods", 400}, {"at_most", 400}};
  const OpenedSweep opened = opened_sweep(sweep);
  const std::atomic<bool> stop{false};
  const CaseRecord marched = run_bifurcation(opened.first(), *opened.registry, {}, stop);
  const auto values = orbits_of(marched);
  REQUIRE(values.size() == 1);
  if (values[0].regime != "periodic" || values[0].period != 1) return;
  const auto strobes = orbit_numbers(marched, points_type(), &SectionColumns::displacement, 0.085, "rest");
  REQUIRE_FALSE(strobes.empty());
  CHECK(std::abs(strobes.back() - *rows[0].tip_displacement) < 1e-9);
}

TEST_CASE("every row of a branch is an orbit, and rows go on from each other") {
  const CaseRecord record = continued(tube_continuation());
  REQUIRE(record.status == Status::done);
  const auto rows = rows_of(record);
  REQUIRE(rows.size() > 10);
  std::map<std::string, double> arcs;
  for (const BranchRow& row : rows) {
    INFO(row.branch << " " << row.row);
    CHECK(*row.residual < 1e-11);
    CHECK(*row.parameter >= 0.07 - 1e-12);
    CHECK(*row.parameter <= 0.09 + 1e-12);
    if (const auto last = arcs.find(row.branch); last != arcs.end()) CHECK(*row.arc >= last->second);
    arcs[row.branch] = *row.arc;
  }
  CHECK(arcs.size() == 2);
  const auto points = points_of(record);
  CHECK(std::count_if(points.begin(), points.end(), [](const SpecialRow& one) { return one.kind == PointKind::end; }) ==
        2);
}

TEST_CASE("orbits that touch nothing have the multipliers of their free motion, whatever efforts a scheme keeps") {
  Json study = Json::parse(R"json({
    "name": "free", "kind": "continuation",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "damping": 0.08,
                            "force": {"amplitude": 0.6, "pulsation": 1}},
              "stops": {"upper": 1.2, "at": "tip"}},
    "methods": {"mass": "consistent", "contact": {"name": "penalty", "stiffness": 30, "evaluation": "averaged"},
                "time": "moreau-jean"},
    "parameter": {"pointer": "/scene/structure/force/pulsation", "from": 0.6, "to": 0.75},
    "steps_per_period": 100, "orbits": [{"at": 0.65, "from": "rest", "periods": 200}]})json");
  for (const char* time : {"moreau-jean", "newmark-dumont-paoli", "generalised-alpha"}) {
    INFO(time);
    study["methods"]["time"] = time;
    const CaseRecord record = continued(study);
    REQUIRE(record.status == Status::done);
    const auto rows = rows_of(record);
    REQUIRE(rows.size() > 4);
    // e^{(−ζ ± i√(1−ζ²)) 2π/ω}, ζ = 0.04, to what the scheme damps and turns it by.
    const double period = 2 * std::numbers::pi / *rows.front().parameter;
    CHECK(std::abs(rows.front().multipliers.front().value()) == Approx(std::exp(-0.04 * period)).epsilon(0.02));
  }
}

TEST_CASE("marks are solved where they are asked for, and a branch stops where the study says") {
  Json study = tube_continuation();
  study["mark"] = {{"parameter", {0.0852}}};
  study["stop_at"] = "contact";
  study["both_ways"] = false;
  const CaseRecord record = continued(study);
  const auto points = points_of(record);
  REQUIRE_FALSE(points.empty());
  CHECK(points.back().kind == PointKind::end);
  const auto mark =
      std::find_if(points.begin(), points.end(), [](const SpecialRow& one) { return one.kind == PointKind::mark; });
  REQUIRE(mark != points.end());
  CHECK(*mark->parameter == 0.0852);
  const auto rows = rows_of(record);
  const auto row =
      std::find_if(rows.begin(), rows.end(), [](const BranchRow& one) { return *one.parameter == 0.0852; });
  REQUIRE(row != rows.end());
  CHECK(*row->residual < 1e-11);
  CHECK(*row->point == mark->point);
  CHECK(*row->tip_displacement == Approx(*mark->tip_displacement).margin(1e-14));
  const auto contacts =
      std::count_if(points.begin(), points.end(), [](const SpecialRow& one) { return one.kind == PointKind::contact; });
  CHECK(contacts <= 1);
}

TEST_CASE("a branch that was stopped and goes on has the rows of one that was not") {
  Json study = tube_continuation();
  study["follow"] = GENERATE("pieces", "steps");
  if (study["follow"] == "steps") study["at_most"] = {{"pieces", 12}};
  const CaseRecord whole = continued(study);
  const OpenedContinuation opened = opened_continuation(study);
  std::map<std::string, std::string> kept;
  CaseContext context;
  context.key = "tube";
  context.checkpoints.find = [&](const std::string& key) {
    const auto found = kept.find(key);
    return found == kept.end() ? std::string() : found->second;
  };
  context.checkpoints.keep = [&](const std::string& key, const std::string& content) {
    if (content.empty())
      kept.erase(key);
    else
      kept[key] = content;
  };
  // Stopped at once: one batch of pieces, or one step, is made, and kept; one of each branch.
  const std::atomic<bool> stop{true};
  for (int times = 0; times < 2; ++times) {
    CHECK_THROWS_AS(run_continuation(opened.study.cases.front(), *opened.registry, context, stop), Interrupted);
    CHECK_FALSE(kept.empty());
  }
  const std::atomic<bool> go_on{false};
  const CaseRecord resumed = run_continuation(opened.study.cases.front(), *opened.registry, context, go_on);
  CHECK(kept.empty());
  REQUIRE(resumed.tables.size() == whole.tables.size());
  for (std::size_t t = 0; t < whole.tables.size(); ++t) {
    REQUIRE(resumed.tables[t].rows.size() == whole.tables[t].rows.size());
    for (std::size_t r = 0; r < whole.tables[t].rows.size(); ++r) {
      bool same = true;
      for (std::size_t c = 0; c < whole.tables[t].rows[r].size(); ++c)
        same = same && resumed.tables[t].rows[r][c].text() == whole.tables[t].rows[r][c].text();
      CHECK(same);
    }
  }
}

namespace {

Json oscillator_continuation(const std::string& time) {
  Json study = Json::parse(R"({
    "name": "oscillator", "kind": "continuation",
    "scene": {
      "structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "damping": 0.04,
                    "force": {"amplitude": 0.5, "pulsation": 1.3}},
      "stops": {"upper": 1, "at": "tip"}
    },
    "methods": {"mass": "consistent", "contact": {"name": "penalty", "stiffness": 30}},
    "steps_per_period": 2000,
    "parameter": {"pointer": "/scene/structure/force/amplitude", "from": 0.3, "to": 1.0},
    "orbits": [{"at": 0.5, "from": "free"}], "both_ways": false,
    "switch": null, "at_most": {"arc": 10}
  })");
  study["methods"]["time"] = Json::parse(time);
  return study;
}

}  // namespace

TEST_CASE("the bilinear oscillator folds where event-driven shooting says") {
  const CaseRecord record = continued(oscillator_continuation(R"({"name": "newmark-dumont-paoli", "beta": 0.25})"));
  REQUIRE(record.status == Status::done);
  const auto points = points_of(record);
  REQUIRE(points.size() >= 2);
  // Without contact x = F / √((1 − ω²)² + (cω)²), 1 m at the graze.
  CHECK(points[0].note == "first contact");
  CHECK(*points[0].parameter == Approx(std::hypot(1 - 1.69, 0.04 * 1.3)).margin(1e-5));
  CHECK(points[1].kind == PointKind::fold);
  // Second order in h: 5e-5 N at 500 steps, 2.7e-6 N here.
  CHECK(std::abs(*points[1].parameter - 0.6921345) < 4e-6);
}

TEST_CASE("steps and pieces follow one branch: the same marks, folds and first contact") {
  Json study = oscillator_continuation(R"({"name": "newmark-dumont-paoli", "beta": 0.25})");
  study["steps_per_period"] = 500;
  study["mark"] = {{"parameter", {0.66, 0.7, 0.8, 1.0}}};
  std::map<std::string, std::vector<SpecialRow>> found;
  for (const char* follow : {"pieces", "steps"}) {
    study["follow"] = follow;
    const CaseRecord record = continued(study);
    REQUIRE(record.status == Status::done);
    for (const SpecialRow& point : points_of(record))
      if (point.kind != PointKind::end) found[follow].push_back(point);
  }
  REQUIRE(found["pieces"].size() == found["steps"].size());
  for (std::size_t i = 0; i < found["pieces"].size(); ++i) {
    const SpecialRow &piece = found["pieces"][i], &step = found["steps"][i];
    INFO(word(piece.kind) << " at " << *piece.parameter);
    CHECK(step.kind == piece.kind);
    if (piece.kind == PointKind::mark) {
      CHECK(*step.parameter == *piece.parameter);
      CHECK(*step.tip_displacement == Approx(*piece.tip_displacement).margin(1e-9));
    } else {  // between two orbits of the curve
      CHECK(*step.parameter == Approx(*piece.parameter).margin(2e-3));
    }
  }
}

TEST_CASE("steps turn the corners of a piecewise affine map, and stay on its branch") {
  Json study = tube_continuation();
  const std::vector<BranchRow> pieces = rows_of(continued(study));
  study["follow"] = "steps";
  study["at_most"] = {{"pieces", 1000}};
  const CaseRecord record = continued(study);
  for (const SpecialRow& point : points_of(record))
    if (point.kind == PointKind::end) CHECK(point.note.starts_with("the range ends at "));
  for (const BranchRow& row : rows_of(record)) {
    double nearest = 1;
    for (std::size_t i = 1; i < pieces.size(); ++i) {
      const double a = *pieces[i - 1].parameter, b = *pieces[i].parameter, at = *row.parameter;
      if (pieces[i].branch != pieces[i - 1].branch || (at - a) * (at - b) > 0 || a == b) continue;
      const double ta = *pieces[i - 1].tip_displacement, tb = *pieces[i].tip_displacement;
      nearest = std::min(nearest, std::abs(ta + (tb - ta) * (at - a) / (b - a) - *row.tip_displacement));
    }
    INFO(row.branch << " " << *row.parameter);
    CHECK(nearest < 1e-9);
  }
}

TEST_CASE("an oscillator that rebounds flips near to where Shaw and Holmes found it, and the interval says how near") {
  Json study = Json::parse(R"({
    "name": "rebound", "kind": "continuation",
    "scene": {
      "structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "damping": 0,
                    "force": {"amplitude": 1, "pulsation": 2.5}},
      "stops": {"upper": 0, "at": "tip"}
    },
    "methods": {"mass": "consistent", "contact": "signorini",
                "time": {"name": "newmark-dumont-paoli", "restitution": 0.8}},
    "steps_per_period": 8000,
    "parameter": {"pointer": "/scene/structure/force/pulsation", "from": 2.5, "to": 2.7},
    "orbits": [{"at": 2.6, "periods": 200}], "both_ways": false,
    "at_most": {"pieces": 60}
  })");
  const CaseRecord record = continued(study);
  REQUIRE(record.status == Status::done);
  const auto points = points_of(record);
  const auto flip =
      std::find_if(points.begin(), points.end(), [](const SpecialRow& one) { return one.kind == PointKind::flip; });
  REQUIRE(flip != points.end());
  CHECK(*flip->parameter == Approx(2.653347728).margin(3e-4));
  CHECK(*flip->low <= 2.653347728);
  CHECK(*flip->high >= 2.653347728);
  CHECK(flip->note.find("not exact") != std::string::npos);
}

TEST_CASE("where symmetry is lost a branch of other orbits begins, and it ends where they are symmetric again") {
  Json study = tube_continuation();
  study["mesh"]["elements"] = 10;
  study["steps_per_period"] = 2000;
  study["parameter"] = Json::parse(R"({"pointer": "/scene/support/amplitude", "from": 0.0799, "to": 0.0912})");
  study["orbits"] = Json::parse(R"([{"at": 0.08, "periods": 300}])");
  study["both_ways"] = false;
  study["switch"] = "symmetry";
  study["at_most"] = {{"pieces", 500}};
  const CaseRecord record = continued(study);
  REQUIRE(record.status == Status::done);
  std::string others;
  for (const SpecialRow& point : points_of(record))
    if (point.kind == PointKind::symmetry) others += " " + point.to_branch;
  REQUIRE(others.size() > 1);
  int asymmetric = 0;
  for (const BranchRow& row : rows_of(record)) {
    if ((others + " ").find(" " + row.branch + " ") == std::string::npos) continue;
    ++asymmetric;
    CHECK_FALSE(*row.symmetric);
    CHECK(*row.residual < 1e-10);
  }
  CHECK(asymmetric > 10);
  bool met = false;
  for (const SpecialRow& point : points_of(record))
    met = met || point.note.starts_with("its orbits become their own images");
  CHECK(met);
}

TEST_CASE("an orbit that is not found fails its case, whose other orbits are followed") {
  Json study = tube_continuation();
  study["orbits"] = Json::parse(R"([{"at": 0.085, "periods": 100}, {"at": 0.085, "periods": 100, "period": 2}])");
  for (const char* follow : {"pieces", "steps"}) {
    study["follow"] = follow;
    study["at_most"] = {{"pieces", 3}};
    const CaseRecord record = continued(study);
    const auto points = points_of(record);
    const auto missing =
        std::find_if(points.begin(), points.end(), [](const SpecialRow& one) { return one.branch == "orbit-2"; });
    REQUIRE(missing != points.end());
    CHECK(record.status == Status::failed);
    CHECK(record.reason() == missing->note);
    CHECK(record.reason() == "the orbit found from rest at λ = 0.085 repeats after 1 period; expected period 2");
    CHECK_FALSE(rows_of(record).empty());
  }
}

TEST_CASE("an orbit of a bifurcation study that is not there is a row that says so, and others are followed") {
  Json study = tube_continuation();
  study["orbits"].push_back(study["orbits"][0]);
  study["orbits"][0]["from"] = {{"study", "/nowhere"}, {"case", "ab"}, {"parameter", 0.085}, {"start", "rest"}};
  study["at_most"] = {{"pieces", 3}};
  const CaseRecord record = continued(study);
  CHECK(record.status == Status::failed);
  CHECK(record.reason().find("/nowhere: there is no results.sqlite") != std::string::npos);
  CHECK(points_of(record).front().note == record.reason());
  CHECK_FALSE(rows_of(record).empty());
}

TEST_CASE("a branch of doubled orbits ends where they repeat sooner") {
  Json study = oscillator_continuation(R"({"name": "newmark-dumont-paoli", "beta": 0.25})");
  study["scene"]["structure"]["force"]["pulsation"] = 2.6;
  study["steps_per_period"] = 1000;
  study["parameter"]["from"] = 5.75;
  study["parameter"]["to"] = 5.77;
  study["orbits"][0]["at"] = 5.755;
  study["switch"] = "flip";
  const auto points = points_of(continued(study));
  const auto end = std::find_if(points.begin(), points.end(), [](const SpecialRow& one) {
    return one.note.starts_with("its orbits repeat after 1 period from");
  });
  REQUIRE(end != points.end());
  // That is the flip at which it began.
  const auto flip =
      std::find_if(points.begin(), points.end(), [](const SpecialRow& one) { return one.kind == PointKind::flip; });
  REQUIRE(flip != points.end());
  CHECK(*end->parameter >= *flip->low);
  CHECK(*end->parameter <= *flip->high);
}

TEST_CASE("roots of the step on displacements without mass are no multipliers") {
  Json study = tube_continuation();
  study["scene"]["structure"]["damping"] = {{"mass", 2}};
  study["orbits"] = Json::parse(R"([{"at": 0.075, "from": "free"}])");
  for (const int steps : {200, 202}) {
    if (steps == 202) study["scene"]["stops"]["lower"] = nullptr;
    study["steps_per_period"] = steps;
    study["at_most"] = {{"pieces", 1}};
    // All modes are damped, those that the step does not resolve by a few percent; what is left out has 1.
    for (const BranchRow& row : rows_of(continued(study)))
      if (row.contact_runs == 0) CHECK(std::abs(*row.multipliers.at(0)) < 0.99);
  }
}

TEST_CASE("roots of the step alone make no flip, and no branch leaves the range") {
  // i⁴⁰² = −1 on the tip without mass: that is no multiplier of the motion.
  Json study = tube_continuation();
  study["scene"]["structure"]["damping"] = {{"mass", 2}};
  study["scene"]["stops"]["lower"] = nullptr;
  study["mesh"]["elements"] = 6;
  study["steps_per_period"] = 402;
  study["orbits"] = Json::parse(R"([{"at": 0.079, "from": "free"}])");
  study["switch"] = "flip";
  study["at_most"] = {{"pieces", 100}};
  const CaseRecord record = continued(study);
  for (const BranchRow& row : rows_of(record)) {
    CHECK(*row.parameter >= 0.07);
    CHECK(*row.parameter <= 0.09);
  }
  const auto points = points_of(record);
  CHECK(std::none_of(points.begin(), points.end(), [](const SpecialRow& one) { return one.kind == PointKind::flip; }));
  CHECK(std::count_if(points.begin(), points.end(), [](const SpecialRow& one) { return one.kind == PointKind::end; }) ==
        2);
}

TEST_CASE("a step of several stages that read contact is followed by steps, and its rows are orbits") {
  Json study = tube_continuation();
  study["methods"] = Json::parse(R"({"mass": "consistent", "contact": {"name": "penalty", "stiffness": 1e4},
                                     "time": "bathe"})");
  study["at_most"] = {{"pieces", 3}};
  const CaseRecord record = continued(study);
  CHECK(record.status == Status::done);
  CHECK(std::any_of(record.notes.begin(), record.notes.end(), [](const std::string& note) {
    return note.find("several of its stages read contact") != std::string::npos;
  }));
  for (const BranchRow& row : rows_of(record)) CHECK(*row.residual < 1e-10);
}
