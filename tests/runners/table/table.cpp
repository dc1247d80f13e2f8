#include "runners/table/table.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <limits>

#include "runners/table/number_table.hpp"
#include "runners/table/table_reader.hpp"
#include "runners/table/text.hpp"

using namespace ricochet;

namespace {

Table sample() {
  return {"limits",
          "One step.",
          {{"step", "s", "Time step."}, {"closed", "", "Whether contact is closed."}, {"why", "", "A reason."}},
          {{1e-4, true, "a, b"}, {2, false, nullptr}, {std::numeric_limits<double>::quiet_NaN(), nullptr, ""}}};
}

}  // namespace

TEST_CASE("a cell is what it is made of, and what is not finite is nothing") {
  CHECK(Cell().is_nothing());
  CHECK(Cell(nullptr).is_nothing());
  CHECK(Cell(std::numeric_limits<double>::infinity()).is_nothing());
  CHECK(Cell(std::optional<double>()).is_nothing());
  CHECK(Cell(std::optional<double>(0.5)).number() == 0.5);
  CHECK(Cell(3).whole() == 3);
  CHECK(Cell(3).number() == 3.0);
  CHECK(Cell(3) == Cell(3.0));
  CHECK_FALSE(Cell(3.5).whole());
  CHECK(Cell(true).truth() == true);
  CHECK_FALSE(Cell(true).number());
  CHECK_FALSE(Cell("3").number());
  CHECK_FALSE(Cell("") == Cell());
  CHECK(Cell("x") == "x");
  CHECK(Cell(1e-5).text() == "1e-05");
  CHECK(Cell(false).text() == "false");
  CHECK(Cell().text().empty());
}

TEST_CASE("a reader finds a column once, and says which table lacks one") {
  const Table table = sample();
  const TableReader rows(table);
  REQUIRE(rows.size() == 3);
  const std::size_t step = rows.column("step"), closed = rows.column("closed");
  CHECK(rows.number(0, step) == 1e-4);
  CHECK(rows.number(1, step) == 2.0);
  CHECK_FALSE(rows.number(2, step));
  CHECK(rows.truth(0, closed) == true);
  CHECK_FALSE(rows.truth(2, closed));
  CHECK(rows.text(0, "why") == "a, b");
  CHECK(rows.text(1, "step") == "2");
  CHECK(rows.column_if_any("radius") == TableReader::absent);
  CHECK(rows.cell(0, TableReader::absent).is_nothing());
  CHECK_THROWS_WITH(rows.column("radius"), "the table limits has no column radius");
  CHECK_THROWS_AS(rows.number(0, "radius"), TableError);
}

TEST_CASE("a table as CSV") {
  CHECK(table_csv(sample()) == "step,closed,why\n1e-04,true,\"a, b\"\n2,false,\n,,\n");
}

TEST_CASE("copies share their columns until one of them is changed") {
  Table one = sample();
  Table other = one;
  CHECK(other.columns.same(one.columns));
  other.columns.push_back({"more", "1", ""});
  CHECK_FALSE(other.columns.same(one.columns));
  CHECK(one.columns.size() + 1 == other.columns.size());
  one.columns.own().front().name = "first";
  CHECK(other.columns.front().name != "first");
  CHECK(Columns().empty());
}

TEST_CASE("columns that were read back are described by those that are declared") {
  Table stored{"limits", "", named_columns({"why", "step", "more"}), {}};
  describe(stored, sample());
  CHECK(stored.text == "One step.");
  CHECK(stored.columns[0].text == "A reason.");
  CHECK(stored.columns[1].unit == "s");
  CHECK(stored.columns[2].name == "more");
  CHECK(stored.columns[2].text.empty());
}

TEST_CASE("a table of numbers is filled by rows and read by columns") {
  NumberTable table = number_table("points", named_columns({"parameter", "start"}));
  table.words = {{"start", {"rest", "up"}}};
  table.add({0.07, 1});
  table.add({0.08, 0});
  CHECK(table.rows() == 2);
  REQUIRE(table.numbers("parameter"));
  CHECK(*table.numbers("parameter") == std::vector<double>{0.07, 0.08});
  CHECK(table.numbers("phase") == nullptr);
  REQUIRE(table.words_of("start"));
  CHECK(table.words_of("parameter") == nullptr);
  CHECK(find_table(std::vector<NumberTable>{table}, "impacts") == nullptr);
}

TEST_CASE("csv: a number reads back as the same double") {
  for (const double value : {0.1, 1.0 / 3.0, 1e-300, 5e-324, 6.02214076e23, -0.0, 14.0, 1e22, 2.5e-7}) {
    const std::string text = csv_number(value);
    CHECK(std::strtod(text.c_str(), nullptr) == value);
  }
  CHECK(csv_number(14) == "14");
  CHECK(csv_number(0.25) == "0.25");
}

TEST_CASE("csv: what is not finite is an empty field") {
  CHECK(csv_number(std::numeric_limits<double>::quiet_NaN()).empty());
  CHECK(csv_number(std::numeric_limits<double>::infinity()).empty());
  CHECK(csv_number(-std::numeric_limits<double>::infinity()).empty());
}

TEST_CASE("csv: quoting after RFC 4180") {
  CHECK(csv_field("plain text") == "plain text");
  CHECK(csv_field("a,b") == "\"a,b\"");
  CHECK(csv_field("say \"x\"") == "\"say \"\"x\"\"\"");
  CHECK(csv_field("two\nlines") == "\"two\nlines\"");
  CHECK(csv_field("") == "");
}
