#pragma once
#include <ricochet/measure/stability/stability.hpp>
#include <string>
#include <vector>

#include "runners/table/row_type.hpp"

namespace ricochet {

/// One row of `stability_roots`: a root on the unit circle that is the scheme's own, over the steps of a case.
struct RootRow {
  std::string id;
  bool closed = false;
  std::string place, root;
  bool twofold = false;
  double from = 0, to = 0;
  std::size_t steps = 0, of = 0;
  int times = 0;
};
TableType<RootRow> stability_roots_type();

/// Counts the roots of the step h, one of so many, in the rows of `stability_roots`.
void add_roots(std::vector<RootRow>& rows, bool closed, double h, std::size_t of, const StepSpectrum& spectrum);

}  // namespace ricochet
