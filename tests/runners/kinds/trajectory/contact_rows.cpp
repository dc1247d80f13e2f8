// impacts.csv, stops.csv and the extremes between samples say the same as the measures of their case.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <ricochet/loader/catalogue.hpp>
#include <set>

#include "runners/answers/answer.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/kinds/trajectory/stop_tables.hpp"
#include "runners/kinds/trajectory/trajectory.hpp"
#include "runners/store/record_values.hpp"
#include "runners/study/load_study.hpp"
#include "runners/table/table_reader.hpp"
#include "tests/places.hpp"

using namespace ricochet;

namespace {

const std::atomic<bool> goes_on = false;

/// A tube between plates, its far end on a stop without a gap; a load swings it.
Json tube_study() {
  return Json::parse(R"json({
    "name": "tube", "kind": "trajectory",
    "scene": {"structure": {"type": "beam", "length": 1.5, "section": {"type": "given", "EI": 498, "rhoS": 1.013},
                            "damping": {"stiffness": 1e-4}},
              "stops": {"lower": "x>1.4 ? 0 : -0.0003", "upper": "x>1.4 ? 1 : 0.0003", "at": [0.5, 1.0, 1.5]},
              "load": "-20 - 60*sin(90*t)",
              "initial": {"displacement": 0, "velocity": 0}},
    "mesh": {"elements": 15},
    "methods": {"mass": "consistent", "contact": {"name": "penalty", "stiffness": 1e6},
                "time": ["newmark-dumont-paoli", "bathe"]},
    "step": 5e-5, "duration": 0.3, "samples": 100})json");
}

StudyResults results_of(const Json& text) {
  static Catalogue catalogue{tests::places().plugins, {}, {}};
  static Registry registry;
  StudyResults results;
  const Study study = parse_study(text.dump(1), catalogue, registry);
  results.kind = "trajectory";
  results.columns = {"mass", "contact", "contact.stiffness", "time", "elements", "step"};
  for (const StudyCase& one : study.cases) results.cases.push_back(run_case(one, registry, goes_on));
  return results;
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

std::vector<double> column_of(const Table& table, const char* name) {
  std::vector<double> out;
  const std::size_t place = find_column(table.columns, name).value();
  for (const Row& row : table.rows) out.push_back(row.at(place).number().value());
  return out;
}

const std::vector<double>& series_of(const CaseRecord& record, const char* name) {
  const auto& names = record.curve.names;
  return record.curve.columns.at(static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin()));
}

}  // namespace

TEST_CASE("the impacts of a case are rows, and add up to its measures and to those of its stops") {
  StudyResults results = results_of(tube_study());
  for (CaseRecord& record : results.cases) {
    INFO(axis(record, "time").text());
    REQUIRE(record.status == Status::done);
    const NumberTable* impacts = find_table(record.numbers, "impacts");
    const Table* stops = find_table(record.tables, "stops");
    REQUIRE((impacts && stops));
    CHECK(static_cast<double>(impacts->rows()) == measure(record, "impacts").value());
    CHECK(impacts->rows() > 10);
    // Different orders of summation.
    // The far end is pressed on its stop from the start: that contact has no row, until it first opens.
    const double of_start = measure(record, "impulse").value() - sum(*impacts->numbers("impulse"));
    CHECK(of_start > 0);
    CHECK(of_start < 0.02 * measure(record, "impulse").value());
    CHECK(sum(column_of(*stops, "impulse")) == Approx(measure(record, "impulse").value()).epsilon(1e-12));
    CHECK(sum(*impacts->numbers("duration")) < measure(record, "contact_time").value());
    CHECK(sum(column_of(*stops, "contact_time")) == Approx(measure(record, "contact_time").value()).epsilon(1e-12));
    CHECK(sum(column_of(*stops, "impacts")) == measure(record, "impacts").value());
    CHECK(largest(*impacts->numbers("peak_force")) == measure(record, "peak_contact_force").value());
    CHECK(largest(column_of(*stops, "peak_force")) == measure(record, "peak_contact_force").value());
    CHECK(impacts->numbers("t")->front() == measure(record, "first_impact").value());
    // Every place and side that is hit, and no other.
    std::set<std::pair<double, double>> hit;
    for (std::size_t i = 0; i < impacts->rows(); ++i)
      hit.emplace(impacts->numbers("x")->at(i), impacts->numbers("side")->at(i));
    CHECK(hit.size() == stops->rows.size());
    CHECK(hit.size() >= 3);
    CHECK(*impacts->words_of("side") == std::vector<std::string>{"lower", "upper"});
    // Force, time and work are those of something.
    for (const char* name : {"mean_force", "rms_force", "normal_work", "contact_time"})
      for (const double value : column_of(*stops, name)) CHECK(value > 0);
  }
}

TEST_CASE("between two samples nothing is lost: the extremes of the curve are those of every step") {
  for (const CaseRecord& record : results_of(tube_study()).cases) {
    INFO(axis(record, "time").text());
    const auto &tip = series_of(record, "tip_displacement"), &low = series_of(record, "tip_displacement_low"),
               &high = series_of(record, "tip_displacement_high"), &force = series_of(record, "contact_force"),
               &total = series_of(record, "contact_force_total"), &peak = series_of(record, "contact_force_peak"),
               &deepest = series_of(record, "penetration_peak"), &penetration = series_of(record, "penetration");
    REQUIRE(tip.size() >= 100);
    for (std::size_t i = 0; i < tip.size(); ++i) {
      CHECK(low[i] <= tip[i]);
      CHECK(tip[i] <= high[i]);
      CHECK(std::abs(force[i]) <= total[i] * (1 + 1e-12));
      CHECK(total[i] <= 3 * peak[i] * (1 + 1e-12));  // three points
      CHECK(penetration[i] <= deepest[i]);
    }
    CHECK(largest(peak) == measure(record, "peak_contact_force").value());
    CHECK(largest(deepest) == measure(record, "deepest_penetration").value());
    CHECK(std::max(largest(high), -*std::min_element(low.begin(), low.end())) ==
          measure(record, "largest_tip_displacement").value());
    // The samples alone would have missed it.
    CHECK(largest(peak) > 1.02 * largest(total) / 3);
  }
}

