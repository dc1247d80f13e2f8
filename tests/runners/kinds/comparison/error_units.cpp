// A column of errors has their unit where they have one.
#include <catch2/catch.hpp>

#include "runners/kinds/comparison/comparison_tables.hpp"

using namespace ricochet;

TEST_CASE("tables of errors say the unit that all errors of the study have") {
  StudyResults results;
  const auto unit = [&](const std::vector<std::string>& errors) {
    results.study = {{"errors", errors}};
    return error_unit(results);
  };
  CHECK(unit({"tip-linf"}) == "m");
  CHECK(unit({"tip-linf", "tip-l2"}) == "m");
  CHECK(unit({"energy"}) == "J");
  CHECK(unit({"tip-linf", "energy"}) == of_each_error);
  CHECK(unit({"of-another-program"}) == of_each_error);
  CHECK(unit({}) == of_each_error);
  results.study = {{"errors", {"impulse"}}};
  for (const Table& table : {errors_table(results), work_precision_table(results), precision_targets_table(results)}) {
    INFO(table.name);
    int units = 0;
    for (const Column& column : table.columns) {
      CHECK(column.unit != of_each_error);
      units += column.unit == "N s" ? 1 : 0;
    }
    CHECK(units > 0);
  }
}
