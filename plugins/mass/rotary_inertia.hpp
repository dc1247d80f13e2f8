#pragma once
#include <optional>
#include <ricochet/contract/mass_strategy.hpp>

namespace ricochet {

/// What a mass without inertia of rotations says of rotary inertia; nothing where there is none.
inline std::optional<Refusal> refuse_rotary_inertia(const FiniteElementSpace& space) {
  for (const auto& element : space.elements)
    if (element.rotary != 0)
      return Refusal{
          "rotary inertia gives every rotation a mass, so that no motion without inertia is left for the stops: drop "
          "shear.rotary, or use the mass redistributed"};
  return std::nullopt;
}

}  // namespace ricochet
