#pragma once
#include <string>
#include <vector>

#include "runners/store/record.hpp"

namespace ricochet {

/// The outcome of one case in words: "done: energy 12.3 J → 11.9 J (−3.2 %), 14 impacts, 0.42 µs/step", or the status
/// and its reason. A kind of study may have more to say of a finished case (Kind::outcome).
std::string outcome_text(const CaseRecord& record, const std::string& kind);

/// The question and the sentences of the answer, a few at most, each on a line of its own; how many more there are.
std::string answer_text(const StudyResults& results);

/// One line per case: the axes that vary in aligned columns under their names, then the outcome.
std::string case_table(const StudyResults& results);

/// "48 cases: 40 done, 4 refused, 2 diverged, 2 failed".
std::string totals_text(const StudyResults& results);

/// 0, or 3 when a case diverged or failed, or its integration without contact is not what its spectrum says (refused
/// and excluded cases did what the study asks).
int results_exit_code(const StudyResults& results);

}  // namespace ricochet
