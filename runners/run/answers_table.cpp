#include "runners/run/answers_table.hpp"

#include <algorithm>

#include "runners/answers/answer.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

constexpr const char* status_asked = "status";

std::vector<std::string> asked(const StudyResults& results) {
  const auto given = results.study.find("observe");
  const bool list = given != results.study.end() && given->is_array();
  return list ? given->get<std::vector<std::string>>() : std::vector<std::string>{};
}

bool answers_itself(const StudyResults& results) {
  const Kind* kind = find_kind(results.kind);
  return kind && kind->answers_itself();
}

}  // namespace

std::vector<std::string> observed_measures(const StudyResults& results) {
  std::vector<std::string> names = asked(results);
  std::erase(names, status_asked);
  const Kind* kind = find_kind(results.kind);
  if (names.empty() && kind) names = kind->observed(results);
  std::erase_if(names, [&](const std::string& name) {
    return std::none_of(results.cases.begin(), results.cases.end(),
                        [&](const CaseRecord& one) { return one.status == "done" && measure(one, name); });
  });
  return names;
}

Table answers_table(const StudyResults& results) {
  if (answers_itself(results)) return find_kind(results.kind)->answers(results).table();
  const std::vector<std::string> names = asked(results);
  const bool status_first = !names.empty() && names.front() == status_asked;
  return answers::measure_answer(answers::Compared(results), observed_measures(results), status_first).table();
}

std::vector<Table> evidence_tables(const StudyResults& results) {
  if (answers_itself(results)) return {};
  const answers::Compared study(results);
  const std::vector<std::string> measures = observed_measures(results);
  return {answers::limits_table(study, measures), answers::refinements_table(study, measures),
          answers::differences_table(study, measures)};
}

std::string evidence_text(const StudyResults& results) {
  const std::vector<std::string> measures =
      answers_itself(results) ? std::vector<std::string>{} : observed_measures(results);
  return measures.empty() ? "" : answers::evidence_text(answers::Compared(results), measures.front());
}

}  // namespace ricochet
