// Tables of contact tell stops that have names by them, and are else what they are without.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "runners/store/record_values.hpp"
#include "tests/refusals.hpp"
#include "tests/runners/kinds/trajectory/case_runs.hpp"

using namespace ricochet;
using ricochet::testing::CaseRuns;

namespace {

Json beam_between(const Json& stops) {
  Json study = Json::parse(R"json({
    "name": "named", "kind": "trajectory",
    "scene": {"structure": {"type": "beam", "length": 1.5, "section": {"type": "given", "EI": 40, "rhoS": 0.12}},
              "load": "-20 - 60*sin(90*t)"},
    "mesh": {"elements": 10},
    "methods": {"mass": "consistent", "contact": {"name": "penalty", "stiffness": 1e6}, "time": "newmark-dumont-paoli"},
    "step": 5e-5, "duration": 0.1})json");
  study["scene"]["stops"] = stops;
  return study;
}

}  // namespace

TEST_CASE("names stand in the last column of impacts and stops, the rest is that of places without names") {
  CaseRuns runs;
  const CaseRecord plain =
      runs.first_of(beam_between(Json::parse(R"({"lower": -0.01, "upper": 0.01, "at": [0.75, 1.5]})")));
  const CaseRecord named = runs.first_of(beam_between(Json::parse(
      R"([{"name": "plate", "at": {"x": 0.75}, "lower": -0.01, "upper": 0.01},
          {"name": "end", "at": {"x": 1.5}, "lower": -0.01, "upper": 0.01}])")));
  REQUIRE(plain.status == Status::done);
  REQUIRE(named.status == Status::done);
  const auto value = [](const CaseRecord& record, const std::string& name) {
    for (const auto& [key, number] : record.measures)
      if (key == name) return number;
    return std::nan("");
  };
  for (const char* name : {"energy_end", "impacts", "peak_contact_force", "contact_time"})
    CHECK(value(plain, name) == value(named, name));
  const auto impacts_of = [](const CaseRecord& record) { return *find_table(record.numbers, "impacts"); };
  const NumberTable before = impacts_of(plain), after = impacts_of(named);
  REQUIRE(before.rows() > 3);
  CHECK(after.columns.size() == before.columns.size() + 1);
  CHECK(after.columns.back().name == "stop");
  for (std::size_t c = 0; c < before.columns.size(); ++c) CHECK(before.columns[c].name == after.columns[c].name);
  CHECK(*before.numbers("impulse") == *after.numbers("impulse"));
  CHECK(*before.numbers("t") == *after.numbers("t"));
  CHECK(*after.words_of("stop") == std::vector<std::string>{"plate", "end"});
  CHECK(*after.numbers("stop") == *after.numbers("point"));
  const auto stops =
      std::find_if(named.tables.begin(), named.tables.end(), [](const Table& table) { return table.name == "stops"; });
  REQUIRE(stops != named.tables.end());
  REQUIRE_FALSE(stops->rows.empty());
  for (const Row& row : stops->rows)
    CHECK(row.back().text() == (row[find_column(stops->columns, "point").value()].number() == 0.0 ? "plate" : "end"));
}

TEST_CASE("each stop that has a name has measures of its own, which sum to those of the case") {
  CaseRuns runs;
  Json study = beam_between(Json::parse(
      R"([{"name": "plate", "at": {"x": 0.75}, "lower": -0.01, "upper": 0.01},
          {"name": "end", "at": {"x": 1.5}, "lower": -0.01, "upper": 0.01}])"));
  study["observe"] = {"impulse[end]", "impacts"};
  const CaseRecord record = runs.first_of(study);
  const auto of = [&](const char* name) { return measure(record, name).value(); };
  CHECK(of("impulse[plate]") + of("impulse[end]") == Approx(of("impulse")).epsilon(1e-12));
  CHECK(of("impacts[plate]") + of("impacts[end]") == of("impacts"));
  CHECK(of("contact_time[plate]") + of("contact_time[end]") == Approx(of("contact_time")).epsilon(1e-12));
  CHECK(std::max(of("peak_force[plate]"), of("peak_force[end]")) == of("peak_contact_force"));
  CHECK(of("rms_force[end]") > 0);
  CHECK(of("rms_force[end]") <= of("peak_force[end]"));
  const MeasureInfo* info = measure_info("impulse[end]");
  REQUIRE(info);
  CHECK(std::string(info->unit) == "N s");
  CHECK(std::string(info->reading.words) == "impulse at end");
  CHECK_FALSE(measure_info("impulse[]"));
  CHECK_FALSE(measure_info("energy_left[end]"));
}

TEST_CASE("an observed measure of a stop that is not there is refused with the nearest name") {
  CaseRuns runs;
  Json study = beam_between(Json::parse(R"([{"name": "plate", "at": {"x": 0.75}, "lower": -0.01, "upper": 0.01}])"));
  const auto refusal = [&](const char* measure) {
    study["observe"] = measure;
    return runs.refusal(study);
  };
  CHECK(refusal("impulse[plate]") == "no error");
  CHECK_THAT(refusal("impulse[plato]"),
             Catch::Contains("/observe/0: no stop \"plato\"") && Catch::Contains("did you mean \"plate\"?"));
  CHECK_THAT(refusal("energy_left[plate]"), Catch::Contains("/observe: no measure \"energy_left\" of a stop"));
  CHECK_THAT(refusal("rms_forces[plate]"), Catch::Contains("did you mean \"rms_force\"?"));
  CHECK_THAT(refusal("rms_force"), Catch::Contains("expected rms_force[NAME]"));
  CHECK_THAT(refusal("impulse[]"), Catch::Contains("expected impulse[NAME]"));
  CHECK(refusal("impulse") == "no error");
  study["scene"]["stops"] = {{"lower", -0.01}, {"at", "tip"}};
  CHECK_THAT(refusal("impulse[plate]"), Catch::Contains("the scene has no stops with names"));
}
