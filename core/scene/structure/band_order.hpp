#pragma once
#include <ricochet/contract/mass_strategy.hpp>
#include <vector>

namespace ricochet {

/// An order of the rows of a symmetric pattern (n × n, both triangles) in which its band is narrow. Reverse
/// Cuthill–McKee (Cuthill and McKee 1969; George 1971) begins each component at a node at the end of a longest path.
/// The order given stays where it is as narrow. Row i of the new order is row out[i] of the matrix.
std::vector<int> narrow_order(const SparseMatrix& pattern);

}  // namespace ricochet
