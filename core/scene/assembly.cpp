#include <algorithm>
#include <cassert>
#include <cmath>
#include <ricochet/scene/assembly.hpp>

namespace ricochet {

SparseMatrix bending_stiffness(const FiniteElementSpace& space, double EI) {
  assert(space.basis == FiniteElementSpace::Basis::hermite);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(16 * space.elements.size());
  for (const auto& element : space.elements) {
    const double l = element.length, k = EI / (l * l * l);
    const double local[4][4] = {{12 * k, 6 * l * k, -12 * k, 6 * l * k},
                                {6 * l * k, 4 * l * l * k, -6 * l * k, 2 * l * l * k},
                                {-12 * k, -6 * l * k, 12 * k, -6 * l * k},
                                {6 * l * k, 2 * l * l * k, -6 * l * k, 4 * l * l * k}};
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b)
        if (element.dof[a] >= 0 && element.dof[b] >= 0)
          entries.emplace_back(element.dof[a], element.dof[b], local[a][b]);
  }
  SparseMatrix stiffness(space.dofs, space.dofs);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  return stiffness;
}

Eigen::VectorXd rigid_motion_load(const FiniteElementSpace& space) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(space.dofs);
  for (const auto& element : space.elements) {
    const double mass = element.line_density * element.length, half = mass / 2, moment = mass * element.length / 12;
    const std::array<double, 4> integrals = space.basis == FiniteElementSpace::Basis::hermite
                                                ? std::array<double, 4>{half, moment, half, -moment}
                                                : std::array<double, 4>{half, half, 0, 0};
    for (int a = 0; a < space.functions(); ++a)
      if (element.dof[a] >= 0) load[element.dof[a]] += integrals[a];
  }
  for (const auto& point : space.point_masses) load[point.dof] += point.mass;
  return load;
}

std::vector<std::pair<int, double>> displacement_row(const FiniteElementSpace& space, double x) {
  assert(!space.elements.empty());
  const auto after = std::upper_bound(space.elements.begin(), space.elements.end(), x,
                                      [](double value, const auto& element) { return value < element.left; });
  const auto& element = after == space.elements.begin() ? space.elements.front() : *(after - 1);
  double xi = (x - element.left) / element.length;
  if (std::abs(xi - std::round(xi)) < 1e-10) xi = std::round(xi);  // the rounding of a decimal position
  const auto phi = shape_values(space.basis, element.length, xi);
  std::vector<std::pair<int, double>> row;
  for (int a = 0; a < space.functions(); ++a)
    if (element.dof[a] >= 0 && phi[a] != 0) row.emplace_back(element.dof[a], phi[a]);
  return row;
}

Eigen::SparseMatrix<double, Eigen::RowMajor> displacement_rows(const FiniteElementSpace& space,
                                                               const std::vector<double>& x) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (const auto& [dof, value] : displacement_row(space, x[i]))
      entries.emplace_back(static_cast<int>(i), dof, value);
  Eigen::SparseMatrix<double, Eigen::RowMajor> rows(static_cast<Eigen::Index>(x.size()), space.dofs);
  rows.setFromTriplets(entries.begin(), entries.end());
  return rows;
}

std::vector<double> node_positions(double length, int elements) {
  std::vector<double> x(static_cast<std::size_t>(elements) + 1);
  for (int i = 0; i <= elements; ++i) x[i] = i == elements ? length : length * i / elements;
  return x;
}

}  // namespace ricochet
