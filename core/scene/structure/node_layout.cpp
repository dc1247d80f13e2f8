#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <ricochet/scene/structure/node_layout.hpp>
#include <set>

namespace ricochet {
namespace {

constexpr std::array<const char*, 3> components = {"ux", "uy", "uz"};

// Links beyond so many per node hide the shape; of each node this many shortest are drawn then.
constexpr std::size_t most_links = 3;

using Nodes = std::map<std::string, AssembledStructure::Node>;

std::array<double, 3> extents(const Nodes& nodes) {
  std::array<double, 3> low = nodes.begin()->second.place, high = low;
  for (const auto& [name, node] : nodes)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], node.place[axis]);
      high[axis] = std::max(high[axis], node.place[axis]);
    }
  return {high[0] - low[0], high[1] - low[1], high[2] - low[2]};
}

// Free dofs along each axis.
std::array<std::size_t, 3> free_directions(const AssembledStructure& structure) {
  std::array<std::size_t, 3> out{};
  for (const DofName& one : structure.names)
    for (std::size_t axis = 0; axis < 3; ++axis) out[axis] += one.component == components[axis] ? 1 : 0;
  return out;
}

std::array<std::size_t, 2> drawn_axes(const AssembledStructure& structure) {
  constexpr double flat = 1e-9;
  const std::array<double, 3> extent = extents(structure.nodes);
  const std::array<std::size_t, 3> moves = free_directions(structure);
  std::array<std::size_t, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return extent[a] > extent[b]; });
  if (extent[order[1]] <= flat * extent[order[0]] && moves[order[2]] > moves[order[1]]) std::swap(order[1], order[2]);
  return {std::min(order[0], order[1]), std::max(order[0], order[1])};
}

// Which of the nodes are kept, in the order given.
std::vector<char> kept_nodes(const std::vector<std::string>& names, const std::vector<std::string>& wanted,
                             std::size_t most) {
  std::vector<char> kept(names.size(), names.size() <= most);
  if (names.size() <= most) return kept;
  const std::set<std::string> first(wanted.begin(), wanted.end());
  std::size_t count = 0;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (first.contains(names[i]) && count < most) count += kept[i] = 1;
  const std::size_t others = most - count;
  for (std::size_t k = 0; k < others; ++k) kept[k * names.size() / others] = 1;
  return kept;
}

// The kept node that each node is nearest to, by links.
std::vector<int> nearest_kept(const std::vector<char>& kept, const std::vector<std::vector<int>>& joined) {
  std::vector<int> owner(kept.size(), -1);
  std::deque<int> front;
  int number = 0;
  for (std::size_t i = 0; i < kept.size(); ++i)
    if (kept[i]) {
      owner[i] = number++;
      front.push_back(static_cast<int>(i));
    }
  for (; !front.empty(); front.pop_front())
    for (const int next : joined[static_cast<std::size_t>(front.front())])
      if (owner[static_cast<std::size_t>(next)] < 0) {
        owner[static_cast<std::size_t>(next)] = owner[static_cast<std::size_t>(front.front())];
        front.push_back(next);
      }
  return owner;
}

void thin_links(NodeLayout& layout) {
  if (layout.links.size() <= most_links * layout.names.size()) return;
  const auto length = [&](const std::pair<int, int>& link) {
    const auto &a = layout.places[static_cast<std::size_t>(link.first)],
               &b = layout.places[static_cast<std::size_t>(link.second)];
    return std::hypot(a[0] - b[0], a[1] - b[1]);
  };
  std::stable_sort(layout.links.begin(), layout.links.end(),
                   [&](const auto& a, const auto& b) { return length(a) < length(b); });
  std::vector<std::size_t> count(layout.names.size(), 0);
  std::erase_if(layout.links, [&](const std::pair<int, int>& link) {
    std::size_t &a = count[static_cast<std::size_t>(link.first)], &b = count[static_cast<std::size_t>(link.second)];
    if (a >= most_links && b >= most_links) return true;
    ++a;
    ++b;
    return false;
  });
}

}  // namespace

