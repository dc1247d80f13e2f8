#pragma once
#include <complex>
#include <memory>
#include <string>
#include <vector>

namespace ricochet {

/// One-sided power spectral density of a real signal by Welch's method: segments that overlap by half, each less its
/// mean and under a Hann window,
///
///     S_k = c_k/(f_s Σ w²) mean |Σ_n w_n (x_n − x̄) e^{−2πikn/N}|²   (unit²/Hz),   f_k = k f_s/N,
///
/// c_k = 2, and 1 at 0 and f_s/2. Of a signal that is stationary over the segments, Σ S_k f_s/N is the variance. One
/// segment of samples is kept, whatever the length of the signal. Source: Welch (1967), IEEE Trans. Audio
/// Electroacoust. 15, 70–73.
class WelchSpectrum {
 public:
  /// `rate`: samples per second, Hz; `samples`: of a segment, even, 4 or more. Throws std::invalid_argument else.
  WelchSpectrum(double rate, int samples);
  ~WelchSpectrum();
  WelchSpectrum(WelchSpectrum&&) noexcept;

  void add(double sample);
  int segments() const { return segments_; }
  /// S_k for k = 0 … N/2; empty without a whole segment.
  std::vector<double> density() const;
  double frequency(int k) const { return k * rate_ / size_; }
  /// Between two frequencies, Hz.
  double spacing() const { return rate_ / size_; }

 private:
  struct Transform;
  void take_segment();

  double rate_;
  int size_;
  int segments_ = 0;
  std::vector<double> window_, samples_, windowed_, sums_;
  std::vector<std::complex<double>> transformed_;
  std::unique_ptr<Transform> transform_;
};

/// A third of an octave: from f_m 10^(−1/20) to f_m 10^(1/20), f_m = 10^(n/10) Hz (IEC 61260-1, base ten).
struct ThirdOctave {
  int number = 0;               ///< n
  double from = 0, to = 0;      ///< Hz
  double rms = 0;               ///< √(∫ S df) over the band, the unit of the signal
  double centre() const;        ///< f_m, Hz
  std::string nominal() const;  ///< as bands are called: "31.5", "63", "1000"
};

/// Levels of a one-sided density S_k (unit²/Hz) at f_k = k Δf. Each line has the width Δf and its middle at f_k. Where
/// a band ends within a line, it has that share of it. Bands whose width is Δf or more and that end at or below the
/// last line.
std::vector<ThirdOctave> third_octaves(const std::vector<double>& density, double spacing);

}  // namespace ricochet
