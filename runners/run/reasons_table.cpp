#include "runners/run/reasons_table.hpp"

#include <algorithm>
#include <map>
#include <regex>
#include <string_view>

#include "runners/store/record_values.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet {
namespace {

/// A sentence without its numbers, lists of them being one: doubts of one kind are alike.
std::string without_numbers(const std::string& text) {
  static const std::regex number(R"([-+]?[0-9][0-9.]*(e[-+]?[0-9]+)?)"), list(R"(#(( to |, )#)+)"),
      more(" and # more");
  return std::regex_replace(std::regex_replace(std::regex_replace(text, number, "#"), list, "#"), more, "");
}

}  // namespace

Table reasons_table(const StudyResults& results) {
  Table out{"reasons",
            "One row per reason for which finished cases have no result, or a doubtful one, in the study's order.",
            {{"status", "", "refused (does not apply), diverged or failed; done, with a doubt."},
             {"reason", "", "Why, as it stands in cases.csv; doubts of one kind are one, that of the first case."},
             {"cases", "1", "Number of cases that give this reason."},
             {"case", "", "The first of them: its row in cases.csv."}},
            {}};
  std::vector<std::pair<Row, Cases>> groups;
  std::map<std::string, std::string> kinds;
  for (const CaseRecord& record : results.cases) {
    if (record.partial) continue;
    if (record.status == "done") {
      constexpr std::string_view between = "; ";
      for (std::size_t begin = 0; begin < record.reason.size();) {
        const std::size_t end = std::min(record.reason.find(between, begin), record.reason.size());
        const std::string doubt = record.reason.substr(begin, end - begin);
        // The first of a kind speaks for all.
        const std::string& first = kinds.try_emplace(without_numbers(doubt), doubt).first->second;
        in_order_met(groups, Row{record.status, first}).push_back(&record);
        begin = end + between.size();
      }
      continue;
    }
    in_order_met(groups, Row{record.status, record.reason}).push_back(&record);
  }
  for (const auto& [said, cases] : groups) out.rows.push_back({said[0], said[1], cases.size(), cases.front()->id});
  return out;
}

}  // namespace ricochet
