#include "runners/kinds/basins/page/basin_data.hpp"

#include "runners/kinds/basins/page/basins.hpp"

namespace ricochet::report {

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

}  // namespace ricochet::report
