#pragma once
#include <cstdint>
#include <ricochet/engine/compile.hpp>

namespace ricochet {

/// Gives a lane a random initial state between the stops, the same for the same seed and number, relative to the clamp.
/// It is a sum of the three slowest modes of the free structure, shapes with a positive tip. Tip amplitudes are uniform
/// in [−1, 1] times the distance to the stops, times 1, ½, ¼ by mode; velocities are the same times ω_k. One factor
/// brings all back where a contact point would stand beyond 0.95 of its distance. Without stops the distance is the
/// support's amplitude, or 1 m.
void set_random_state(LaneSpec& lane, const SemiDiscrete& problem, std::uint64_t seed, int number);

}  // namespace ricochet
