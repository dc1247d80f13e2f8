// Boundaries whose dimension is known: lines, circles, Cantor sets.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>
#include <ricochet/measure/attractors/basin_grid.hpp>
#include <stdexcept>

using namespace ricochet;

namespace {

std::vector<int> grid(int columns, int rows, const std::function<int(double, double)>& label) {
  std::vector<int> labels;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) labels.push_back(label((i + 0.5) / columns, (j + 0.5) / rows));
  return labels;
}

Interval exponent(const std::vector<int>& labels, int columns, int rows) {
  const auto found = uncertainty_exponent(labels, columns, rows);
  REQUIRE(found);
  CHECK(found->low <= found->value);
  CHECK(found->value <= found->high);
  return *found;
}

/// Which gap of the Cantor set that keeps two outer parts of `keep` each x lies in, by depth (parity); points deeper
/// than `depth` count as another gap.
int cantor_gap(double x, double keep, int depth) {
  for (int level = 0; level < depth; ++level) {
    if (x > keep && x < 1 - keep) return level % 2;
    x = x <= keep ? x / keep : (x - (1 - keep)) / keep;
  }
  return depth % 2;
}

}  // namespace

TEST_CASE("uncertainty exponent: a smooth boundary has 1") {
  for (const int cells : {64, 200}) {
    INFO(cells << " cells a side");
    // A line parallel to an axis has 2ε uncertain cells per row, whatever ε.
    const auto straight = grid(cells, cells, [](double x, double) { return x > 0.37; });
    CHECK(exponent(straight, cells, cells).value == Approx(1).epsilon(1e-12));
    // Where a boundary slants or bends, an offset along the other axis may reach beyond it: a few percent.
    const auto line = grid(cells, cells, [](double x, double y) { return x + 0.3 * y > 0.6; });
    CHECK(exponent(line, cells, cells).value == Approx(1).epsilon(0.04));
    const auto circle = grid(cells, cells, [](double x, double y) { return std::hypot(x - 0.5, y - 0.5) < 0.3; });
    const Interval found = exponent(circle, cells, cells);
    CHECK(found.value == Approx(1).epsilon(0.1));
    CHECK((found.low < 1 && found.high > 1));
  }
}

TEST_CASE("uncertainty exponent: a Cantor set of lines has 1 − ln 2/ln(1/keep)") {
  for (const double keep : {1.0 / 3, 0.25, 0.4}) {
    const double expected = 1 - std::log(2.0) / std::log(1 / keep);
    const int cells = 2048;
    const auto row = grid(cells, 1, [&](double x, double) { return cantor_gap(x, keep, 12); });
    const auto column = grid(1, cells, [&](double, double y) { return cantor_gap(y, keep, 12); });
    const Interval found = exponent(row, cells, 1);
    INFO("keep " << keep << ": expected " << expected << ", found " << found.value << " in [" << found.low << ", "
                 << found.high << "]");
    // Doubling against scales of 1/keep: counts oscillate around the power, and bend as they fill the line.
    CHECK(found.value == Approx(expected).margin(0.06));
    CHECK((found.low < expected && expected < found.high));
    CHECK(found.high - found.low < 0.5);
    CHECK(exponent(column, 1, cells).value == found.value);
    // A line times the set: the same exponent in two dimensions.
    const int side = 512;
    const auto plane = grid(side, side, [&](double x, double) { return cantor_gap(x, keep, 10); });
    const auto section = grid(side, 1, [&](double x, double) { return cantor_gap(x, keep, 10); });
    CHECK(exponent(plane, side, side).value == Approx(exponent(section, side, 1).value).epsilon(1e-12));
  }
}

TEST_CASE("uncertainty exponent: basins as fine as the grid have no exponent") {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto noise = grid(128, 128, [&](double, double) { return unit(random) < 0.5; });
  CHECK_FALSE(uncertainty_exponent(noise, 128, 128));  // 15 cells of 16 are uncertain, at every size
}

TEST_CASE("uncertainty exponent: names, mirrors and cells not known do not matter") {
  const int cells = 150;
  const auto wavy = [](double x, double y) { return y > 0.5 + 0.2 * std::sin(9 * x); };
  const auto first = grid(cells, cells, [&](double x, double y) { return wavy(x, y) ? 1 : 0; });
  const double value = exponent(first, cells, cells).value;
  CHECK(exponent(grid(cells, cells, [&](double x, double y) { return wavy(x, y) ? 3 : 17; }), cells, cells).value ==
        value);
  // Mirrored, the same pairs of cells in another order.
  CHECK(exponent(grid(cells, cells, [&](double x, double y) { return wavy(1 - x, y) ? 1 : 0; }), cells, cells).value ==
        Approx(value).epsilon(1e-12));
  CHECK(exponent(grid(cells, cells, [&](double x, double y) { return wavy(y, x) ? 1 : 0; }), cells, cells).value ==
        Approx(value).epsilon(1e-12));
  // A corner that failed, away from the boundary, is no basin of its own: a few percent fewer cells.
  const auto torn = grid(cells, cells, [&](double x, double y) {
    return x < 0.2 && y < 0.2 ? -1 : wavy(x, y) ? 1 : 0;
  });
  CHECK(exponent(torn, cells, cells).value == Approx(value).margin(0.03));
  const auto basin = grid(cells, cells, [&](double x, double y) {
    return x < 0.2 && y < 0.2 ? 2 : wavy(x, y) ? 1 : 0;
  });
  CHECK(uncertainty_exponent(basin, cells, cells)->value != Approx(value).margin(1e-6));
}

TEST_CASE(
    "uncertainty exponent: nothing for one basin, small grids and unknown ones, refused where labels do not fit") {
  CHECK_FALSE(uncertainty_exponent(std::vector<int>(10000, 4), 100, 100));
  CHECK_FALSE(uncertainty_exponent(std::vector<int>(10000, -1), 100, 100));
  CHECK_FALSE(uncertainty_exponent({1}, 1, 1));
  const auto small = [](int cells) { return grid(cells, cells, [](double x, double) { return x > 0.4; }); };
  CHECK_FALSE(uncertainty_exponent(small(15), 15, 15));  // sizes 1 and 2 only
  CHECK(uncertainty_exponent(small(16), 16, 16));
  CHECK_THROWS_AS(uncertainty_exponent({1, 2}, 3, 1), std::invalid_argument);
  CHECK_THROWS_AS(uncertainty_exponent({}, 0, 0), std::invalid_argument);
}
