// Tables of contact tell stops that have names by them, and are else what they are without.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

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
  REQUIRE(plain.status == "done");
  REQUIRE(named.status == "done");
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
