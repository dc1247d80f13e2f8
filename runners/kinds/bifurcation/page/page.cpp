#include "runners/kinds/bifurcation/page/page.hpp"

#include "runners/kinds/bifurcation/page/orbit_data.hpp"

namespace ricochet::report {

KindPage bifurcation_page() {
  KindPage page;
  page.scripts = scripts({"orbits", "hand_drawn", "orbit_panel", "diagram_panels", "diagram", "distance"});
  page.tables = {"verdicts", "exponent_methods", "distance_spreads", "distance_medians"};
  page.own_tables = {"bifurcations"};
  page.derived = {distance_spreads, distance_medians, exponent_methods};
  page.answer = dynamics_answer_html;
  page.methods = dynamics_tables_html;
  page.data_key = "orbits";
  page.data = orbit_data;
  page.masses = false;
  return page;
}

}  // namespace ricochet::report
