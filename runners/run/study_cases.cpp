#include "runners/run/study_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "runners/store/fingerprint.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

/// What is left of a prediction when the last digits of processors are not told apart.
double three_digits(double seconds) {
  return to_digits(seconds, 3);
}

}  // namespace

void check_part(const Study& study, const StudyPart& part) {
  const auto cases = std::count_if(study.cases.begin(), study.cases.end(),
                                   [](const StudyCase& one) { return !one.excluded.has_value(); });
  if (cases >= part.of) return;
  throw PartRefused(fmt::format("{}: this study has {} case{} to run: at most {} part{}, not {}", study.name, cases,
                                cases == 1 ? "" : "s", cases, cases == 1 ? "" : "s", part.of));
}

std::vector<const StudyCase*> cases_of_part(const Study& study, const StudyPart& part,
                                            const std::map<std::string, double>& seconds) {
  std::vector<double> costs;
  for (const StudyCase& one : study.cases) {
    const auto found = seconds.find(one.id);
    costs.push_back(one.excluded ? -1 : found == seconds.end() ? 0 : three_digits(found->second));
  }
  std::vector<std::size_t> order(study.cases.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return costs[a] != costs[b] ? costs[a] > costs[b] : study.cases[a].id < study.cases[b].id;
  });
  std::vector<std::size_t> own;
  const auto step = static_cast<std::size_t>(part.of);
  for (std::size_t rank = static_cast<std::size_t>(part.number) - 1; rank < order.size(); rank += step)
    own.push_back(order[rank]);
  std::sort(own.begin(), own.end());
  std::vector<const StudyCase*> cases;
  for (const std::size_t i : own) cases.push_back(&study.cases[i]);
  return cases;
}

namespace {

CaseRecord excluded_record(const StudyCase& study_case) {
  CaseRecord record;
  record.id = study_case.id;
  record.axes = study_case.axes;
  record.status = Status::refused;
  record.reasons = {*study_case.excluded};
  record.excluded = true;
  return record;
}

}  // namespace

StudyResults results_header(const Study& study) {
  StudyResults results;
  results.study = study.resolved;
  results.name = study.name;
  results.question = study.question;
  results.kind = study.kind;
  results.columns = study.columns;
  results.axes = study.axes;
  results.method_words = study.method_words;
  results.expected_cases = static_cast<int>(study.cases.size());
  return results;
}

std::vector<ExpectedCase> expected_cases(const FindLibraries& libraries, const Study& study) {
  Fingerprints fingerprints(study.kind, program_hash());
  std::vector<ExpectedCase> expected;
  for (const StudyCase& study_case : study.cases)
    expected.push_back({study_case.id, fingerprints.of(study_case, libraries(study_case))});
  return expected;
}

std::set<std::string> find_missing(const std::vector<const StudyCase*>& cases,
                                   const std::map<std::string, std::string>& fingerprints,
                                   const std::set<std::string>& settled, std::vector<CaseRecord>& excluded,
                                   std::vector<PendingCase>& pending) {
  std::set<std::string> missing;
  for (const StudyCase* one : cases) {
    if (settled.count(one->id) != 0 || !missing.insert(one->id).second) continue;
    if (one->excluded)
      excluded.push_back(excluded_record(*one));
    else
      pending.push_back({one, 0, fingerprints.at(one->id)});
  }
  return missing;
}

}  // namespace ricochet
