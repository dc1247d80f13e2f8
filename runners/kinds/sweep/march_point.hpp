#pragma once
#include <functional>
#include <ricochet/contract/registry.hpp>
#include <ricochet/engine/marcher.hpp>
#include <string>

#include "runners/kinds/basins/cell_ends.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// How much of a motion is wanted.
struct SampleCount {
  int periods = 1;
  int samples = 1;  ///< per period, at most one per step
};

/// One orbit of a case of kind `bifurcation`, to be marched again from where its kept periods began.
struct PointTask {
  double parameter = 0;  ///< a value that the case marched
  std::string start;     ///< "rest", "up", "random-3" …
  LaneState entry;
  SampleCount count;
};

/// A sample: t from the strobe before the kept periods (s), the tip's absolute displacement (m) and velocity (m/s,
/// central over two steps). `strobe`: the number of the strobe that it stands at, from 0 as in points.csv; else −1.
struct PointSample {
  double time = 0, displacement = 0, velocity = 0;
  long long strobe = -1;
};

/// Marches the orbit and hands over its samples, `samples` per period, the last of each at the strobe: with the bits of
/// the run that left the entry. Throws InputError where the scene cannot be marched at this value.
void march_point(const StudyCase& study_case, const Registry& registry, const PointTask& task,
                 const std::function<void(const PointSample&)>& use);

/// A cell of a case of kind `basins`, by its places on the axes.
struct CellPlace {
  std::size_t column = 0, row = 0;
};

/// Marches the orbit of a cell from its initial state to its end, with the bits of a run that marches it; then hands
/// over samples of the kept periods, as march_point() does. A cell that is refused or stops hands over none.
CellEnd march_cell(const StudyCase& study_case, const Registry& registry, CellPlace cell, SampleCount count,
                   const std::function<void(const PointSample&)>& use);

}  // namespace ricochet
