#pragma once
#include "runners/kinds/kind.hpp"

namespace ricochet {

/// Each case goes through a parameter: sections, classes, exponents of its orbits from several starts.
KindPointer bifurcation_kind();

/// Marches one orbit of a diagram again, from where its kept periods begin: --parameter and --start as in values.csv.
int march_orbit_again(const StudyResults& results, const PointRequest& asked, std::ostream& out);

}  // namespace ricochet
