#pragma once
#include "runners/kinds/kind.hpp"

/// \file
/// The kinds of study, each made by the folder of its name.
namespace ricochet {

/// Each case integrates its scene once: energies, impacts, a curve over time.
KindPointer trajectory_kind();
/// Each case is compared with a reference; orders of the errors in the step and in the element length.
KindPointer convergence_kind();
/// As convergence, and each case is timed: error against processor time.
KindPointer work_precision_kind();
/// Each case goes through a range of steps: spectral radius of the step, and what marching it shows.
KindPointer stability_kind();
/// Each case goes through a parameter: sections, classes, exponents of its orbits from several starts.
KindPointer bifurcation_kind();
/// Each case goes through a grid of two parameters: the end of the orbit of each cell.
KindPointer basins_kind();
/// Each case follows periodic orbits of its scheme's own map along a parameter, stable or not, and locates their
/// special points.
KindPointer continuation_kind();

}  // namespace ricochet
