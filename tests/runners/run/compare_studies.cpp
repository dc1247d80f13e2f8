#include "runners/run/compare_studies.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "runners/table/table_reader.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;

namespace {

/// Two masses × two steps; an integration of a thousand steps.
StudyResults study(const std::string& beginning = "a") {
  StudyResults results;
  results.name = "pair";
  results.kind = "trajectory";
  results.study = {{"name", "pair"}, {"duration", 1.0}, {"step", {1e-3, 1e-4}}, {"scene", {{"a/b", 1}}}};
  results.columns = {"mass", "step"};
  results.environment.entries = {
      {"commit", "one"}, {"plugin mass.so", "/here/mass.so (1234)"}, {kStarted, "2026-01-01T00:00:00Z"}};
  for (const char* mass : {"light", "heavy"})
    for (const double step : {1e-3, 1e-4}) {
      CaseRecord& record = results.cases.emplace_back();
      record.id = beginning + std::to_string(results.cases.size());
      record.status = Status::done;
      record.steps = 1000;
      record.axes = {{"mass", mass}, {"step", step}};
      record.measures = {{"energy_brought_in", 4.0}, {"dissipated_at_contact", 1.0}, {"microseconds_per_step", 1.0}};
    }
  return results;
}

void put(CaseRecord& record, const std::string& name, double value) {
  for (auto& [known, there] : record.measures)
    if (known == name) there = value;
}

const MeasureChange& change_of(const StudyComparison& found, const std::string& measure, const std::string& id) {
  const auto at = std::find_if(found.measures.begin(), found.measures.end(), [&](const MeasureChange& one) {
    return one.measure == measure && one.pair.a->id == id;
  });
  REQUIRE(at != found.measures.end());
  return *at;
}

}  // namespace

TEST_CASE("A study compared with itself is equal to the last bit, whenever it ran and however long it took") {
  const StudyResults a = study();
  StudyResults b = study();
  b.environment.entries = {
      {"commit", "one"}, {"plugin mass.so", "/there/mass.so (1234)"}, {kStarted, "2026-02-02T00:00:00Z"}};
  for (CaseRecord& record : b.cases) put(record, "microseconds_per_step", 2);
  const StudyComparison found = compare_studies(a, b);
  CHECK(found.inputs.empty());
  CHECK(found.environment.empty());
  CHECK(found.pairs.size() == 4);
  CHECK(found.by_id);
  CHECK(found.measures.size() == 8);
  CHECK(found.count(NumberChange::none) == 8);
  CHECK_THAT(comparison_text(found, a, b), Contains("The results are equal to the last bit."));
}

TEST_CASE("Tables of rows and of numbers count as results, with or without measures") {
  StudyResults a = study();
  a.cases.front().tables = {{"rows", "Rows.", {{"x", "1", "A number."}}, {{1.0}, {2.0}}}};
  NumberTable numbers;
  numbers.name = "numbers";
  numbers.columns = {{"y", "1", "A number."}};
  numbers.values = {{1.0, NAN}};
  a.cases.back().numbers = {numbers};
  StudyResults b = a;
  const auto said = [&] { return comparison_text(compare_studies(a, b), a, b); };
  CHECK_THAT(said(),
             Contains("tables: 2 tables compared: 2 equal") && Contains("The results are equal to the last bit."));
  b.cases.front().tables[0].rows[1][0] = 2 + 1e-15;
  CHECK_THAT(said(),
             Contains("1 equal; others: rows of 1 case") && Contains("have equal measures, but their tables differ"));
  b.cases.back().numbers[0].values[0].push_back(3);
  CHECK_THAT(said(), Contains("0 equal; others: numbers of 1 case, rows of 1 case"));
  for (StudyResults* one : {&a, &b})
    for (CaseRecord& record : one->cases) record.measures.clear();
  CHECK_THAT(said(), Contains("The results differ in their tables."));
  b.cases.back().numbers.clear();
  const Table table = comparison_table(compare_studies(a, b));
  CHECK(std::count_if(table.rows.begin(), table.rows.end(),
                      [](const Row& row) { return row[0].text() == "table" && row.back().text() == "changed"; }) == 2);
}

TEST_CASE("What was asked differently is told by pointer, a list that grew as one value") {
  const StudyResults a = study();
  StudyResults b = study();
  b.study["duration"] = 2.0;
  b.study["step"] = {1e-3, 1e-4, 1e-5};
  b.study["scene"]["a/b"] = 7;
  b.study["samples"] = 10;
  const StudyComparison found = compare_studies(a, b);
  std::vector<std::string> pointers;
  for (const ChangedText& one : found.inputs) pointers.push_back(one.where);
  CHECK(pointers == std::vector<std::string>{"/duration", "/step", "/scene/a~1b", "/samples"});
  CHECK(found.inputs[0].a == "1.0");
  CHECK(found.inputs[0].b == "2.0");
  CHECK(found.inputs[3].a.empty());
}

