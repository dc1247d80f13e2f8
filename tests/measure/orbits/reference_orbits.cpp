// Branches of the continuous beam: its first contact in closed form, its fold and its torus whatever the modes.
#include <complex>
#include <ricochet/measure/orbits/reference_orbits.hpp>
#include <ricochet/measure/orbits/special_points.hpp>

#include "tests/plugins/reference/shaken_beam.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

constexpr double least = 0.066, largest = 0.103, tolerance = 1e-12, located = 2.5e-5;

ReferenceOrbits beam_orbits(int modes, double at) {
  return {
      [modes](double amplitude) {
        return ReferenceOrbits::Scene{beam_map(shaken_beam(amplitude), modes), 2 * std::numbers::pi / beam_pulsation};
      },
      at, 1.0};
}

// Special points of the branch of symmetric orbits through the one that `periods` periods from rest lead to.
std::vector<SpecialPoint> points_of(int modes, double at, int periods, int way, double to, double finer = 1) {
  ReferenceOrbits map = beam_orbits(modes, at);
  const MapClock clock{0, 1, true};
  const ShotOrbit orbit = shoot(map, map.settle(at, periods), at, clock, tolerance);
  REQUIRE(orbit.found);
  ArcSteps limits{{std::min(least, to), std::max(at, to)}};
  limits.tolerance = tolerance;
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

std::vector<SpecialPoint> of_kind(const std::vector<SpecialPoint>& points, const std::string& kind) {
  std::vector<SpecialPoint> own;
  for (const SpecialPoint& point : points)
    if (point.kind == kind) own.push_back(point);
  return own;
}

// |u(L)| of the beam without stops over the amplitude of its clamp: EI(1 + iωα) w'''' = ρS ω² (1 + w), w clamped at 0.
double response() {
  const ReferenceProblem problem = shaken_beam(1);
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

TEST_CASE("first contact of the continuous beam is its gap over its response, and its branch goes on from there") {
  const double exact = beam_gap / response();
  // The modes left out of the response: as the inverse fifth power of their number, 3e-9 of it at 20.
  for (const auto& [modes, within] : {std::pair(20, 1e-9), {40, 4e-10}}) {
    ReferenceOrbits map = beam_orbits(modes, 0.07);
    const MapClock clock{0, 1, true};
    const ShotOrbit free = shoot(map, Eigen::VectorXd::Zero(map.size()), 0.07, clock, tolerance);
    REQUIRE(free.found);
    // Without contact the map is affine: exact at once, and its distance from the image of 0 is round-off.
    CHECK(free.iterations == 1);
    const auto contacts = of_kind(points_of(modes, 0.078, 1, -1, 0.08), "contact");
    CHECK(contacts.empty());
    const auto points = points_of(modes, 0.08, 300, -1, 0.066);
    const auto grazes = of_kind(points, "contact");
    REQUIRE_FALSE(grazes.empty());
    CHECK(grazes.back().note == "first contact");
    CHECK(grazes.back().parameter == Approx(exact).epsilon(0).margin(within));
    CHECK(points.back().note == "the range ends at 0.066");
  }
}

TEST_CASE("the torus of the continuous beam is the same with twice the modes and steps four times finer") {
  // 0.0849574 m; intervals are what a step of 1e-4 of the range leaves.
  const auto torus = [](int modes, double finer) {
    const auto found = of_kind(points_of(modes, 0.084, 300, 1, 0.0853, finer), "torus");
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
