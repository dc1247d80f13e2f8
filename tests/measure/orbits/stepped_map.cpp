// Steps of arclength against pieces, and against impacts known in closed form.
#include <complex>
#include <ricochet/engine/lane_groups.hpp>
#include <ricochet/measure/orbits/special_points.hpp>
#include <ricochet/measure/orbits/stepped_map.hpp>

#include "tests/measure/orbits/shaken_tube.hpp"
#include "tests/plugins/reference/continuous_beam.hpp"

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
  return {make, [](const LaneState& state, int, int) { return state; }, 0.08, {1.0, tube_pulsation}};
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

TEST_CASE("an orbit is the same wherever its state stands in the period") {
  const int steps = 200;
  PeriodicMap pieces = tube_map(steps, 4);
  SteppedMap map = amplitude_map(steps, 4);
  const Eigen::VectorXd x = settled_tube(pieces, 0.09, steps, 20, 4);
  for (const bool half : {false, true}) {
    const MapClock clock{steps, 1, half};
    const SteppedMap::Image image = map.march(x, 0.09, clock);
    for (const int begins : {1, 37, 99}) {
      MapClock there = clock;
      there.begins = begins;
      const Eigen::VectorXd y = map.moved(x, 0.09, clock, begins);
      // Once round: as far as the map goes.
      CHECK(map.metric().size(map.moved(y, 0.09, there, 0) - image.image) == 0);
      const SteppedMap::Image made = map.march(y, 0.09, there, true);
      CHECK(map.metric().size(made.strobe - image.image) == 0);
      CHECK(map.metric().size(made.image - map.moved(image.image, 0.09, clock, begins)) < 1e-13);
      // The support stands at A sin 2π, off 0 by round-off.
      CHECK(made.tip == Approx(map.march(image.image, 0.09, clock).tip).epsilon(1e-14));
    }
  }
}

