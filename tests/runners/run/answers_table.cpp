// What answers rest on: limits, shares, observed measures; references that refuse.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>

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
        record.status = Status::done;
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

}  // namespace

TEST_CASE("removing the finest step never makes an answer surer") {
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> uniform;
  for (int draw = 0; draw < 60; ++draw) {
    const double a = uniform(random), b = uniform(random), p = 0.5 + 3 * uniform(random);
    const auto value = [&](int mass, int, double step) { return 0.5 + 0.1 * mass * a + b * std::pow(1e3 * step, p); };
    const auto uncertainty = [&](const std::vector<double>& steps) {
      const std::vector<Table> tables = evidence_tables(Choices(study(value, steps, 1)));
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

TEST_CASE("a reference that refuses is named, with the cases that it leaves") {
  StudyResults results = study([](int mass, int, double step) { return (mass ? 0.6 : 0.4) + step; });
  const auto first = [&] { return AnalysedResults(results).asked.first; };
  CHECK(first().empty());
  for (CaseRecord& record : results.cases)
    record.notes = {"reference that does not apply: exact: the beam is held twice"};
  CHECK(first() == std::vector<std::string>{"The reference exact does not apply: the beam is held twice."});
  results.cases.back().notes.clear();
  CHECK(first() ==
        std::vector<std::string>{"The reference exact does not apply to 11 of 12 cases: the beam is held twice."});
}
