// Kinds convergence and work-precision end to end: references, errors, orders, timing, and what is refused.
#include "runners/kinds/comparison/comparison.hpp"

#include <SQLiteCpp/Database.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "runners/kinds/comparison/references.hpp"
#include "runners/kinds/trajectory/trajectory.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/run/finish_run.hpp"
#include "runners/run/run_study.hpp"
#include "runners/store/store.hpp"
#include "runners/study/load_study.hpp"
#include "runners/table/table_reader.hpp"
#include "tests/places.hpp"
#include "tests/refusals.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;

namespace {

Json oscillator(const std::string& kind) {
  Json study = Json::parse(R"({
    "name": "small",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 4},
              "stops": {"upper": 0.7, "at": "tip"},
              "initial": {"displacement": 0.5, "velocity": 1}},
    "methods": {"mass": "consistent", "contact": "signorini",
                "time": [{"name": "moreau-jean", "theta": 0.5, "restitution": 0.5}]},
    "step": [0.02, 0.01, 0.005, 0.0025, 0.00125], "duration": 2, "samples": 40,
    "reference": ["exact"]
  })");
  study["kind"] = kind;
  return study;
}

struct Run {
  ScratchFolder folder;
  Catalogue catalogue{tests::places().plugins, {}, {}};
  Registry registry;
  int go(const Json& text) {
    const Study study = parse_study(text.dump(), catalogue, registry);
    return run_study(study, catalogue, registry, {folder.path(), 2, false});
  }
  StudyResults results() const { return with_tables(read_store(folder.path())); }
};

const Table& table(const StudyResults& results, const std::string& name) {
  for (const Table& one : results.derived)
    if (one.name == name) return one;
  FAIL("no table " << name);
  return results.derived.front();
}

const Cell& cell(const Table& from, const Row& row, const std::string& column) {
  return row[TableReader(from).column(column)];
}

std::string problem_of(const Json& study) {
  Run run;
  return testing::input_error([&] { run.go(study); });
}

}  // namespace

TEST_CASE("convergence: without contact an exact reference confirms the declared order") {
  Run run;
  Json study = oscillator("convergence");
  study["methods"]["contact"] = "none";
  study["errors"] = {"tip-linf", "energy"};
  CHECK(run.go(study) == 0);
  const StudyResults results = run.results();
  const Table& orders = table(results, "orders");
  REQUIRE(orders.rows.size() == 2);
  for (const auto& row : orders.rows) {
    CHECK(cell(orders, row, "refined") == "step");
    CHECK(cell(orders, row, "order").number().value() == Approx(2).margin(0.05));
    CHECK(cell(orders, row, "declared") == 2);
    CHECK(cell(orders, row, "verdict") == "confirmed");
  }
  const Table& errors = table(results, "errors");
  CHECK(errors.rows.size() == 10);  // five steps, two errors
  CHECK(errors.columns.back().name == "floor");
  CHECK(std::filesystem::exists(run.folder.path() / "errors.csv"));
  CHECK(std::filesystem::exists(run.folder.path() / "orders.csv"));
}

TEST_CASE("convergence: impacts with restitution converge to the exact motion, and both routes agree") {
  Run run;
  Json study = oscillator("convergence");
  study["reference"] = {"exact", "self"};
  study["errors"] = {"tip-linf", "impact-times"};
  CHECK(run.go(study) == 0);
  const StudyResults results = run.results();
  for (const CaseRecord& record : results.cases) {
    std::map<std::string, double> measures(record.measures.begin(), record.measures.end());
    // One impact that is met within a step: errors of the size of h·v, and the gap of the two references below them.
    const double h = record.axes.back().second.get<double>();
    CHECK(measures.at("error.tip-linf") <= 3 * h);
    CHECK(measures.at("floor.tip-linf") > 0);
    CHECK(measures.at("floor.tip-linf") <= 3 * 0.00125);
  }
}

TEST_CASE("a scheme that makes energy on finer steps hides none of its errors from the exact motion") {
  // Newmark on rigid stops: the energy made at impacts grows as the step falls.
  const auto floors = [](const Json& references) {
    Run run;
    Json study = oscillator("convergence");
    study["methods"]["time"] = {{{"name", "newmark"}}};
    study["reference"] = references;
    study["errors"] = {"tip-linf"};
    study["scene"]["structure"] = {{"type", "oscillator"},
                                   {"mass", 0.5},
                                   {"stiffness", 200},
                                   {"damping", 0.3},
                                   {"force", {{"amplitude", 4}, {"pulsation", 11}}}};
    study["scene"]["stops"]["upper"] = 0.02;
    study["scene"]["initial"] = {{"displacement", 0}, {"velocity", 0}};
    study["step"] = {0.0005, 0.00025, 0.000125};
    run.go(study);
    std::vector<std::pair<double, double>> out;
    for (const CaseRecord& record : run.results().cases)
      out.emplace_back(measure(record, "floor.tip-linf").value(), measure(record, "error.tip-linf").value());
    return out;
  };
  const auto alone = floors({"exact"}), beside = floors({"exact", "self"});
  REQUIRE(alone.size() == beside.size());
  // The motion is within 0.05 m.
  constexpr double size = 0.05;
  for (std::size_t k = 0; k < alone.size(); ++k) {
    CHECK(beside[k].second == alone[k].second);
    CHECK(beside[k].second > 0.01);
    CHECK(beside[k].first < size);
  }
}

