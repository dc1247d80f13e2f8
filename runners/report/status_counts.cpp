#include "runners/report/status_counts.hpp"

#include <fmt/format.h>

#include "runners/report/html.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet::report {

std::vector<std::pair<std::string, size_t>> status_counts(const StudyResults& results) {
  std::vector<std::pair<std::string, size_t>> counts;
  for (const char* status : {"done", "refused", "diverged", "failed"})
    if (const size_t count = with_status(all_cases(results), status).size()) counts.emplace_back(status, count);
  return counts;
}

std::string statuses_text(const StudyResults& results) {
  std::string text;
  for (const auto& [status, count] : status_counts(results))
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + status;
  return text;
}

std::string counts_text(const StudyResults& results) {
  const std::string statuses = statuses_text(results);
  const std::string part =
      results.part.whole() ? "" : fmt::format("Part {} of {}, ", results.part.number, results.part.of);
  return part + count_text(results.cases.size(), "case", "cases") + (statuses.empty() ? "" : ": " + statuses) + ".";
}

}  // namespace ricochet::report
