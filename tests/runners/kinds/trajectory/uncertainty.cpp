// Between which values a measure of a stop is, over methods, steps, meshes and parts of a window.
#include "runners/answers/uncertainty.hpp"

#include <catch2/catch.hpp>

#include "runners/answers/answer.hpp"
#include "runners/store/record.hpp"

using namespace ricochet;

namespace {

/// Two schemes at two steps: 10.2, 10.0 N and 11.1, 11.0 N.
StudyResults two_forces() {
  StudyResults results;
  results.kind = "trajectory";
  results.columns = {"time", "step"};
  const auto add = [&](const char* scheme, double step, double value) {
    CaseRecord& record = results.cases.emplace_back();
    record.id = scheme + std::to_string(results.cases.size());
    record.status = Status::done;
    record.axes = {{"time", scheme}, {"step", step}};
    record.measures = {{"impulse", 3.0}, {"rms_force[bar]", value}};
  };
  add("newmark", 2e-3, 10.2);
  add("newmark", 1e-3, 10.0);
  add("moreau-jean", 2e-3, 11.1);
  add("moreau-jean", 1e-3, 11.0);
  return results;
}

Cell told(const Table& table, const char* column) {
  REQUIRE(table.rows.size() == 1);
  return table.rows.front()[find_column(table.columns, column).value()];
}

Table uncertain(const StudyResults& results) {
  return answers::uncertainty_table(Choices(results));
}

}  // namespace

TEST_CASE("an interval is the range over the methods, widened by the sum of step, mesh and sampling") {
  StudyResults results = two_forces();
  const Table table = uncertain(results);
  CHECK(told(table, "measure").text() == "rms_force");
  CHECK(told(table, "stop").text() == "bar");
  CHECK(told(table, "unit").text() == "N");
  CHECK(told(table, "value").number() == 10.0);
  CHECK(told(table, "least").number() == 10.0);
  CHECK(told(table, "largest").number() == 11.0);
  // Of two steps their difference.
  CHECK(told(table, "step_gap").number().value() == Approx(0.2).epsilon(1e-12));
  CHECK(told(table, "mesh_gap").is_nothing());
  CHECK(told(table, "sampling").is_nothing());
  CHECK(told(table, "low").number().value() == Approx(9.8).epsilon(1e-12));
  CHECK(told(table, "high").number().value() == Approx(11.2).epsilon(1e-12));
  CHECK(told(table, "verdict").text() == "methods");
  CHECK(told(table, "sentence").text() ==
        "Rms force at bar: 9.8 to 11.2 N; methods differ by 1.0; the step leaves 0.2.");

  results.cases.back().measures.emplace_back("confidence.rms_force[bar]", 0.8);
  const Table sampled = uncertain(results);
  CHECK(told(sampled, "sampling").number() == 0.8);
  CHECK(told(sampled, "low").number().value() == Approx(9.0).epsilon(1e-12));
  CHECK(told(sampled, "verdict").text() == "sampling");
}

TEST_CASE("where methods differ by less than refinement leaves, no choice is said to decide") {
  StudyResults results = two_forces();
  results.cases[2].measures.back().second = 10.1;
  results.cases[3].measures.back().second = 10.05;
  CHECK(told(uncertain(results), "sentence").text() ==
        "Rms force at bar: 9.8 to 10.2 N; methods differ by 0.05; the step leaves 0.2.");
}

TEST_CASE("small powers are said in thousandths of a watt, and stand in the table in watts") {
  StudyResults results = two_forces();
  for (CaseRecord& record : results.cases) {
    record.measures.back().first = "wear_power[bar]";
    record.measures.back().second *= 1e-4;
  }
  const Table table = uncertain(results);
  CHECK(told(table, "unit").text() == "W");
  CHECK(told(table, "low").number().value() == Approx(9.8e-4).epsilon(1e-12));
  CHECK(told(table, "sentence").text() ==
        "Wear power at bar: 0.98 to 1.12 mW; methods differ by 0.10; the step leaves 0.02.");
}

TEST_CASE("an interval of what is never below 0 begins at 0") {
  StudyResults results = two_forces();
  results.cases.back().measures.emplace_back("confidence.rms_force[bar]", 30.0);
  CHECK(told(uncertain(results), "low").number() == 0.0);
  for (CaseRecord& record : results.cases)
    for (auto& [name, value] : record.measures)
      if (name == "rms_force[bar]") name = "window_displacement_mean[bar]";
  results.cases.back().measures.back().first = "confidence.window_displacement_mean[bar]";
  CHECK(told(uncertain(results), "low").number().value() == Approx(-20.2).epsilon(1e-12));
}

TEST_CASE("of a single step no interval is told") {
  StudyResults results = two_forces();
  results.cases.erase(results.cases.begin() + 2);
  results.cases.erase(results.cases.begin());
  const Table table = uncertain(results);
  CHECK(told(table, "least").number() == 10.0);
  CHECK(told(table, "low").is_nothing());
  CHECK(told(table, "high").is_nothing());
  CHECK(told(table, "verdict").text() == "unknown");
  CHECK(told(table, "sentence").text() == "Rms force at bar: 10.0 to 11.0 N; what the step leaves open is not known.");
}

TEST_CASE("measures of a whole case, and studies without stops with names, have no row") {
  StudyResults results = two_forces();
  for (CaseRecord& record : results.cases) record.measures.pop_back();
  CHECK(uncertain(results).rows.empty());
  CHECK(uncertain({}).rows.empty());
}