TEST_CASE("an oscillator on the springs of its law is compared with the exact motion on these springs") {
  Run run;
  Json study = oscillator("convergence");
  study["methods"]["contact"] = {{"name", "penalty"}, {"stiffness", 40}};
  study["methods"]["time"] = {{{"name", "newmark"}}};
  study["errors"] = {"tip-linf", "impact-times"};
  CHECK(run.go(study) == 0);
  const StudyResults results = run.results();
  REQUIRE(results.cases.size() == 5);
  for (const CaseRecord& record : results.cases) {
    std::map<std::string, double> measures(record.measures.begin(), record.measures.end());
    CHECK(measures.at("reference_of_law") == 1);
    // Of second order but for the steps in which the spring is met; against rigid stops the tip is off by 0.1 m.
    const double h = record.axes.back().second.get<double>();
    CHECK(measures.at("error.tip-linf") <= 60 * h * h);
  }
}

TEST_CASE("a comparison without contact says so first") {
  Run run;
  Json study = oscillator("convergence");
  study["scene"]["stops"]["upper"] = 7;
  study["errors"] = {"tip-linf", "impact-times"};
  CHECK(run.go(study) == 0);
  const AnalysedResults results(run.results());
  REQUIRE(!results.asked.first.empty());
  CHECK(results.asked.first.front().find("No stop was touched") == 0);
  // Without a contact law nothing was to be touched.
  Run linear;
  study["methods"]["contact"] = "none";
  CHECK(linear.go(study) == 0);
  const AnalysedResults without(linear.results());
  for (const std::string& one : without.asked.first) CHECK(one.find("No stop") == std::string::npos);
}

TEST_CASE("a comparison is asked what its cases measure, and nothing that only a trajectory observes") {
  Run run;
  Json text = oscillator("work-precision");
  REQUIRE(run.go(text) == 0);
  const StudyResults results = run.results();
  std::set<std::string> recorded;
  for (const CaseRecord& record : results.cases)
    for (const auto& [name, value] : record.measures) recorded.insert(name);
  const auto refused = [&](const std::string& name) {
    Json asking = text;
    asking["ask"] = Json::array({{{"value", name}}});
    Registry registry;
    try {
      parse_study(asking.dump(), run.catalogue, registry);
    } catch (const InputError& error) {
      return error.pointer() == "/ask/0/value";
    }
    return false;
  };
  for (const MeasureInfo& info : all_measures()) {
    INFO(info.name);
    // What a scene without loads, with one reference, or without an impact may lack is no contradiction.
    if (recorded.contains(info.name)) CHECK_FALSE(refused(info.name));
  }
  for (const char* name : {"energy_left", "work_of_damping", "impulse", "window_power", "largest_exponent"})
    CHECK(refused(name));
}

TEST_CASE("a reference is computed once, kept in the store, and found again") {
  Run run;
  Json study = oscillator("convergence");
  CHECK(run.go(study) == 0);
  {
    SQLite::Database database((run.folder.path() / "results.sqlite").string());
    CHECK(database.execAndGet("SELECT count(*) FROM motions").getInt() == 1);
  }
  study["step"].push_back(0.000625);
  CHECK(run.go(study) == 0);
  SQLite::Database database((run.folder.path() / "results.sqlite").string());
  CHECK(database.execAndGet("SELECT count(*) FROM motions").getInt() == 1);
  CHECK(run.results().cases.size() == 6);
}

TEST_CASE("work-precision: every finished case has a time with its spread, apart from the errors' run") {
  Run run;
  Json study = oscillator("work-precision");
  study["repeats"] = 3;
  study["errors"] = {"tip-l2"};
  CHECK(run.go(study) == 0);
  const StudyResults results = run.results();
  const Table& work = table(results, "work_precision");
  CHECK(work.rows.size() == 5);
  for (const auto& row : work.rows) {
    const double low = cell(work, row, "low").number().value(), high = cell(work, row, "high").number().value();
    const double median = cell(work, row, "run_seconds").number().value();
    CHECK(low > 0);
    CHECK(low <= median);
    CHECK(median <= high);
    CHECK(cell(work, row, "status") == "done");
  }
  // Nothing is timed twice.
  CHECK(run.go(study) == 0);
}

