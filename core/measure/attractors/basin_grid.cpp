#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <deque>
#include <map>
#include <numeric>
#include <ricochet/measure/attractors/attractors.hpp>
#include <ricochet/measure/attractors/basin_grid.hpp>
#include <set>
#include <stdexcept>
#include <utility>

namespace ricochet {

namespace {

// Spreads the ends of the cells in front over neighbours of their class that have none.
void flood(BasinGrid& grid, std::deque<std::size_t>& front) {
  for (; !front.empty(); front.pop_front()) {
    const GridCell from = grid.cells[front.front()];
    for (const std::size_t place : grid.neighbours(front.front())) {
      GridCell& cell = grid.cells[place];
      if (!cell.present || cell.end >= 0 || !(cell.motion == from.motion)) continue;
      cell.end = from.end;
      front.push_back(place);
    }
  }
}

// Decided cells that lie inside a region and have no section of their own.
void fill_by_neighbours(BasinGrid& grid) {
  std::deque<std::size_t> front;
  for (std::size_t place = 0; place < grid.cells.size(); ++place)
    if (grid.cells[place].present && grid.cells[place].end >= 0) front.push_back(place);
  flood(grid, front);
  for (std::size_t place = 0; place < grid.cells.size(); ++place) {
    GridCell& cell = grid.cells[place];
    if (!cell.present || cell.end >= 0 || !cell.motion.decided()) continue;
    const auto same = std::find_if(grid.ends.begin(), grid.ends.end(),
                                   [&](const SettledSection& end) { return end.motion == cell.motion; });
    cell.end = static_cast<int>(same - grid.ends.begin());
    if (same == grid.ends.end()) grid.ends.push_back({cell.motion, {}});
    front.push_back(place);
    flood(grid, front);
  }
}

int match_ends(std::vector<BasinGrid>& cases) {
  std::vector<OwnedSection> sections;
  for (std::size_t c = 0; c < cases.size(); ++c)
    for (const SettledSection& end : cases[c].ends) sections.push_back({static_cast<int>(c), &end});
  const std::vector<int> groups = match_owners(sections);
  std::size_t first = 0;
  for (BasinGrid& grid : cases) {
    for (GridCell& cell : grid.cells)
      if (cell.end >= 0) cell.attractor = groups[first + static_cast<std::size_t>(cell.end)];
    first += grid.ends.size();
  }
  return groups.empty() ? 0 : *std::max_element(groups.begin(), groups.end()) + 1;
}

// How many cells each region of a case shares with each attractor of the cases before it.
std::map<std::pair<int, int>, int> shared_cells(const std::vector<BasinGrid>& cases, std::size_t c) {
  std::map<std::pair<int, int>, int> shared;
  for (std::size_t before = 0; before < c; ++before)
    for (std::size_t place = 0; place < cases[c].cells.size(); ++place) {
      const GridCell &one = cases[c].cells[place], &other = cases[before].cells[place];
      if (one.present && other.present && one.end >= 0 && one.motion == other.motion)
        ++shared[{one.end, other.attractor}];
    }
  return shared;
}

int match_regions(std::vector<BasinGrid>& cases) {
  int attractors = 0;
  for (std::size_t c = 0; c < cases.size(); ++c) {
    std::vector<std::pair<int, std::pair<int, int>>> most;
    for (const auto& [pair, count] : shared_cells(cases, c)) most.emplace_back(-count, pair);
    std::sort(most.begin(), most.end());
    std::vector<int> attractor(static_cast<std::size_t>(cases[c].end_count), -1);
    std::set<int> taken;
    for (const auto& [count, pair] : most)
      if (attractor[static_cast<std::size_t>(pair.first)] < 0 && taken.insert(pair.second).second)
        attractor[static_cast<std::size_t>(pair.first)] = pair.second;
    for (int& one : attractor)
      if (one < 0) one = attractors++;
    for (GridCell& cell : cases[c].cells)
      if (cell.end >= 0) cell.attractor = attractor[static_cast<std::size_t>(cell.end)];
  }
  return attractors;
}

// Numbers from the largest basin on.
std::vector<MotionClass> sort_by_size(std::vector<BasinGrid>& cases, int attractors) {
  std::vector<int> size(static_cast<std::size_t>(attractors), 0), order(size.size()), place(size.size());
  for (const BasinGrid& grid : cases)
    for (const GridCell& cell : grid.cells)
      if (cell.attractor >= 0) ++size[static_cast<std::size_t>(cell.attractor)];
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return size[static_cast<std::size_t>(a)] > size[static_cast<std::size_t>(b)]; });
  for (std::size_t k = 0; k < order.size(); ++k) place[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
  std::vector<MotionClass> motions(size.size());
  for (BasinGrid& grid : cases)
    for (GridCell& cell : grid.cells)
      if (cell.attractor >= 0) {
        cell.attractor = place[static_cast<std::size_t>(cell.attractor)];
        motions[static_cast<std::size_t>(cell.attractor)] = cell.motion;
      }
  while (!motions.empty() && !motions.back().decided()) motions.pop_back();
  return motions;
}

}  // namespace

