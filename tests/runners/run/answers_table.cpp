// What a study of trajectories answers: tiers of methods, choices by what they move, cases without a result.
#include <algorithm>
#include <catch2/catch.hpp>
#include <ricochet/contract/said_format.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <regex>

#include "runners/run/choice_effects.hpp"
#include "runners/run/finish_run.hpp"
#include "runners/table/table_reader.hpp"

using namespace ricochet;

namespace {

/// Two masses × laws × steps; `left` gives the energy left of a case.
StudyResults study(const std::function<double(int mass, int law, double step)>& left,
                   const std::vector<double>& steps = {4e-4, 2e-4, 1e-4}, int laws = 2) {
  StudyResults results;
  results.kind = "trajectory";
  results.columns = {"mass", "contact", "step"};
  for (const int mass : {0, 1})
    for (int law = 0; law < laws; ++law)
      for (const double step : steps) {
        CaseRecord& record = results.cases.emplace_back();
        record.id = "0" + std::to_string(results.cases.size());
        record.status = "done";
        record.steps = 1000;
        record.axes = {{"mass", mass ? "heavy" : "light"},
                       {"contact", law == 0   ? "hard"
                                   : law == 1 ? "soft"
                                              : "softer" + std::to_string(law)},
                       {"step", step}};
        record.measures = {{"energy_left", left(mass, law, step)}, {"work_of_loads", 0}, {"work_of_damping", 0}};
      }
  return results;
}

std::string said(const Table& answers) {
  std::string all;
  const TableReader rows(answers);
  for (std::size_t row = 0; row < rows.size(); ++row) all += rows.text(row, "sentence") + "\n";
  return all;
}

std::string form_of(const Table& answers) {
  return TableReader(answers).text(0, "form");
}

}  // namespace

TEST_CASE("methods that differ by less than 1 % do not, and what step still moves is said") {
  const Table answers =
      answers_table(answers::Compared(study([](int mass, int, double step) { return 0.4 + 0.002 * mass + step; })));
  CHECK(form_of(answers) == "none");
  CHECK_THAT(said(answers),
             Catch::Contains("No difference: the energy left is 40.") && Catch::Contains("methods differ by 0.2 %"));
}

TEST_CASE("methods that differ are told apart by the choice that does it") {
  const Table answers =
      answers_table(answers::Compared(study([](int mass, int, double step) { return (mass ? 0.6 : 0.4) + step; })));
  CHECK(form_of(answers) == "differ");
  CHECK_THAT(said(answers),
             Catch::Contains("None keeps it; the heavy mass comes nearest with 60.01 %; the light mass keeps 40.01 %"));
}

TEST_CASE("what the step moves more than methods do cannot be told") {
  const Table answers = answers_table(answers::Compared(
      study([](int mass, int, double step) { return (mass ? 0.42 : 0.4) + 200 * std::sin(1e5 * step); })));
  CHECK(form_of(answers) == "open");
  CHECK_THAT(said(answers), Catch::Contains("These steps cannot tell"));
}

TEST_CASE("with a compared choice that is spoken of first, paired over all others") {
  StudyResults results = study([](int mass, int law, double step) { return 0.4 + (mass && law ? 0.2 : 0) + step; });
  results.study = {{"compare", "mass"}};
  CHECK_THAT(said(answers_table(answers::Compared(results))),
             Catch::StartsWith("The mass matrix matters with soft: it moves the energy left by 33 %") ||
                 Catch::StartsWith("The mass matrix matters with soft"));
  results = study([](int, int law, double step) { return 0.4 + 0.2 * law + step; });
  results.study = {{"compare", "mass"}};
  CHECK_THAT(said(answers_table(answers::Compared(results))), Catch::StartsWith("The mass matrix does not matter"));
}

