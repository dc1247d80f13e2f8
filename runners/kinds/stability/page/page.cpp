#include "runners/kinds/stability/page/page.hpp"

namespace ricochet::report {

KindPage stability_page() {
  KindPage page;
  page.scripts = scripts({"stability_tables", "limit_dots", "spectral_radius", "stability_map"});
  page.tables = {"stability_cells", "step_limits", "stability_disagreements"};
  page.answer = [](const CaseView& view) { return stability_html(view) + restitution_html(view); };
  return page;
}

}  // namespace ricochet::report
