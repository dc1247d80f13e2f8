// Formulas over named values mean what the same text means in C++.
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/named_formulas.hpp>

using namespace ricochet;
using Catch::Matchers::Contains;

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
