#include "runners/command/describe_words.hpp"

#include <catch2/catch.hpp>

using namespace ricochet;

TEST_CASE("Values of axes are told in their shortest form") {
  CHECK(plain(0.1) == "0.1");
  CHECK(plain(1e6) == "1e+06");
  CHECK(plain(1234567.5) == "1234567.5");
  CHECK(plain(50) == "50");
  CHECK(plain("P1") == "P1");
  CHECK(plain(nullptr) == "none");
  CHECK(plain({1.0, 1.5}) == "[1.0,1.5]");
}
