// Which cells of a grid are marched: everything where nothing is known before, little where boundaries are short.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>
#include <ricochet/measure/attractors/basin_grid.hpp>

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