std::vector<std::size_t> BasinGrid::neighbours(std::size_t place) const {
  const std::size_t x = place % columns, y = place / columns;
  std::vector<std::size_t> out;
  if (x > 0) out.push_back(place - 1);
  if (x + 1 < columns) out.push_back(place + 1);
  if (y > 0) out.push_back(place - columns);
  if (y + 1 < rows) out.push_back(place + columns);
  return out;
}

void find_ends(BasinGrid& grid, const SectionOf& section) {
  for (const GridCell& cell : grid.cells) grid.end_count = std::max(grid.end_count, cell.end + 1);
  if (grid.end_count > 0) {
    std::vector<std::size_t> first(static_cast<std::size_t>(grid.end_count), grid.cells.size());
    for (std::size_t place = grid.cells.size(); place-- > 0;)
      if (grid.cells[place].end >= 0) first[static_cast<std::size_t>(grid.cells[place].end)] = place;
    for (const std::size_t place : first)
      grid.ends.push_back(place < grid.cells.size() ? section(place) : SettledSection{});
  } else {
    OrbitEnds ends;
    for (std::size_t place = 0; place < grid.cells.size(); ++place) {
      GridCell& cell = grid.cells[place];
      if (!cell.present || !cell.motion.decided()) continue;
      SettledSection own = section(place);
      if (own.cloud.empty() && cell.motion.regime != Regime::no_contact) continue;
      cell.end = ends.label(std::move(own));
    }
    grid.ends = ends.met();
  }
  fill_by_neighbours(grid);
  grid.end_count = static_cast<int>(grid.ends.size());
}

void find_regions(BasinGrid& grid, const SectionOf& section) {
  const std::size_t columns = grid.columns;
  std::vector<std::size_t> parent(grid.cells.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t k) {
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
  };
  std::vector<SettledSection> above(columns), here(columns);
  for (std::size_t place = 0; place < grid.cells.size(); ++place) {
    const std::size_t x = place % columns;
    if (x == 0) std::swap(above, here);
    here[x] = {};
    const GridCell& cell = grid.cells[place];
    if (!cell.present || !cell.motion.decided()) continue;
    here[x] = section(place);
    if (x > 0 && relative_distance(here[x - 1], here[x], kAlongParameter) <= 1) parent[root(place)] = root(place - 1);
    if (place >= columns && relative_distance(above[x], here[x], kAlongParameter) <= 1)
      parent[root(place)] = root(place - columns);
  }
  std::map<std::size_t, int> known;
  for (std::size_t place = 0; place < grid.cells.size(); ++place) {
    GridCell& cell = grid.cells[place];
    if (cell.present && cell.motion.decided())
      cell.end = known.emplace(root(place), static_cast<int>(known.size())).first->second;
  }
  grid.end_count = static_cast<int>(known.size());
}

std::vector<MotionClass> match_attractors(std::vector<BasinGrid>& cases, GridOf grid) {
  return sort_by_size(cases, grid == GridOf::initial_states ? match_ends(cases) : match_regions(cases));
}

std::size_t count_cells(const BasinGrid& grid, int attractor) {
  return static_cast<std::size_t>(std::count_if(grid.cells.begin(), grid.cells.end(), [&](const GridCell& cell) {
    return cell.present && cell.attractor == attractor;
  }));
}

std::size_t decided_cells(const BasinGrid& grid) {
  return static_cast<std::size_t>(
      std::count_if(grid.cells.begin(), grid.cells.end(), [](const GridCell& cell) { return cell.attractor >= 0; }));
}

