#pragma once
#include <complex>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace ricochet {

/// A spectrum that a load is drawn from: S(f), one-sided, unit²/Hz, on `lines` equal bands from `from` to `to`.
struct SpectrumSpec {
  std::function<double(double)> density;  ///< S(f); its value may be anything where the spectrum is not given
  double from = 0, to = 0;                ///< Hz
  int lines = 0;
  std::uint64_t seed = 0, load = 0;  ///< a load of another number, or seed, is independent
  std::string pointer;               ///< for errors
};

/// F(t) = Σ_i √(2 S(f_i) Δf) cos(2π f_i t + θ_i), f_i the middle of band i, θ_i from a counter-based generator
/// (SplitMix64 of seed, load and i): the same on every machine, in any order of asking.
///
/// Its mean square over 2/Δf is Σ S(f_i) Δf whatever the seed, where from/Δf is whole. After 1/Δf it repeats, but for a
/// phase. Between instants 1/(64·to) apart, at which value and slope are exact, it is the cubic of Hermite: off by less
/// than (2π/64)⁴/384 = 2.5e-7 of its amplitude.
class RandomLoad {
 public:
  /// Throws InputError at the pointer for bands without width, S(f) negative or not finite.
  explicit RandomLoad(const SpectrumSpec& spectrum);

  /// The first call makes the tables. Any number of threads may ask.
  double value(double t) const;
  double period() const { return 1 / band_; }          ///< 1/Δf, s
  double mean_square() const { return mean_square_; }  ///< Σ S Δf, unit²

 private:
  void make_tables() const;
  using Complex = std::complex<double>;
  double band_ = 0, spacing_ = 0, base_ = 0;  ///< Δf (Hz), instants (s), first line (rad/s)
  double mean_square_ = 0;
  std::vector<double> lines_, phases_;  ///< A_i and θ_i
  std::size_t count_ = 1;               ///< of instants in 1/Δf
  mutable std::once_flag made_;
  mutable std::vector<Complex> envelope_,
      slope_;  ///< Σ A_i e^{i(θ_i + 2π i Δf t)} at the instants, times iω of each line
};

}  // namespace ricochet
