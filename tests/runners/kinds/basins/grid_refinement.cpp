// Which cells of a grid are marched: everything where nothing is known before, little where boundaries are short.
#include "runners/kinds/basins/grid_refinement.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <set>

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
  GridRefinement grid(columns, rows, refine);
  Filled out;
  for (auto wanted = grid.next(); !wanted.empty(); wanted = grid.next()) {
    ++out.rounds;
    CHECK(std::is_sorted(wanted.begin(), wanted.end()));
    for (const std::size_t cell : wanted) {
      CHECK_FALSE(grid.marched(cell));
      grid.set_label(cell, truth(cell % columns, cell / columns));
      ++out.marched;
    }
  }
  out.sources = grid.sources();
  for (const std::size_t source : out.sources) {
    REQUIRE(source < columns * rows);
    REQUIRE(grid.marched(source));
    out.labels.push_back(truth(source % columns, source / columns));
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

TEST_CASE("One basin costs the coarse grid alone") {
  for (const auto& [columns, rows] : {std::pair<std::size_t, std::size_t>{33, 33}, {2, 2}, {2, 9}, {6, 11}, {5, 3}}) {
    INFO(columns << " x " << rows);
    const Filled one = fill(columns, rows, true, [](std::size_t, std::size_t) { return 0; });
    CHECK(one.marched == GridRefinement::coarse_cells(columns, rows, true));
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

TEST_CASE("A grid that is all boundary is marched whole") {
  const Filled chess = fill(17, 13, true, [](std::size_t x, std::size_t y) { return static_cast<int>(7 * x + 3 * y); });
  CHECK(chess.marched == 17 * 13);
}
