#pragma once
#include <string>
#include <vector>

#include "runners/store/record.hpp"

namespace ricochet {

/// answers: what the study says to its question, in the order in which it is read. Of a kind that answers itself its
/// rows; else one row per choice and observed measure.
Table answers_table(const StudyResults& results);

/// What the answer rests on: limits and differences of the observed measures; of a kind that answers itself its own.
std::vector<Table> evidence_tables(const StudyResults& results);

/// The same for a terminal, of the measure that is observed first: at most twelve lines.
std::string evidence_text(const StudyResults& results);

/// The measures that a study observes: its key "observe", else what its kind asks of such results; those that some
/// finished case has.
std::vector<std::string> observed_measures(const StudyResults& results);

}  // namespace ricochet
