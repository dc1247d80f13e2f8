#include "runners/run/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "runners/kinds/kind.hpp"
#include "runners/report/case_view.hpp"
#include "runners/report/html.hpp"
#include "runners/report/summary_page.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/table_reader.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

std::string cell(const CaseRecord& record, const std::string& column) {
  return axis(record, column).text();
}

// What is wrong with the finished cases, and with how many of them.
std::map<std::string, int> contradictions(const StudyResults& results) {
  std::map<std::string, int> found;
  const Kind* kind = find_kind(results.kind);
  if (kind)
    for (const CaseRecord& record : results.cases)
      if (const std::string wrong = kind->contradiction(record); !wrong.empty()) ++found[wrong];
  return found;
}

int count(const StudyResults& results, const char* status) {
  return static_cast<int>(std::count_if(results.cases.begin(), results.cases.end(), [&](const CaseRecord& record) {
    return !record.partial && record.status == status;
  }));
}

}  // namespace

std::string outcome_text(const CaseRecord& record, const std::string& kind) {
  if (record.partial) return record.reason;
  if (record.status == "done") {
    const Kind* known = find_kind(kind);
    const std::string own = known ? known->outcome(record) : "";
    std::string text = own.empty() ? "done" : "done: " + own;
    if (!record.reason.empty()) text += (own.empty() ? ": " : "; ") + record.reason;
    return text;
  }
  return record.reason.empty() ? record.status : fmt::format("{}: {}", record.status, record.reason);
}

std::string answer_text(const StudyResults& results) {
  constexpr std::size_t most = report::most_answer_lines;
  const std::vector<std::string> lines = report::answer_lines(results);
  std::string out = results.question.empty() ? "" : results.question + "\n";
  for (std::size_t k = 0; k < std::min(lines.size(), most); ++k) out += "  " + lines[k] + "\n";
  if (lines.size() > most) out += fmt::format("  {} more in the report\n", lines.size() - most);
  return out;
}

std::string case_table(const StudyResults& results) {
  std::vector<std::string> header;
  for (const std::string& name : results.columns) {
    const auto differs = [&](const CaseRecord& record) {
      return cell(record, name) != cell(results.cases.front(), name);
    };
    if (std::any_of(results.cases.begin(), results.cases.end(), differs)) header.push_back(name);
  }
  const std::vector<std::string> axes = header;
  if (axes.empty()) header.emplace_back("case");
  header.emplace_back("outcome");
  TextTable table(header);
  for (const CaseRecord& record : results.cases) {
    std::vector<std::string> line;
    for (const std::string& name : axes) line.push_back(cell(record, name));
    if (axes.empty()) line.push_back(record.id);
    line.push_back(outcome_text(record, results.kind));
    table.add(std::move(line));
  }
  return table.text();
}

std::string totals_text(const StudyResults& results) {
  std::vector<std::string> parts;
  for (const auto& [status, number] : report::status_counts(results))
    parts.push_back(fmt::format("{} {}", number, status));
  if (const auto number = std::count_if(results.cases.begin(), results.cases.end(),
                                        [](const CaseRecord& record) { return record.partial; }))
    parts.push_back(fmt::format("{} under way", number));
  const std::size_t cases = results.cases.size();
  std::string text =
      fmt::format("{}{} case{}", results.part.whole() ? "" : results.part.text() + ": ", cases, cases == 1 ? "" : "s");
  if (!parts.empty()) text += fmt::format(": {}", fmt::join(parts, ", "));
  for (const auto& [wrong, number] : contradictions(results)) text += fmt::format("; in {} {}", number, wrong);
  if (const int missing = results.expected_cases - static_cast<int>(cases); missing > 0)
    text += fmt::format("; {} not run yet", missing);
  return text;
}

int results_exit_code(const StudyResults& results) {
  constexpr int some_failed = 3;
  return !contradictions(results).empty() || count(results, "diverged") + count(results, "failed") > 0 ? some_failed
                                                                                                       : 0;
}

}  // namespace ricochet
