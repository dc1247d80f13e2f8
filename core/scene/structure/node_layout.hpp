#pragma once
#include <array>
#include <optional>
#include <ricochet/scene/structure/assembled_structure.hpp>
#include <string>
#include <utility>
#include <vector>

namespace ricochet {

/// Pairs of nodes, by their order, that an entry of K (all dofs of the table) joins.
std::vector<std::pair<int, int>> linked_nodes(const std::map<std::string, AssembledStructure::Node>& nodes,
                                              const SparseMatrix& stiffness);

/// Nodes of an assembled structure as they are drawn: on the plane of two coordinate axes along which it is largest.
/// Of a structure on one line the second axis is the one along which most of its nodes may move.
struct NodeLayout {
  std::array<std::size_t, 2> axes{0, 1};      ///< 0 x, 1 y, 2 z; the first to the right, the second upwards
  std::vector<std::string> names;             ///< of the nodes, along the first axis, then the second
  std::vector<std::array<double, 2>> places;  ///< m
  std::vector<int> held;                      ///< nodes with a dof that is held
  std::vector<std::pair<int, int>> links;     ///< nodes that the stiffness joins; of nodes left out, their nearest kept

  /// −1 where the node is none of them.
  int find(const std::string& node) const;
};

/// Nothing where all nodes have one place, or there are none. Of more than `most` nodes those of `wanted` are kept, and
/// others evenly among the rest.
std::optional<NodeLayout> node_layout(const AssembledStructure& structure, const std::vector<std::string>& wanted,
                                      std::size_t most);

/// A place on that plane: its node, and the direction of its displacement, not normalised where it leaves the plane.
struct DrawnPlace {
  int node = -1;
  std::array<double, 2> direction{0, 0};
};
DrawnPlace drawn_place(const AssembledStructure& structure, const NodeLayout& layout, const Place& place);

/// The node that a place of an assembled structure names first; "" where it names none.
std::string node_of(const AssembledStructure& structure, const Place& place);

}  // namespace ricochet
