#include "runners/kinds/basins/page/basins.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "runners/kinds/basins/cell_ends.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"

namespace ricochet::report {
namespace {

constexpr size_t most_labels = 250;
constexpr std::array attractor_colours = {"#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00",
                                          "#6A3D9A", "#8C6D31", "#F0E442", "#44AA99", "#882255", "#999933"};

/// How a label sorts: attractors by number before everything else.
using Rank = std::pair<long long, std::string>;
constexpr long long no_attractor = 1'000'000'000, not_started = 2 * no_attractor;
constexpr const char* not_started_colour = "#E4DFD2";

struct PlacedCell {
  const CaseRecord* record;
  double x, y;
  Rank rank;
  std::string reason;
  bool filled = false;
};

Rank rank_of(const TableReader& rows, size_t row) {
  if (const auto attractor = rows.number(row, rows.column_if_any("attractor"))) return {std::llround(*attractor), ""};
  const std::string status = rows.text(row, rows.column_if_any("status")), regime = rows.text(row, "class");
  const auto period = rows.number(row, "period");
  if (status == no_start) return {not_started, no_start};
  if (!status.empty() && (status == "failed" || status == "refused" || status == "diverged"))
    return {no_attractor + static_cast<long long>(failed_group), regime_groups[failed_group].name};
  const size_t group = regime_group(regime, period ? std::optional(static_cast<int>(*period)) : std::nullopt);
  return {no_attractor + static_cast<long long>(group), regime_groups[group].name};
}

std::vector<PlacedCell> cells_of(const StudyResults& results) {
  std::map<std::string, const CaseRecord*> by_id;
  for (const CaseRecord& record : results.cases) by_id[record.id] = &record;
  std::vector<PlacedCell> out;
  const auto read = [&](const Table& table, const CaseRecord* record) {
    const TableReader rows(table);
    for (size_t row = 0; row < rows.size(); ++row) {
      const CaseRecord* owner = record;
      if (!owner) {
        const auto found = by_id.find(rows.text(row, "case"));
        if (found == by_id.end()) continue;
        owner = found->second;
      }
      const auto x = rows.number(row, "x"), y = rows.number(row, "y");
      if (x && y)
        out.push_back({owner, *x, *y, rank_of(rows, row), rows.text(row, rows.column_if_any("reason")),
                       !rows.truth(row, rows.column_if_any("marched")).value_or(true)});
    }
  };
  for (const Table& table : results.derived)
    if (table.name == "cells") read(table, nullptr);
  if (!out.empty()) return out;
  for (const CaseRecord& record : results.cases)
    if (const Table* table = find_table(record.tables, "cells")) read(*table, &record);
  return out;
}

/// "attractor 2 (periodic 3)".
std::map<long long, std::string> attractor_names(const StudyResults& results) {
  std::map<long long, std::string> out;
  for (const Table& table : results.derived) {
    if (table.name != "attractors") continue;
    const TableReader rows(table);
    for (size_t row = 0; row < rows.size(); ++row) {
      const auto number = rows.number(row, "attractor"), period = rows.number(row, "period");
      if (!number) continue;
      out[std::llround(*number)] = regime_text(rows.text(row, "class"), period);
    }
  }
  return out;
}

}  // namespace

Basins basins_of(const StudyResults& results) {
  Basins out;
  const std::vector<PlacedCell> cells = cells_of(results);
  std::set<double> xs, ys;
  std::set<Rank> ranks;
  for (const PlacedCell& cell : cells) {
    xs.insert(cell.x);
    ys.insert(cell.y);
    ranks.insert(cell.rank);
  }
  out.xs.assign(xs.begin(), xs.end());
  out.ys.assign(ys.begin(), ys.end());
  const auto names = attractor_names(results);
  std::map<Rank, std::uint8_t> index;
  size_t attractor = 0;
  for (const Rank& rank : ranks) {
    index[rank] = static_cast<std::uint8_t>(std::min(out.labels.size(), most_labels - 1));
    if (out.labels.size() == most_labels) continue;
    if (rank.first == not_started) {
      out.labels.push_back({rank.second, not_started_colour, false, false});
    } else if (rank.first >= no_attractor) {
      const size_t group = regime_group(rank.second, std::nullopt);
      out.labels.push_back({rank.second, regime_groups[group].colour, false});
      // Groups such as "period 3" are no words of a class: without attractors they tell the cells apart.
      for (size_t g = 0; g < undecided_group; ++g)
        if (rank.second == regime_groups[g].name) out.labels.back() = {rank.second, regime_groups[g].colour, true};
    } else {
      const auto said = names.find(rank.first);
      out.labels.push_back({"attractor " + std::to_string(rank.first) +
                                (said == names.end() || said->second.empty() ? "" : " (" + said->second + ")"),
                            attractor_colours[attractor++ % attractor_colours.size()], true});
    }
  }
  std::map<const CaseRecord*, size_t> place;
  const auto at = [](const std::vector<double>& list, double value) {
    return static_cast<size_t>(std::lower_bound(list.begin(), list.end(), value) - list.begin());
  };
  std::set<const CaseRecord*> with_cells;
  for (const PlacedCell& cell : cells) with_cells.insert(cell.record);
  for (const CaseRecord& record : results.cases)
    if (with_cells.contains(&record)) {
      place[&record] = out.grids.size();
      out.grids.push_back({&record, std::vector<std::uint8_t>(xs.size() * ys.size(), BasinGrid::absent), 0, 0, {}});
    }
  for (const PlacedCell& cell : cells) {
    BasinGrid& grid = out.grids[place.at(cell.record)];
    const std::uint8_t label = index.at(cell.rank);
    grid.cells[at(out.ys, cell.y) * xs.size() + at(out.xs, cell.x)] = label;
    grid.no_starts += cell.rank.first == not_started;
    grid.filled +=
        cell.filled && cell.rank.first != not_started && cell.rank.second != regime_groups[failed_group].name;
    if (cell.rank.second == regime_groups[failed_group].name) ++grid.reasons[cell.reason];
  }
  const auto axes = results.study.find("axes");
  out.x = {"x", ""};
  out.y = {"y", ""};
  if (axes != results.study.end() && axes->is_array() && axes->size() == 2) {
    out.x = swept_quantity(results, (*axes)[0], "x");
    out.y = swept_quantity(results, (*axes)[1], "y");
  }
  return out;
}

}  // namespace ricochet::report
