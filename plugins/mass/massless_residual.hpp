#pragma once
#include <ricochet/contract/mass_strategy.hpp>
#include <vector>

namespace ricochet {

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
