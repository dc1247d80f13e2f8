#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ricochet/measure/statistics/third_octaves.hpp>

namespace ricochet {
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
