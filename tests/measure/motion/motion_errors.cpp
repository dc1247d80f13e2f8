#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/measure/motion/motion_errors.hpp>
#include <ricochet/measure/motion/motion_sampler.hpp>

using namespace ricochet;

namespace {

SampleGrid beam_grid() {
  SampleGrid grid;
  for (int k = 0; k <= 100; ++k) grid.times.push_back(0.02 * k);
  sample_places(2, 8, grid);
  return grid;
}

// u = a(1 + t) x, everything else in proportion, one impact below at 0.5 + late.
SampledMotion motion(const SampleGrid& grid, double a, double late = 0) {
  SampledMotion m;
  for (const double t : grid.times) {
    m.tip.push_back(2 * a * (1 + t));
    m.tip_velocity.push_back(2 * a);
    m.energy.push_back(a);
    m.impulse.push_back(a * t);
    for (const double x : grid.places) {
      m.displacement.push_back(a * (1 + t) * x);
      m.strain.push_back(a);
      m.velocity.push_back(a * x);
    }
  }
  m.events = {{0.5 + late, -1, true, -1}, {0.6 + late, -1, false, 0}};
  return m;
}

double error(const char* name, const SampledMotion& a, const SampledMotion& b, double horizon = 2) {
  const auto found = motion_errors(a, b, beam_grid(), horizon, {name});
  INFO(found[0].reason);
  REQUIRE(found[0].value);
  return *found[0].value;
}

}  // namespace

TEST_CASE("errors are the norms they say, on differences that are known") {
  const SampleGrid grid = beam_grid();
  const SampledMotion a = motion(grid, 1.25, 0.03), b = motion(grid, 1);
  const double d = 0.25;
  CHECK(error("tip-linf", a, b) == Approx(2 * d * 3).epsilon(1e-14));
  // 1/2 ∫ (2d(1+t))² dt = 4d²·(27−1)/6; the trapezoidal rule adds h²/12 of the second derivative.
  CHECK(error("tip-l2", a, b) == Approx(2 * d * std::sqrt(26.0 / 6)).epsilon(1e-4));
  // ∫x² dx over [0,2] = 8/3, exact for two Gauss points.
  CHECK(error("displacement-l2", a, b) == Approx(d * std::sqrt(26.0 / 6 * 8 / 3)).epsilon(1e-4));
  CHECK(error("displacement-h2", a, b) == Approx(d * std::sqrt(2)).epsilon(1e-13));
  CHECK(error("velocity-l2", a, b) == Approx(d * std::sqrt(8.0 / 3)).epsilon(1e-13));
  CHECK(error("energy", a, b) == Approx(d).epsilon(1e-13));
  CHECK(error("impulse", a, b) == Approx(d * 2).epsilon(1e-13));
  CHECK(error("impact-times", a, b) == Approx(0.03).epsilon(1e-13));
  // The horizon cuts.
  CHECK(error("tip-linf", a, b, 1) == Approx(2 * d * 2).epsilon(1e-14));
  for (const char* name : {"tip-linf", "tip-l2", "displacement-l2", "energy", "impulse", "impact-times"})
    CHECK(error(name, b, b) == 0);
}

TEST_CASE("errors that cannot be told say why") {
  const SampleGrid grid = beam_grid();
  const SampledMotion reference = motion(grid, 1);
  const auto reason = [&](const SampledMotion& a, const SampledMotion& b, const char* name, double horizon = 2) {
    const auto found = motion_errors(a, b, grid, horizon, {name});
    CHECK_FALSE(found[0].value);
    return found[0].reason;
  };
  SampledMotion cut = motion(grid, 1);
  cut.tip.resize(10);
  CHECK(reason(cut, reference, "tip-linf").find("ends at t = 0.18 s") != std::string::npos);
  SampledMotion missing = motion(grid, 1);
  missing.events.clear();
  CHECK(reason(missing, reference, "impact-times").find("no impact on the lower stop") != std::string::npos);
  CHECK(reason(reference, missing, "impact-times").find("which the reference never hits") != std::string::npos);
  // Beyond the horizon both touch: that is no motion without contact.
  CHECK(reason(reference, reference, "impact-times", 0.4) == "neither motion has an impact within the horizon");
  CHECK(reason(missing, missing, "impact-times") == no_contact);
  SampledMotion silent = motion(grid, 1);
  std::fill(silent.impulse.begin(), silent.impulse.end(), 0.0);
  CHECK(reason(silent, silent, "impulse") == "neither motion touches a stop");
  SampledMotion broken = motion(grid, 1);
  broken.energy[3] = std::nan("");
  CHECK(reason(broken, reference, "energy") == "the difference is not finite");
  CHECK_THROWS(motion_errors(reference, reference, grid, 2, {"no-such-error"}));
}

TEST_CASE("Richardson: errors of the order supposed cancel, event times included") {
  const SampleGrid grid = beam_grid();
  // Exact 1; coarse 1 + 0.4, fine 1 + 0.1: order 2 at a ratio of 2. Times: 0.04 and 0.01 late.
  const SampledMotion better = extrapolated(motion(grid, 1.1, 0.01), motion(grid, 1.4, 0.04), 2, 2);
  CHECK(error("tip-linf", better, motion(grid, 1)) <= 1e-14);
  CHECK(error("impact-times", better, motion(grid, 1)) <= 1e-14);
  CHECK(common_horizon(motion(grid, 1), motion(grid, 1), grid, 0.01) == 2);
  // 2a(1+t) differs by 1 % of its largest value 6 where 0.02·(1+t) = 0.06·…: with a = 1.015 at 0.03(1+t) > 0.06.
  CHECK(common_horizon(motion(grid, 1), motion(grid, 1.015), grid, 0.01) == Approx(1.02).margin(0.021));
}

TEST_CASE("an impact that the reference has not is an error, one while it is in contact is none") {
  const SampleGrid grid = beam_grid();
  const SampledMotion reference = motion(grid, 1);  // in contact from 0.5 to 0.6
  const auto with = [&](double from, double to) {
    SampledMotion other = motion(grid, 1);
    other.events.push_back({from, -1, true, -1});
    other.events.push_back({to, -1, false, 0});
    return other;
  };
  CHECK(error("impact-times", with(0.55, 0.58), reference) == 0);
  CHECK(error("impact-times", with(0.9, 0.91), reference) == Approx(0.3).epsilon(1e-13));
  // Seen from the other motion, in which the last one is missing.
  CHECK(error("impact-times", reference, with(0.9, 0.91)) == Approx(0.4).epsilon(1e-13));
  // Beyond the horizon none counts.
  CHECK(error("impact-times", with(0.9, 0.91), reference, 0.8) == 0);
}
