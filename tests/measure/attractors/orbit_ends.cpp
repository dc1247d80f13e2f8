// One rule for the same end of two orbits of a scene.
#include <catch2/catch.hpp>
#include <random>
#include <ricochet/measure/attractors/basin_grid.hpp>

using namespace ricochet;

namespace orbit_ends_tests {

namespace {

/// A periodic end at a place of the plane, with its mirror image at another.
SettledSection cycle(double x, double v, double image_x, double image_v, int period = 1) {
  return {{Regime::periodic, period},
          make_cloud(std::vector<CloudPoint>(20, {x, v}), std::vector<CloudPoint>(20, {image_x, image_v}), {1, 1}, 1)};
}

SettledSection noise(std::mt19937& random, double x, Regime regime) {
  std::normal_distribution<double> normal;
  std::vector<CloudPoint> run, opposite;
  for (int k = 0; k < 64; ++k) {
    run.push_back({x + normal(random), normal(random)});
    opposite.push_back({9 + normal(random), normal(random)});
  }
  return {{regime}, make_cloud(run, opposite, {1, 1}, 0)};
}

}  // namespace

TEST_CASE("orbit ends: one orbit, or its mirror image, is one end, another orbit or class is another") {
  OrbitEnds ends;
  CHECK(ends.label(cycle(0.3, 0.7, -0.2, 0.4)) == 0);
  CHECK(ends.label(cycle(0.3 + 0.02, 0.7 - 0.02, -0.2, 0.4)) == 0);  // what a short transient leaves
  CHECK(ends.label(cycle(-0.2, 0.4, 0.3, 0.7)) == 0);                // the image
  CHECK(ends.label(cycle(0.3, 0.9, -0.2, 0.1)) == 1);
  CHECK(ends.label(cycle(0.3, 0.7, -0.2, 0.4, 2)) == 2);
  CHECK(ends.label({{Regime::no_contact}, {}}) == 3);
  CHECK(ends.label({{Regime::no_contact}, {}}) == 3);
  // One at rest where another orbit passes by, and one at rest elsewhere.
  const auto resting = [](double x) {
    return SettledSection{{Regime::at_rest}, make_cloud(std::vector<CloudPoint>(20, {x, 0}), {}, {1, 1}, 1)};
  };
  CHECK(ends.label(cycle(0.5, 0, -0.5, 0)) == 4);
  CHECK(ends.label(resting(0.5)) == 5);
  CHECK(ends.label(resting(0.5)) == 5);
  CHECK(ends.label(resting(0.8)) == 6);
  CHECK(ends.met().size() == 7);
}

TEST_CASE("orbit ends: of several that are near, the nearest") {
  OrbitEnds ends;
  CHECK(ends.label(cycle(0, 0, 5, 5)) == 0);
  CHECK(ends.label(cycle(0.06, 0, 5, 5)) == 1);
  CHECK(ends.label(cycle(0.04, 0, 5, 5)) == 1);
  CHECK(ends.label(cycle(0.02, 0, 5, 5)) == 0);
}

TEST_CASE("orbit ends: runs of one wandering motion are one end, of two motions two") {
  std::mt19937 random(3);
  OrbitEnds ends;
  const int chaotic = ends.label(noise(random, 0, Regime::chaotic));
  int split = 0;
  for (int trial = 0; trial < 100; ++trial) split += ends.label(noise(random, 0, Regime::chaotic)) != chaotic;
  CHECK(split <= 5);
  CHECK(ends.label(noise(random, 4, Regime::chaotic)) != chaotic);
  CHECK(ends.label(noise(random, 0, Regime::quasi_periodic)) != chaotic);
}

TEST_CASE("basin grid: ends told while the cells were marched are those that are shown") {
  // Two ends that the sections alone would join: what the integration told apart stays apart, in every cell.
  BasinGrid grid;
  grid.columns = 4;
  grid.rows = 1;
  grid.cells.resize(4);
  for (std::size_t place = 0; place < 4; ++place)
    grid.cells[place] = {true, {Regime::periodic, 1}, place < 2 ? 0 : 1, -1};
  grid.cells[3] = {true, {}, -1, -1};
  std::vector<BasinGrid> cases = {grid};
  const SectionOf section = [](std::size_t) { return cycle(0.3, 0.7, -0.2, 0.4); };
  find_ends(cases[0], section);
  CHECK(cases[0].end_count == 2);
  const auto attractors = match_attractors(cases, GridOf::initial_states);
  REQUIRE(attractors.size() == 2);
  CHECK(attractors_of(cases[0]) == std::vector<int>{0, 0, 1, -1});
  CHECK(decided_cells(cases[0]) == 3);
  CHECK(count_cells(cases[0], -1) == 1);
  CHECK(boundary_share(cases[0]) == Approx(2.0 / 3));

  // Without, the sections tell; two cases agree where they can be compared.
  for (GridCell& cell : grid.cells) cell.end = -1;
  cases = {grid, grid};
  for (BasinGrid& one : cases) find_ends(one, section);
  CHECK(match_attractors(cases, GridOf::initial_states).size() == 1);
  CHECK(compare(cases[0], cases[1]).both == 3);
  CHECK(compare(cases[0], cases[1]).differ == 0);
}

}  // namespace orbit_ends_tests
