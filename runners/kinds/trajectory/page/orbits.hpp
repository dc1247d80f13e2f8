#pragma once
#include "runners/report/case_view.hpp"

namespace ricochet::report {

/// Where places are within their clearances: the finest case of each method, thinned to what a figure shows.
Table orbit_points(const CaseView& view);

}  // namespace ricochet::report
