#pragma once
#include <string>

#include "runners/store/record.hpp"

namespace ricochet {

/// Cases with a curve that have each a file of their own, curves/ID.csv: where there are more, nobody opens them one by
/// one, and file systems that machines share suffer from so many; their curves are exported into one file.
inline constexpr std::size_t kMostCurveFiles = 2000;

/// Whether each case that has a curve has its file.
bool has_curve_files(const StudyResults& results);

/// Where all curves are, as the end of a sentence: "each case has its own in curves/ID.csv".
std::string where_curves_are(const StudyResults& results);

}  // namespace ricochet
