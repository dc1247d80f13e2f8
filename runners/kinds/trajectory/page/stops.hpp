#pragma once
#include <string>
#include <vector>

#include "runners/answers/compared.hpp"
#include "runners/report/case_view.hpp"

namespace ricochet::report {

/// The cases of each method, finest mesh and step first.
std::vector<Cases> methods_from_finest(const answers::Compared& study);

/// What each stop that has a name gives, a row per measure and a column per stop, as HTML; "" without such stops.
std::string stops_html(const CaseView& view);

/// The largest shocks of the finest case of each method, for a figure.
Table shock_points(const CaseView& view);

/// Between which densities the spectra of all methods are at their finest step and mesh, and what refining still moves
/// them by, for a figure.
Table spectrum_bands(const CaseView& view);

}  // namespace ricochet::report
