#include <algorithm>
#include <catch2/catch.hpp>
#include <sstream>

#include "runners/command/subcommand.hpp"

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

TEST_CASE("A measure of a stop is described by its name with that of the stop") {
  std::ostringstream out;
  CHECK(describe_word("wear_power[bar-a]", out));
  CHECK_THAT(out.str(), Catch::Contains("bar-a") && Catch::Contains("W"));
  CHECK_FALSE(describe_word("energy_left[bar-a]", out));
  std::ostringstream bare;
  CHECK(describe_word("shock_rate", bare));
  CHECK_THAT(bare.str(), Catch::StartsWith("shock_rate[NAME] (a measure of a case, in 1/s)"));
}

TEST_CASE("Each column of cases.csv is described, measure or not") {
  for (const auto& [name, begins] : {std::pair{"setup_seconds", "setup_seconds (a column of cases.csv, in s): "},
                                     {"run_seconds", "run_seconds (a column of cases.csv, in s): "},
                                     {"status", "status (a column of cases.csv): "}}) {
    std::ostringstream out;
    CHECK(describe_word(name, out));
    CHECK_THAT(out.str(), Catch::StartsWith(begins));
  }
  const std::vector<std::string> words = words_of_results();
  CHECK(std::find(words.begin(), words.end(), "run_seconds") != words.end());
}

TEST_CASE("The words of studies are named once") {
  std::vector<std::string> words = words_of_studies();
  CHECK(std::find(words.begin(), words.end(), "tube") != words.end());
  std::sort(words.begin(), words.end());
  CHECK(std::adjacent_find(words.begin(), words.end()) == words.end());
}
