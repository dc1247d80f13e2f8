// Steps by contact set against marched ones, Newton's method against settled orbits, multipliers against differences.
#include <ricochet/measure/orbits/multipliers.hpp>
#include <ricochet/measure/orbits/periodic_map.hpp>

#include "tests/measure/orbits/shaken_tube.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

Methods spring_methods(const char* evaluation) {
  Methods methods = tube_methods();
  methods.contact = {"penalty", {{"stiffness", 1e4}, {"evaluation", std::string(evaluation)}}};
  return methods;
}

}  // namespace

TEST_CASE("integration over contacts is the composition of affine steps by its contact sets") {
  const int steps = 200;
  for (const Methods& methods : {tube_methods(), spring_methods("implicit"), spring_methods("averaged")}) {
    INFO(methods.contact.name);
    PeriodicMap map = tube_map(steps, 5, methods);
    const Eigen::VectorXd x = settled_tube(map, 0.09, steps, 20, 5, methods);
    for (const bool half : {false, true}) {
      const MapClock clock{steps, 1, half};
      const MapMarch made = map.march(x, 0.09, clock);
      REQUIRE(!made.end);
      CHECK(std::count(made.sets.begin(), made.sets.end(), 0) < steps);
      std::vector<PeriodicMap::Column> column = {{x, 0.09, false}};
      map.sweep(made.sets, clock, column);
      // Round-off of some hundred steps on numbers of 0.1 m.
      CHECK(map.metric().size(column[0].x - made.image) < 1e-11);
      // With these sets the image is affine: derivative and value give the image of any state by the same sets.
      std::vector<PeriodicMap::Column> moved = {{1.5 * x, 0.09, false}};
      map.sweep(made.sets, clock, moved);
      CHECK(map.metric().size(moved[0].x - made.image - 0.5 * map.derivative(made.sets, clock) * x) < 1e-11);
    }
  }
}

TEST_CASE("the parameter's column is the difference of two marches with the same contact sets") {
  const int steps = 200;
  PeriodicMap map = tube_map(steps, 5);
  const MapClock clock{steps, 1, false};
  const Eigen::VectorXd x = settled_tube(map, 0.09, steps, 20, 5);
  constexpr double by = 1e-9;  // far within a piece
  const MapMarch low = map.march(x, 0.09 - by, clock), high = map.march(x, 0.09 + by, clock);
  REQUIRE(low.sets == high.sets);
  std::vector<PeriodicMap::Column> column = {{Eigen::VectorXd::Zero(map.size()), 2 * by, true}};
  map.sweep(low.sets, clock, column);
  // Differences of numbers of 0.1 m.
  CHECK(map.metric().size(high.image - low.image - column[0].x) < 1e-14);
}

TEST_CASE("Newton's method finds the orbit that marching settles on") {
  const int steps = 500;
  PeriodicMap map = tube_map(steps);
  const MapClock clock{steps, 1, false};
  const Eigen::VectorXd x = settled_tube(map, 0.095, steps);
  const ShotOrbit orbit = shoot(map, x, 0.095, clock, 1e-12);
  REQUIRE(orbit.found);
  // What a settled orbit is known to: multipliers to the power of 300.
  CHECK(map.metric().size(orbit.x - x) < 1e-11);
  CHECK(map.tip(orbit.x, 0.095) == Approx(0.002339).margin(5e-7));
  CHECK(std::abs(multipliers_of(map.derivative(orbit.sets, clock)).front()) == Approx(0.4087).margin(5e-5));
  const ShotOrbit again = shoot(map, settled_tube(map, 0.095, steps, 3), 0.095, clock, 1e-12);
  CHECK(again.found);
  CHECK(again.iterations <= 10);
  CHECK(map.metric().size(again.x - orbit.x) < 1e-11);
}

TEST_CASE("an orbit without contact is found at once") {
  const int steps = 500;
  PeriodicMap map = tube_map(steps);
  for (const bool half : {false, true}) {
    const MapClock clock{steps, 1, half};
    const auto x = free_orbit(map, 0.05, clock);
    REQUIRE(x);
    const MapMarch made = map.march(*x, 0.05, clock);
    CHECK(made.sets == SetSequence(static_cast<std::size_t>(clock.steps()), 0));
    CHECK(map.metric().size(made.image - *x) < 1e-13);
  }
}

TEST_CASE("stops that are closed by velocities, and laws that are not linear, have no affine steps") {
  const auto refused = [](Methods methods) {
    methods.mass = {"consistent"};
    const auto reason = SetSteps::refusal(tube_program(0.08, 100, 4, methods));
    return reason.value_or("");
  };
  Methods methods;
  methods.time = {"moreau-jean"};
  CHECK(refused(methods) == "its stops are closed by velocities");
  methods.time = {"newmark-dumont-paoli"};
  methods.contact = {"hertz", {{"stiffness", 1e7}}};
  CHECK(refused(methods) == "its law is not linear");
}
