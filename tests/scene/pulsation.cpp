// Which loads are a constant and one sine: what a formula of t may say so that this is known.
#include <fmt/format.h>

#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/pulsation.hpp>

#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

std::optional<double> of(const std::string& text) {
  return pulsation_of(Formula(text, "/scene/load"));
}

LoadSpec load_of(const std::string& formula) {
  LoadSpec load;
  load.formula = Formula(formula, "/scene/load");
  return load;
}

std::optional<double> of_load(const LoadSpec& load) {
  return DistributedLoad(load, make_space(unit_beam().structure, 4)).pulsation();
}

}  // namespace

TEST_CASE("the pulsation of a formula is read off its sines, whatever stands around them") {
  CHECK(of("sin(40*t)") == 40.0);
  CHECK(of("2.5e1*cos(t*40 + 0.3)*x^2 - 4 + sin(pi*x)") == 40.0);
  CHECK(of("sin(3*x - 40*t)") == 40.0);
  CHECK(of("1e-3*sin(2*pi*12.5*(t))") == 2 * std::numbers::pi * 12.5);
  CHECK(of("sin(40*t) + cos(40*t)") == 40.0);
  CHECK(of("exp(-x)*sin(40*t)/sqrt(2)") == 40.0);
  // The order of one sine is for the load's values to show.
  CHECK(of("sin(40*t)^2") == 40.0);
}

TEST_CASE("t elsewhere, two pulsations, a chirp and a condition are none") {
  for (const char* text : {"t*sin(40*t)", "sin(40*t) + sin(41*t)", "sin(40*t^2)", "exp(-t)*sin(40*t)",
                           "(t > 1)*sin(40*t)", "t < 1 ? sin(40*t) : 0", "sin(sin(40*t))", "exp(sin(40*t))",
                           "max(0, sin(40*t))", "sin(40*x*t)", "abs(t)", "t", "sin(0*t)"}) {
    INFO(text);
    CHECK_FALSE(of(text));
  }
  CHECK(pulsation_of(Formula(HarmonicTerm{2, -40, 0.3}, "")) == 40.0);
  CHECK_FALSE(pulsation_of(Formula([](double t) { return t; }, "sin(40*t)", "")));
  CHECK_FALSE(of("sin(40*x)"));
}

TEST_CASE("a load has one pulsation where its values over a period are a constant and one sine") {
  CHECK(of_load(load_of("(2 + sin(40*t))*x")) == 40.0);
  CHECK(of_load(load_of("sin(3*x - 40*t)")) == 40.0);
  for (const char* text : {"sin(40*t)^2", "sin(40*t)*cos(40*t)", "1/(2 + sin(40*t))"}) {
    INFO(text);
    CHECK_FALSE(of_load(load_of(text)));
  }
  LoadSpec load = load_of("3*sin(40*t)*x");
  load.terms.push_back({true, 0.5, {}, Formula("2*cos(40*t + 1)", "/force", "t")});
  CHECK(of_load(load) == 40.0);
  load.terms.push_back({true, 0.75, {}, Formula("7", "/force", "t")});
  CHECK(of_load(load) == 40.0);
  load.terms.push_back({true, 1.0, {}, Formula("sin(39*t)", "/force", "t")});
  CHECK_FALSE(of_load(load));
  CHECK_FALSE(of_load(load_of("2*x")));
}
