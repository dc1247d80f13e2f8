#pragma once
#include <ricochet/measure/attractors/attractors.hpp>
#include <string>
#include <vector>

#include "runners/kinds/sweep/orbit_rows.hpp"

namespace ricochet {

/// What the orbit of one cell of a grid ended in.
struct CellEnd {
  MotionClass motion{Regime::failed};
  int period = 0;                     ///< of what repeats, be it without contact; 0: nothing does
  long long periods = 0;              ///< marched, transient and kept
  std::string status, reason;         ///< done, refused, no start, diverged, failed
  bool lost = false;                  ///< the processes that marched it ended
  std::vector<SectionPoint> section;  ///< strobed: one period of what repeats, else the last points
  std::vector<double> displacements;  ///< of the same strobes, without the sawtooth of single steps
};

/// The end of a finished orbit of which its end is kept (keep_end).
CellEnd cell_end(const Orbit& orbit);
CellEnd refused_end(const std::string& sentence);

/// The class and the status of a cell that begins beyond a stop: no motion begins there, so it has no end.
inline constexpr const char* no_start = "no start";
CellEnd no_start_end(const std::string& sentence);

/// Ends as bytes and back, bit for bit. Bytes that to_bytes() did not write throw std::runtime_error.
std::string to_bytes(const std::vector<CellEnd>& ends);
std::vector<CellEnd> cell_ends(const std::string& bytes);

/// The section of an end, ready to be compared (core/measure/attractors/orbit_ends.hpp), in units of
/// SectionPlan::scale and ω·scale, without the sawtooth of single steps.
SettledSection settled_section(const CellEnd& end, const SectionPlan& plan);

}  // namespace ricochet
