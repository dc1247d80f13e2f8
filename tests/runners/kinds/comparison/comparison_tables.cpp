// Which columns of comparing studies are methods.
#include "runners/kinds/comparison/comparison_tables.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "runners/kinds/comparison/comparison_answers.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/table_reader.hpp"

using namespace ricochet;

namespace {

StudyResults two_schemes() {
  StudyResults results;
  results.columns = {"mass", "contact", "time", "step"};
  for (const char* scheme : {"one", "other"}) {
    CaseRecord record;
    record.id = scheme;
    record.status = Status::done;
    record.axes = {{"mass", "full"}, {"contact", "rigid"}, {"time", scheme}, {"step", 1e-3}};
    results.cases.push_back(std::move(record));
  }
  return results;
}

}  // namespace

TEST_CASE("a way of marching is part of the method: both ways of one scene stand against each other") {
  CHECK(is_method("march"));
  CHECK(is_method("mass.velocity"));
  CHECK_FALSE(is_method("structure.damping.stiffness"));
  CHECK(is_scene("structure.damping.stiffness"));
  for (const char* column : {"march", "step", "elements", "time.beta"}) CHECK_FALSE(is_scene(column));
  StudyResults results = two_schemes();
  results.columns = {"mass", "contact", "time", "march", "step"};
  results.study = {{"errors", {"tip-linf"}}};
  const double seconds[] = {3e-3, 2e-4};
  for (std::size_t k = 0; k < 2; ++k) {
    CaseRecord& record = results.cases[k];
    record.axes = {{"mass", "full"},
                   {"contact", "rigid"},
                   {"time", "one"},
                   {"march", k ? "flights" : "every-step"},
                   {"step", 1e-3}};
    record.measures = {
        {"error.tip-linf", 1e-5}, {"size.tip-linf", 1e-2}, {"timed_seconds", seconds[k]}, {"steps_visited", 1}};
  }
  const Table targets = precision_targets_table(results);
  REQUIRE_FALSE(targets.rows.empty());
  const TableReader rows(targets);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    CHECK(rows.text(row, "case") == "other");
    CHECK(rows.text(row, "other_case") == "one");
  }
}

TEST_CASE("errors of velocities show no order beyond that of their reading") {
  CaseRecord record;
  record.measures = {{"declared_order", 3}, {"velocity_order", 2}};
  for (const char* error : {"velocity-l2", "energy"}) {
    CHECK(shown_order(record, error).order == 2);
    CHECK(shown_order(record, error).because == "velocities are read by order 2, the scheme declares 3");
  }
  CHECK(shown_order(record, "displacement-l2").order == 3);
  record.measures[1].second = 3;
  CHECK(shown_order(record, "energy").order == 3);
  CHECK(shown_order(record, "energy").because.empty());
}
