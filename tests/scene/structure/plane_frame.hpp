#pragma once
#include <cmath>

#include "tests/scene/structure/beam_files.hpp"

namespace ricochet::testing {

/// Nodes of a plane frame and straight elements between one and the next: bars and Hermite beams of EA = 50, EI = 1,
/// ρA = 1, dofs ux, uy, rz of each node, the first node held.
inline BeamFiles frame_files(const std::vector<std::array<double, 2>>& nodes, bool places = true) {
  const auto count = static_cast<int>(nodes.size());
  std::vector<Eigen::Triplet<double>> K, M;
  for (int e = 0; e + 1 < count; ++e) {
    const auto &a = nodes[static_cast<std::size_t>(e)], &b = nodes[static_cast<std::size_t>(e) + 1];
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]), c = (b[0] - a[0]) / length, s = (b[1] - a[1]) / length;
    FiniteElementSpace beam, bar;
    beam.dofs = 4;
    beam.elements = {{0, length, 1, {0, 1, 2, 3}}};
    bar.basis = FiniteElementSpace::Basis::linear;
    bar.dofs = 2;
    bar.elements = {{0, length, 1, {0, 1, -1, -1}}};
    // Rows: axial, transverse and rotation of each end, of the six dofs of the frame.
    Eigen::MatrixXd along = Eigen::MatrixXd::Zero(2, 6), across = Eigen::MatrixXd::Zero(4, 6);
    for (int end = 0; end < 2; ++end) {
      along.block(end, 3 * end, 1, 2) << c, s;
      across.block(2 * end, 3 * end, 1, 2) << -s, c;
      across(2 * end + 1, 3 * end + 2) = 1;
    }
    const Eigen::MatrixXd k = along.transpose() * axial_stiffness(bar, 50) * along +
                              across.transpose() * bending_stiffness(beam, 1.0) * across,
                          m = along.transpose() * consistent_mass(bar) * along +
                              across.transpose() * consistent_mass(beam) * across;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        K.emplace_back(3 * e + i, 3 * e + j, (k(i, j) + k(j, i)) / 2);
        M.emplace_back(3 * e + i, 3 * e + j, (m(i, j) + m(j, i)) / 2);
      }
  }
  SparseMatrix stiffness(3 * count, 3 * count), mass(3 * count, 3 * count);
  stiffness.setFromTriplets(K.begin(), K.end());
  mass.setFromTriplets(M.begin(), M.end());
  BeamFiles files{matrix_market(stiffness), matrix_market(mass), "dof,node,component,x,y,z,held\n"};
  const char* const components[] = {"ux", "uy", "rz"};
  for (int dof = 0; dof < 3 * count; ++dof) {
    const auto& at = nodes[static_cast<std::size_t>(dof / 3)];
    files.dofs += fmt::format("{},N{},{},{},{},0,{}\n", dof + 1, dof / 3, components[dof % 3], places ? at[0] : 0,
                              places ? at[1] : 0, dof < 3 ? "fixed" : "");
  }
  return files;
}

/// Half a circle of ten elements, radius 1.
inline std::vector<std::array<double, 2>> arch() {
  std::vector<std::array<double, 2>> nodes;
  for (int i = 0; i <= 10; ++i) nodes.push_back({std::cos(0.314 * i), std::sin(0.314 * i)});
  return nodes;
}

}  // namespace ricochet::testing
