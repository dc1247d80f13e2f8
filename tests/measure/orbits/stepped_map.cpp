// Steps of arclength against pieces, and against impacts known in closed form.
#include <ricochet/engine/lane_groups.hpp>
#include <ricochet/measure/orbits/special_points.hpp>
#include <ricochet/measure/orbits/stepped_map.hpp>

#include "tests/measure/orbits/shaken_tube.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

SteppedMap amplitude_map(int steps, int elements) {
  const auto make = [=](double amplitude, int tangents) {
    CompileOptions options;
    options.moving_support = true;
    options.tangents = tangents;
    const Methods methods = tube_methods();
    auto program = compiled(problem_of(shaken_tube(amplitude), elements, methods.mass, methods.contact), methods,
                            2 * std::numbers::pi / tube_pulsation / steps, options);
    REQUIRE(std::holds_alternative<Program>(program));
    return SteppedMap::Scene{std::move(std::get<Program>(program)), 0};
  };
  return {make, [](const LaneState& state, int, int) { return state; }, 0.08, 1.0};
}

}  // namespace

TEST_CASE("tangent columns of a stepped map are the product of affine steps") {
  const int steps = 200;
  PeriodicMap pieces = tube_map(steps, 4);
  SteppedMap map = amplitude_map(steps, 4);
  REQUIRE(map.size() == pieces.size());
  const Eigen::VectorXd x = settled_tube(pieces, 0.09, steps, 20, 4);
  for (const bool half : {false, true}) {
    const MapClock clock{steps, 1, half};
    const MapMarch made = pieces.march(x, 0.09, clock, true);
    const SteppedMap::Image image = map.march(x, 0.09, clock, true);
    CHECK(pieces.metric().size(made.image - image.image) == 0);
    const Eigen::MatrixXd product = pieces.derivative(made.sets, clock);
    CHECK((product - image.derivative).cwiseAbs().maxCoeff() < 1e-9 * product.cwiseAbs().maxCoeff());
    CHECK(image.runs == contact_runs(pieces.sets(), made.sets, half).count);
    CHECK(image.tip == made.tip);
    CHECK(image.tip_velocity == made.tip_velocity);
  }
}

TEST_CASE("steps of arclength follow the branch that pieces follow") {
  const int steps = 200;
  PeriodicMap pieces = tube_map(steps, 4);
  SteppedMap map = amplitude_map(steps, 4);
  const MapClock clock{steps, 1, true};
  const ShotOrbit orbit = shoot(pieces, settled_tube(pieces, 0.08, steps, 300, 4), 0.08, clock, 1e-12);
  if (!orbit.found) return;
  BranchRun exact(pieces, clock, PieceFollower(pieces, clock, branch_start(orbit.x, 0.08, orbit.sets, 1), 1e-13),
                  {0.07, 0.082});
  exact.advance(100000);
  ArcSteps limits{{0.07, 0.082}};
  limits.first = 2e-5;
  StepFollower steps_of(map, clock, orbit.x, 0.08, 1, limits);
  steps_of.advance(200);
  const auto& corners = steps_of.trace().corners;
  REQUIRE(corners.size() > 5);
  CHECK(corners.back().parameter == 0.082);  // the last orbit is solved at the end of the range
  const StepFollower beyond(map, clock, orbit.x, 0.08, 1, ArcSteps{{0.081, 0.082}});
  CHECK(beyond.trace().end == "its first orbit is beyond the range, at 0.08");
  const auto& lines = exact.trace().corners;
  for (const BranchCorner& corner : corners) {
    double nearest = 1;
    for (std::size_t i = 1; i < lines.size(); ++i) {
      const double a = lines[i - 1].parameter, b = lines[i].parameter;
      if ((corner.parameter - a) * (corner.parameter - b) > 0 || a == b) continue;
      const double tip = lines[i - 1].tip + (lines[i].tip - lines[i - 1].tip) * (corner.parameter - a) / (b - a);
      nearest = std::min(nearest, std::abs(tip - corner.tip));
    }
    CHECK(nearest < 1e-9);
  }
}
