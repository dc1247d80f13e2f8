#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/contract/parameters.hpp>

using namespace ricochet;

namespace parameters_tests {
using Catch::Matchers::Contains;

namespace {
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
}  // namespace

TEST_CASE("a range contains its closed ends and not its open ones") {
  const bool low_open = GENERATE(false, true), high_open = GENERATE(false, true);
  const Range range{0, 1, low_open, high_open};
  CHECK(range.contains(0) == !low_open);
  CHECK(range.contains(1) == !high_open);
  CHECK(range.contains(0.5));
  CHECK(range.contains(std::nextafter(0.0, 1.0)));
  CHECK(range.contains(std::nextafter(1.0, 0.0)));
  CHECK_FALSE(range.contains(std::nextafter(0.0, -1.0)));
  CHECK_FALSE(range.contains(std::nextafter(1.0, 2.0)));
  CHECK_FALSE(range.contains(not_a_number));
}

TEST_CASE("a range is written as mathematicians do") {
  CHECK(Range{0, 0.5}.text() == "[0, 0.5]");
  CHECK(Range{0, infinity, true, false}.text() == "]0, ∞[");
  CHECK(Range{0, infinity}.text() == "[0, ∞[");
  CHECK(Range{-1, 1, true, true}.text() == "]-1, 1[");
  CHECK(Range{}.text() == "]−∞, ∞[");
}

TEST_CASE("a declaration holds what it was given") {
  const ParameterSpec beta = real_parameter("beta", "s", 0.25, {0, 0.5}, "β.");
  CHECK(beta.key == "beta");
  CHECK(beta.type == ParameterSpec::Type::real);
  CHECK(beta.unit == "s");
  CHECK(std::get<double>(*beta.fallback) == 0.25);
  CHECK_FALSE(beta.per_lane);
  const ParameterSpec count = integer_parameter("count", std::nullopt, {1, 4}, "N.");
  CHECK(count.type == ParameterSpec::Type::integer);
  CHECK_FALSE(count.fallback.has_value());
  const ParameterSpec space = word_parameter("space", {"P0", "P1"}, "P1", "Space.");
  CHECK(space.type == ParameterSpec::Type::word);
  CHECK(std::get<std::string>(*space.fallback) == "P1");
}

TEST_CASE("a value fits or the sentence says what was expected") {
  const ParameterSpec beta = real_parameter("beta", "1", std::nullopt, {0, 0.5}, "β.");
  CHECK_FALSE(check_parameter(beta, 0.25));
  CHECK_FALSE(check_parameter(beta, 0.0));
  CHECK_THAT(*check_parameter(beta, 0.75), Contains("0.75 is outside [0, 0.5]"));
  CHECK_THAT(*check_parameter(beta, not_a_number), Contains("outside [0, 0.5]"));
  CHECK_THAT(*check_parameter(beta, std::string("a quarter")), Contains("expected a number in [0, 0.5]"));
  CHECK_THAT(*check_parameter(beta, true), Contains("expected a number"));

  const ParameterSpec count = integer_parameter("count", std::nullopt, {1, 4}, "N.");
  CHECK_FALSE(check_parameter(count, 3LL));
  CHECK_THAT(*check_parameter(count, 5LL), Contains("5 is outside [1, 4]"));
  CHECK_THAT(*check_parameter(count, 2.5), Contains("expected a whole number in [1, 4]"));
  CHECK_THAT(*check_parameter(count, 2.0), Contains("expected a whole number"));

  const ParameterSpec space = word_parameter("space", {"P0", "P1"}, std::nullopt, "Space.");
  CHECK_FALSE(check_parameter(space, std::string("P0")));
  CHECK_THAT(*check_parameter(space, std::string("P2")), Contains("expected one of \"P0\", \"P1\""));
  CHECK_THAT(*check_parameter(space, 1.0), Contains("expected one of \"P0\", \"P1\""));

  ParameterSpec flag;
  flag.type = ParameterSpec::Type::boolean;
  CHECK_FALSE(check_parameter(flag, false));
  CHECK_THAT(*check_parameter(flag, 1LL), Contains("expected true or false"));
}

TEST_CASE("a table fits, or the sentence names its row") {
  const ParameterSpec force = table_parameter("force", "N against m", false, "p."),
                      back = table_parameter("back", "N against m", true, "b.");
  CHECK_FALSE(force.fallback.has_value());
  CHECK(std::get<ParameterTable>(*back.fallback).empty());
  const ParameterTable good = {{0, 0}, {1e-4, 0}, {3e-4, 400}};
  CHECK_FALSE(check_parameter(force, good));
  CHECK_FALSE(check_parameter(back, good));
  CHECK_FALSE(check_parameter(back, ParameterTable()));
  CHECK_THAT(*check_parameter(force, ParameterTable()), Contains("there is no row"));
  CHECK_THAT(*check_parameter(force, 1.0), Contains("expected rows [x, y] from [0, 0] on"));
  CHECK_THAT(*check_parameter(force, ParameterTable{{0, 0}, {2, 1}, {1, 2}}),
             Contains("row 3: x does not grow from [2, 1] to [1, 2]"));
  CHECK_THAT(*check_parameter(force, ParameterTable{{0, 0}, {1, infinity}}), Contains("row 2: [1, inf] is not finite"));
  CHECK(Parameters({{"t", good}}).table("t") == good);
  CHECK_THROWS_WITH(Parameters({{"t", 1.0}}).table("t"), Contains("'t' has another type"));
}

TEST_CASE("an infinite value fits only an interval that is closed there") {
  CHECK(check_parameter(real_parameter("k", "N/m", std::nullopt, {0, infinity, true, true}, "k."), infinity));
  CHECK_FALSE(check_parameter(real_parameter("k", "N/m", std::nullopt, {0, infinity, true, false}, "k."), infinity));
}

TEST_CASE("a whole number serves where a real is expected, and nothing else is converted") {
  CHECK_FALSE(check_parameter(real_parameter("k", "N/m", std::nullopt, {0, 10}, "k."), 3LL));
  Parameters parameters({{"k", 3LL}, {"x", 2.5}, {"word", std::string("P0")}, {"flag", true}});
  CHECK(parameters.real("k") == 3.0);
  CHECK(parameters.integer("k") == 3);
  CHECK(parameters.real("x") == 2.5);
  CHECK(parameters.word("word") == "P0");
  CHECK(parameters.flag("flag"));
  CHECK_THROWS_WITH(parameters.integer("x"), Contains("'x' has another type"));
  CHECK_THROWS_WITH(parameters.real("word"), Contains("'word' has another type"));
  CHECK_THROWS_WITH(parameters.real("y"), Contains("'y' was never declared"));
  parameters.set("y", 1.0);
  CHECK(parameters.real("y") == 1.0);
  CHECK(parameters.values().size() == 5);
}

TEST_CASE("a value is found by the role of its parameter, whatever its key") {
  const std::vector<ParameterSpec> declared = {
      real_parameter("restitution", "1", 0.1, {0, 1}, "Not this."),
      with_role(real_parameter("e", "1", 0.2, {0, 1}, "This."), ParameterRole::restitution)};
  const Parameters values({{"restitution", 0.1}, {"e", 0.75}});
  CHECK(value_of_role(declared, values, ParameterRole::restitution) == 0.75);
  CHECK_FALSE(value_of_role(declared, values, ParameterRole::stiffness).has_value());
  CHECK(value_of_role(declared, Parameters({{"e", 1LL}}), ParameterRole::restitution) == 1);
}

}  // namespace parameters_tests
