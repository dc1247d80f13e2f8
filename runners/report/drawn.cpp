#include "runners/report/drawn.hpp"

#include <map>

namespace ricochet::report {

const Drawn& drawn_for(std::string_view kind) {
  static const std::map<std::string_view, Drawn> kinds = {
      {"trajectory",
       {.scripts = {"along_axis", "over_time", "final_energy", "energy", "tip", "force", "penetration", "effects"},
        .tables = {"energy_changes", "effects", "effects_said"},
        .own_tables = {},
        .curves = {"energy", "tip_displacement", "contact_force"}}},
      {"convergence",
       {.scripts = {"error_names", "errors", "effects"},
        .tables = {"errors", "orders", "order_lines", "effects", "effects_said"},
        .own_tables = {},
        .curves = {}}},
      {"work-precision",
       {.scripts = {"error_names", "work_against_error", "work_precision", "steps_precision", "step_cost", "errors",
                    "effects"},
        .tables = {"errors", "orders", "order_lines", "work_points", "effects", "effects_said"},
        .own_tables = {},
        .curves = {}}},
      {"stability",
       {.scripts = {"stability_tables", "spectral_radius", "stability_map", "effects"},
        .tables = {"stability_cells", "stability_limits", "stability_disagreements", "effects", "effects_said"},
        .own_tables = {},
        .curves = {}}},
      {"bifurcation",
       {.scripts = {"orbits", "hand_drawn", "side_panel", "orbit_panel", "diagram_panels", "diagram", "distance",
                    "effects"},
        .tables = {"verdicts", "exponent_methods", "distance_spreads", "distance_medians", "effects", "effects_said"},
        .own_tables = {"bifurcations"},
        .curves = {},
        .orbits = true}},
      {"basins",
       {.scripts = {"side_panel", "basins", "effects"},
        .tables = {"basin_counts", "basin_failures", "effects", "effects_said"},
        .own_tables = {},
        .curves = {},
        .basins = true}}};
  static const Drawn other{
      .scripts = {"effects"}, .tables = {"effects", "effects_said"}, .own_tables = {}, .curves = {}};
  const auto found = kinds.find(kind);
  return found == kinds.end() ? other : found->second;
}

}  // namespace ricochet::report