TEST_CASE("tables of contact come back from a store with units and meanings, under names of their own") {
  StudyResults results = results_of(tube_study());
  for (CaseRecord& record : results.cases) {
    for (NumberTable& table : record.numbers)
      for (Column& column : table.columns.own()) column.unit = column.text = "";
    for (Table& table : record.tables)
      for (Column& column : table.columns.own()) column.unit = column.text = "";
  }
  find_kind("trajectory")->analysis(results, Choices(results));
  std::vector<Table> tables = number_heads(results);
  tables.insert(tables.end(), results.derived.begin(), results.derived.end());
  int seen = 0;
  for (const Table& table : tables) {
    if (table.name != "impacts" && table.name != "stops") continue;
    ++seen;
    std::set<std::string> names;
    for (const Column& column : table.columns) {
      INFO(table.name << " " << column.name);
      CHECK(names.insert(column.name).second);  // no axis is called the same
      if (names.size() > 1 + results.columns.size()) CHECK_FALSE(column.text.empty());
    }
  }
  CHECK(seen == 2);
}

TEST_CASE("a study that compares lists its impacts too, and one without contact has none") {
  Json text = Json::parse(R"({
    "name": "compared", "kind": "convergence",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 100},
              "stops": {"lower": 0, "at": "tip"}, "initial": {"displacement": 0.1, "velocity": 0}},
    "methods": {"mass": "consistent", "contact": "signorini", "time": {"name": "moreau-jean", "restitution": 0.8}},
    "step": [1e-3], "duration": 0.9, "reference": "exact", "errors": ["tip-linf"]})");
  Catalogue catalogue{tests::places().plugins, {}, {}};
  Registry registry;
  const Study study = parse_study(text.dump(1), catalogue, registry);
  CaseRunner runner = find_kind("convergence")->start({study, registry, {}});
  runner.open({}, goes_on);
  const CaseRecord record = runner.run(study.cases.front(), goes_on);
  REQUIRE(record.status == Status::done);
  const NumberTable* impacts = find_table(record.numbers, "impacts");
  REQUIRE(impacts);
  // A quarter of a period, then a half each: 0.157, 0.471, 0.785 s.
  REQUIRE(impacts->rows() == 3);
  CHECK(measure(record, "impacts") == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(impacts->numbers("t")->at(i) == Approx(M_PI / 20 * (1 + 2 * static_cast<double>(i))).margin(3e-3));
    CHECK(impacts->numbers("speed_in")->at(i) == Approx(std::pow(0.8, i)).margin(0.02));
  }

  text = tube_study();
  text["methods"]["contact"] = "none";
  text["methods"]["time"] = "bathe";
  const CaseRecord free = results_of(text).cases.front();
  CHECK(measure(free, "impacts") == 0);
  CHECK_FALSE(find_table(free.numbers, "impacts"));
  CHECK_FALSE(measure(free, "peak_contact_force"));
}

TEST_CASE("a friction damper has one row without a side, and what it takes is there") {
  Json study = Json::parse(R"json({
    "name": "damped", "kind": "trajectory",
    "scene": {"structure": {"type": "oscillator", "mass": 3, "stiffness": 400},
              "stops": [{"name": "wall", "at": {"x": 0}, "upper": 0.01},
                        {"name": "damper", "at": {"x": 0}, "normal_force": 40, "friction": 0.15}],
              "initial": {"displacement": 0, "velocity": 1}},
    "methods": {"mass": "consistent", "contact": {"name": "penalty", "stiffness": 1e5}, "time": "moreau-jean"},
    "step": 1e-4, "duration": 0.05})json");
  const StudyResults results = results_of(study);
  const CaseRecord& record = results.cases.at(0);
  REQUIRE(record.status == Status::done);
  const Table* stops = find_table(record.tables, "stops");
  REQUIRE(stops);
  REQUIRE(stops->rows.size() == 2);
  const auto cell = [&](std::size_t row, const char* name) {
    return stops->rows.at(row).at(find_column(stops->columns, name).value());
  };
  CHECK(cell(0, "stop").text() == "wall");
  CHECK(cell(0, "side").text() == "upper");
  CHECK(cell(0, "friction_power").text().empty());
  CHECK(cell(1, "stop").text() == "damper");
  CHECK(cell(1, "point").number() == 1);
  for (const char* name : {"side", "impacts", "peak_force", "contact_time", "normal_work"})
    CHECK(cell(1, name).text().empty());
  // It slides all along: μN times its way, by the time. The step that turns at the wall has a way of h v of 0.04 m.
  CHECK(cell(1, "stick_share").number() == 0);
  CHECK(cell(1, "friction_power").number().value() ==
        Approx(0.15 * 40 * cell(1, "slip_distance").number().value() / 0.05).epsilon(2.5e-3));
  CHECK(cell(1, "slip_distance").number().value() > 0.01);

  // Without works there is no heat, and the case says why.
  study["methods"]["time"] = "bathe";
  const CaseRecord unknown = results_of(study).cases.at(0);
  CHECK(measure(unknown, "stick_share[damper]"));
  CHECK_FALSE(measure(unknown, "friction_power[damper]"));
  CHECK_THAT(answers::why_without("friction_power[damper]", unknown), Catch::Contains("declares no work form"));
}
