#include <catch2/catch.hpp>
#include <ricochet/contract/said_format.hpp>
#include <stdexcept>

using namespace ricochet;

TEST_CASE("said: the text of fmt::format, and its numbers") {
  const std::string word = "beam 12";
  const Said text = said("{{h}} = {:g} s of {}: {} points, {:.3g} times, {}, {}", 1e-5, word, 3, 2.0 / 3, true, 'x');
  CHECK(text.text ==
        fmt::format("{{h}} = {:g} s of {}: {} points, {:.3g} times, {}, {}", 1e-5, word, 3, 2.0 / 3, true, 'x'));
  REQUIRE(text.marks.size() == 3);
  CHECK(text.number(0) == "1e-05");
  CHECK(text.number(1) == "3");
  CHECK(text.number(2) == "0.667");
  CHECK(said("{1} of {0}", 7u, -2LL).number(0) == "-2");
  CHECK(said("nothing").marks.empty());
  CHECK(Said("of a plugin, at 0.1 s").marks.empty());
}

TEST_CASE("said: texts in a text keep their numbers") {
  Said text = said("body {}: {}; then", "b1", said("the mass {:g} kg is {} times too large", 0.5, 10));
  CHECK(text.text == "body b1: the mass 0.5 kg is 10 times too large; then");
  text += said(" at t = {:g} s", 2.5) + " " + as_number("1, 2 and 3 more", "s");
  REQUIRE(text.marks.size() == 4);
  CHECK(text.number(0) == "0.5");
  CHECK(text.number(1) == "10");
  CHECK(text.number(2) == "2.5");
  CHECK(text.number(3) == "1, 2 and 3 more");
  CHECK(text.marks[3].unit == "s");
  CHECK(text.text.ends_with("at t = 2.5 s 1, 2 and 3 more s"));
}

TEST_CASE("said: texts that differ in numbers alone are alike") {
  const auto refused = [](double limit, const char* scheme) {
    return said("h is beyond the limit {:g} s of {}: use a smaller step", limit, scheme);
  };
  CHECK(refused(1e-5, "a").without_numbers() == refused(0.25, "a").without_numbers());
  CHECK(refused(1e-5, "a").without_numbers() != refused(1e-5, "b").without_numbers());
  // Digits of words are none of its numbers.
  CHECK(refused(1, "p 1").without_numbers() != refused(1, "p 2").without_numbers());
  const Said shared = refused(1e-5, "a").with_numbers({"…"});
  CHECK(shared.text == "h is beyond the limit … s of a: use a smaller step");
  CHECK(shared.number(0) == "…");
  CHECK_THROWS_AS(shared.with_numbers({}), std::invalid_argument);
}
