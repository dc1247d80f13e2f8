#pragma once
#include <cstddef>
#include <optional>
#include <vector>

namespace ricochet {

/// Half the 95 % interval of the mean of draws, t₀.₉₇₅(n−1) s/√n; nothing of fewer than two.
std::optional<double> half_interval(const std::vector<double>& draws);
/// The same over the standard deviation s of n ≥ 2 draws.
double half_interval_over_scatter(std::size_t n);

}  // namespace ricochet
