#pragma once
#include <optional>
#include <ricochet/contract/errors.hpp>

/// \file
/// Stops at one place: contact points i and j with H_j = c H_i whose stops move alike, so that u_j = c u_i always.
namespace ricochet {

struct SemiDiscrete;

/// What a rigid law can know of stops at one place. On each side the nearest bound alone is ever met: the others become
/// ±∞, and a note says so. Refused are two nearest bounds that are equal to 1e-12, since any share of their force is a
/// solution. Throws BeyondStop where the lower bound of one stop is above the upper bound of another.
std::optional<Refusal> keep_nearest_bounds(SemiDiscrete& problem);

}  // namespace ricochet
