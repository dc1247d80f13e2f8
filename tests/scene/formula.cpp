#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/formula.hpp>
#include <thread>
#include <vector>

#include "tests/scene/working_set.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;
using ricochet::testing::input_error;

namespace {
std::string refused(const std::string& text, const std::string& variables = "xt") {
  return input_error([&] { Formula(text, "/here", variables); });
}
}  // namespace

TEST_CASE("a formula has the value of its expression") {
  CHECK(Formula("0.04*x^2", "")(1.5) == Approx(0.09).epsilon(1e-15));
  CHECK(Formula("sin(pi*x)*cos(10*t)", "")(0.3, 0.2) ==
        Approx(std::sin(std::numbers::pi * 0.3) * std::cos(2.0)).epsilon(1e-15));
  CHECK(Formula("e", "")(0) == std::numbers::e);
  CHECK(Formula("x > 0.5 ? 1 : 2", "")(0.6) == 1);
  CHECK(Formula("x == 0.5", "")(0.5) == 1);
  CHECK(Formula("1e-3*x", "")(2) == Approx(2e-3).epsilon(1e-15));
  CHECK(Formula(-0.1)(7, 8) == -0.1);
  CHECK(Formula()(1) == 0);
}

TEST_CASE("a formula knows what it depends on") {
  CHECK(Formula("2*x", "").uses_x());
  CHECK_FALSE(Formula("2*x", "").uses_t());
  CHECK(Formula("sin(t)", "").uses_t());
  CHECK_FALSE(Formula("2*pi", "").uses_x());
  CHECK(Formula().is_zero());
  CHECK(Formula("0", "").is_zero());
  CHECK(Formula("1-1", "").is_zero());
  CHECK_FALSE(Formula("0*x + 1", "").is_zero());
  CHECK(Formula("0.04*x^2", "").text() == "0.04*x^2");
  CHECK(Formula(-0.1).text() == "-0.1");
}

TEST_CASE("a copy is independent of the original and of its lifetime") {
  Formula copy;
  {
    const Formula original("x + 10*t", "/there");
    copy = original;
    CHECK(original(1, 2) == 21);
  }
  CHECK(copy(3, 4) == 43);
  Formula moved = std::move(copy);
  CHECK(moved(3, 4) == 43);
  copy = moved;
  CHECK(copy(1) == 1);
  CHECK_THAT(input_error([] { Formula(Formula("1/x", "/there"))(0); }), Contains("/there: "));
}

TEST_CASE("copies are evaluated at the same time by several threads") {
  const Formula shared("sin(x) + t^2", "");
  std::vector<double> worst(4, 0.0);
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < worst.size(); ++k)
    threads.emplace_back([&worst, &shared, k] {
      const Formula own(shared);
      for (int i = 0; i < 20000; ++i) {
        const double x = 1e-3 * i + static_cast<double>(k);
        worst[k] = std::max(worst[k], std::abs(own(x, 0.5) - (std::sin(x) + 0.25)));
      }
    });
  for (auto& thread : threads) thread.join();
  for (double error : worst) CHECK(error < 1e-15);  // the same two operations
}

TEST_CASE("a copy that goes on with what another one left behind reads its own variables") {
  const Formula original("x + 10*t", "");
  CHECK(original(1, 2) == 21);
  for (int i = 0; i < 20; ++i) {
    const Formula first(original);
    Formula second(original);
    CHECK(first(i, 1) == i + 10);
    CHECK(second(2 * i, 2) == 2 * i + 20);
    second = Formula("x - t", "");
    CHECK(second(i, 1) == i - 1);
    CHECK(first(i, 3) == i + 30);
  }
  CHECK(original(3, 4) == 43);
}

TEST_CASE("evaluate() is operator() at each point and leaves judgement of values to the caller") {
  const Formula formula("1/x + t", "");
  const std::vector<double> x{1, 2, 0};
  std::vector<double> values(3);
  formula.evaluate(x, 3, values);
  CHECK(values[0] == 4);
  CHECK(values[1] == 3.5);
  CHECK(std::isinf(values[2]));
  Formula("2*t", "").evaluate(x, 3, values);
  CHECK(values == std::vector<double>{6, 6, 6});
}

