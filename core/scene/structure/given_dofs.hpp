#pragma once
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/scene/files/text_file.hpp>
#include <vector>

namespace ricochet {

/// Of each dof in `order` (of the table, from 0): 0, 1, 2 a displacement along x, y, z; 3 a rotation; −1 another word.
std::vector<int> dof_directions(const DofTable& table, const std::vector<int>& order);

/// Rigid motions of the dofs in `order`, as columns. First comes each translation that a dof has, then each rotation
/// u = ω × (x − x₀) that K lets be, x₀ the mean place. K is of all dofs of the table, in m. It lets u be where (K u)_i
/// is zero to 1e-6 of its terms in every row that no ground holds. A ground holds the rows in which K resists a
/// translation. `unit`: m per unit of the table's places.
Eigen::MatrixXd rigid_motions(const DofTable& table, const SparseMatrix& stiffness, double unit,
                              const std::vector<int>& order);

/// What a translation along x, y, z of all dofs moves of M (all dofs of the table), kg. Also the sum of the diagonal of
/// M along each, kg.
struct TranslatedMass {
  std::array<double, 3> whole{}, diagonal{};
};
TranslatedMass translated_mass(const DofTable& table, const SparseMatrix& mass);

/// An order of the rows of a symmetric pattern (n × n, both triangles) in which its band is narrow. Reverse
/// Cuthill–McKee (Cuthill and McKee 1969; George 1971) begins each component at a node at the end of a longest path.
/// The order given stays where it is as narrow. Row i of the new order is row out[i] of the matrix.
std::vector<int> narrow_order(const SparseMatrix& pattern);

}  // namespace ricochet
