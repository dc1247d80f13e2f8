#pragma once
#include <map>
#include <memory>

#include "runners/kinds/sweep/forced_scenes.hpp"
#include "runners/kinds/sweep/orbit_scheduler.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"

namespace ricochet {

/// The scenes of a grid of two parameters, made ready cell by cell. Where the axes are the initial displacement and the
/// initial velocity, one scene per column and one per row serve all cells: w(0) hangs on the one, w_t(0) on the other.
class CellScenes {
 public:
  CellScenes(const StudyCase& study_case, const Registry& registry);

  /// Begins a batch of cells: scenes that only served the last one are let go.
  void begin();
  /// The orbit of a cell from the scene's own initial state, or why there is none.
  struct Prepared {
    std::string refusal;
    bool no_start = false;  ///< the cell begins beyond a stop
    OrbitTask task;
  };
  Prepared prepare(std::size_t column, std::size_t row);

  const std::vector<GridAxis>& axes() const { return axes_; }
  const ForcedScenes& scenes() const { return *scenes_; }

 private:
  int displaced(double value);
  int moving(double value);

  const StudyCase& case_;
  const Registry& registry_;
  std::vector<GridAxis> axes_;
  bool shared_ = false, turned_ = false;  // turned: x is the velocity
  std::unique_ptr<ForcedScenes> scenes_;
  std::map<double, int> displacements_, velocities_;  // scenes by value
};

}  // namespace ricochet
