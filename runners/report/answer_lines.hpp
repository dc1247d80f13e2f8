#pragma once
#include <string>
#include <vector>

#include "runners/store/record.hpp"

namespace ricochet::report {

/// So many sentences of an answer are shown at first.
inline constexpr size_t most_answer_lines = 8;

/// The sentences of the table `answers`, in its order.
std::vector<std::string> answer_lines(const StudyResults& results);

}  // namespace ricochet::report
