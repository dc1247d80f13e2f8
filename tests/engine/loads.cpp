// Loads that are assembled once and scaled march as the formula that they are the parts of.
#include "tests/allocations.hpp"
#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

LoadSpec parts() {
  LoadSpec load;
  load.terms.push_back({false, std::nullopt, Formula("x^2", "", "x"), Formula("-3*cos(40*t)", "", "t")});
  load.terms.push_back({false, std::nullopt, Formula("1 - x", "", "x"), Formula(0.5)});
  return load;
}

}  // namespace

TEST_CASE("f(x) g(t) given apart marches as given whole, in any coordinates, and allocates nothing") {
  const auto kind = GENERATE(OperatorKind::band, OperatorKind::modal, OperatorKind::sparse);
  CompileOptions options;
  options.kind = kind;
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-4;
  scene.initial = {};
  scene.load = Formula("-3*cos(40*t)*x^2 + 0.5*(1 - x)", "/scene/load");
  const Methods methods{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli"}};
  Marcher whole = marcher(scene, 8, methods, 1e-4, options);
  scene.load = parts();
  Marcher apart = marcher(scene, 8, methods, 1e-4, options);
  for (Marcher* one : {&whole, &apart}) {
    one->start();
    one->march(50);
  }
  const long before = allocations();
  apart.march(350);
  const long after = allocations();
  whole.march(350);
  CHECK(after == before);
  // Round-off of loads, in free motion without impacts.
  CHECK((whole.position(0) - apart.position(0)).norm() <= 1e-11 * whole.position(0).norm());
  CHECK(whole.position(0).norm() > 0);
}
