#pragma once
#include <map>
#include <memory>
#include <ricochet/measure/attractors/attractors.hpp>
#include <string>
#include <vector>

#include "runners/kinds/sweep/forced_scenes.hpp"
#include "runners/kinds/sweep/march_point.hpp"
#include "runners/kinds/sweep/orbit_rows.hpp"
#include "runners/kinds/sweep/orbit_scheduler.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"

namespace ricochet {

/// The scenes of a grid of two parameters, made ready cell by cell. Where the axes are the initial displacement and the
/// initial velocity, one scene per column and one per row serve all cells. One axis sets w(0), the other w_t(0).
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

/// What the orbit of one cell of a grid ended in.
struct CellEnd {
  MotionClass motion{Regime::failed};
  int period = 0;         ///< of what repeats, be it without contact; 0: nothing does
  double open = 0;        ///< RegimeVerdict::open
  long long periods = 0;  ///< marched, transient and kept
  Status status = Status::failed;
  std::string reason;
  bool no_start = false;              ///< it begins beyond a stop: no motion begins there, so it has no end
  bool lost = false;                  ///< the processes that marched it ended
  std::vector<SectionPoint> section;  ///< strobed: one period of what repeats, else the last points
  std::vector<double> displacements;  ///< of the same strobes, without the sawtooth of single steps
};

/// The end of a finished orbit of which its end is kept (keep_end).
CellEnd cell_end(const Orbit& orbit);
CellEnd refused_end(const std::string& sentence);

/// The class and the status of a cell without a start, as tables say them.
inline constexpr const char* no_start = "no start";
inline const char* status_word(const CellEnd& end) {
  return end.no_start ? no_start : word(end.status);
}
CellEnd no_start_end(const std::string& sentence);

/// Ends as bytes and back, bit for bit. Bytes that to_bytes() did not write throw std::runtime_error.
std::string to_bytes(const std::vector<CellEnd>& ends);
std::vector<CellEnd> cell_ends(const std::string& bytes);

/// The section of an end, ready to be compared (core/measure/attractors/attractors.hpp), in units of
/// SectionPlan::scale and ω·scale, without the sawtooth of single steps.
SettledSection settled_section(const CellEnd& end, const SectionPlan& plan);

/// A cell of a case of kind `basins`, by its places on the axes.
struct CellPlace {
  std::size_t column = 0, row = 0;
};

/// Marches the orbit of a cell from its initial state to its end, bitwise as a run marches it. Then hands over samples
/// of the kept periods, as march_on() does. A cell that is refused or stops hands over none.
CellEnd march_cell(const StudyCase& study_case, const Registry& registry, CellPlace cell, SampleCount count,
                   const std::function<void(const PointSample&)>& use);

}  // namespace ricochet
