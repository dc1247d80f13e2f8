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
  // The answer says the shares, and stands before them.
  const auto before_shares = static_cast<std::ptrdiff_t>(results.derived.size());
  if (Table shares = effects_table(results); !shares.rows.empty()) results.derived.push_back(std::move(shares));
  if (Table answers = answers_table(results); !answers.rows.empty())
    results.derived.insert(results.derived.begin() + before_shares, std::move(answers));
  if (Table reasons = reasons_table(results); !reasons.rows.empty()) results.derived.push_back(std::move(reasons));
  for (Table& table : report::page_tables(results, page_of(results.kind))) results.derived.push_back(std::move(table));
}

}  // namespace ricochet