TEST_CASE("A number moves within the round-off of its integration, or beyond it, against what it is a share of") {
  const StudyResults a = study();
  StudyResults b = study();
  // The scale of what contact takes is the energy brought in, 4: round-off of 1000 steps is 4 × 1000 × 2⁻⁵².
  const double floor = 4 * 1000 * std::ldexp(1.0, -52);
  put(b.cases[0], "dissipated_at_contact", 1 + 0.9 * floor);
  put(b.cases[1], "dissipated_at_contact", 1 + 1.2 * floor);
  put(b.cases[2], "dissipated_at_contact", 1.4);
  b.cases[3].measures.erase(b.cases[3].measures.begin() + 1);
  const StudyComparison found = compare_studies(a, b);
  CHECK(change_of(found, "dissipated_at_contact", "a1").change == NumberChange::round_off);
  CHECK(change_of(found, "dissipated_at_contact", "a2").change == NumberChange::beyond);
  CHECK(change_of(found, "dissipated_at_contact", "a3").relative == Approx(0.1));
  CHECK(change_of(found, "dissipated_at_contact", "a4").change == NumberChange::missing);
  CHECK(found.count(NumberChange::none) == 4);
  const std::string text = comparison_text(found, a, b);
  CHECK_THAT(text, Contains("8 numbers compared: 4 equal to the last bit, 1 within round-off, 2 beyond it, 1 only in "
                            "one"));
  CHECK_THAT(text, Contains("10 %"));
  CHECK_THAT(text, Contains("The results differ beyond round-off"));
  b = study();
  put(b.cases[0], "dissipated_at_contact", 1 + 0.9 * floor);
  CHECK_THAT(comparison_text(compare_studies(a, b), a, b), Contains("equal within round-off."));
}

TEST_CASE("Cases go together by their ids, else by their parameters, and never two to one") {
  const StudyResults a = study("a");
  StudyResults b = study("b");
  b.cases[1].status = Status::diverged;
  b.cases[1].reasons = {"the energy grew"};
  b.cases.pop_back();
  StudyComparison found = compare_studies(a, b);
  CHECK_FALSE(found.by_id);
  CHECK(found.pairs.size() == 3);
  REQUIRE(found.only_a.size() == 1);
  CHECK(found.only_a.front()->id == "a4");
  CHECK(found.only_b.empty());
  REQUIRE(found.status_changes().size() == 1);
  CHECK(found.status_changes().front().b->id == "b2");
  const std::string text = comparison_text(found, a, b);
  CHECK_THAT(text, Contains("by their parameters"));
  CHECK_THAT(text, Contains("done → diverged, the energy grew"));
  CHECK_THAT(text, Contains("the cases themselves differ"));
  // Two cases of the same parameters have no partner that could be told from the other.
  b = study("b");
  b.cases[1].axes = b.cases[0].axes;
  found = compare_studies(a, b);
  CHECK(found.pairs.size() == 2);
  CHECK(found.only_a.size() == 2);
}

TEST_CASE("A comparison fills a screen at most, its table has a row for everything") {
  StudyResults a = study("a"), b = study("b");
  for (int k = 0; k < 40; ++k) {
    b.study["key " + std::to_string(k)] = k;
    b.environment.entries.emplace_back("entry " + std::to_string(k), "x");
    for (StudyResults* one : {&a, &b}) {
      CaseRecord extra = one->cases.front();
      extra.id = (one == &a ? "more a" : "more b") + std::to_string(k);
      extra.axes[1].second = 1.0 + k + (one == &a ? 0 : 100);
      one->cases.push_back(extra);
    }
    a.cases.front().measures.emplace_back("measure_" + std::to_string(k), 1.0);
    b.cases.front().measures.emplace_back("measure_" + std::to_string(k), 2.0);
  }
  const StudyComparison found = compare_studies(a, b);
  const std::string text = comparison_text(found, a, b);
  CHECK(std::count(text.begin(), text.end(), '\n') <= 50);
  const Table table = comparison_table(found);
  // inputs, environment, cases of both and of one, two measures of each pair and 40 of the first
  CHECK(table.rows.size() == 40 + 40 + 4 + 80 + 8 + 40);
  for (const Row& row : table.rows) CHECK(row.size() == table.columns.size());
}
