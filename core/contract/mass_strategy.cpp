#include <ricochet/contract/mass_strategy.hpp>

namespace ricochet {

MassFactors mass_factors(const Inertia& inertia) {
  if (!inertia.inverted()) return {inertia.coupling, inertia.velocity_mass};
  SparseMatrix identity(inertia.inverse.rows(), inertia.inverse.rows());
  identity.setIdentity();
  return {identity, inertia.inverse};
}

SparseMatrix consistent_mass(const FiniteElementSpace& space) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(16 * space.elements.size() + space.point_masses.size());
  const int functions = space.functions();
  for (const auto& element : space.elements) {
    for (int a = 0; a < functions; ++a) {
      for (int b = 0; b <= a; ++b) {
        const int row = element.dof[a], column = element.dof[b];
        if (row < 0 || column < 0) continue;
        double integral = 0;
        for (const auto& [xi, weight] : gauss_points()) {
          const auto phi = shape_values(space.basis, element.length, xi);
          integral += weight * phi[a] * phi[b];
        }
        integral *= element.line_density * element.length;
        entries.emplace_back(row, column, integral);
        if (a != b) entries.emplace_back(column, row, integral);
      }
    }
  }
  for (const auto& point : space.point_masses) entries.emplace_back(point.dof, point.dof, point.mass);
  SparseMatrix mass(space.dofs, space.dofs);
  mass.setFromTriplets(entries.begin(), entries.end());
  return mass;
}

}  // namespace ricochet
