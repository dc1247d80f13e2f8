#include "runners/kinds/tables_of_cases.hpp"

#include <algorithm>

#include "runners/store/record_values.hpp"

namespace ricochet {

void collect_tables(StudyResults& results, const std::function<bool(const std::string&)>& left_out) {
  for (const CaseRecord& record : results.cases)
    for (const Table& own : record.tables) {
      if (left_out && left_out(own.name)) continue;
      auto found = std::find_if(results.derived.begin(), results.derived.end(),
                                [&](const Table& table) { return table.name == own.name; });
      if (found == results.derived.end())
        found = results.derived.insert(results.derived.end(), table_of_cases(results, own));
      append_rows(results, record, own, *found);
    }
}

}  // namespace ricochet
