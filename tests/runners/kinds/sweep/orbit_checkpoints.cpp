// Orbits as bytes and back.
#include "runners/kinds/sweep/orbit_checkpoints.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/runners/kinds/sweep/sweep_case.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

/// An orbit whose every field differs from its default.
Orbit full_orbit() {
  Orbit orbit;
  orbit.task = 7;
  orbit.stage = Orbit::Stage::keep;
  orbit.transient_periods = 301;
  orbit.kept_periods = 2;
  orbit.settled = true;
  orbit.end = {EndCause::elastic_energy_beyond, 3.5, 2.5, 1e9, 16};
  orbit.stopped_period = 12;
  orbit.settling = Settling({0.1, 1.0, 0.1, 1.0}, 1e-6, 5);
  const double row[] = {0.1, -0.0, 3e-310, 1 / 3.0};
  orbit.settling.add(row);
  orbit.readings.width = 4;
  orbit.readings.values = {1, 2, 3, 4};
  orbit.strobed = {{0.1, 0.2, 0.3, 0.4}, {1, 2, 3, 4}};
  orbit.points = {{0.1, 0.2, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()}};
  orbit.impacts = {{1.5, 1, 0.25, 3}, {2.5, 0, 0.75, 0}};
  orbit.impact_counts = {1, 1};
  orbit.contact_steps = 1234567890123;
  orbit.most_on_a_side = 3;
  orbit.closed[1] = true;
  orbit.pushed = {0, 1234567890123};
  orbit.arrived = true;
  orbit.rests = true;
  orbit.entry = {{1, 2}, {3}, {4}, {5, 6}};
  orbit.now = {{0.1, std::numeric_limits<double>::denorm_min()}, {-0.0}, {}, {}};
  return orbit;
}

}  // namespace

TEST_CASE("orbits come back bit for bit") {
  const MarchedOrbits some{{full_orbit(), Orbit{}}, {full_orbit()}};
  const std::string bytes = to_bytes(some);
  const MarchedOrbits back = marched_orbits(bytes);
  REQUIRE(back.finished.size() == 2);
  REQUIRE(back.running.size() == 1);
  CHECK(to_bytes(back) == bytes);
  const Orbit &was = some.running[0], &is = back.running[0];
  CHECK(is.task == was.task);
  CHECK(is.stage == was.stage);
  CHECK(is.transient_periods == was.transient_periods);
  CHECK(is.kept_periods == was.kept_periods);
  CHECK(is.settled == was.settled);
  CHECK(is.end == was.end);
  CHECK(is.stopped_period == was.stopped_period);
  CHECK(same_settling(is.settling, was.settling));
  CHECK(is.readings.width == was.readings.width);
  CHECK(is.readings.values == was.readings.values);
  CHECK(is.strobed.size() == 2);
  CHECK(is.strobed[1].opposite_velocity == 4);
  CHECK(std::isnan(is.points.at(0).opposite_velocity));
  CHECK(is.impacts.at(0).side == 1);
  CHECK(is.impacts.at(1).speed == 0.75);
  CHECK(is.impacts.at(0).point == 3);
  CHECK(is.impact_counts == was.impact_counts);
  CHECK(is.contact_steps == was.contact_steps);
  CHECK(is.most_on_a_side == was.most_on_a_side);
  CHECK(is.closed[0] == was.closed[0]);
  CHECK(is.closed[1] == was.closed[1]);
  for (const auto state : {&Orbit::entry, &Orbit::now}) {
    CHECK((is.*state).slots == (was.*state).slots);
    CHECK((is.*state).efforts == (was.*state).efforts);
    CHECK((is.*state).fastest == (was.*state).fastest);
  }
  CHECK(std::signbit(is.now.efforts[0]));
}

TEST_CASE("nothing marched is nothing") {
  const MarchedOrbits back = marched_orbits(to_bytes(MarchedOrbits{}));
  CHECK(back.finished.empty());
  CHECK(back.running.empty());
}

TEST_CASE("bytes that are cut short or of another kind are refused") {
  const std::string bytes = to_bytes(MarchedOrbits{{full_orbit()}, {full_orbit()}});
  for (std::size_t size = 0; size < bytes.size(); ++size)
    CHECK_THROWS_AS(marched_orbits(bytes.substr(0, size)), std::runtime_error);
  std::string other = bytes;
  other[0] = static_cast<char>(other[0] + 1);
  CHECK_THROWS_AS(marched_orbits(other), std::runtime_error);
}

TEST_CASE("exponents come back, with and without a twin") {
  const std::vector<OrbitExponents> some = {
      {{{1, 0.5, 1.5}, {-2, -3, -1}}, Interval{1.25, 1, 2}, "tangent"},
      {.values = {}, .twin = {}, .method = "", .blind = false, .saturated = true}};
  const std::vector<OrbitExponents> back = orbit_exponents(to_bytes(some));
  REQUIRE(back.size() == 2);
  REQUIRE(back[0].values.size() == 2);
  CHECK(back[0].values[1].low == -3);
  REQUIRE(back[0].twin);
  CHECK(back[0].twin->high == 2);
  CHECK(back[0].method == "tangent");
  CHECK_FALSE(back[1].twin);
  CHECK(back[1].saturated);
  CHECK((to_bytes(back) == to_bytes(some)));
}
