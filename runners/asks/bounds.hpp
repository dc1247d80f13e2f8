#pragma once
#include <optional>
#include <string>

#include "runners/asks/lines.hpp"
#include "runners/asks/verdicts.hpp"

/// \file
/// Whether a line keeps to bounds, as limits and thresholds ask.
namespace ricochet::asks {

/// In the unit of the measure; what equals a bound does not keep to it.
struct Bounds {
  std::optional<double> below, above;
  bool holds(double value) const { return (!below || value < *below) && (!above || value > *above); }
};

/// What of a line keeps to its bounds.
struct Kept {
  Verdict verdict = Verdict::open;
  std::size_t draws = 0, beyond = 0;  ///< of seeds, where each has to keep to them
};

/// Yes where the interval holds; no where it is beyond. A mean over a window is one number, of which seeds are draws.
/// Of what is no mean, as a peak, each seed has to hold, with what refinement leaves of it.
Kept kept(const Line& line, const Bounds& bounds);

/// "2 of 8 seeds are beyond"; "" where none is, or the limit does not speak of each.
std::string beyond_text(const Kept& one);

/// Why that is open.
std::string why_open(const Line& line, const Bounds& bounds);

}  // namespace ricochet::asks