TEST_CASE("a reference that does not apply is refused before anything runs, with the reason and what applies") {
  Json study = oscillator("convergence");
  study["reference"] = "event-driven";
  const std::string told = problem_of(study);
  CHECK(told.starts_with("/reference: no reference applies to this scene: event-driven: "));
  CHECK(told.find("\"self\" applies") != std::string::npos);
  // A plan says so as well.
  Run planned;
  const Study parsed = parse_study(study.dump(), planned.catalogue, planned.registry);
  std::vector<const StudyCase*> cases;
  for (const StudyCase& one : parsed.cases) cases.push_back(&one);
  const ForecastContext context{parsed, planned.registry, cases, [](const StudyCase&) { return 1e-6; }};
  CHECK_THROWS_WITH(seconds_beside(context), Catch::StartsWith("no reference applies to this scene: event-driven: "));
  study["reference"] = "slef";
  CHECK(problem_of(study).find("did you mean \"self\"?") != std::string::npos);
  study["reference"] = "exakt";
  CHECK(problem_of(study).find("did you mean \"exact\"?") != std::string::npos);
  study["reference"] = {"exact", "exact"};
  CHECK(problem_of(study).starts_with("/reference/1: repeats"));
  study["reference"] = "exact";
  study["horizon"] = 3;
  CHECK(problem_of(study).starts_with("/horizon: a horizon of 3 s lies beyond the duration of 2 s"));
  study.erase("horizon");
  study["errors"] = {"tip-linf", "tip-linff"};
  CHECK(problem_of(study).find("did you mean \"tip-linf\"?") != std::string::npos);
}

namespace {

Json bouncing_beam(const Json& masses, const Json& schemes) {
  Json study = Json::parse(R"({
    "name": "bouncing", "kind": "convergence",
    "scene": {"structure": {"type": "beam", "length": 1.501, "young": 2e11, "density": 8000,
                            "section": {"type": "tube", "outer_diameter": 0.01, "wall": 0.0005}},
              "stops": {"lower": -0.02, "upper": 0.02, "at": "tip"},
              "initial": {"displacement": "0.008*x^2", "velocity": "-2*x"}},
    "mesh": {"elements": 4}, "step": [2e-4, 1e-4], "duration": 4, "samples": 400, "reference": "self"
  })");
  study["methods"] = {{"mass", masses}, {"contact", "signorini"}, {"time", schemes}};
  return study;
}

const Json velocity_level = {{"name", "moreau-jean"}, {"theta", 0.5}, {"restitution", 1}};
const Json position_level = {{"name", "newmark-dumont-paoli"}, {"restitution", 1}};

std::vector<double> horizons(const StudyResults& results) {
  std::vector<double> found;
  for (const CaseRecord& one : results.cases)
    for (const auto& [name, value] : one.measures)
      if (name == "horizon") found.push_back(value);
  return found;
}

}  // namespace

TEST_CASE("a method that does not march costs its own rows, and neither the study nor the others' horizon") {
  Run run, without;
  CHECK(run.go(bouncing_beam({"redistributed", "consistent"}, position_level)) == 0);
  CHECK(without.go(bouncing_beam("consistent", position_level)) == 0);
  const StudyResults results = run.results();
  REQUIRE(results.cases.size() == 4);
  for (const CaseRecord& one : results.cases)
    CHECK(one.status == (one.axes.front().second == "consistent" ? Status::done : Status::refused));
  const std::vector<double> told = horizons(results);
  CHECK(told == horizons(without.results()));
  REQUIRE(told.size() == 2);
  CHECK(told[0] < 1);
}

TEST_CASE("a horizon is told by runs whose impacts move with the motion, or not at all") {
  Run both, alone;
  CHECK(both.go(bouncing_beam("consistent", {velocity_level, position_level})) == 0);
  for (const double one : horizons(both.results())) CHECK(one < 1);
  CHECK(alone.go(bouncing_beam("consistent", velocity_level)) == 0);
  const StudyResults results = alone.results();
  CHECK(horizons(results) == std::vector<double>{4, 4});
  for (const CaseRecord& one : results.cases)
    CHECK(std::any_of(one.notes.begin(), one.notes.end(),
                      [](const std::string& note) { return note.find("is not told") != std::string::npos; }));
}

