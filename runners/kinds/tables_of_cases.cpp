#include "runners/kinds/tables_of_cases.hpp"

#include "runners/store/record_values.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {

void collect_tables(StudyResults& results, const std::function<bool(const std::string&)>& left_out) {
  for (const CaseRecord& record : results.cases)
    for (const Table& own : record.tables) {
      if (left_out && left_out(own.name)) continue;
      Table* found = find_table(results.derived, own.name);
      if (!found) found = &results.derived.emplace_back(table_of_cases(results, own));
      append_rows(results, record, own, *found);
    }
}

}  // namespace ricochet
