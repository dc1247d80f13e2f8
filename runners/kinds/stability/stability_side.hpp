#pragma once
#include <algorithm>
#include <cstddef>
#include <optional>
#include <ricochet/measure/stability/observed_stability.hpp>
#include <ricochet/measure/stability/stability.hpp>
#include <variant>
#include <vector>

#include "runners/kinds/stability/stability.hpp"

namespace ricochet {

/// A growth per step that 3000 steps without contact show beyond doubt: by a factor of twenty.
inline constexpr double plain_growth = 1e-3;

/// One contact state over the whole range of steps: what its spectra predict, and what its marches showed.
struct StabilitySide {
  bool closed = false;
  const char* name() const { return closed ? "closed" : "open"; }
  std::vector<std::optional<SpectrumOrRefusal>> spectra;
  std::vector<std::optional<ObservedCell>> cells;
  StepLimit predicted;
  ObservedLimit observed;
  bool untouched = false;  ///< closed: the scene stays bounded and touches no stop, so nothing of contact was observed

  /// What scenes that touch no stop showed of contact: nothing. One that grows without contact too, as `open` does at
  /// the same step, meets the stop in the end.
  void forget_untouched(const std::vector<std::optional<ObservedCell>>& open) {
    bool marched = false, touches = false;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (!cells[k]) continue;
      marched = true;
      const bool grows_open = k < open.size() && open[k] && !open[k]->stable();
      touches = touches || (cells[k]->stable() ? cells[k]->touched : !grows_open);
    }
    untouched = closed && marched && !touches;
    if (untouched) std::fill(cells.begin(), cells.end(), std::nullopt);
  }
  /// Marched somewhere, and stable nowhere.
  bool never_stable() const {
    const auto stable = [](const auto& cell) { return cell && cell->stable(); };
    const auto marched = [](const auto& cell) { return cell.has_value(); };
    return std::any_of(cells.begin(), cells.end(), marched) && std::none_of(cells.begin(), cells.end(), stable);
  }
  /// Marched at every step, and stable at all of them.
  bool marched_stably() const {
    const auto bounded = [](const auto& cell) { return cell && cell->stable(); };
    return !cells.empty() && std::all_of(cells.begin(), cells.end(), bounded);
  }
  /// With a spectrum at every step, and stable by each.
  bool predicted_stable() const {
    const auto inside = [](const auto& one) {
      const auto* known = one ? std::get_if<StepSpectrum>(&*one) : nullptr;
      return known && known->stable();
    };
    return !spectra.empty() && std::all_of(spectra.begin(), spectra.end(), inside);
  }
  /// Without contact a step is linear: it does what its spectrum says, or the plan is not what is marched.
  bool contradicts(std::size_t i) const {
    const StepSpectrum* known = spectrum(i);
    if (closed || !known || cells.size() <= i || !cells[i]) return false;
    if (cells[i]->stable()) return known->radius > 1 + plain_growth && cells[i]->steps >= free_steps;
    return known->stable() && known->marginal.empty();
  }
  const StepSpectrum* spectrum(std::size_t i) const {
    return spectra[i] ? std::get_if<StepSpectrum>(&*spectra[i]) : nullptr;
  }
};

}  // namespace ricochet
