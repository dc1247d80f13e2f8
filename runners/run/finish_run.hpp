#pragma once
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "runners/run/analysed_results.hpp"
#include "runners/run/outputs.hpp"
#include "runners/store/record.hpp"
#include "runners/store/store.hpp"

namespace ricochet {

/// reasons: why cases have no result, each reason once with the number of cases that give it; no rows where all are
/// done.
Table reasons_table(const StudyResults& results);

// How a folder whose cases are all in its store becomes one of results.

/// Makes the views of the store and writes the tables, curves and report of what it holds, which is returned.
/// `changed`: see write_outputs(). `messages`: who waits for it.
std::unique_ptr<const AnalysedResults> write_folder(Store& store, const std::filesystem::path& folder,
                                                    const RenderReport& render,
                                                    const std::set<std::string>* changed = nullptr,
                                                    std::FILE* messages = stderr);

/// Says the answer, the totals (`how` they came about) and where the report is; returns the exit code.
int tell_results(std::FILE* out, const AnalysedResults& results, const std::filesystem::path& folder,
                 const std::string& how, bool table = false);

/// answers: what comes first, a sentence for each ask, what is doubtful and what is left out.
Table asked_table(const Choices& study, const asks::Asked& asked);

/// What an answer by observed measures rests on: limits, refinements and differences of these.
std::vector<Table> evidence_tables(const Choices& study);

/// The measures that a study observes: its key "observe", else what its kind asks of such results; those that some
/// finished case has.
std::vector<std::string> observed_measures(const StudyResults& results);

/// The outcome of one case in words, or the status and its reason: "done: energy 12.3 J → 11.9 J (−3.2 %), 14 impacts,
/// 0.42 µs/step". A kind of study may have more to say of a finished case (Kind::outcome).
std::string outcome_text(const CaseRecord& record, const std::string& kind);

/// One line per case: the axes that vary in aligned columns under their names, then the outcome.
std::string case_table(const StudyResults& results);

/// "48 cases: 40 done, 4 refused, 2 diverged, 2 failed".
std::string totals_text(const StudyResults& results);

/// 0, or 3 when a case diverged or failed, its integration without contact is not what its spectrum says, or every case
/// is refused. Beside others, refused and excluded cases did what the study asks.
int results_exit_code(const StudyResults& results);

}  // namespace ricochet
