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
