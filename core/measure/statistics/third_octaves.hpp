#pragma once
#include <string>
#include <vector>

namespace ricochet {

/// A third of an octave: from f_m 10^(−1/20) to f_m 10^(1/20), f_m = 10^(n/10) Hz (IEC 61260-1, base ten).
struct ThirdOctave {
  int number = 0;               ///< n
  double from = 0, to = 0;      ///< Hz
  double rms = 0;               ///< √(∫ S df) over the band, the unit of the signal
  double centre() const;        ///< f_m, Hz
  std::string nominal() const;  ///< as bands are called: "31.5", "63", "1000"
};

/// Levels of a one-sided density S_k (unit²/Hz) at f_k = k Δf, each line of the width Δf with its middle at f_k: where
/// a band ends within a line, it has that share of it. Bands whose width is Δf or more and that end at or below the
/// last line.
std::vector<ThirdOctave> third_octaves(const std::vector<double>& density, double spacing);

}  // namespace ricochet
