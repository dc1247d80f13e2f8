// Which cells of a grid are marched: everything where nothing is known before, little where boundaries are short.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>
#include <ricochet/measure/attractors/basin_grid.hpp>
#include <stdexcept>

using namespace ricochet;

namespace {

using Labels = std::function<int(std::size_t column, std::size_t row)>;

struct Filled {
  std::size_t marched = 0, rounds = 0;
  std::vector<int> labels;  // what each cell is taken for
  std::vector<std::size_t> sources;
};

/// Marches a grid whose labels are known.
Filled fill(std::size_t columns, std::size_t rows, bool refine, const Labels& truth) {
  const auto label = [&](std::size_t cell) { return truth(cell % columns, cell / columns); };
  GridRefinement grid(columns, rows, refine, [&](std::size_t a, std::size_t b) { return label(a) == label(b); });
  Filled out;
  for (auto wanted = grid.next(); !wanted.empty(); wanted = grid.next()) {
    ++out.rounds;
    CHECK(std::is_sorted(wanted.begin(), wanted.end()));
    for (const std::size_t cell : wanted) {
      CHECK_FALSE(grid.marched(cell));
      grid.set_marched(cell);
      ++out.marched;
    }
  }
  out.sources = grid.sources();
  for (const std::size_t source : out.sources) {
    REQUIRE(source < columns * rows);
    REQUIRE(grid.marched(source));
    out.labels.push_back(label(source));
  }
  return out;
}

std::size_t wrong(const Filled& filled, std::size_t columns, const Labels& truth) {
  std::size_t count = 0;
  for (std::size_t cell = 0; cell < filled.labels.size(); ++cell)
    count += filled.labels[cell] != truth(cell % columns, cell / columns);
  return count;
}

}  // namespace

TEST_CASE("Without refinement every cell is marched, once") {
  const Filled all = fill(7, 5, false, [](std::size_t x, std::size_t) { return static_cast<int>(x); });
  CHECK(all.marched == 35);
  CHECK(all.rounds == 1);
  for (std::size_t cell = 0; cell < 35; ++cell) CHECK(all.sources[cell] == cell);
}

TEST_CASE("One basin costs the coarse grid and the frame") {
  for (const auto& [columns, rows] : {std::pair<std::size_t, std::size_t>{33, 33}, {2, 2}, {2, 9}, {6, 11}, {5, 3}}) {
    INFO(columns << " x " << rows);
    const Filled one = fill(columns, rows, true, [](std::size_t, std::size_t) { return 0; });
    CHECK(one.marched == GridRefinement::first_cells(columns, rows, true));
    CHECK(one.rounds == 1);
  }
}

TEST_CASE("Boundaries that the coarse grid sees are found cell by cell") {
  // A line, a disc wider than the coarse stride, and both at once, whatever the size of the grid.
  const auto line = [](std::size_t x, std::size_t y) { return 3 * x + y > 50 ? 1 : 0; };
  const auto disc = [](std::size_t x, std::size_t y) {
    return std::hypot(static_cast<double>(x) - 14, static_cast<double>(y) - 11) < 7.3 ? 1 : 0;
  };
  const auto both = [&](std::size_t x, std::size_t y) { return line(x, y) + 2 * disc(x, y); };
  for (const auto& [columns, rows] : {std::pair<std::size_t, std::size_t>{33, 29}, {40, 31}, {34, 26}})
    for (const Labels& truth : {Labels(line), Labels(disc), Labels(both)}) {
      INFO(columns << " x " << rows);
      const Filled filled = fill(columns, rows, true, truth);
      CHECK(wrong(filled, columns, truth) == 0);
      CHECK(filled.marched < columns * rows / 2);
    }
}

TEST_CASE("A tongue is followed from where the coarse grid meets it") {
  // Two cells wide, so that it runs between the corners of most blocks; it meets a corner at (16, 16).
  const auto tongue = [](std::size_t x, std::size_t y) { return y / 2 == 8 && x >= 4 && x < 30 ? 1 : 0; };
  const Filled filled = fill(33, 33, true, tongue);
  CHECK(wrong(filled, 33, tongue) == 0);
}

TEST_CASE("A tongue that enters the grid from outside is found however thin") {
  const auto needle = [](std::size_t x, std::size_t y) { return x > 20 && y == 22 + (40 - x) / 7 ? 1 : 0; };
  const Filled filled = fill(41, 37, true, needle);
  CHECK(wrong(filled, 41, needle) == 0);
  CHECK(filled.marched < 41 * 37 / 2);
}

namespace {

/// Regions of like cells, joined by an edge or a corner; a number for each cell.
std::vector<std::size_t> regions(std::size_t columns, std::size_t rows, const std::vector<int>& labels) {
  std::vector<std::size_t> region(labels.size(), labels.size());
  for (std::size_t seed = 0; seed < labels.size(); ++seed) {
    if (region[seed] < labels.size()) continue;
    std::vector<std::size_t> front = {seed};
    region[seed] = seed;
    while (!front.empty()) {
      const std::size_t here = front.back(), x = here % columns, y = here / columns;
      front.pop_back();
      for (std::size_t j = y > 0 ? y - 1 : 0; j <= std::min(y + 1, rows - 1); ++j)
        for (std::size_t i = x > 0 ? x - 1 : 0; i <= std::min(x + 1, columns - 1); ++i) {
          const std::size_t there = i + columns * j;
          if (region[there] < labels.size() || labels[there] != labels[here]) continue;
          region[there] = seed;
          front.push_back(there);
        }
    }
  }
  return region;
}

}  // namespace

TEST_CASE("Whatever the grid, a region that holds one of the first cells is found whole") {
  std::mt19937 random(7);
  std::size_t islands = 0;
  for (int trial = 0; trial < 60; ++trial) {
    // Waves of random length cut off at a random height: blobs, necks and needles.
    const std::size_t columns = 9 + random() % 40, rows = 9 + random() % 40;
    const auto number = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
    const double a = 1.2 * number(), b = 1.2 * number(), c = 0.8 * number(), d = 0.8 * number(), height = number();
    std::vector<int> labels;
    for (std::size_t y = 0; y < rows; ++y)
      for (std::size_t x = 0; x < columns; ++x) {
        const auto u = static_cast<double>(x), v = static_cast<double>(y);
        labels.push_back(std::sin(a * u + b * v) + std::sin(c * u - d * v * v / 30) > height ? 1 : 0);
      }
    const Labels truth = [&](std::size_t x, std::size_t y) { return labels[x + columns * y]; };
    const Filled filled = fill(columns, rows, true, truth);
    const std::vector<std::size_t> region = regions(columns, rows, labels);
    std::vector<bool> met(labels.size(), false);
    GridRefinement grid(columns, rows, true, [](std::size_t, std::size_t) { return true; });
    for (const std::size_t cell : grid.next()) met[region[cell]] = true;
    for (std::size_t cell = 0; cell < labels.size(); ++cell) {
      if (met[region[cell]])
        REQUIRE(filled.labels[cell] == labels[cell]);
      else
        islands += filled.labels[cell] != labels[cell];
    }
  }
  CHECK(islands > 0);  // the price is paid somewhere, or the trials tell nothing
}

TEST_CASE("A grid that is all boundary is marched whole") {
  const Filled chess = fill(17, 13, true, [](std::size_t x, std::size_t y) { return static_cast<int>(7 * x + 3 * y); });
  CHECK(chess.marched == 17 * 13);
}

// Boundaries whose dimension is known: lines, circles, Cantor sets.

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

/// Which gap x lies in, by depth (parity), of the Cantor set that keeps two outer parts of `keep` each. Points deeper
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
