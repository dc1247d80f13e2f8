// What a study of trajectories answers: each choice against what step and mesh leave open.
#include "runners/run/answers_table.hpp"

#include <catch2/catch.hpp>
#include <functional>

#include "runners/run/choice_effects.hpp"
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
        record.measures = {{"energy_left", left(mass, law, step)}, {"work_of_loads", 0}};
      }
  return results;
}

std::string verdict_of(const Table& answers, const std::string& choice) {
  const TableReader rows(answers);
  for (std::size_t row = 0; row < rows.size(); ++row)
    if (rows.text(row, "choice") == choice) return rows.text(row, "verdict");
  return "";
}

std::string said(const Table& answers) {
  std::string all;
  const TableReader rows(answers);
  for (std::size_t row = 0; row < rows.size(); ++row) all += rows.text(row, "sentence") + "\n";
  return all;
}

}  // namespace

TEST_CASE("a choice decides, does not matter, or is not resolved") {
  const Table decided = answers_table(study([](int mass, int, double step) { return (mass ? 0.6 : 0.4) + step; }));
  CHECK(verdict_of(decided, "mass") == "decides");
  CHECK(verdict_of(decided, "contact") == "does not matter");
  CHECK_THAT(said(decided), Catch::Contains("The mass matrix decides: energy left by 20 % against 0.01 % from the step "
                                            "(least with light, most with heavy)."));
  CHECK_THAT(said(decided), Catch::Contains("The contact law does not matter here: energy left 0 % against 0.01 %"));

  const Table open = answers_table(study([](int mass, int, double step) { return (mass ? 0.42 : 0.4) + 200 * step; }));
  CHECK(verdict_of(open, "mass") == "not resolved");
  // 2 % in 1e-4 s leave 2 % open; a third of the difference is open at a third of the step.
  CHECK_THAT(said(open), Catch::Contains("refine h to 2e-5 s"));
}

TEST_CASE("where a choice decides with some levels of another, that one is named") {
  const Table answers =
      answers_table(study([](int mass, int law, double step) { return 0.4 + (mass && law ? 0.2 : 0) + step; }));
  CHECK(verdict_of(answers, "mass") == "depends");
  CHECK_THAT(said(answers),
             Catch::Contains("The mass matrix decides in part, as the contact law tells: energy left in 1 "
                             "of 2 combinations by up to 20 %."));
}

TEST_CASE("what decides nowhere is not said to decide in part") {
  // Within 1 % with one law, open with the other.
  const Table answers =
      answers_table(study([](int mass, int law, double step) { return 0.4 + 0.004 * mass + (law ? 300 : 1) * step; }));
  CHECK(verdict_of(answers, "mass") == "not resolved");
}

TEST_CASE("where a choice does not matter in most combinations, the others are told apart") {
  // Of five laws one leaves open what the mass changes: a median over all would be neither.
  const Table answers = answers_table(
      study([](int mass, int law, double step) { return 0.4 + 0.004 * mass + (law == 4 ? 300 : 1) * step; },
            {4e-4, 2e-4, 1e-4}, 5));
  CHECK_THAT(said(answers), Catch::Contains("What the mass matrix changes is not resolved: energy left in 1 of 5 "
                                            "combinations by 0.4 % against 3 % from the step"));
  CHECK_THAT(said(answers), Catch::Contains("The mass matrix changes less than 1 % here: energy left in 4 of 5 "
                                            "combinations 0.4 % against 0.01 % from the step."));
  const TableReader rows(answers);
  std::vector<double> combinations;
  for (std::size_t row = 0; row < rows.size(); ++row)
    if (rows.text(row, "choice") == "mass") combinations.push_back(rows.number(row, "combinations").value());
  CHECK(combinations == std::vector<double>{1, 4});
}

TEST_CASE("of what is far below any figure it is said that it is less") {
  const Table answers = answers_table(study([](int mass, int, double step) { return 0.4 + 1e-13 * mass + step; }));
  CHECK_THAT(said(answers), Catch::Contains("The mass matrix does not matter here: energy left less than 1e-7 %"));
}

TEST_CASE("one step tells nothing of what it leaves open") {
  const Table answers = answers_table(study([](int mass, int, double) { return mass ? 0.6 : 0.4; }, {1e-4}));
  CHECK(verdict_of(answers, "mass") == "not told");
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

TEST_CASE("cases that gave no result are told by what sets them apart, where all are done nothing is said of it") {
  StudyResults results = study([](int mass, int, double step) { return (mass ? 0.6 : 0.4) + step; });
  CHECK(said(answers_table(results)).find("iverged") == std::string::npos);
  for (CaseRecord& record : results.cases)
    if (record.axes[0].second == "heavy" && record.axes[1].second == "soft") record.status = "diverged";
  CHECK_THAT(said(answers_table(results)), Catch::Contains("Diverged: 3 of 12 cases (mass heavy; contact soft).\n"));
  // Why, where cases share it; a sentence of one case among many is in reasons.csv.
  for (CaseRecord& record : results.cases)
    if (record.status == "diverged") {
      record.status = "refused";
      record.reason = "no impact measure";
    }
  CHECK_THAT(said(answers_table(results)),
             Catch::Contains("Refused: 3 of 12 cases (mass heavy; contact soft). Why: no impact measure (3).\n"));
  results.cases.back().reason = "no step";
  CHECK_THAT(said(answers_table(results)), Catch::Contains("Why: no impact measure (2); no step (1).\n"));
}

TEST_CASE("what is told from step and mesh, and below 1 %, is small and not nothing, its spread has no shares") {
  const StudyResults results = study([](int mass, int, double step) { return 0.5 + 0.004 * mass + 2 * step; });
  Table effects = effects_table(results);
  CHECK_FALSE(effects.rows.empty());
  StudyResults with_shares = results;
  with_shares.derived.push_back(effects);
  const Table answers = answers_table(with_shares);
  CHECK(verdict_of(answers, "mass") == "does not matter");
  CHECK_THAT(said(answers),
             Catch::Contains("The mass matrix changes less than 1 % here: energy left 0.4 % against 0.02 %"));
  CHECK(said(answers).find("of the spread") == std::string::npos);
}
