#include "runners/kinds/trajectory/page/page.hpp"

namespace ricochet::report {

KindPage trajectory_page() {
  KindPage page;
  page.scripts =
      scripts({"along_axis", "over_time", "final_energy", "energy", "tip", "force", "penetration", "impacts"});
  page.tables = {"energy_changes"};
  page.curves = {"energy", "tip_displacement", "contact_force_peak"};
  page.derived = {energy_changes};
  page.answer = energy_answer;
  return page;
}

}  // namespace ricochet::report