TEST_CASE("one step only is said, and no difference is told as if it were known") {
  const Table answers =
      answers_table(answers::Compared(study([](int mass, int, double) { return mass ? 0.6 : 0.4; }, {1e-4})));
  CHECK_THAT(said(answers), Catch::Contains("the only step"));
}

TEST_CASE("the order of cases leaves the answer as it is") {
  const StudyResults results =
      study([](int mass, int law, double step) { return 0.4 + 0.1 * mass + 0.03 * law + 50 * step * (1 + mass); });
  const auto numbers = [](const StudyResults& one) {
    std::vector<std::string> out;
    const Table table = answers_table(answers::Compared(one));
    const TableReader rows(table);
    for (std::size_t row = 0; row < rows.size(); ++row)
      out.push_back(rows.text(row, "form") + rows.text(row, "low") + rows.text(row, "high"));
    return out;
  };
  std::mt19937_64 random(3);
  for (int draw = 0; draw < 20; ++draw) {
    StudyResults shuffled = results;
    std::shuffle(shuffled.cases.begin(), shuffled.cases.end(), random);
    CHECK(numbers(shuffled) == numbers(results));
  }
}

TEST_CASE(
    "an answer has at most five sentences before those on cases without a result, and says no number without a row") {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  for (int draw = 0; draw < 60; ++draw) {
    const StudyResults results =
        study([&](int, int, double) { return 0.5 + 0.1 * normal(random); }, {4e-4, 2e-4, 1e-4}, 1 + draw % 5);
    const Table answers = answers_table(answers::Compared(results));
    const TableReader rows(answers);
    std::size_t sentences = 0;
    for (std::size_t row = 0; row < rows.size(); ++row) {
      sentences += !rows.text(row, "sentence").empty();
      CHECK_FALSE(rows.text(row, "form").empty());
    }
    CHECK(sentences >= 1);
    CHECK(sentences <= 5);
  }
}

TEST_CASE("other names of methods change words alone") {
  StudyResults results =
      study([](int mass, int law, double step) { return 0.4 + 0.1 * mass + 0.03 * law + 50 * step * (1 + mass); });
  const auto numbers = [](const StudyResults& one) {
    std::vector<std::string> out;
    const Table table = answers_table(answers::Compared(one));
    const TableReader rows(table);
    for (std::size_t row = 0; row < rows.size(); ++row)
      for (const char* column : {"form", "measure", "value", "low", "high", "u", "status", "methods"})
        out.push_back(rows.text(row, column));
    return out;
  };
  const auto before = numbers(results);
  const std::map<std::string, std::string> renamed = {
      {"light", "zinc"}, {"heavy", "air"}, {"hard", "b"}, {"soft", "a"}};
  for (CaseRecord& record : results.cases)
    for (auto& [axis, value] : record.axes)
      if (const auto found = value.is_string() ? renamed.find(value.get<std::string>()) : renamed.end();
          found != renamed.end())
        value = found->second;
  CHECK(numbers(results) == before);
}

