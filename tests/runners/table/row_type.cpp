#include "runners/table/row_type.hpp"

#include <catch2/catch.hpp>

using namespace ricochet;

namespace {

struct Measured {
  std::string id, name;
  int count = 0;
  double value = 0;
  std::optional<double> limit;
  bool closed = false;
};

TableType<Measured> measured_type() {
  RowType<Measured> rows;
  rows.of_case(&Measured::id)
      .add({"name", "", "Its name."}, &Measured::name)
      .add({"count", "1", "How many."}, &Measured::count)
      .add({"value", "m", "A displacement."}, &Measured::value)
      .add({"limit", "m", "Its limit."}, &Measured::limit)
      .add({"closed", "", "Whether it is closed."}, &Measured::closed);
  return {"measured", "A measurement.", rows};
}

// As a derived table has it: the case, an axis of the study, then the declared columns.
Table of_cases() {
  Table table = measured_type().head();
  table.columns = joined({{case_name, "", ""}, {"step", "s", ""}}, table.columns);
  table.rows = {{"a", 1e-3, "first", 1, 0.5, nullptr, true}, {"b", 1e-4, nullptr, 2, nullptr, 0.25, false}};
  return table;
}

}  // namespace

TEST_CASE("row type: what is written is read back, and what is absent stays so") {
  const TableType<Measured> type = measured_type();
  const std::vector<Measured> rows = {{"", "first", 3, 0.1, 0.2, true}, {"", "", -1, 1e-300, std::nullopt, false}};
  const Table table = type.with(rows);
  CHECK(table.rows[1][3].is_nothing());
  const std::vector<Measured> back = type.rows.read(table);
  REQUIRE(back.size() == rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) CHECK(type.rows.row(back[k]) == type.rows.row(rows[k]));
}

TEST_CASE("row type: columns are found by name, whatever stands between them, and one may be missing") {
  const TableType<Measured> type = measured_type();
  Table table = of_cases();
  CHECK(type.rows.read(table)[1].id == "b");
  CHECK(type.rows.read(table)[1].limit == 0.25);
  table.columns.own()[5].name = "another";
  CHECK_FALSE(type.rows.read(table)[1].limit.has_value());
}
