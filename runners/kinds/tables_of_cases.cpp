#include "runners/kinds/tables_of_cases.hpp"

#include <algorithm>

#include "runners/store/record_values.hpp"

namespace ricochet {

void collect_tables(StudyResults& results, const std::function<bool(const std::string&)>& left_out) {
  for (const CaseRecord& record : results.cases)
    for (const DerivedTable& own : record.tables) {
      if (left_out && left_out(own.name)) continue;
      auto found = std::find_if(results.derived.begin(), results.derived.end(),
                                [&](const DerivedTable& table) { return table.name == own.name; });
      if (found == results.derived.end()) {
        DerivedTable table{own.name, results.columns, {}};
        table.columns.insert(table.columns.end(), own.columns.begin(), own.columns.end());
        found = results.derived.insert(results.derived.end(), std::move(table));
      }
      for (const auto& row : own.rows) {
        auto whole = axes_of(record, results.columns);
        whole.insert(whole.end(), row.begin(), row.end());
        found->rows.push_back(std::move(whole));
      }
    }
}

}  // namespace ricochet
