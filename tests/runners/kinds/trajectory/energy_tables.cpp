#include "runners/kinds/trajectory/energy_tables.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "runners/kinds/trajectory/energy_trend.hpp"
#include "runners/table/table_reader.hpp"
#include "tests/runners/report/synthetic.hpp"

using namespace ricochet;

TEST_CASE("the order of a trend is that of a power law") {
  for (const double order : {0.5, 1.0, 2.0}) {
    const std::vector<double> steps = {1e-3, 2e-4, 1e-4};
    std::vector<double> ratios, damped;
    for (const double h : steps) ratios.push_back(1 - std::pow(h, order));
    // 1 − (1 − x) loses at most 2⁻⁵³ of x ≥ 1e-8, hence 1e-8 of the logarithm's argument
    CHECK(energy_trend(steps, ratios, 1e-15).order.value() == Approx(order).margin(1e-6));
    // The moves of a power law follow it only for a constant ratio of steps.
    const std::vector<double> even = {4e-4, 2e-4, 1e-4};
    for (const double h : even) damped.push_back(0.43 - std::pow(h, order));
    CHECK(energy_trend(even, damped, 1e-15, false).order.value() == Approx(order).margin(1e-6));
  }
  CHECK(energy_trend({}, {}, 1e-12).trend == Trend::none);
}

TEST_CASE("the noise floor is round-off or the balance's residual, whichever is larger") {
  CaseRecord record;
  record.steps = 1 << 20;
  CHECK(energy_noise(record) == std::ldexp(1.0, -32));
  record.measures = {{"energy_brought_in", 2}, {"balance_residual", -1e-9}};
  CHECK(energy_noise(record) == 5e-10);
  // What a scheme takes and does not declare is no round-off.
  record.measures.back().second = -1e-3;
  CHECK(energy_noise(record) == std::ldexp(1.0, -32));
}

TEST_CASE("the energies of a study stand in tables before any sentence says them") {
  const StudyResults results = synthetic::results();
  const Table ends = energy_ends_table(results), masses = energy_by_mass_table(results),
              trends = energy_trends_table(results), worth = choice_worth_table(results);
  const TableReader mass(masses);
  REQUIRE(mass.size() == 4);
  double finished = 0;
  for (std::size_t row = 0; row < mass.size(); ++row) finished += mass.number(row, "finished").value();
  CHECK(finished == static_cast<double>(ends.rows.size()));
  // A method per mass, velocity, scheme and parameter.
  CHECK(trends.rows.size() == 12);
  const TableReader choices(worth);
  for (std::size_t row = 0; row < choices.size(); ++row) {
    CHECK(choices.number(row, "median").value() <= choices.number(row, "largest").value());
    CHECK(choices.number(row, "comparisons").value() >= 1);
  }
  for (const Table* table : {&ends, &masses, &trends, &worth})
    for (const Row& row : table->rows) CHECK(row.size() == table->columns.size());
}

TEST_CASE("a scheme that declares no work leaves the others to tell whether a scene keeps its energy") {
  StudyResults results;
  results.columns = {"time", "support.amplitude", "step"};
  const auto add = [&](const char* scheme, double amplitude, std::optional<double> loads) {
    CaseRecord& record = results.cases.emplace_back();
    record.status = "done";
    record.axes = {{"time", scheme}, {"support.amplitude", amplitude}, {"step", 1e-3}};
    if (loads) record.measures = {{"work_of_damping", 0.0}, {"work_of_loads", *loads}};
  };
  add("silent", 0, std::nullopt);
  CHECK_FALSE(energy_is_kept(results));
  add("audited", 0, 0.0);
  CHECK(energy_is_kept(results));
  // Of another scene nothing is known yet, and then that it is driven.
  add("silent", 0.1, std::nullopt);
  CHECK_FALSE(energy_is_kept(results));
  add("audited", 0.1, 0.0);
  CHECK(energy_is_kept(results));
  results.cases.back().measures.back().second = 1e-3;
  CHECK_FALSE(energy_is_kept(results));
}

TEST_CASE("the ledger of a case closes, and says so where the works are not known") {
  StudyResults results;
  CaseRecord& known = results.cases.emplace_back();
  known.status = "done";
  // The scheme's own energy rises by 1.25 J, a quarter of which the common one has not: loads 1 − damping 0.5 − scheme
  // 0.2 + stops 0.95, of whose springs 0.0625 J are held at the end beside it.
  known.measures = {{"energy_start", 2},         {"energy_end", 3.0625},      {"energy_brought_in", 3},
                    {"work_of_loads", 1},        {"work_of_damping", 0.5},    {"dissipated_at_contact", -1.0125},
                    {"stored_at_stops", 0.0625}, {"balance_residual", 1e-12}, {"dissipated_by_scheme", 0.2},
                    {"scheme_energy_start", 2},  {"scheme_energy_end", 3.25}};
  CaseRecord& silent = results.cases.emplace_back();
  silent.status = "done";
  silent.measures = {{"energy_start", 2}, {"energy_end", 1}};
  const Table ledger = energy_ledger_table(results);
  const TableReader rows(ledger);
  REQUIRE(rows.size() == 2);
  const auto of = [&](const char* column) { return rows.number(0, column).value(); };
  CHECK(of("start") + of("loads") - of("damping") - of("stops") - of("scheme") - of("form") + of("residual") ==
        Approx(of("end")).epsilon(1e-12));
  CHECK(of("form") == 0.25);
  CHECK(rows.text(0, "closes") == "exact");
  CHECK(rows.text(1, "closes") == "not known");
  CHECK_FALSE(rows.number(1, "stops"));
}