TEST_CASE("each number of a sentence stands in a table") {
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> uniform;
  const std::regex number("(?:^|[ (])((?:−)?[0-9][0-9.]*(?:e-?[0-9]+)?)(?=[ ,.;:)]|$)");
  for (int draw = 0; draw < 40; ++draw) {
    const double a = uniform(random), b = uniform(random), c = draw % 3 ? uniform(random) : 0,
                 p = 0.5 + 3 * uniform(random);
    const StudyResults results = study(
        [&](int mass, int law, double step) {
          return 0.2 + 0.3 * a * mass + 0.1 * c * law + b * (1 + mass) * std::pow(1e3 * step, p);
        },
        {8e-4, 4e-4, 2e-4, 1e-4}, 1 + draw % 3);
    std::vector<Table> tables = evidence_tables(answers::Compared(results));
    tables.push_back(answers_table(answers::Compared(results)));
    std::vector<double> known;
    for (const Table& table : tables)
      for (const Row& row : table.rows)
        for (const Cell& cell : row)
          if (const auto value = cell.number()) known.push_back(std::abs(*value));
    const std::string text = said(tables.back());
    for (std::sregex_iterator it(text.begin(), text.end(), number), end; it != end; ++it) {
      std::string word = (*it)[1].str();
      if (word.back() == '.') word.pop_back();
      const std::string digits = word.starts_with("−") ? word.substr(std::string("−").size()) : word;
      const std::size_t exponent = digits.find('e'), point = digits.find('.');
      const std::size_t decimals = point == std::string::npos ? 0 : std::min(exponent, digits.size()) - point - 1;
      // Ranges are rounded outwards: one unit of the last digit, zeros at the end of a whole number not counted.
      const std::string mantissa = digits.substr(0, exponent);
      const std::size_t zeros = point == std::string::npos ? mantissa.size() - 1 - mantissa.find_last_not_of('0') : 0;
      const double power = (exponent == std::string::npos ? 0 : std::stod(digits.substr(exponent + 1))) -
                           static_cast<double>(decimals) + static_cast<double>(zeros),
                   unit = std::pow(10, power), value = std::stod(digits);
      const bool there =
          std::any_of(known.begin(), known.end(), [&](double one) { return std::abs(one - value) <= 1.001 * unit; });
      INFO(text << word);
      CHECK(there);
    }
  }
}

TEST_CASE("removing the finest step never makes an answer surer") {
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> uniform;
  for (int draw = 0; draw < 60; ++draw) {
    const double a = uniform(random), b = uniform(random), p = 0.5 + 3 * uniform(random);
    const auto value = [&](int mass, int, double step) { return 0.5 + 0.1 * mass * a + b * std::pow(1e3 * step, p); };
    const auto uncertainty = [&](const std::vector<double>& steps) {
      const std::vector<Table> tables = evidence_tables(answers::Compared(study(value, steps, 1)));
      double most = 0;
      const TableReader rows(tables.front());
      for (std::size_t row = 0; row < rows.size(); ++row)
        most = std::max(most, rows.number(row, "u").value_or(INFINITY));
      return most;
    };
    CHECK(uncertainty({8e-4, 4e-4, 2e-4}) >= uncertainty({8e-4, 4e-4, 2e-4, 1e-4}));
  }
}

TEST_CASE("the measures that a study names are those that it is answered by") {
  StudyResults results = study([](int, int, double) { return 0.5; });
  for (CaseRecord& record : results.cases) record.measures.emplace_back("impulse", 3);
  CHECK(observed_measures(results) == std::vector<std::string>{"energy_left", "impulse"});
  results.study = {{"observe", {"impulse"}}};
  CHECK(observed_measures(results) == std::vector<std::string>{"impulse"});
  // Where loads work, it is the loss at the stops that is asked for.
  results.study = nlohmann::ordered_json::object();
  for (CaseRecord& record : results.cases) record.measures[1].second = 2;
  for (CaseRecord& record : results.cases) record.measures.emplace_back("dissipated_at_contact", 1);
  CHECK(observed_measures(results).front() == "dissipated_at_contact");
}

TEST_CASE("two levels have no share, nor does what round-off explains") {
  const auto shares = [](const StudyResults& results) { return effects_table(results).rows; };
  const StudyResults three_steps = study([](int mass, int, double step) { return (mass ? 0.6 : 0.4) + 1e3 * step; });
  for (const Row& row : shares(three_steps)) {
    CHECK(row.at(1).text().find("mass") == std::string::npos);
    CHECK(row.at(1).text().find("contact") == std::string::npos);
  }
  CHECK(!shares(three_steps).empty());
  CHECK(shares(study([](int mass, int, double step) { return (mass ? 0.6 : 0.4) + step; }, {2e-4, 1e-4})).empty());
  // 2⁻⁵² × 1000 steps is 2.2e-13.
  CHECK(shares(study([](int, int, double step) { return 0.5 + 1e-10 * step; })).empty());
}

