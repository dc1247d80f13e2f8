// One period of an orbit, step by step, and its runs of contact.
#include <ricochet/measure/orbits/branch.hpp>
#include <ricochet/measure/orbits/orbit_motion.hpp>
#include <ricochet/measure/orbits/periodic_map.hpp>

#include "tests/measure/orbits/shaken_tube.hpp"

using namespace ricochet;
using namespace ricochet::testing;

TEST_CASE("a period of an orbit closes, and its runs are those of its contact sets") {
  const int steps = 500;
  PeriodicMap map = tube_map(steps);
  const MapClock clock{steps, 1, false};
  const ShotOrbit orbit = shoot(map, settled_tube(map, 0.095, steps), 0.095, clock, 1e-12);
  REQUIRE(orbit.found);
  const OrbitMotion motion = march_orbit(map.begin(orbit.x, 0.095), steps);
  REQUIRE(!motion.end);
  REQUIRE(motion.time.size() == 501);
  REQUIRE(motion.velocity.size() == 501);
  const MapMarch made = map.march(orbit.x, 0.095, clock, true);
  CHECK(motion.displacement.front() == made.tip);
  // The residual is a mean over ten nodes, of which the tip moves most.
  CHECK(std::abs(motion.displacement.back() - motion.displacement.front()) < 20 * orbit.residual + 1e-15);
  // One step of 1.3 ms over a residual of 1e-13 m.
  CHECK(motion.velocity.front() == Approx(made.tip_velocity).margin(1e-9));
  CHECK(motion.penetration == made.penetration);
  CHECK(static_cast<int>(motion.runs.size()) == contact_runs(map.sets(), made.sets, false).count);
  // A force stands in each step of a run and in no other.
  long long pushed = 0, of_runs = 0;
  for (std::size_t k = 1; k < motion.force.size(); ++k) pushed += motion.force[k] != 0;
  double impulse = 0, sum = 0;
  for (const ContactRun& run : motion.runs) {
    of_runs += run.steps;
    impulse += run.impulse;
    CHECK((run.impulse < 0) == run.upper);
    // At every step of a run the tip is at its stop: rigid contact by position.
    for (long long k = 0; k < run.steps; ++k) {
      const auto at = static_cast<std::size_t>((run.begin - 1 + k) % steps + 1);
      CHECK(motion.force[at] != 0);
      CHECK(motion.displacement[at] == Approx(run.upper ? 0.1 : -0.1).margin(1e-12));
    }
  }
  for (std::size_t k = 1; k < motion.force.size(); ++k) sum += motion.force[k] * map.program().h;
  CHECK(pushed == of_runs);
  CHECK(sum == Approx(impulse).margin(1e-12));
}

TEST_CASE("the second half of an orbit that is its own image is minus the first") {
  const int steps = 500;
  PeriodicMap map = tube_map(steps);
  const MapClock half{steps, 1, true};
  const ShotOrbit orbit = shoot(map, settled_tube(map, 0.08, steps), 0.08, half, 1e-12);
  REQUIRE(orbit.found);
  const OrbitMotion motion = march_orbit(map.begin(orbit.x, 0.08), steps);
  for (std::size_t k = 0; k <= 250; ++k) CHECK(std::abs(motion.displacement[k] + motion.displacement[k + 250]) < 1e-10);
  // Runs come in pairs, half a period apart, by the other stop.
  CHECK(motion.runs.size() % 2 == 0);
  for (const ContactRun& run : motion.runs)
    CHECK(std::count_if(motion.runs.begin(), motion.runs.end(), [&](const ContactRun& other) {
            return other.upper != run.upper && other.steps == run.steps && (other.begin - run.begin) % 250 == 0;
          }) == 1);
}

TEST_CASE("a run over the strobe is one run") {
  const int steps = 200;
  PeriodicMap map = tube_map(steps, 5);
  const MapClock clock{steps, 1, false};
  const ShotOrbit orbit = shoot(map, settled_tube(map, 0.09, steps, 300, 5), 0.09, clock, 1e-12);
  if (!orbit.found) return;
  const OrbitMotion motion = march_orbit(map.begin(orbit.x, 0.09), steps);
  REQUIRE_FALSE(motion.runs.empty());
  // The same orbit read from the middle of its first run has as many runs of the same lengths.
  const long long shift = motion.runs.front().begin + motion.runs.front().steps / 2;
  Marcher& marcher = map.begin(orbit.x, 0.09);
  marcher.march(shift);
  const LaneState there = marcher.lane_state(0);
  marcher.set_lane(0, map.lanes().lane(0.09), there);
  const OrbitMotion shifted = march_orbit(marcher, steps);
  const auto lengths = [](const OrbitMotion& of) {
    std::vector<long long> found;
    for (const ContactRun& run : of.runs) found.push_back(run.steps);
    std::sort(found.begin(), found.end());
    return found;
  };
  CHECK(lengths(shifted).size() == lengths(motion).size());
}
