#include "runners/answers/numbers_in_words.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <string>

using namespace ricochet;
using namespace ricochet::answers;

namespace {

/// The number that a text begins with: "−4.9e5 ± …".
double number_of(std::string text) {
  for (std::size_t at = text.find("−"); at != std::string::npos; at = text.find("−"))
    text.replace(at, std::string("−").size(), "-");
  return std::stod(text);
}

MeasureWords in_unit(const std::string& unit) {
  MeasureWords words;
  words.unit = unit;
  return words;
}

}  // namespace

TEST_CASE("numbers in words: value ± u holds the value, whatever both are") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-9, 9), share(-8.9, 1.5), mantissa(1, 10);
  const std::string mark = " ± ";
  for (int draw = 0; draw < 5000; ++draw) {
    const double value = mantissa(random) * std::pow(10, std::floor(exponent(random))) * (draw % 2 == 0 ? 1 : -1),
                 u = std::abs(value) * std::pow(10, share(random));
    const std::string text = with_uncertainty(in_unit("N"), value, u);
    CAPTURE(value, u, text);
    const std::size_t at = text.find(mark);
    REQUIRE(at != std::string::npos);
    const double told = number_of(text), told_u = number_of(text.substr(at + mark.size()));
    // One digit of u, two where it begins with 1: half a unit of the last is a quarter of u at most.
    CHECK(std::abs(told - value) <= 0.26 * u);
    CHECK(told_u == Approx(u).epsilon(0.25));
  }
}

TEST_CASE("numbers in words: a share beside another has the digits that tell them apart") {
  CHECK(percent_beside(1.0482e-4, 1e-4) == "0.0105 %");
  CHECK(percent_beside(1e-4, 1e-4) == percent(1e-4));
  CHECK(percent_beside(0.05, 0.01) == percent(0.05));
}

TEST_CASE("numbers in words: large, small and nearly whole values keep the digits that they are known by") {
  CHECK(with_uncertainty(in_unit("N"), 489897.9485566, 0.0011) == "489897.9486 ± 0.0011 N");
  CHECK(with_uncertainty(in_unit("m"), 2.362042451e-4, 2e-10) == "2.362042e-4 ± 2e-10 m");
  // Known to round-off: six digits.
  CHECK(with_uncertainty(in_unit("s"), 1.36022345e-5, 1e-18) == "1.36022e-5 s");
  MeasureWords percent = in_unit("%");
  percent.factor = 100;
  CHECK(with_uncertainty(percent, 0.9999999514, 1e-9) == "99.99999514 ± 1e-7 %");
  CHECK(with_uncertainty(percent, 0.99999999995, 1e-9) == "100 ± 1e-7 %");
  // What is lacking of 100 % keeps two digits.
  CHECK(value_text(percent, 0.9999960678, {}) == "99.99961 %");
  CHECK(value_text(percent, 1, {}) == "100 %");
}
