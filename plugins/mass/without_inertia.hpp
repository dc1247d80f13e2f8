#pragma once
#include <optional>
#include <ricochet/contract/mass_strategy.hpp>
#include <vector>

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

/// Of a structure in modes: what touches, the residual flexibility of the stops, has no inertia.
inline InertiaOrRefusal massless_residual(const GivenMass& given) {
  if (given.attached.empty())
    return Refusal{
        "the modes carry no residual flexibility, so that nothing without inertia is left at the stops: give it, or "
        "use the mass consistent"};
  std::vector<bool> attached(static_cast<std::size_t>(given.mass.rows()), false);
  for (const int dof : given.attached) attached[static_cast<std::size_t>(dof)] = true;
  Inertia inertia;
  inertia.mass = given.mass;
  inertia.mass.prune([&](int row, int column, double) {
    return !attached[static_cast<std::size_t>(row)] && !attached[static_cast<std::size_t>(column)];
  });
  inertia.kernel_dimension = static_cast<int>(given.attached.size());
  return inertia;
}

}  // namespace ricochet
