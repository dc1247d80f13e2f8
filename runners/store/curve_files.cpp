#include "runners/store/curve_files.hpp"

#include <algorithm>

namespace ricochet {

bool has_curve_files(const StudyResults& results) {
  const auto curves = std::count_if(results.cases.begin(), results.cases.end(),
                                    [](const CaseRecord& record) { return !record.curve.names.empty(); });
  return static_cast<std::size_t>(curves) <= kMostCurveFiles;
}

std::string where_curves_are(const StudyResults& results) {
  return has_curve_files(results) ? "each case has its own in curves/ID.csv"
                                  : "cases are too many for a file each, all curves are in the store: `ricochet export "
                                    "DIR --to CSVDIR --curves` writes them into one curves.csv";
}

}  // namespace ricochet
