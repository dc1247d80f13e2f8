#include "runners/store/views.hpp"

#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runners/store/record_tables.hpp"

namespace ricochet {
namespace {

/// A text of SQL: a name in double quotes, a value in single ones.
std::string in_quotes(const std::string& text, char quote) {
  std::string result(1, quote);
  for (const char c : text) result += c == quote ? std::string(2, c) : std::string(1, c);
  return result + quote;
}

std::string expression(const std::string& column, const StudyResults& results) {
  static const std::set<std::string> own = {"status", "reason", "steps", "setup_seconds", "run_seconds"};
  if (column == "case") return "id";
  const bool axis = std::find(results.columns.begin(), results.columns.end(), column) != results.columns.end();
  if (!axis && own.count(column) != 0) return in_quotes(column, '"');
  return fmt::format("(SELECT {} FROM {} WHERE case_id = cases.id AND name = {})",
                     axis ? "json_extract(value, '$')" : "value", axis ? "axes" : "measures", in_quotes(column, '\''));
}

}  // namespace

void make_views(SQLite::Database& database, const StudyResults& results) {
  std::string columns;
  for (const Column& column : cases_table(results).columns)
    columns += fmt::format("{}{} AS {}", columns.empty() ? "" : ", ", expression(column.name, results),
                           in_quotes(column.name, '"'));
  database.exec("DROP VIEW IF EXISTS v_cases");
  database.exec(
      fmt::format("CREATE VIEW v_cases AS SELECT {} FROM cases WHERE fingerprint != '' ORDER BY position", columns));
}

}  // namespace ricochet
