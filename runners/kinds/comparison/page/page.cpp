#include "runners/kinds/comparison/page/page.hpp"

namespace ricochet::report {

KindPage comparison_page() {
  KindPage page;
  page.scripts = scripts({"error_names", "order_dots", "errors"});
  page.tables = {"errors", "orders", "order_lines"};
  page.derived = {order_lines};
  page.answer = orders_html;
  return page;
}

}  // namespace ricochet::report
