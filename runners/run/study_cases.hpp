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

/// The plugin libraries that a case needs.
using FindLibraries = std::function<std::vector<std::filesystem::path>(const StudyCase&)>;

/// Every case with what tells whether its stored row is still that case.
std::vector<ExpectedCase> expected_cases(const FindLibraries& libraries, const Study& study);

/// Splits what is missing of these cases: excluded ones get their record, the others wait. Returns the ids that are
/// new.
std::set<std::string> find_missing(const std::vector<const StudyCase*>& cases,
                                   const std::map<std::string, std::string>& fingerprints,
                                   const std::set<std::string>& settled, std::vector<CaseRecord>& excluded,
                                   std::vector<PendingCase>& pending);

}  // namespace ricochet
