// No method is dropped without a word: who gains is named first, who settles nowhere or has no value is named too.
#include <catch2/catch.hpp>

#include "runners/answers/limits.hpp"
#include "runners/json/json_text.hpp"
#include "tests/runners/answers/small_studies.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;
using synthetic::full_factorial, synthetic::sentences;

namespace {

const std::vector<double> refined = {1e-3, 1e-4, 1e-5};

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

void put(CaseRecord& record, const std::string& name, double value) {
  record.measures.emplace_back(name, value);
}

bool is_of(const CaseRecord& record, const char* level) {
  return record.axes.front().second == level;
}

}  // namespace

TEST_CASE("who gains energy is named first, whatever is observed") {
  for (const char* observed : {"energy_left", "impulse", "dissipated_at_contact", "tip_displacement_end"}) {
    StudyResults results = full_factorial(
        {{"time", {"kept", "lost", "made"}}}, refined,
        [&](const auto& at, double step) {
          if (std::string(observed) != "energy_left") return 1.0 + static_cast<double>(at[0]);
          return at[0] == 2 ? 12 - 1e3 * step : at[0] == 1 ? 0.5 : 1.0;
        },
        observed);
    for (CaseRecord& record : results.cases) {
      put(record, "energy_brought_in", 2);
      const double step = record.axes.back().second.get<double>();
      if (std::string(observed) != "energy_left")
        put(record, "energy_left", is_of(record, "made") ? 12 - 1e3 * step : is_of(record, "lost") ? 0.5 : 1.0);
    }
    const std::string text = sentences(results);
    INFO(text);
    CHECK(first_line(text) == "Energy is made with made: it ends with up to 12 times what was brought in.");
    CHECK(text.find("Energy is made") == text.rfind("Energy is made"));
  }
}

TEST_CASE("a method that has no value of a measure is named with the reason") {
  StudyResults results =
      full_factorial({{"time", {"audited", "other", "silent"}}}, refined, [](const auto&, double) { return 0.81; });
  for (CaseRecord& record : results.cases) {
    put(record, "impulse", 2);
    if (is_of(record, "silent")) record.measures = {{"impulse", 2}};
  }
  results.study["observe"] = {"energy_left", "impulse"};
  const std::string text = sentences(results);
  INFO(text);
  CHECK_THAT(text, Contains("Left out: 3 without a value: the scheme declares no work form."));
  // Nobody has one.
  for (CaseRecord& record : results.cases)
    record.measures = {{"impulse", 2}, {"work_of_damping", 0}, {"work_of_loads", 0}};
  const std::string blank = sentences(results);
  CHECK_THAT(blank, !Contains("the energy left is"));
}

TEST_CASE("a value that a case left out is told with the reason that the case has") {
  StudyResults results = full_factorial(
      {{"contact", {"soft", "hard"}}}, refined, [](const auto&, double) { return 400; }, "peak_contact_force");
  for (CaseRecord& record : results.cases) {
    put(record, "impulse", 2);
    if (!is_of(record, "hard")) continue;
    record.measures = {{"impulse", 2}};
    record.left_out = {{"impulse of nothing", "another item"}, {"peak_contact_force", "it grows without end"}};
  }
  results.study["observe"] = {"peak_contact_force", "impulse"};
  const std::string text = sentences(results);
  INFO(text);
  CHECK_THAT(text, Contains("Left out: 3 without a value: it grows without end."));
}

TEST_CASE("where no stop was touched the first sentence says so, with the gap") {
  StudyResults results = full_factorial(
      {{"contact", {"hard", "soft"}}}, refined, [](const auto&, double) { return 0; }, "dissipated_at_contact");
  for (CaseRecord& record : results.cases) {
    put(record, "energy_brought_in", 1);
    put(record, "smallest_gap", 100);
    put(record, "contact_instants", 0);
    put(record, "largest_tip_displacement", 0.052);
  }
  CHECK(
      first_line(sentences(results)) ==
      "No stop was touched: the largest displacement of the tip, 0.052 m, is 1/1923 of the smallest gap; contact laws "
      "are not compared.");
  // One case that touched is enough.
  for (auto& [name, value] : results.cases.back().measures)
    if (name == "contact_instants") value = 1;
  CHECK_THAT(sentences(results), !Contains("No stop was touched"));
}

TEST_CASE("where nothing moved the first sentence says so, with stops and without") {
  StudyResults results = full_factorial(
      {{"mass", {"consistent", "lumped"}}}, refined, [](const auto&, double) { return 0; }, "impulse");
  for (CaseRecord& record : results.cases) {
    put(record, "largest_tip_displacement", 0);
    put(record, "energy_start", 0);
    put(record, "work_of_loads", 0);
  }
  const std::string first =
      "Nothing moved: the structure starts at rest where nothing pushes it, and no load does work.";
  CHECK(first_line(sentences(results)) == first);
  for (CaseRecord& record : results.cases) {
    put(record, "smallest_gap", 0.1);
    put(record, "contact_instants", 0);
  }
  CHECK(first_line(sentences(results)) == first);
  // One case that moved is enough, and so is one that had energy.
  for (const char* name : {"largest_tip_displacement", "energy_start", "work_of_loads"}) {
    StudyResults one = results;
    for (auto& [measure, value] : one.cases.back().measures)
      if (measure == name) value = 1e-9;
    CHECK_THAT(sentences(one), !Contains("Nothing moved"));
  }
}

TEST_CASE("a case is driven by what no potential tells") {
  CaseRecord record;
  record.measures = {{"work_of_loads", 3.0}};
  CHECK(answers::is_driven(record));
  put(record, "work_of_steady_loads", 3.0);
  CHECK_FALSE(answers::is_driven(record));
  record.measures = {};
  CHECK_FALSE(answers::is_driven(record));
}
