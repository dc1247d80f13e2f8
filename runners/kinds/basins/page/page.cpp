#include "runners/kinds/basins/page/page.hpp"

#include "runners/kinds/basins/page/basins.hpp"

namespace ricochet::report {

KindPage basins_page() {
  KindPage page;
  page.scripts = scripts({"basins"});
  page.tables = {"basin_counts", "basin_failures"};
  page.derived = {basin_counts, basin_failures};
  page.answer = basins_html;
  page.data_key = "basins";
  page.data = basin_data;
  page.masses = false;
  return page;
}

nlohmann::ordered_json basin_data(const CaseView& view, CurveData& blocks) {
  using Json = nlohmann::ordered_json;
  const Basins basins = basins_of(view.results());
  Json labels = Json::array(), grids = Json::array();
  for (const BasinLabel& label : basins.labels)
    labels.push_back({label.name, label.colour, label.decided, label.start});
  for (const BasinGrid& grid : basins.grids) {
    blocks.put(grid.record->id + "/cells", "u8", grid.cells);
    grids.push_back(grid.record->id);
  }
  return {{"x", {basins.x.name, basins.x.unit}},
          {"y", {basins.y.name, basins.y.unit}},
          {"xs", basins.xs},
          {"ys", basins.ys},
          {"labels", std::move(labels)},
          {"grids", std::move(grids)}};
}

Table basin_counts(const CaseView& view) {
  Table out{"basin_counts",
            "One row per case: its grid of basins beside that of the first case.",
            {{"case", "", "Identity of the case: its row in cases.csv."},
             {"other_case", "", "The first case of the study, which the grid is compared with."},
             {"cells", "1", "Cells of the grid."},
             {"filled", "1", "Cells that take the end of a marched one."},
             {"differ", "1", "Cells decided in both grids that end elsewhere."},
             {"same", "1", "Cells decided in both grids that end alike."},
             {"undecided", "1", "Cells that are starts in one of the two, and undecided in one."},
             {"decided", "1", "Cells that both decide."},
             {"share", "1", "Share of the cells decided in both that differ."},
             {"no_starts", "1", "Cells that begin beyond a stop: no motion begins there."}},
            {}};
  const Basins basins = basins_of(view.results());
  if (basins.grids.empty()) return out;
  const BasinGrid& first = basins.grids.front();
  const auto decided = [&](std::uint8_t cell) { return cell != BasinGrid::absent && basins.labels[cell].decided; };
  const auto starts = [&](std::uint8_t cell) { return cell == BasinGrid::absent || basins.labels[cell].start; };
  for (const BasinGrid& grid : basins.grids) {
    size_t differ = 0, same = 0, neither = 0;
    for (size_t i = 0; i < grid.cells.size(); ++i) {
      neither += !starts(grid.cells[i]) && !starts(first.cells[i]);
      if (!decided(grid.cells[i]) || !decided(first.cells[i])) continue;
      ++(grid.cells[i] == first.cells[i] ? same : differ);
    }
    const size_t both = differ + same;
    const Cell share = both > 0 ? Cell(static_cast<double>(differ) / static_cast<double>(both)) : Cell();
    out.rows.push_back({grid.record->id, first.record->id, grid.cells.size(), grid.filled, differ, same,
                        grid.cells.size() - both - neither, both, share, grid.no_starts});
  }
  return out;
}

Table basin_failures(const CaseView& view) {
  Table out{"basin_failures",
            "One row per case and reason: cells whose orbit failed.",
            {{"case", "", "Identity of the case: its row in cases.csv."},
             {"reason", "", "What became of the cells."},
             {"cells", "1", "Cells that it happened to."}},
            {}};
  for (const BasinGrid& grid : basins_of(view.results()).grids)
    for (const auto& [reason, count] : grid.reasons) out.rows.push_back({grid.record->id, reason, count});
  return out;
}

}  // namespace ricochet::report
