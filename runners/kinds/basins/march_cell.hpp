#pragma once
#include "runners/kinds/basins/cell_ends.hpp"
#include "runners/kinds/sweep/march_point.hpp"

namespace ricochet {

/// A cell of a case of kind `basins`, by its places on the axes.
struct CellPlace {
  std::size_t column = 0, row = 0;
};

/// Marches the orbit of a cell from its initial state to its end, with the bits of a run that marches it; then hands
/// over samples of the kept periods, as march_on() does. A cell that is refused or stops hands over none.
CellEnd march_cell(const StudyCase& study_case, const Registry& registry, CellPlace cell, SampleCount count,
                   const std::function<void(const PointSample&)>& use);

}  // namespace ricochet
