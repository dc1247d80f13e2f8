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

TEST_CASE("measures do not depend on how many steps are made at once") {
  const int steps = 200;
  for (const Methods& methods : {tube_methods(), spring_methods("implicit")}) {
    INFO(methods.contact.name);
    PeriodicMap map = tube_map(steps, 5, methods);
    REQUIRE(map.sets().longest_stride() > 2);
    const Eigen::VectorXd x = settled_tube(map, 0.09, steps, 20, 5, methods);
    const MapClock clock{steps, 1, false};
    const MapMarch made = map.march(x, 0.09, clock);
    const std::vector<PeriodicMap::Column> columns = {{x, 0.09, false}, {x, 0.02, true}};
    auto whole = columns;
    PeriodicMap::Measures expected, measures;
    map.sweep(made.sets, clock, whole, &expected);
    const auto rows = static_cast<std::size_t>(map.sets().measure_rows());
    double value = 0, slope = 0, largest = 0, steepest = 0;
    for (std::size_t count = 1; count <= made.sets.size(); ++count) {
      auto some = columns;
      map.sweep({made.sets.begin(), made.sets.begin() + static_cast<std::ptrdiff_t>(count)}, clock, some, &measures);
      for (std::size_t at = (count - 1) * rows; at < count * rows; ++at) {
        // Efforts are larger than distances by what a step's force moves.
        const double give = map.sets()[made.sets[count - 1]].give[at % rows], unit = give > 0 ? give : 1;
        value = std::max(value, unit * std::abs(measures.value[at] - expected.value[at]));
        slope = std::max(slope, unit * std::abs(measures.slope[at] - expected.slope[at]));
        largest = std::max(largest, unit * std::abs(expected.value[at]));
        steepest = std::max(steepest, unit * std::abs(expected.slope[at]));
      }
    }
    // Round-off of some hundred steps.
    CHECK(value < 1e-11 * largest);
    CHECK(slope < 1e-11 * steepest);
  }
}

TEST_CASE("blends change the derivative as a product of their steps does") {
  const int steps = 200;
  PeriodicMap map = tube_map(steps, 5);
  const Eigen::VectorXd x = settled_tube(map, 0.09, steps, 20, 5);
  const Eigen::Index D = map.size();
  for (const bool half : {false, true}) {
    const MapClock clock{steps, 1, half};
    const SetSequence sets = map.march(x, 0.09, clock).sets;
    const auto last = sets.size() - 1;
    const auto blend = [&](std::size_t step, bool upper, double weight) {
      return SetBlend{step, map.sets().toggled(sets[step], 0, upper), weight, 0};
    };
    std::vector<SetBlend> blends;
    for (const std::size_t step : {std::size_t{0}, std::size_t{1}, std::size_t{40}, last - 30, last})
      for (const bool upper : {false, true}) {
        blends.push_back(blend(step, upper, upper ? 0.3 : 0.45));
        if (upper && blends[blends.size() - 2].other == blends.back().other) blends.pop_back();
      }
    // More of them than vectors are carried for.
    std::vector<SetBlend> many;
    for (std::size_t step = 0; step <= last && 2 * std::ssize(many) <= D; ++step)
      many.push_back(blend(step, false, 0.01));
    REQUIRE(2 * std::ssize(blends) < D);
    REQUIRE(2 * std::ssize(many) > D);
    for (const auto& some : {std::vector<SetBlend>{}, {blend(57, true, 1.0)}, blends, many}) {
      Eigen::MatrixXd expected = Eigen::MatrixXd::Identity(D, D);
      for (std::size_t k = 0; k < sets.size(); ++k) {
        Eigen::MatrixXd step = map.sets()[sets[k]].state.topRows(D);
        const Eigen::MatrixXd own = step;
        for (const SetBlend& one : some)
          if (one.step == k) step += one.weight * (map.sets()[one.other].state.topRows(D) - own);
        expected = step * expected;
      }
      expected *= clock.sign();
      const Eigen::MatrixXd made = map.blended(map.derivative(sets, clock), sets, clock, some);
      CHECK((made - expected).cwiseAbs().maxCoeff() < 1e-11 * expected.cwiseAbs().maxCoeff());
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
