#include "runners/table/text.hpp"

#include <catch2/catch.hpp>

using namespace ricochet;

TEST_CASE("Columns are aligned by characters, and empty ones are left out") {
  TextTable table({"a", "none", "b"});
  table.add({"é", "", "1"});
  table.add({"long", "", "2"});
  CHECK(table.text(1) == " a     b\n é     1\n long  2\n");
}

TEST_CASE("Times are told in the unit that a person would choose") {
  CHECK(duration_text(2.4e-3) == "2.4 ms");
  CHECK(duration_text(0.3) == "300 ms");
  CHECK(duration_text(3) == "3.0 s");
  CHECK(duration_text(42.3) == "42 s");
  CHECK(duration_text(59.7) == "1 min 00 s");
  CHECK(duration_text(185) == "3 min 05 s");
  CHECK(duration_text(7800) == "2 h 10 min");
}
