#pragma once
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "runners/run/study_runner.hpp"
#include "runners/store/store.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// A part that cannot be run as it was asked for; the message is complete.
class PartRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws PartRefused where the study has fewer cases to run than parts: a case is not split.
void check_part(const Study& study, const StudyPart& part);

/// The cases of one part, in the study's order. All cases of the study are sorted by predicted cost, the dearest first.
/// Part k of N takes the k-th of them and every N-th after it. The parts are disjoint, hold every case, and cost about
/// the same. `seconds`: the predictions by case id, as plans make them; of one that is missing, 0. Three digits of them
/// count, and excluded cases come last: every machine deals alike. Equals stand by their ids, which are hashes. In the
/// study's order a part would have one method alone wherever the number of parts is a multiple of the number of
/// methods.
std::vector<const StudyCase*> cases_of_part(const Study& study, const StudyPart& part,
                                            const std::map<std::string, double>& seconds);

// The cases of a study as one run of it sees them: which there are, which are missing.

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
