#include "runners/run/study_cases.hpp"

#include "runners/store/fingerprint.hpp"

namespace ricochet {
namespace {

CaseRecord excluded_record(const StudyCase& study_case) {
  CaseRecord record;
  record.id = study_case.id;
  record.axes = study_case.axes;
  record.status = "refused";
  record.reason = "excluded: " + *study_case.excluded;
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
  results.expected_cases = static_cast<int>(study.cases.size());
  return results;
}

std::vector<ExpectedCase> expected_cases(const StudyRunner& runner, const Study& study) {
  Fingerprints fingerprints(study.kind, program_hash());
  std::vector<ExpectedCase> expected;
  for (const StudyCase& study_case : study.cases)
    expected.push_back({study_case.id, fingerprints.of(study_case, runner.libraries(study_case))});
  return expected;
}

std::set<std::string> find_missing(const Study& study, const std::map<std::string, std::string>& fingerprints,
                                   const std::set<std::string>& settled, std::vector<CaseRecord>& excluded,
                                   std::vector<PendingCase>& pending) {
  std::set<std::string> missing;
  for (const StudyCase& study_case : study.cases) {
    if (settled.count(study_case.id) != 0 || !missing.insert(study_case.id).second) continue;
    if (study_case.excluded)
      excluded.push_back(excluded_record(study_case));
    else
      pending.push_back({&study_case, 0, fingerprints.at(study_case.id)});
  }
  return missing;
}

}  // namespace ricochet
