#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>
#include <string>
#include <vector>

/// \file
/// A beam of this program as the files of another one: all dofs, those of the clamp too.
namespace ricochet::testing {

struct BeamFiles {
  std::string stiffness, mass, dofs;
};

struct BeamFileOptions {
  double unit = 1;             ///< m per unit of length of the files
  std::string held = "fixed";  ///< of the first node
  std::vector<int> order;      ///< number of each dof in the files, from 0; empty: by nodes
};

/// Matrix Market, coordinate, symmetric, every digit.
inline std::string matrix_market(const SparseMatrix& matrix) {
  std::string entries;
  int count = 0;
  for (int j = 0; j < matrix.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(matrix, j); it; ++it)
      if (it.row() >= it.col()) {
        entries += fmt::format("{} {} {}\n", it.row() + 1, it.col() + 1, it.value());
        ++count;
      }
  return fmt::format("%%MatrixMarket matrix coordinate real symmetric\n% of a test\n{} {} {}\n", matrix.rows(),
                     matrix.cols(), count) +
         entries;
}

/// Hermite elements without a support: dofs (w_0, w'_0, …, w_N, w'_N).
inline FiniteElementSpace free_space(const BeamSpec& beam, int elements) {
  FiniteElementSpace space = make_space(beam, elements);
  space.left_fixed = false;
  space.dofs = 2 * (elements + 1);
  for (int e = 0; e < elements; ++e)
    space.elements[static_cast<std::size_t>(e)].dof = {2 * e, 2 * e + 1, 2 * e + 2, 2 * e + 3};
  return space;
}

inline BeamFiles beam_files(const BeamSpec& beam, int elements, const BeamFileOptions& options = {}) {
  const FiniteElementSpace space = free_space(beam, elements);
  const double EI = section_properties(beam.section, beam.young, beam.density).EI;
  std::vector<int> order = options.order;
  if (order.empty()) {
    order.resize(static_cast<std::size_t>(space.dofs));
    std::iota(order.begin(), order.end(), 0);
  }
  // q in metres is ℓ times q in units on displacements: A in units is T⁻¹ A T⁻¹ / ℓ.
  const auto permuted = [&](const SparseMatrix& matrix) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int j = 0; j < matrix.outerSize(); ++j)
      for (SparseMatrix::InnerIterator it(matrix, j); it; ++it) {
        double value = it.value() / options.unit;
        for (const auto dof : {it.row(), it.col()})
          if (dof % 2 == 0) value *= options.unit;
        entries.emplace_back(order[static_cast<std::size_t>(it.row())], order[static_cast<std::size_t>(it.col())],
                             value);
      }
    SparseMatrix out(matrix.rows(), matrix.cols());
    out.setFromTriplets(entries.begin(), entries.end());
    return out;
  };
  BeamFiles files{matrix_market(permuted(bending_stiffness(space, EI))),
                  matrix_market(permuted(consistent_mass(space))), "dof,node,component,x,y,z,held\n"};
  const auto x = node_positions(beam.length, elements);
  for (int dof = 0; dof < space.dofs; ++dof)
    files.dofs += fmt::format("{},N{},{},{},0,0,{}\n", order[static_cast<std::size_t>(dof)] + 1, dof / 2,
                              dof % 2 == 0 ? "uy" : "rz", x[static_cast<std::size_t>(dof / 2)] / options.unit,
                              dof < 2 ? options.held : "");
  return files;
}

inline AssembledStructure assembled(const BeamFiles& files, double unit = 1, const std::string& damping = "") {
  AssembledFiles read;
  read.stiffness_name = "K.mtx";
  read.mass_name = "M.mtx";
  read.length_unit = unit;
  read.table = read_dof_table(files.dofs, "dofs.csv");
  const auto dofs = static_cast<int>(read.table.dofs.size());
  read.stiffness = read_matrix_market(files.stiffness, "K.mtx", dofs, "dofs.csv");
  read.mass = read_matrix_market(files.mass, "M.mtx", dofs, "dofs.csv");
  if (!damping.empty()) {
    read.damping_name = "C.mtx";
    read.damping = read_matrix_market(damping, "C.mtx", dofs, "dofs.csv");
  }
  return assemble_structure(read);
}

inline Place at_node(const std::string& node, const std::string& component = "uy") {
  Place place;
  place.node = node;
  place.component = component;
  return place;
}

/// A scene of given matrices, at rest, without stops and loads.
inline SceneSpec assembled_scene(AssembledStructure structure, const Damping& damping = {}) {
  SceneSpec scene;
  scene.structure = AssembledSpec{std::make_shared<const AssembledStructure>(std::move(structure)), damping, {}};
  return scene;
}

}  // namespace ricochet::testing