TEST_CASE(
    "at the only step methods whose values chain into one another differ by what is measured, no finer step asked") {
  const std::string text = said(answers_table(
      answers::Compared(study([](int mass, int law, double) { return 0.25 + 0.009 * law + 1e-4 * mass; }, {1e-4}, 3))));
  INFO(text);
  CHECK_THAT(text, Catch::Contains(
                       "differs by 1.8 % between methods at h = 1e-4 s, the only step: it lies in 25.0 to 26.8 %") &&
                       Catch::Contains("What a finer step would change is not known."));
  CHECK_THAT(text, !Catch::Contains("up to 0 %"));
}

TEST_CASE("cases that gave no result are told by what sets them apart, where all are done nothing is said of it") {
  StudyResults results = study([](int mass, int, double step) { return (mass ? 0.6 : 0.4) + step; });
  CHECK(said(answers_table(answers::Compared(results))).find("iverged") == std::string::npos);
  for (CaseRecord& record : results.cases)
    if (record.axes[0].second == "heavy" && record.axes[1].second == "soft") record.status = "diverged";
  CHECK_THAT(said(answers_table(answers::Compared(results))),
             Catch::Contains("Diverged: 3 of 12 cases (the heavy mass with soft).\n"));
  // Why, where cases share it; a sentence of one case among many is in reasons.csv.
  for (CaseRecord& record : results.cases)
    if (record.status == "diverged") {
      record.status = "refused";
      record.reasons = {"no impact measure"};
    }
  CHECK_THAT(said(answers_table(answers::Compared(results))),
             Catch::Contains("Not run: 3 of 12 cases (the heavy mass with soft): no impact measure.\n"));
  // Each reason with its own cases; reasons that differ in numbers alone are one.
  results.cases.back().reasons = {"no step"};
  CHECK_THAT(said(answers_table(answers::Compared(results))),
             Catch::Contains("Not run: 2 of 12 cases (the heavy mass with soft at h = ") &&
                 Catch::Contains(": no impact measure.\n") && Catch::Contains("Not run: 1 of 12 cases (") &&
                 Catch::Contains(": no step.\n"));
  int number = 0;
  for (CaseRecord& record : results.cases)
    if (record.status == "refused") record.reasons = {said("step {} is beyond 2", 0.125 * ++number)};
  CHECK_THAT(said(answers_table(answers::Compared(results))),
             Catch::Contains("Not run: 3 of 12 cases (the heavy mass with soft): step … is beyond 2.\n"));
  for (CaseRecord& record : results.cases)
    if (record.status == "refused") record.reasons = {"no impact measure"};
  // A reference that refuses is named.
  for (CaseRecord& record : results.cases)
    record.notes = {"reference that does not apply: exact: the beam is held twice"};
  CHECK_THAT(said(answers_table(answers::Compared(results))),
             Catch::Contains("The reference exact does not apply: the beam is held twice.\n"));
  results.cases.back().notes.clear();
  CHECK_THAT(said(answers_table(answers::Compared(results))),
             Catch::Contains("The reference exact does not apply to 11 of 12 cases: "));
  for (CaseRecord& record : results.cases) record.notes.clear();
  // Of several methods one alone.
  StudyResults one = study([](int, int, double step) { return 0.6 + step; }, {4e-4, 2e-4, 1e-4}, 1);
  for (CaseRecord& record : one.cases)
    if (record.axes[0].second == "light") record.status = "refused";
  CHECK_THAT(said(answers_table(answers::Compared(one))),
             Catch::StartsWith("Only the heavy mass runs: the energy left is 60.01 "));
  // What becomes of cases, first.
  results.study = {{"observe", {"status", "energy_left"}}};
  CHECK_THAT(said(answers_table(answers::Compared(results))),
             Catch::StartsWith("Everything that applies runs: 9 of 12 cases"));
}
