#include <catch2/catch.hpp>

#include "runners/run/compare_studies.hpp"

using namespace ricochet;

namespace {

CaseRecord case_of(const char* id, const char* mass, const char* scheme, double beta, double impacts) {
  CaseRecord record;
  record.id = id;
  record.status = Status::done;
  record.axes = {{"mass", mass}, {"time", scheme}, {"time.beta", beta}, {"time.start", "second"}, {"step", 1e-3}};
  record.measures = {{"impacts", impacts}};
  record.steps = 1000;
  return record;
}

Table orders(std::vector<Row> rows) {
  for (Row& row : rows) {
    // Narrow intervals, but of orders that are marked as wild.
    const double order = row[3].number().value(), half = order == 1.7 ? 0.3 : 0.1;
    row.insert(row.end(), {order - half, order + half});
  }
  return {"orders", "", named_columns({"case", "refined", "error", "order", "low", "high"}), std::move(rows)};
}

/// "free" measures orders and errors without contact, "stops" with it.
std::vector<StudyResults> studies() {
  StudyResults free, stops;
  free.name = "family-free";
  free.columns = stops.columns = {"mass", "time", "time.beta", "time.start", "step"};
  free.cases = {case_of("a", "full", "three", 0.25, 0), case_of("b", "full", "three", 0.5, 0),
                case_of("c", "poor", "three", 0.5, 0), case_of("z", "full", "silent", 0.5, 0)};
  free.derived = {orders({{"a", "step", "tip-l2", 2.0004},
                          {"b", "step", "tip-l2", 1.98},
                          {"c", "step", "tip-l2", 2.03},
                          {"c", "elements", "tip-l2", 4.0},
                          {"c", "step", "energy", 9.0}})};
  stops.name = "family-stops";
  stops.cases = {case_of("d", "full", "three", 0.25, 3), case_of("e", "full", "three", 0.25, 3),
                 case_of("f", "full", "three", 0.5, 3), case_of("g", "full", "three", 0.25, 3)};
  stops.derived = {orders({{"d", "step", "tip-l2", 1.1}, {"f", "step", "tip-l2", 1.7}, {"g", "step", "tip-l2", 1.7}}),
                   {"energy_ends", "", named_columns({"case", "step_gain"}), {{"d", 1e-14}, {"e", 0.26}}},
                   {"work_precision",
                    "",
                    named_columns({"case", "error", "value", "run_seconds"}),
                    {{"d", "tip-l2", 1e-5, 9e-4}, {"e", "tip-l2", 1e-6, 1.1e-3}, {"e", "energy", 1e-9, 1e-4}}}};
  return {free, stops};
}

std::string cell(const Table& table, std::size_t row, const char* column) {
  return table.rows.at(row).at(find_column(table.columns, column).value()).text();
}

}  // namespace

TEST_CASE("league: a row per scheme, each cell measured and followed by its study, blank where nothing was") {
  const Table table = league_table(studies());
  REQUIRE(table.rows.size() == 2);  // one scheme has no figure at all
  // Named by what tells it from others of its name: not by `start`, which all share.
  CHECK(cell(table, 0, "scheme") == "three, beta 0.25");
  CHECK(cell(table, 1, "scheme") == "three, beta 0.5");
  CHECK(cell(table, 0, "order free") == "2.00 [free]");
  CHECK(cell(table, 1, "order free") == "1.98 … 2.03 [free]");
  CHECK(cell(table, 0, "order through contact") == "1.10 (1 of 2) [stops]");
  CHECK(cell(table, 1, "order through contact") == "not told [stops]");  // its interval is 0.6 wide
  CHECK(cell(table, 1, "largest step gain").empty());
  CHECK(cell(table, 0, "largest step gain") == "0.26 [stops]");
  CHECK(cell(table, 0, "cost of a step") == "0.9 … 1.1 [stops]");
  CHECK(cell(table, 0, "error at 1 ms") == "1e-05 [stops]");  // the smaller error took longer
  CHECK(cell(table, 0, "e mean").empty());
}

TEST_CASE("league: the first study that measured something gives it") {
  std::vector<StudyResults> all = studies();
  all.push_back(all.front());
  all.back().name = "family-other";
  all.back().derived = {orders({{"a", "step", "tip-l2", 7.0}})};
  CHECK(cell(league_table(all), 0, "order free") == "2.00 [free]");
  std::swap(all.front(), all.back());
  CHECK(cell(league_table(all), 0, "order free") == "7.00 [other]");
}

TEST_CASE("league: names lose what they share, up to a hyphen, and a study alone loses nothing") {
  std::vector<StudyResults> all = studies();
  CHECK(common_beginning(all) == "family-");
  all.front().name = "stones";
  all.back().name = "stops";
  CHECK(common_beginning(all).empty());
  all.pop_back();
  all.front().name = "family-free";
  CHECK(common_beginning(all).empty());
}

TEST_CASE("league: Markdown has units in its head and a line per row") {
  const Table table{"t", "", {{"scheme", "", ""}, {"cost", "µs", ""}, {"order", "1", ""}}, {{"a", 1.5, nullptr}}};
  CHECK(markdown(table) == "| scheme | cost, µs | order |\n|---|---|---|\n| a | 1.5 |  |\n");
}
