// Orbits as bytes and back.
#include "runners/kinds/sweep/orbit_checkpoints.hpp"

#include <catch2/catch.hpp>
#include <cereal/archives/binary.hpp>
#include <limits>
#include <sstream>

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
  orbit.end_words = "its process ended";
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
  orbit.lasting = 1234567890124;
  orbit.rebounds = 0.25;
  orbit.rebounds_so_far = 0.125;
  orbit.brief[1] = {3, 12, -0.5};
  orbit.verdict = RegimeVerdict{{Regime::chattering, 2}, 2, "it repeats"};
  orbit.entry = {{1, 2}, {3}, {4}, {5, 6}};
  orbit.now = {{0.1, std::numeric_limits<double>::denorm_min()}, {-0.0}, {}, {}};
  return orbit;
}

template <class Member>
std::string bytes_of(const Member& member) {
  std::ostringstream out;
  cereal::BinaryOutputArchive archive(out);
  archive(member);
  return out.str();
}

/// Each member of an orbit as bytes, but for the lane, which its task knows.
std::vector<std::string> members_of(const Orbit& orbit) {
  const auto& [task, stage, transient_periods, kept_periods, settled, end, end_words, stopped_period, settling,
               readings, strobed, points, impacts, impact_counts, contact_steps, most_on_a_side, closed, pushed,
               arrived, rests, lasting, rebounds, rebounds_so_far, brief, verdict, lane, entry, now] = orbit;
  return {bytes_of(task),           bytes_of(stage),           bytes_of(transient_periods),
          bytes_of(kept_periods),   bytes_of(settled),         bytes_of(end),
          bytes_of(end_words),      bytes_of(stopped_period),  bytes_of(settling),
          bytes_of(readings),       bytes_of(strobed),         bytes_of(points),
          bytes_of(impacts),        bytes_of(impact_counts),   bytes_of(contact_steps),
          bytes_of(most_on_a_side), bytes_of(closed),          bytes_of(pushed),
          bytes_of(arrived),        bytes_of(rests),           bytes_of(lasting),
          bytes_of(rebounds),       bytes_of(rebounds_so_far), bytes_of(brief),
          bytes_of(verdict),        bytes_of(entry),           bytes_of(now)};
}

}  // namespace

TEST_CASE("orbits come back bit for bit") {
  const MarchedOrbits some{{full_orbit(), Orbit{}}, {full_orbit()}};
  const std::string bytes = to_bytes(some);
  const MarchedOrbits back = marched_orbits(bytes);
  REQUIRE(back.finished.size() == 2);
  REQUIRE(back.running.size() == 1);
  CHECK(to_bytes(back) == bytes);
  const auto was = members_of(some.running[0]), is = members_of(back.running[0]), none = members_of(Orbit{});
  for (std::size_t k = 0; k < was.size(); ++k) {
    INFO("member " << k + 1 << " of those that are kept");
    CHECK((is[k] == was[k]));
    CHECK((was[k] != none[k]));
  }
  CHECK(std::isnan(back.running[0].points.at(0).opposite_velocity));
  CHECK(std::signbit(back.running[0].now.efforts[0]));
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
