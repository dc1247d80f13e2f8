#pragma once
#include <string>

#include "runners/report/kind_page.hpp"
#include "runners/run/analysed_results.hpp"

namespace ricochet {

/// "1.44 ± 0.13", in the digits of the sentences; "8e-4 to 0.001" of what is known by its bounds alone.
std::string value_cell(const asks::VerdictRow& row);

/// What a row is of, a measure or an axis, in words. Some measures are known with their stop alone, and name it.
std::string subject_words(const asks::VerdictRow& row);

/// The rows of one answer: values with as many digits as their uncertainty allows, the unit in the head where all have
/// one; columns that are empty throughout are left out.
report::AskedTable asked_rows(const asks::Answered& answered);

/// What a study asks, answered, as its page and a terminal show it.
report::AskedAnswers asked_answers(const AnalysedResults& results);

/// What the page of a study shows: what its kind does, behind what it asks.
report::KindPage page_of_study(const AnalysedResults& results);

/// The question, what warns, then the sentence of each ask, each above its rows, twelve at most.
std::string asked_text(const AnalysedResults& results);

/// The rows of a table for programs, each with the columns by name; what a row has not is null.
nlohmann::ordered_json rows_as_json(const Table& table);

/// The same for programs: {"question", "first", "verdicts"}, each of these with the columns of verdicts.csv by name;
/// what a row has not is null.
nlohmann::ordered_json asked_json(const AnalysedResults& results);

}  // namespace ricochet
