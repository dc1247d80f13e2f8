#include "runners/run/derive.hpp"

#include "runners/kinds/kind.hpp"
#include "runners/kinds/tables_of_cases.hpp"
#include "runners/run/answers_table.hpp"
#include "runners/run/effects_table.hpp"
#include "runners/run/reasons_table.hpp"

namespace ricochet {

void derive_tables(StudyResults& results) {
  results.derived.clear();
  const Kind* kind = find_kind(results.kind);
  if (kind && kind->tables)
    kind->tables(results);
  else
    collect_tables(results);
  for (Table table : {answers_table(results), effects_table(results), reasons_table(results)})
    if (!table.rows.empty()) results.derived.push_back(std::move(table));
  for (Table& table : report::page_tables(results, page_of(results.kind))) results.derived.push_back(std::move(table));
}

}  // namespace ricochet
