#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include "runners/run/study_runner.hpp"
#include "runners/store/store.hpp"

/// \file
/// The cases of a study as one run of it sees them: which there are, which are missing.
namespace ricochet {

/// Results without cases: what the store says of the study itself.
StudyResults results_header(const Study& study);

/// Every case with what tells whether its stored row is still that case.
std::vector<ExpectedCase> expected_cases(const StudyRunner& runner, const Study& study);

/// Splits what is missing: excluded cases get their record, the others wait. Returns the ids that are new.
std::set<std::string> find_missing(const Study& study, const std::map<std::string, std::string>& fingerprints,
                                   const std::set<std::string>& settled, std::vector<CaseRecord>& excluded,
                                   std::vector<PendingCase>& pending);

}  // namespace ricochet
