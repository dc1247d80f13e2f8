#pragma once
#include <optional>
#include <string>

#include "runners/store/record.hpp"

namespace ricochet::report {

/// Cases that the figures and the table of cases of one page hold, at most; of a study of more, these are shown:
constexpr std::size_t most_shown_cases = 2000;

/// The results without the cases that a page of so many leaves out of its figures and of its table of cases, and
/// without their rows in derived tables; nothing where all are shown. Shown are the first case of each value of an
/// axis, up to a quarter of the most that are not done, and others in the order of their ids, which are hashes: drawn
/// by lot, and the same ones each time.
std::optional<StudyResults> shown_cases(const StudyResults& results);

/// How many of how many are shown, and where all are.
std::string shown_sentence(const StudyResults& shown, const StudyResults& all);

}  // namespace ricochet::report
