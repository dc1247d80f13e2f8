#pragma once
#include "runners/kinds/kind.hpp"

namespace ricochet {

/// Each case goes through a grid of two parameters: the end of the orbit of each cell.
KindPointer basins_kind();

/// Marches the orbit of one cell again, from the scene's initial state: --cell X,Y as in cells.csv.
int march_cell_again(const StudyResults& results, const PointRequest& asked, std::ostream& out);

}  // namespace ricochet