TEST_CASE("the slope is exact for polynomials of degree 6, at the ends of the interval too") {
  const double low = 0, high = 1.501;
  const Formula polynomial("1 - 2*x + 3*x^2 - 4*x^3 + 5*x^4 - 6*x^5 + 7*x^6", "");
  for (double x : {0.0, 1e-6, 0.01, 0.75, 1.2345, 1.5, 1.501}) {
    const double exact = -2 + 6 * x - 12 * x * x + 20 * std::pow(x, 3) - 30 * std::pow(x, 4) + 42 * std::pow(x, 5);
    // Round-off of values up to 80 divided by the spacing 0.006, times the stencil's weights (up to 20 at the ends).
    CHECK(polynomial.slope(x, low, high) == Approx(exact).margin(1e-10));
  }
  // Outside the interval this one has no value: the stencil must not look there.
  CHECK(Formula("sqrt(x*(1.501-x))*0 + x", "").slope(high, low, high) == Approx(1).margin(1e-11));
  // Truncation (spacing⁶/140)·π⁷ = 9e-14 at most, plus round-off 1e-16/0.006 times a few.
  CHECK(Formula("sin(pi*x)", "").slope(0.4, low, high) ==
        Approx(std::numbers::pi * std::cos(0.4 * std::numbers::pi)).margin(5e-13));
  CHECK(Formula("x*t", "").slope(0.4, low, high, 3.0) == Approx(3).margin(1e-11));
  CHECK(Formula("t", "").slope(0.4, low, high, 3.0) == 0);
}

TEST_CASE("a formula that cannot be read says which word, what may stand there, and the nearest name") {
  CHECK(refused("2*y") ==
        "/here: unknown name \"y\" in the formula \"2*y\"; the variables are x and t, the constants are pi and e");
  CHECK_THAT(refused("sqr(x)"), Contains("unknown name \"sqr\"") && Contains("did you mean \"sqrt\"?"));
  CHECK_THAT(refused("2*t", "x"), Contains("unknown name \"t\"") && Contains("the only variable is x"));
  CHECK_THAT(refused("2*(x"), Contains("the formula \"2*(x\" does not parse") && Contains("parenthesis"));
  CHECK_THAT(refused("2x"), Contains("does not parse") && Contains("a product is written with *"));
  CHECK_THAT(refused("2*"), Contains("does not parse"));
  CHECK_THAT(refused("  "), Contains("the formula is empty"));
  CHECK_THAT(refused("x = 3"), Contains("assigns with ="));
  CHECK_THAT(refused("0,1"), Contains("gives 2 values") && Contains("decimals take a point"));
  CHECK_THAT(refused("\"x\""), Contains("/here: "));
}

TEST_CASE("a value that is no finite number is an error that says where") {
  CHECK_THAT(refused("1/0"), Contains("gives an infinite value; expected a finite number"));
  CHECK_THAT(refused("sqrt(-1)"), Contains("gives no number (NaN)"));
  const Formula formula("log(x - t)", "/here");
  CHECK(input_error([&] { formula(1, 2); }) ==
        "/here: the formula \"log(x - t)\" gives no number (NaN) at x = 1 m, t = 2 s; expected a finite number");
  CHECK(input_error([] { Formula("1/x", "/here")(0); }) ==
        "/here: the formula \"1/x\" gives an infinite value at x = 0 m; expected a finite number");
  CHECK_THROWS_AS(Formula(std::nan("")), InputError);
}

TEST_CASE("a formula that is too long is told by its beginning, the limit and the way out") {
  const auto sum = [](std::size_t size) {
    std::string text = "t";
    while (text.size() + 2 <= size) text += "+1";
    return text + std::string(size - text.size(), ' ');
  };
  // What the parser takes, to the character.
  CHECK(Formula(sum(19999), "/here")(0, 1) == 10000);
  const std::string said = refused(sum(20000));
  CHECK(said == "/here: the formula \"" + sum(20000).substr(0, 80) +
                    "…\" has 20000 characters; expected at most 19999: shorten it");
  CHECK_THAT(input_error([&] { Formula(sum(82000), "/scene/load/0/force"); }),
             Contains("82000 characters") && Contains("or give a list of several loads"));
}

