#include "runners/kinds/basins/page/page.hpp"

#include "runners/kinds/basins/page/basin_data.hpp"

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

}  // namespace ricochet::report
