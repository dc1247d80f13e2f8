#include <algorithm>
#include <cmath>
#include <ricochet/kernels/eigenvalues.hpp>
#include <ricochet/measure/orbits/multipliers.hpp>

namespace ricochet {

using Eigen::MatrixXd;

std::vector<std::complex<double>> multipliers_of(MatrixXd derivative, int without_kernel) {
  if (!derivative.allFinite()) return {};
  balance(derivative);
  const GeneralModes modes = general_modes(derivative, EigenVectors::none);
  if (!modes.found) return {};
  std::vector<std::complex<double>> all(modes.values.begin(), modes.values.end());
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    const double one = std::abs(a), other = std::abs(b);
    if (one != other) return one > other;
    return a.imag() > b.imag();
  });
  constexpr double near = 1e-6;
  std::erase_if(all, [&](const std::complex<double>& value) {
    return without_kernel > 0 && std::abs(value + 1.0) < near && without_kernel-- > 0;
  });
  return all;
}

Outside outside(const std::vector<std::complex<double>>& multipliers) {
  Outside found;
  for (const std::complex<double>& one : multipliers) {
    if (std::abs(one) <= 1) continue;
    ++found.total;
    found.above += one.imag() == 0 && one.real() > 0;
    found.below += one.imag() == 0 && one.real() < 0;
    found.pairs += one.imag() > 0;
  }
  return found;
}

namespace {

// How far a row is on its side of a change: the distance of the free measure to the bound.
double margin(const PeriodicMap& map, const SetStep& step, int row, double value, bool upper, double parameter) {
  if (step.side[static_cast<std::size_t>(row)] != 0) return std::abs(value) * step.give[static_cast<std::size_t>(row)];
  return std::abs(value - map.bound(row, upper, parameter, false));
}

}  // namespace

MatrixXd half_step_derivative(PeriodicMap& map, const SetSequence& sets, const MapClock& clock, double parameter,
                              const PeriodicMap::Measures& measures) {
  const int rows = map.sets().measure_rows();
  std::vector<SetBlend> blends;
  for (std::size_t k = 1; k < sets.size(); ++k) {
    if (sets[k] == sets[k - 1]) continue;
    const SetStep &before = map.sets()[sets[k - 1]], &after = map.sets()[sets[k]];
    const auto row =
        std::mismatch(before.side.begin(), before.side.end(), after.side.begin()).first - before.side.begin();
    const auto r = static_cast<std::size_t>(row), n = static_cast<std::size_t>(rows);
    const bool upper = before.side[r] + after.side[r] > 0;
    const double m0 = margin(map, before, static_cast<int>(row), measures.value[(k - 1) * n + r], upper, parameter);
    const double m1 = margin(map, after, static_cast<int>(row), measures.value[k * n + r], upper, parameter);
    if (!(m0 + m1 > 0)) continue;
    const double theta = m0 / (m0 + m1);
    const SetBlend blend = theta < 0.5 ? SetBlend{k - 1, sets[k], 0.5 - theta} : SetBlend{k, sets[k - 1], theta - 0.5};
    if (!blends.empty() && blends.back().step == blend.step)
      blends.back() = blend;
    else
      blends.push_back(blend);
  }
  return map.derivative(sets, clock, blends);
}

}  // namespace ricochet
