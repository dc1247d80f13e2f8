#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace ricochet {

/// What one row and column of the matrices stands for.
struct DofName {
  int dof = 0;  ///< number in the file, from 1
  std::string node, component;
  std::array<double, 3> place{};  ///< x, y, z of the node, m
  std::string held;               ///< "" free, "fixed" at rest, else the name of the support that moves it

  bool rotation() const { return component == "rx" || component == "ry" || component == "rz"; }
  bool translation() const { return component == "ux" || component == "uy" || component == "uz"; }
  /// "N3 uy".
  std::string text() const { return node + " " + component; }
};

/// A table of dofs.
struct DofTable {
  std::string name;
  std::vector<DofName> dofs;  ///< in the order of their numbers
};

/// Reads a CSV with the columns dof,node,component,x,y,z,held in any order, numbers as in the file. Throws FileError
/// for dofs that are missing or stand twice, nodes with two equal components or two places, empty names.
DofTable read_dof_table(std::string_view content, const std::string& name);

}  // namespace ricochet
