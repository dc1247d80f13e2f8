#include "runners/run/reasons_table.hpp"

#include "runners/store/record_values.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet {

Table reasons_table(const StudyResults& results) {
  Table out{"reasons",
            "One row per reason for which finished cases have no result, in the study's order.",
            {{"status", "", "refused (does not apply), diverged or failed."},
             {"reason", "", "Why, as it stands in cases.csv."},
             {"cases", "1", "Number of cases that give this reason."},
             {"case", "", "The first of them: its row in cases.csv."}},
            {}};
  std::vector<std::pair<Row, Cases>> groups;
  for (const CaseRecord& record : results.cases) {
    if (record.partial || record.status == "done") continue;
    in_order_met(groups, Row{record.status, record.reason}).push_back(&record);
  }
  for (const auto& [said, cases] : groups) out.rows.push_back({said[0], said[1], cases.size(), cases.front()->id});
  return out;
}

}  // namespace ricochet
