#include "runners/command/table.hpp"

#include <catch2/catch.hpp>

using namespace ricochet;

TEST_CASE("Columns are aligned by characters, and empty ones are left out") {
  TextTable table({"a", "none", "b"});
  table.add({"é", "", "1"});
  table.add({"long", "", "2"});
  CHECK(table.text(1) == " a     b\n é     1\n long  2\n");
}

TEST_CASE("Times are told in the unit that a person would choose") {
  CHECK(plain_seconds(2.4e-3) == "2.4 ms");
  CHECK(plain_seconds(0.3) == "300 ms");
  CHECK(plain_seconds(3) == "3.0 s");
  CHECK(plain_seconds(99.4) == "99 s");
  CHECK(plain_seconds(119.9) == "2 min 0 s");
  CHECK(plain_seconds(7260) == "2 h 1 min");
}

TEST_CASE("Values of axes are told in their shortest form") {
  CHECK(plain(0.1) == "0.1");
  CHECK(plain(1e6) == "1e+06");
  CHECK(plain(1234567.5) == "1234567.5");
  CHECK(plain(50) == "50");
  CHECK(plain("P1") == "P1");
  CHECK(plain(nullptr) == "none");
  CHECK(plain({1.0, 1.5}) == "[1.0,1.5]");
}