std::vector<std::pair<int, int>> linked_nodes(const std::map<std::string, AssembledStructure::Node>& nodes,
                                              const SparseMatrix& stiffness) {
  std::vector<int> node_of(static_cast<std::size_t>(stiffness.rows()), 0);
  int number = 0;
  for (const auto& [name, node] : nodes) {
    for (const auto& [component, dof] : node.dofs) node_of[static_cast<std::size_t>(dof) - 1] = number;
    ++number;
  }
  std::vector<std::pair<int, int>> links;
  for (int j = 0; j < stiffness.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(stiffness, j); it; ++it) {
      const std::pair link(node_of[static_cast<std::size_t>(it.row())], node_of[static_cast<std::size_t>(j)]);
      if (link.first < link.second && (links.empty() || links.back() != link)) links.push_back(link);
    }
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  return links;
}

int NodeLayout::find(const std::string& node) const {
  const auto found = std::find(names.begin(), names.end(), node);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

std::optional<NodeLayout> node_layout(const AssembledStructure& structure, const std::vector<std::string>& wanted,
                                      std::size_t most) {
  if (structure.nodes.empty()) return std::nullopt;
  const std::array<double, 3> extent = extents(structure.nodes);
  if (!(*std::max_element(extent.begin(), extent.end()) > 0)) return std::nullopt;
  NodeLayout out;
  out.axes = drawn_axes(structure);
  const auto place_of = [&](const AssembledStructure::Node& node) {
    return std::array<double, 2>{node.place[out.axes[0]], node.place[out.axes[1]]};
  };
  std::vector<std::string> names;
  std::map<std::string, int> number;  // as they stand in the structure
  for (const auto& [name, node] : structure.nodes) {
    number.emplace(name, static_cast<int>(names.size()));
    names.push_back(name);
  }
  std::stable_sort(names.begin(), names.end(), [&](const std::string& a, const std::string& b) {
    return place_of(structure.nodes.at(a)) < place_of(structure.nodes.at(b));
  });
  std::vector<int> position(names.size());
  for (std::size_t i = 0; i < names.size(); ++i)
    position[static_cast<std::size_t>(number.at(names[i]))] = static_cast<int>(i);
  std::vector<std::vector<int>> joined(names.size());
  for (const auto& [a, b] : structure.links) {
    const int from = position[static_cast<std::size_t>(a)], to = position[static_cast<std::size_t>(b)];
    joined[static_cast<std::size_t>(from)].push_back(to);
    joined[static_cast<std::size_t>(to)].push_back(from);
  }
  const std::vector<char> kept = kept_nodes(names, wanted, most);
  const std::vector<int> owner = nearest_kept(kept, joined);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!kept[i]) continue;
    const AssembledStructure::Node& node = structure.nodes.at(names[i]);
    const bool held = std::any_of(node.dofs.begin(), node.dofs.end(), [&](const auto& dof) {
      return structure.where[static_cast<std::size_t>(dof.second) - 1].free < 0;
    });
    if (held) out.held.push_back(static_cast<int>(out.names.size()));
    out.names.push_back(names[i]);
    out.places.push_back(place_of(node));
  }
  std::set<std::pair<int, int>> links;
  for (std::size_t i = 0; i < joined.size(); ++i)
    for (const int j : joined[i])
      if (owner[i] >= 0 && owner[i] < owner[static_cast<std::size_t>(j)])
        links.emplace(owner[i], owner[static_cast<std::size_t>(j)]);
  out.links.assign(links.begin(), links.end());
  thin_links(out);
  return out;
}

std::string node_of(const AssembledStructure& structure, const Place& place) {
  if (place.dofs.empty()) return place.node;
  for (const auto& [name, node] : structure.nodes)
    for (const auto& [component, dof] : node.dofs)
      if (dof == place.dofs.front().first) return name;
  return "";
}

DrawnPlace drawn_place(const AssembledStructure& structure, const NodeLayout& layout, const Place& place) {
  DrawnPlace out;
  const std::string name = node_of(structure, place);
  out.node = layout.find(name);
  const auto found = structure.nodes.find(name);
  if (out.node < 0 || found == structure.nodes.end()) return out;
  double length = 0;
  for (const double one : place.direction) length = std::hypot(length, one);
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t axis = layout.axes[k];
    if (place.component == components[axis]) out.direction[k] = 1;
    if (axis < place.direction.size() && length > 0) out.direction[k] = place.direction[axis] / length;
    const auto dof = found->second.dofs.find(components[axis]);
    for (const auto& [number, weight] : place.dofs)
      if (dof != found->second.dofs.end() && dof->second == number) out.direction[k] += weight;
  }
  return out;
}

}  // namespace ricochet
