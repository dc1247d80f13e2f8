#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <ricochet/measure/statistics/spectra.hpp>
#include <stdexcept>
#include <unsupported/Eigen/FFT>

namespace ricochet {

struct WelchSpectrum::Transform {
  Eigen::FFT<double> fft;
};

WelchSpectrum::WelchSpectrum(double rate, int samples)
    : rate_(rate), size_(samples), transform_(std::make_unique<Transform>()) {
  constexpr int fewest = 4;
  if (!(rate > 0) || samples < fewest || samples % 2 != 0)
    throw std::invalid_argument("a spectrum has a rate above 0 and an even number of samples, 4 or more");
  const auto count = static_cast<std::size_t>(samples);
  transform_->fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  samples_.reserve(count);
  windowed_.resize(count);
  sums_.resize(count / 2 + 1);
  for (int n = 0; n < samples; ++n) window_.push_back(0.5 - 0.5 * std::cos(2 * std::numbers::pi * n / samples));
}

WelchSpectrum::~WelchSpectrum() = default;
WelchSpectrum::WelchSpectrum(WelchSpectrum&&) noexcept = default;

void WelchSpectrum::add(double sample) {
  samples_.push_back(sample);
  if (samples_.size() == window_.size()) take_segment();
}

void WelchSpectrum::take_segment() {
  const double mean = std::accumulate(samples_.begin(), samples_.end(), 0.0) / size_;
  for (std::size_t n = 0; n < window_.size(); ++n) windowed_[n] = window_[n] * (samples_[n] - mean);
  transform_->fft.fwd(transformed_, windowed_);
  for (std::size_t k = 0; k < sums_.size(); ++k) sums_[k] += std::norm(transformed_[k]);
  ++segments_;
  samples_.erase(samples_.begin(), samples_.begin() + size_ / 2);
}

std::vector<double> WelchSpectrum::density() const {
  std::vector<double> out;
  if (segments_ == 0) return out;
  const double squares = std::inner_product(window_.begin(), window_.end(), window_.begin(), 0.0);
  for (std::size_t k = 0; k < sums_.size(); ++k) {
    const double sides = k == 0 || k + 1 == sums_.size() ? 1 : 2;
    out.push_back(sides * sums_[k] / (segments_ * rate_ * squares));
  }
  return out;
}
namespace {

constexpr std::array<double, 10> nominal_frequencies = {1, 1.25, 1.6, 2, 2.5, 3.15, 4, 5, 6.3, 8};
constexpr int per_decade = 10;

double band_end(int number, double half) {
  return std::pow(10, (number + half) / per_decade);
}

}  // namespace

double ThirdOctave::centre() const {
  return band_end(number, 0);
}

std::string ThirdOctave::nominal() const {
  const int decade = static_cast<int>(std::floor(static_cast<double>(number) / per_decade));
  return fmt::format(
      "{:g}", nominal_frequencies[static_cast<std::size_t>(number - per_decade * decade)] * std::pow(10, decade));
}

std::vector<ThirdOctave> third_octaves(const std::vector<double>& density, double spacing) {
  std::vector<ThirdOctave> out;
  if (density.size() < 2 || !(spacing > 0)) return out;
  const double last = spacing * static_cast<double>(density.size() - 1);
  constexpr double half = 0.5, rounding = 1e-12;
  // A band is f_m (10^(1/20) − 10^(−1/20)) wide.
  const double share = std::pow(10, half / per_decade) - std::pow(10, -half / per_decade);
  const int first = static_cast<int>(std::ceil(per_decade * std::log10(spacing / share) - rounding));
  for (int n = first; band_end(n, half) <= last * (1 + rounding); ++n) {
    ThirdOctave band{n, band_end(n, -half), band_end(n, half), 0};
    double square = 0;
    const auto from = static_cast<std::size_t>(std::max(0.0, std::floor(band.from / spacing - half)));
    for (std::size_t k = from; k < density.size(); ++k) {
      const double low = std::max(band.from, (static_cast<double>(k) - half) * spacing),
                   high = std::min(band.to, (static_cast<double>(k) + half) * spacing);
      if (low >= band.to) break;
      if (high > low) square += density[k] * (high - low);
    }
    band.rms = std::sqrt(square);
    out.push_back(band);
  }
  return out;
}

}  // namespace ricochet
