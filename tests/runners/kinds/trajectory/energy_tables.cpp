#include "runners/kinds/trajectory/energy_tables.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "runners/answers/limits.hpp"
#include "runners/table/table_reader.hpp"
#include "tests/runners/report/synthetic.hpp"

using namespace ricochet;

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

TEST_CASE("a scheme that declares no work leaves the others to tell whether a scene keeps its energy") {
  StudyResults results;
  results.columns = {"time", "support.amplitude", "step"};
  const auto add = [&](const char* scheme, double amplitude, std::optional<double> loads) {
    CaseRecord& record = results.cases.emplace_back();
    record.status = Status::done;
    record.axes = {{"time", scheme}, {"support.amplitude", amplitude}, {"step", 1e-3}};
    if (loads) record.measures = {{"work_of_damping", 0.0}, {"work_of_loads", *loads}};
  };
  add("silent", 0, std::nullopt);
  CHECK_FALSE(answers::keeps_energy(results));
  add("audited", 0, 0.0);
  CHECK(answers::keeps_energy(results));
  // Of another scene nothing is known yet, and then that it is driven.
  add("silent", 0.1, std::nullopt);
  CHECK_FALSE(answers::keeps_energy(results));
  add("audited", 0.1, 0.0);
  CHECK(answers::keeps_energy(results));
  results.cases.back().measures.back().second = 1e-3;
  CHECK_FALSE(answers::keeps_energy(results));
}

TEST_CASE("the ledger of a case closes, and says so where the works are not known") {
  StudyResults results;
  CaseRecord& known = results.cases.emplace_back();
  known.status = Status::done;
  // The scheme's own energy rises by 1.25 J: loads 1 − damping 0.5 − scheme 0.2 + stops 0.95. The common one rises by
  // 1.0625 J, of which springs at the stops hold 0.0625 J at the end.
  known.measures = {{"energy_start", 2},         {"energy_end", 3.0625},      {"energy_brought_in", 3},
                    {"work_of_loads", 1},        {"work_of_damping", 0.5},    {"dissipated_at_contact", -1.0125},
                    {"stored_at_stops", 0.0625}, {"balance_residual", 1e-12}, {"dissipated_by_scheme", 0.2},
                    {"scheme_energy_start", 2},  {"scheme_energy_end", 3.25}};
  CaseRecord& silent = results.cases.emplace_back();
  silent.status = Status::done;
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