TEST_CASE("a budget stops a case, which counts as failed and leaves a study of itself that runs") {
  Run run;
  Json study = oscillator("convergence");
  study["kind"] = "trajectory";
  study.erase("reference");
  study["step"] = {1e-7};
  study["budget"] = 1e-6;
  CHECK(run.go(study) == 3);
  const StudyResults results = run.results();
  REQUIRE(results.cases.size() == 1);
  CHECK(results.cases[0].status == Status::failed);
  CHECK(results.cases[0].reason().starts_with("the budget of 1e-06 s was spent at step "));
  const auto file = run.folder.path() / "failures" / (results.cases[0].id + ".json");
  REQUIRE(std::filesystem::exists(file));
  Json alone = minimal_study(results, results.cases[0]);
  CHECK(alone["step"] == 1e-7);
  CHECK(alone["methods"]["time"]["name"] == "moreau-jean");
  const Study again = parse_study(alone.dump(), run.catalogue, run.registry);
  CHECK(again.cases.size() == 1);
}

TEST_CASE("a measure that some method never has is left out of the effects, neither zero nor filled in") {
  StudyResults results;
  results.kind = "trajectory";
  results.columns = {"mass", "time"};
  for (const char* mass : {"consistent", "lumped"})
    for (const char* time : {"newmark", "hht", "moreau-jean"}) {
      CaseRecord record;
      record.axes = {{"mass", mass}, {"time", time}};
      record.status = Status::done;
      const double value = static_cast<double>(results.cases.size());
      record.measures = {{"impulse", 1 + value}};
      if (std::string(time) != "hht") record.measures.emplace_back("work_of_damping", 2 + value * value);
      // One that a single case lacks is filled in as before.
      if (value != 4) record.measures.emplace_back("first_impact", 3 + value);
      results.cases.push_back(std::move(record));
    }
  const auto measures = [&] {
    results = with_tables(std::move(results));
    std::set<std::string> found;
    for (const auto& row : table(results, "effects").rows) found.insert(row.front().text());
    return found;
  };
  CHECK(measures() == std::set<std::string>{"impulse", "first_impact"});
  // A method of which no case came to its end says nothing of what it declares.
  for (CaseRecord& record : results.cases)
    if (record.axes[1].second == "hht") record.status = Status::failed;
  CHECK(measures() == std::set<std::string>{"impulse", "first_impact", "work_of_damping"});
}

TEST_CASE("effects stand beside the cases wherever two choices of three levels vary, and sum to the whole") {
  Run run;
  Json study = oscillator("trajectory");
  study.erase("reference");
  study["methods"]["time"] = {{{"name", "moreau-jean"}, {"theta", {0.5, 0.75, 1}}, {"restitution", 0.5}}};
  CHECK(run.go(study) == 0);
  const StudyResults results = run.results();
  const Table& effects = table(results, "effects");
  std::map<std::string, double> sums;
  for (const auto& row : effects.rows)
    sums[cell(effects, row, "measure").text()] += cell(effects, row, "share").number().value();
  REQUIRE(sums.count("tip_displacement_end") == 1);
  CHECK(sums["tip_displacement_end"] == Approx(1).epsilon(1e-9));
}

TEST_CASE("a third party's scheme and law are known by what they declare, not by what they call it") {
  Catalogue catalogue{tests::places().plugins, {}, {}};
  Registry registry;
  catalogue.open_all(registry);
  // Moreau–Jean and the penalty under other names, with other keys.
  registry.add_time(
      {.name = "foreign",
       .summary = "a scheme of the tests",
       .text = "Moreau-Jean.",
       .source = "these tests",
       .parameters = {with_role(real_parameter("bounce", "1", 0.0, {.low = 0, .high = 1}, "e"),
                                ParameterRole::restitution)}},
      [&registry](const Parameters& p) {
        return registry.time("moreau-jean")->make(Parameters({{"theta", 0.5}, {"restitution", p.real("bounce")}}));
      });
  Json study = oscillator("convergence");
  const auto problem = [&](const Json& time, const Json& contact) {
    study["methods"]["time"] = time;
    study["methods"]["contact"] = contact;
    const Study read = parse_study(study.dump(), catalogue, registry);
    return reference_problem(read.cases.front(), registry);
  };
  const Json own = {{"name", "moreau-jean"}, {"theta", 0.5}, {"restitution", 0.5}},
             other = {{"name", "foreign"}, {"bounce", 0.5}}, spring = {{"name", "penalty"}, {"stiffness", 1e4}};
  CHECK(problem(own, "signorini").restitution == 0.5);
  CHECK(problem(other, "signorini").restitution == 0.5);
  CHECK(problem(other, spring).contact_stiffness == 1e4);
  // What is said of a compliant law beside a restitution is said of both schemes.
  for (const Json& time : {own, other}) {
    study["methods"]["time"] = time;
    const Study read = parse_study(study.dump(), catalogue, registry);
    const Prepared prepared = prepare_case(read.cases.front(), registry);
    CHECK(std::any_of(prepared.notes.begin(), prepared.notes.end(), [](const std::string& note) {
      return note.find("the scheme's restitution has no part in it") != std::string::npos;
    }));
  }
}
