#include "runners/kinds/work-precision/page/page.hpp"

#include "runners/kinds/comparison/page/page.hpp"

namespace ricochet::report {

KindPage work_precision_page() {
  KindPage page = comparison_page();
  page.scripts = scripts({"error_names", "work_against_error", "work_front", "work_precision", "steps_precision",
                          "step_cost", "order_dots", "errors"});
  page.tables.push_back("work_points");
  page.derived.push_back(work_points);
  page.answer = [](const CaseView& view) { return work_precision_html(view) + orders_html(view); };
  return page;
}

}  // namespace ricochet::report
