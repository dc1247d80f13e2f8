#include <cmath>
#include <ricochet/measure/stability/stability.hpp>

namespace ricochet {

StepLimit step_limit(const std::function<SpectrumOrRefusal(double h)>& spectrum, const std::vector<double>& steps) {
  StepLimit limit;
  const auto at = [&](double h) -> std::optional<StepSpectrum> {
    auto found = spectrum(h);
    if (auto* known = std::get_if<StepSpectrum>(&found)) return std::move(*known);
    return std::nullopt;
  };
  std::optional<double> stable, unstable;
  for (const double h : steps) {
    const auto found = at(h);
    if (!found) continue;
    if (!found->stable()) {
      unstable = h;
      limit.beyond = found;
      break;
    }
    stable = h;
  }
  if (!unstable) return limit;
  for (double h = *unstable; !stable && h > 1e-6 * steps.front();) {
    limit.below_range = true;
    h /= 4;
    const auto found = at(h);
    if (!found) return limit;
    if (found->stable())
      stable = h;
    else
      unstable = h, limit.beyond = found;
  }
  if (!stable) return limit;
  double low = *stable, high = *unstable;
  while (high > low * (1 + 1e-6)) {
    const double middle = std::sqrt(low * high);
    const auto found = at(middle);
    if (!found) break;
    if (found->stable())
      low = middle;
    else
      high = middle, limit.beyond = found;
  }
  limit.step = low;
  return limit;
}

}  // namespace ricochet
