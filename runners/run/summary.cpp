#include "runners/run/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "runners/kinds/kind.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/plain_text.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {
namespace {

std::string cell(const CaseRecord& record, const std::string& column) {
  return axis(record, column).text();
}

std::string signed_percent(double ratio) {
  const double percent = 100 * ratio;
  constexpr double tenth = 0.05, double_noise = 1e-13;  // percent
  if (std::abs(percent) < double_noise) return "unchanged";
  const char* sign = percent < 0 ? "−" : "+";
  const double size = std::abs(percent);
  return size < tenth ? fmt::format("{}{:.1e} %", sign, size) : fmt::format("{}{:.1f} %", sign, size);
}

bool contradicts_itself(const CaseRecord& record) {
  return measure(record, "contradictions").value_or(0) > 0;
}

std::string done_text(const CaseRecord& record) {
  std::vector<std::string> parts;
  auto start = measure(record, "energy_start");
  auto end = measure(record, "energy_end");
  if (start && end) {
    std::string text = fmt::format("energy {:.4g} J → {:.4g} J", *start, *end);
    if (*start != 0) text += fmt::format(" ({})", signed_percent((*end - *start) / std::abs(*start)));
    parts.push_back(text);
  }
  if (const auto impacts = measure(record, "impacts"))
    parts.push_back(fmt::format("{:.0f} impact{}", *impacts, *impacts == 1 ? "" : "s"));
  if (const auto cost = measure(record, "microseconds_per_step")) parts.push_back(fmt::format("{:.3g} µs/step", *cost));
  return parts.empty() ? "done" : fmt::format("done: {}", fmt::join(parts, ", "));
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
    const std::string own = known && known->outcome ? known->outcome(record) : "";
    return own.empty() ? done_text(record) : "done: " + own;
  }
  return record.reason.empty() ? record.status : fmt::format("{}: {}", record.status, record.reason);
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
  for (const char* status : {"done", "refused", "diverged", "failed"})
    if (const int number = count(results, status)) parts.push_back(fmt::format("{} {}", number, status));
  if (const auto number = std::count_if(results.cases.begin(), results.cases.end(),
                                        [](const CaseRecord& record) { return record.partial; }))
    parts.push_back(fmt::format("{} under way", number));
  const std::size_t cases = results.cases.size();
  std::string text = fmt::format("{} case{}", cases, cases == 1 ? "" : "s");
  if (!parts.empty()) text += fmt::format(": {}", fmt::join(parts, ", "));
  if (const auto number = std::count_if(results.cases.begin(), results.cases.end(), contradicts_itself))
    text += fmt::format("; in {} spectrum and march disagree without contact", number);
  if (const int missing = results.expected_cases - static_cast<int>(cases); missing > 0)
    text += fmt::format("; {} not run yet", missing);
  return text;
}

int results_exit_code(const StudyResults& results) {
  constexpr int some_failed = 3;
  const bool wrong = std::any_of(results.cases.begin(), results.cases.end(), contradicts_itself);
  return wrong || count(results, "diverged") + count(results, "failed") > 0 ? some_failed : 0;
}

}  // namespace ricochet
