#pragma once
#include <cstddef>
#include <ricochet/measure/statistics/refinement.hpp>
#include <vector>

/// \file
/// Methods that are told apart by a measure, and those that are not.
namespace ricochet {

/// Indices of what was compared.
using Members = std::vector<std::size_t>;

struct Tiers {
  std::vector<Members> tiers;  ///< from the smallest value to the largest
  Members nowhere;             ///< what belongs to no single tier: it settles nowhere
  bool none_firm = false;      ///< every uncertainty is large: the tiers tell nothing
};

/// Limits sorted into tiers. Firm ones, u ≤ max(2T, 0.3 × spread of the values), are taken by the low ends of their
/// intervals. A new tier begins where the gap to all before is larger than the tolerance T. Other limits touch a tier
/// where their intervals come within T of its own. One that touches a single tier joins it. Those that touch none make
/// tiers of their own. One that touches several, or has u > 2 × max(spread, T), is nowhere. A single size counts as
/// firm.
Tiers tiers_of(const std::vector<Limit>& limits, double tolerance);

/// Values ≥ 0 over decades: a new tier begins at three times the largest value before; all below `nothing` is one tier.
/// Values that chain into one another over more than a decade part where their ratio is largest, until no tier spans
/// more.
Tiers tiers_over_decades(const std::vector<double>& values, double nothing);

}  // namespace ricochet
