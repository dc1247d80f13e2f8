#pragma once
#include <string>
#include <utility>
#include <vector>

#include "runners/store/record.hpp"

namespace ricochet::report {

/// How many cases ended so: done, refused, diverged, failed, in this order; none that no case has.
std::vector<std::pair<std::string, size_t>> status_counts(const StudyResults& results);

/// "20 done, 4 refused".
std::string statuses_text(const StudyResults& results);

/// "24 cases: 20 done, 4 refused."
std::string counts_text(const StudyResults& results);

}  // namespace ricochet::report
