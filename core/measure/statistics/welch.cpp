#include <cmath>
#include <numbers>
#include <numeric>
#include <ricochet/measure/statistics/welch.hpp>
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

}  // namespace ricochet
