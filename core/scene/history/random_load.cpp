#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/history/random_load.hpp>
#include <unsupported/Eigen/FFT>

namespace ricochet {
namespace {

// Steele, Lea, Flood 2014: one output of SplitMix64 for each counter.
std::uint64_t mixed(std::uint64_t counter) {
  std::uint64_t z = counter * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31U);
}

// A phase in [0, 2π[ of each line, load and seed.
double phase(std::uint64_t seed, std::uint64_t load, std::uint64_t line) {
  const std::uint64_t drawn = mixed(mixed(mixed(seed + 1) + load + 1) + line + 1);
  return 2 * std::numbers::pi * static_cast<double>(drawn >> 11U) * 0x1p-53;
}

}  // namespace

RandomLoad::RandomLoad(const SpectrumSpec& spectrum) {
  if (!(spectrum.to > spectrum.from))
    throw InputError(spectrum.pointer + "/to", fmt::format("the spectrum ends at {:.6g} Hz; expected more than {:.6g}",
                                                           spectrum.to, spectrum.from));
  constexpr double resolution = 64;  // instants per period of the highest line
  constexpr double pi = std::numbers::pi;
  const int lines = spectrum.lines;
  band_ = (spectrum.to - spectrum.from) / lines;
  const double first = spectrum.from + band_ / 2;
  base_ = 2 * pi * first;
  while (static_cast<double>(count_) * band_ < resolution * spectrum.to) count_ *= 2;
  constexpr std::size_t most = std::size_t{1} << 24U;
  if (count_ > most)
    throw InputError(spectrum.pointer + "/lines",
                     fmt::format("lines {:.3g} Hz apart up to {:.6g} Hz take {} instants; expected at most {}", band_,
                                 spectrum.to, count_, most));
  spacing_ = 1 / (band_ * static_cast<double>(count_));
  for (int i = 0; i < lines; ++i) {
    const double f = first + i * band_, S = spectrum.density(f);
    if (!(S >= 0) || !std::isfinite(S))
      throw InputError(spectrum.pointer, fmt::format("S(f) is {:.6g} at {:.6g} Hz; expected 0 or above", S, f));
    mean_square_ += S * band_;
    lines_.push_back(std::sqrt(2 * S * band_));
    phases_.push_back(phase(spectrum.seed, spectrum.load, static_cast<std::uint64_t>(i)));
  }
}

// Σ_i A_i e^{2πi·i·k/N}: an inverse transform without its 1/N.
void RandomLoad::make_tables() const {
  std::vector<Complex> amplitude(count_), rate(count_);
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    amplitude[i] = std::polar(lines_[i], phases_[i]);
    rate[i] = Complex(0, base_ + 2 * std::numbers::pi * band_ * static_cast<double>(i)) * amplitude[i];
  }
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::Unscaled);
  transform.inv(envelope_, amplitude);
  transform.inv(slope_, rate);
}

double RandomLoad::value(double t) const {
  std::call_once(made_, [this] { make_tables(); });
  const double place = t / spacing_, whole = std::floor(place), s = place - whole;
  const auto count = static_cast<long long>(envelope_.size());
  const auto at = [&](long long k) { return static_cast<std::size_t>(((k % count) + count) % count); };
  const auto k = static_cast<long long>(whole);
  const Complex here = std::polar(1.0, base_ * spacing_ * whole), step = std::polar(1.0, base_ * spacing_);
  const double left = (here * envelope_[at(k)]).real(), right = (here * step * envelope_[at(k + 1)]).real();
  const double rise = spacing_ * (here * slope_[at(k)]).real(),
               fall = spacing_ * (here * step * slope_[at(k + 1)]).real();
  const double c2 = 3 * (right - left) - 2 * rise - fall, c3 = 2 * (left - right) + rise + fall;
  return left + s * (rise + s * (c2 + s * c3));
}

}  // namespace ricochet