GridDifference compare(const BasinGrid& a, const BasinGrid& b) {
  GridDifference out;
  for (std::size_t place = 0; place < a.cells.size(); ++place) {
    const int one = a.cells[place].attractor, other = b.cells[place].attractor;
    if (one < 0 || other < 0) continue;
    ++out.both;
    out.differ += one != other;
  }
  return out;
}

std::optional<double> boundary_share(const BasinGrid& grid) {
  int known = 0, boundary = 0;
  for (std::size_t place = 0; place < grid.cells.size(); ++place) {
    const int here = grid.cells[place].attractor;
    if (here < 0) continue;
    ++known;
    const auto around = grid.neighbours(place);
    boundary += std::any_of(around.begin(), around.end(), [&](std::size_t other) {
      return grid.cells[other].attractor >= 0 && grid.cells[other].attractor != here;
    });
  }
  return known > 0 ? std::optional(static_cast<double>(boundary) / known) : std::nullopt;
}

std::vector<int> attractors_of(const BasinGrid& grid) {
  std::vector<int> out;
  for (const GridCell& cell : grid.cells) out.push_back(cell.attractor);
  return out;
}

namespace {

constexpr double saturated = 0.8;
constexpr std::size_t fewest_sizes = 3;

struct Size {
  double x = 0, y = 0, trust = 0;  // ln ε, ln f, relative error of f by counting
};

/// Cells by row; what lies outside is not known.
struct Grid {
  const std::vector<int>& labels;
  int columns, rows;
  int operator()(int i, int j) const {
    if (i < 0 || j < 0 || i >= columns || j >= rows) return -1;
    return labels[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i)];
  }
  bool uncertain(int i, int j, int reach) const {
    const int own = (*this)(i, j);
    const auto differs = [&](int label) { return label >= 0 && label != own; };
    return differs((*this)(i - reach, j)) || differs((*this)(i + reach, j)) || differs((*this)(i, j - reach)) ||
           differs((*this)(i, j + reach));
  }
};

}  // namespace

std::optional<Interval> uncertainty_exponent(const std::vector<int>& labels, int columns, int rows) {
  if (columns < 1 || rows < 1 || labels.size() != static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))
    throw std::invalid_argument("the labels do not fill the grid");
  const Grid grid{labels, columns, rows};
  const int dimensions = (columns > 1) + (rows > 1);
  const int side = columns == 1 ? rows : rows == 1 ? columns : std::min(columns, rows);
  const auto known = std::count_if(labels.begin(), labels.end(), [](int label) { return label >= 0; });
  std::vector<Size> sizes;
  for (int reach = 1; reach <= side / 4; reach *= 2) {
    long long uncertain = 0;
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) uncertain += grid(i, j) >= 0 && grid.uncertain(i, j, reach);
    if (uncertain == 0) continue;
    const double share = static_cast<double>(uncertain) / static_cast<double>(known);
    if (share > saturated) break;
    const double apart = static_cast<double>(uncertain) / std::pow(2.0 * reach, dimensions);
    sizes.push_back({std::log(reach), std::log(share), 1 / std::sqrt(std::max(1.0, apart))});
  }
  if (sizes.size() < fewest_sizes) return std::nullopt;

  const double n = static_cast<double>(sizes.size());
  double mean_x = 0, mean_y = 0, sxx = 0, sxy = 0, squares = 0, counted = 0;
  for (const Size& s : sizes) mean_x += s.x / n, mean_y += s.y / n;
  for (const Size& s : sizes) sxx += (s.x - mean_x) * (s.x - mean_x), sxy += (s.x - mean_x) * (s.y - mean_y);
  const double slope = sxy / sxx;
  for (const Size& s : sizes) {
    squares += std::pow(s.y - mean_y - slope * (s.x - mean_x), 2);
    counted += std::pow((s.x - mean_x) / sxx * s.trust, 2);
  }
  const double student = boost::math::quantile(boost::math::students_t(n - 2), 0.975);
  const double half = std::hypot(student * std::sqrt(squares / (n - 2) / sxx), 1.96 * std::sqrt(counted));
  return Interval{slope, slope - half, slope + half};
}

}  // namespace ricochet