TEST_CASE("no error echoes more than the beginning of a formula") {
  const std::string tail = std::string(5000, ' ') + "+1";
  for (const std::string& text : {"2*y" + tail, "sqr(x)" + tail, "2*(x" + tail, "2x" + tail, "x = 3" + tail,
                                  "0,1" + tail, "1/0" + tail, "sqrt(-1)" + tail, "x+" + std::string(5000, 'y'),
                                  "x+\"" + std::string(5000, 'y') + "\"", std::string(5000, '(')}) {
    const std::string said = refused(text);
    CAPTURE(said);
    CHECK(said.size() > 20);
    CHECK(said.size() < 400);
  }
  CHECK(input_error([&] { Formula("log(x - t)" + tail, "/here")(1, 2); }).size() < 400);
}

// Formulas over named values mean what the same text means in C++.

namespace {

double value(NamedFormulas& formulas, const std::string& text) {
  formulas.read(text, "/here");
  return formulas.value();
}

}  // namespace

TEST_CASE("a formula is bitwise the same expression in C++") {
  NamedFormulas formulas;
  for (const double h : {0.1, 3.1e-5, 0.7e-7})
    for (const double b : {0.3, 0.25, 0.1}) {
      formulas.set("h", h);
      formulas.set("b", b);
      // The last is among those that a merging parser rounds otherwise.
      CHECK(value(formulas, "(0.5-b)*h*h") == (0.5 - b) * h * h);
      CHECK(value(formulas, "0.5*(b-h/2)*h*h") == 0.5 * (b - h / 2) * h * h);
      CHECK(value(formulas, "h*3*b*3") == h * 3 * b * 3);
      CHECK(value(formulas, "2*h/3*0.1") == 2 * h / 3 * 0.1);
      CHECK(value(formulas, "h*0.1+h*0.2") == h * 0.1 + h * 0.2);
    }
}

TEST_CASE("values may change, conditions choose, and what is used is known") {
  NamedFormulas formulas;
  formulas.set("x", 1);
  formulas.set("y", 2);
  formulas.read("x > 0 ? sqrt(y) : 1/0", "/here");
  CHECK(formulas.value() == std::sqrt(2.0));
  formulas.set("y", 9);
  CHECK(formulas.value() == 3);
  formulas.set("x", 0);
  CHECK(std::isinf(formulas.value()));
  formulas.read("2*y", "/here");
  CHECK(formulas.uses("y"));
  CHECK_FALSE(formulas.uses("x"));
  CHECK(formulas.names() == std::vector<std::string>{"x", "y"});
  CHECK(formulas.is_taken("sin"));
  CHECK(formulas.is_taken("pi"));
  CHECK_FALSE(formulas.is_taken("x"));
}

TEST_CASE("what is no formula is told with its place, an unknown name with the nearest") {
  NamedFormulas formulas;
  CHECK_THROWS_WITH(formulas.read("h", "/here"), Contains("no name may appear"));
  formulas.set("gamma", 1);
  CHECK_THROWS_WITH(formulas.read("gama*2", "/here"),
                    Contains("the names are gamma") && Contains("did you mean \"gamma\"?"));
  CHECK_THROWS_WITH(formulas.read("2 gamma", "/here"), Contains("a product is written with *"));
  CHECK_THROWS_WITH(formulas.read("gamma = 2", "/here"), Contains("assigns"));
  CHECK_THROWS_WITH(formulas.read(" ", "/here"), Contains("empty"));
  CHECK_THROWS_WITH(formulas.read("1,5", "/here"), Contains("gives 2 values"));
  try {
    formulas.read("nothing", "/here");
    FAIL("accepted");
  } catch (const InputError& error) {
    CHECK(error.pointer() == "/here");
  }
  CHECK(is_formula_name("a_1"));
  CHECK_FALSE(is_formula_name("1a"));
  CHECK_FALSE(is_formula_name("a-b"));
  CHECK_FALSE(is_formula_name(""));
}

TEST_CASE("a harmonic term has the values of its text, to the last bit") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-40, 40), exponent(-6, 6);
  const auto draw = [&] { return number(random) * std::pow(10, exponent(random)); };
  for (int k = 0; k < 200; ++k) {
    const HarmonicTerm term{draw(), draw(), k % 2 == 0 ? 0 : draw()};
    const Formula made(term, "/here"), written(made.text(), "/here", "t");
    CHECK(made.uses_t());
    CHECK_FALSE(made.uses_x());
    CHECK(made.operations() == written.operations());
    for (int i = 0; i < 20; ++i) {
      const double t = std::abs(draw());
      CHECK(made(0, t) == written(0, t));
    }
  }
}