TEST_CASE("half a period from the second half leads to what the whole one leads to") {
  const int steps = 200, begins = 150;
  PeriodicMap pieces = tube_map(steps, 4);
  SteppedMap map = amplitude_map(steps, 4);
  const Eigen::VectorXd x = settled_tube(pieces, 0.09, steps, 20, 4);
  const MapClock whole{steps, 1, false};
  MapClock half{steps, 1, true};
  half.begins = begins;
  const Eigen::VectorXd later = map.moved(map.march(x, 0.09, whole).image, 0.09, whole, begins - steps / 2);
  CHECK(map.metric().size(map.march(map.moved(x, 0.09, whole, begins), 0.09, half).image + later) < 1e-13);
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

// Branches of the continuous beam: its first contact in closed form, its fold and its torus whatever the modes.

namespace {

constexpr double least = 0.066, largest = 0.103, solved_to = 1e-12, located = 2.5e-5;

ReferenceOrbits beam_orbits(int modes, double at) {
  return {[modes](double amplitude) {
            return ReferenceOrbits::Scene{beam_map(continuous_beam(amplitude), modes),
                                          2 * std::numbers::pi / beam_pulsation};
          },
          at, 1.0};
}

// Special points of the branch of symmetric orbits through the one that `periods` periods from rest lead to.
std::vector<SpecialPoint> orbit_points(int modes, double at, int periods, int way, double to, double finer = 1) {
  ReferenceOrbits map = beam_orbits(modes, at);
  const MapClock clock{0, 1, true};
  const ShotOrbit orbit = shoot(map, map.settle(at, periods), at, clock, solved_to);
  REQUIRE(orbit.found);
  ArcSteps limits{{std::min(least, to), std::max(at, to)}};
  limits.tolerance = solved_to;
  limits.located = located / finer;
  limits.smooth = true;
  StepFollower follower(map, clock, orbit.x, at, way, limits);
  follower.advance(3000);
  PointSearch search;
  search.half = true;
  search.prominence = 1e-5;
  search.by_steps = true;
  search.contacts = 1e-9 * (largest - least);
  return special_points(follower.trace(), search);
}

std::vector<SpecialPoint> of_kind(const std::vector<SpecialPoint>& points, PointKind kind) {
  std::vector<SpecialPoint> own;
  for (const SpecialPoint& point : points)
    if (point.kind == kind) own.push_back(point);
  return own;
}

// |u(L)| of the beam without stops over the amplitude of its clamp: EI(1 + iωα) w'''' = ρS ω² (1 + w), w clamped at 0.
double response() {
  const ReferenceProblem problem = continuous_beam(1);
  const double omega = beam_pulsation;
  const std::complex<double> stiffness = problem.stiffness * std::complex<double>(1, omega * problem.damping_stiffness);
  const std::complex<double> k = std::pow(problem.inertia * omega * omega / stiffness, 0.25), z = k * beam_length;
  // 1 + w = a cosh kx + b sinh kx + c cos kx + d sin kx: a + c = 1, b + d = 0, free end.
  const auto cosh = std::cosh(z), sinh = std::sinh(z), cosine = std::cos(z), sine = std::sin(z);
  // a cosh + b sinh − c cos − d sin = 0, a sinh + b cosh + c sin − d cos = 0 with c = 1 − a, d = −b.
  const auto p = cosh + cosine, q = sinh + sine, r = sinh - sine;
  const auto determinant = p * p - q * r;
  const auto a = (cosine * p + sine * q) / determinant, b = (-sine * p - cosine * r) / determinant;
  return std::abs(a * cosh + b * sinh + (1.0 - a) * cosine - b * sine);
}

}  // namespace

TEST_CASE("an orbit of the continuous beam without contact is solved at once") {
  ReferenceOrbits map = beam_orbits(20, 0.07);
  const ShotOrbit free = shoot(map, Eigen::VectorXd::Zero(map.size()), 0.07, {0, 1, true}, solved_to);
  REQUIRE(free.found);
  CHECK(free.iterations == 1);
}

TEST_CASE("first contact of the continuous beam is its gap over its response, and its branch goes on from there") {
  // Downwards from 0.08 m, over the folds near 0.0674, up to the graze and back to the end of the range.
  const auto points = orbit_points(20, 0.08, 300, -1, least);
  const auto grazes = of_kind(points, PointKind::contact);
  REQUIRE_FALSE(grazes.empty());
  CHECK(grazes.back().note == "first contact");
  // Modes beyond 20 have 3e-9 of the response.
  CHECK(grazes.back().parameter == Approx(beam_gap / response()).epsilon(0).margin(1e-9));
  CHECK(points.back().note == "the range ends at 0.066");
  bool lower_fold = false;
  for (const SpecialPoint& fold : of_kind(points, PointKind::fold))
    lower_fold = lower_fold || std::abs(fold.parameter - 0.06745046843) < 1e-8;
  CHECK(lower_fold);
}

TEST_CASE("the upper fold of the continuous beam lies at 0.1005653 m") {
  double fold = 0;
  for (const SpecialPoint& point : of_kind(orbit_points(16, 0.08, 300, 1, largest), PointKind::fold))
    if (point.parameter > 0.1) fold = point.parameter;
  // With 12, 20 and 40 modes 0.10056532194, …286 and …292.
  CHECK(fold == Approx(0.10056532292).epsilon(0).margin(1e-9));
}

TEST_CASE("the torus of the continuous beam is the same with twice the modes and steps four times finer") {
  // 0.0849574 m; intervals are what a step of 1e-4 of the range leaves.
  const auto torus = [](int modes, double finer) {
    const auto found = of_kind(orbit_points(modes, 0.084, 300, 1, 0.0853, finer), PointKind::torus);
    REQUIRE(found.size() == 1);
    CHECK(found.front().low < found.front().parameter);
    CHECK(found.front().parameter < found.front().high);
    return found.front().parameter;
  };
  const double coarse = torus(20, 1);
  CHECK(coarse == Approx(0.08495738).epsilon(0).margin(1e-8));
  CHECK(torus(40, 1) == Approx(coarse).epsilon(0).margin(1e-8));
  CHECK(torus(20, 4) == Approx(coarse).epsilon(0).margin(1e-8));
}
