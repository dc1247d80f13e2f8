#pragma once
#include <cstdint>
#include <ricochet/engine/compile.hpp>

namespace ricochet {

/// Gives a lane a random initial state between the stops, the same for the same seed and number: the three slowest
/// modes of the free structure (shapes with a positive tip), tip amplitudes uniform in [−1, 1] times the room to the
/// stops, smaller for higher modes (1, ½, ¼), velocities uniform in the same times ω_k; all brought back by one factor
/// where a contact point would stand beyond 0.95 of its room. Without stops the room is the support's amplitude, or
/// 1 m. Relative to the clamp.
void set_random_state(LaneSpec& lane, const SemiDiscrete& problem, std::uint64_t seed, int number);

}  // namespace ricochet
