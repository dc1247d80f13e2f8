#include "runners/report/table_view.hpp"

#include <algorithm>

#include "runners/report/case_view.hpp"
#include "runners/report/html.hpp"
#include "runners/report/template.hpp"

namespace ricochet::report {
namespace {

constexpr size_t most_view_rows = 40;  // a page of a thousand cases must stay one that can be sent

Fill view_column(const Table& table, size_t place) {
  const Column& column = table.columns[place];
  const bool numbers = std::any_of(table.rows.begin(), table.rows.end(),
                                   [&](const Row& row) { return place < row.size() && row[place].number(); });
  Fill out;
  out.set("header", with_unit({in_words(column.name), column.unit}));
  out.set("tooltip", column.text);
  out.set("classes", numbers ? "number" : "text");
  return out;
}

Fill view_cell(const Cell& cell) {
  Fill out;
  if (const auto number = cell.number()) {
    out.set("classes", "number");
    const std::string exact = exact_text(*number), shown = number_text(*number, 6);
    if (exact != shown) out.set("value", exact);
    out.set("text", shown);
  } else {
    const auto truth = cell.truth();
    const std::string text = truth ? (*truth ? "yes" : "no") : cell.text();
    out.set("classes", text.empty() ? "absent" : text.size() > 30 ? "reason" : "text");
    out.set("text", text.empty() ? "–" : text);
  }
  return out;
}

}  // namespace

std::string derived_tables_html(const StudyResults& results) {
  Fill tables{Fill::type::list}, with;
  bool any = false;
  for (const Table& table : results.derived) {
    if (table.rows.empty()) continue;
    any = true;
    Fill one, columns{Fill::type::list}, rows{Fill::type::list};
    for (size_t c = 0; c < table.columns.size(); ++c) columns << view_column(table, c);
    const size_t shown = std::min(table.rows.size(), most_view_rows);
    for (size_t r = 0; r < shown; ++r) {
      Fill row, cells{Fill::type::list};
      for (const auto& cell : table.rows[r]) cells << view_cell(cell);
      row.set("cells", cells);
      rows << row;
    }
    one.set("name", table.name);
    one.set("title", in_words(table.name));
    one.set("size", count_text(table.rows.size(), "row", "rows"));
    one.set("columns", columns);
    one.set("rows", rows);
    one.set("tall", shown > 24 ? Fill::type::bool_true : Fill::type::bool_false);
    if (table.rows.size() > shown) one.set("more", std::to_string(table.rows.size() - shown));
    tables << one;
  }
  if (!any) return "";
  with.set("tables", tables);
  return filled("tables", with);
}

}  // namespace ricochet::report
