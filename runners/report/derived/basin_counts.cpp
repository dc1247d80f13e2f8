#include "runners/report/basins.hpp"
#include "runners/report/derived/shown_tables.hpp"

namespace ricochet::report {

DerivedTable basin_counts(const CaseView& view) {
  DerivedTable out{
      "basin_counts", {"case", "other_case", "cells", "filled", "differ", "same", "undecided", "decided", "share"}, {}};
  const Basins basins = basins_of(view.results());
  if (basins.grids.empty()) return out;
  const BasinGrid& first = basins.grids.front();
  const auto decided = [&](std::uint8_t cell) { return cell != BasinGrid::absent && basins.labels[cell].decided; };
  for (const BasinGrid& grid : basins.grids) {
    size_t differ = 0, same = 0;
    for (size_t i = 0; i < grid.cells.size(); ++i) {
      if (!decided(grid.cells[i]) || !decided(first.cells[i])) continue;
      ++(grid.cells[i] == first.cells[i] ? same : differ);
    }
    const size_t both = differ + same;
    const nlohmann::ordered_json share =
        both > 0 ? nlohmann::ordered_json(static_cast<double>(differ) / static_cast<double>(both)) : nullptr;
    out.rows.push_back({grid.record->id, first.record->id, grid.cells.size(), grid.filled, differ, same,
                        grid.cells.size() - both, both, share});
  }
  return out;
}

DerivedTable basin_failures(const CaseView& view) {
  DerivedTable out{"basin_failures", {"case", "reason", "cells"}, {}};
  for (const BasinGrid& grid : basins_of(view.results()).grids)
    for (const auto& [reason, count] : grid.reasons) out.rows.push_back({grid.record->id, reason, count});
  return out;
}

}  // namespace ricochet::report
