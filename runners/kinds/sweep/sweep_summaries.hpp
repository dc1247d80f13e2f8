#pragma once
#include "runners/kinds/sweep/sweep_tables.hpp"

/// \file
/// What the orbits of a bifurcation study come to, over values and starts.
namespace ricochet {

/// verdict_shares: for each verdict and deciding choice, how many intervals and which share of the range; robust first,
/// undecided last.
Table verdict_shares_table(const Table& verdicts, const SweptColumns& swept);

/// One row of `class_counts`.
struct ClassCount {
  std::string id, regime;
  std::optional<int> period;
  int orbits = 0;
  double share = 0;
};
TableType<ClassCount> class_counts_type();
/// class_counts: for each case and class, the orbits that have it.
Table class_counts_table(const StudyResults& results);

/// One row of `grazing_ranges`.
struct GrazingRange {
  std::string start;
  int changes = 0;
  std::optional<double> low, high;
  double bracket = 0;
};
TableType<GrazingRange> grazing_ranges_type(const SweptColumns& swept = {});
/// grazing_ranges: for each start, where contact begins or ends, over the cases.
Table grazing_ranges_table(const StudyResults& results, const SweptColumns& swept);

/// One row of `numerical_viscosity`.
struct NumericalViscosity {
  std::string id;
  std::optional<double> low, high, physical_low, physical_high, share;
  std::optional<bool> small;
};
TableType<NumericalViscosity> numerical_viscosity_type();
/// numerical_viscosity: for each case, what its scheme adds to the viscosity of the scene.
Table numerical_viscosity_table(const StudyResults& results);

}  // namespace ricochet
