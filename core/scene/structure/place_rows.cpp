#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>

// Places of a structure as rows over its dofs.

namespace ricochet {
namespace {

std::vector<std::pair<int, double>> gathered(std::vector<std::pair<int, double>> entries) {
  std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::pair<int, double>> out;
  for (const auto& [index, value] : entries)
    if (!out.empty() && out.back().first == index)
      out.back().second += value;
    else
      out.emplace_back(index, value);
  std::erase_if(out, [](const auto& entry) { return entry.second == 0; });
  return out;
}

std::string components_of(const AssembledStructure::Node& node) {
  std::vector<std::string> names;
  for (const auto& [component, ignored] : node.dofs) names.push_back(component);
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

PlaceRow difference(const PlaceRow& a, const PlaceRow& b) {
  PlaceRow out = a;
  for (const auto& [dof, value] : b.free) out.free.emplace_back(dof, -value);
  for (const auto& [support, value] : b.held) out.held.emplace_back(support, -value);
  out.free = gathered(std::move(out.free));
  out.held = gathered(std::move(out.held));
  return out;
}

namespace {

PlaceRow point_row(const AssembledStructure& structure, const Place& place, const std::string& pointer) {
  const auto& points = structure.modes->points;
  std::vector<std::string> known;
  for (const auto& [name, ignored] : points) known.push_back(name);
  if (place.point.empty())
    throw InputError(pointer, "a modal structure has points of shapes alone; expected {\"point\": name}");
  const auto found = points.find(place.point);
  if (found != points.end()) return found->second;
  const std::string nearest = nearest_name(place.point, known);
  throw InputError(pointer + "/point",
                   fmt::format("no point \"{}\"{}", shortened(place.point),
                               nearest.empty() ? fmt::format("; {} has {}", structure.table_name, points.size())
                                               : "; nearest " + nearest));
}

// Adds the displacement of a place at a node: `add`(dof, weight), dofs from 1.
template <class Add>
void add_node(const AssembledStructure& structure, const Place& place, const std::string& pointer, PlaceRow& out,
              const Add& add) {
  const auto found = structure.nodes.find(place.node);
  if (found == structure.nodes.end()) {
    std::vector<std::string> known;
    for (const auto& [name, ignored] : structure.nodes) known.push_back(name);
    const std::string nearest = nearest_name(place.node, known);
    throw InputError(
        pointer + "/node",
        fmt::format("\"{}\": no such node{}", shortened(place.node),
                    nearest.empty() ? fmt::format("; {} has {} nodes", structure.table_name, structure.nodes.size())
                                    : "; nearest " + nearest));
  }
  const auto& node = found->second;
  out.x = node.place[0];
  const auto component = [&](const std::string& name, double weight, const char* key) {
    const auto dof = node.dofs.find(name);
    if (dof == node.dofs.end())
      throw InputError(fmt::format("{}/{}", pointer, key),
                       fmt::format("node {} has {} and no {}", place.node, components_of(node), shortened(name)));
    add(dof->second, weight);
  };
  if (place.direction.empty()) {
    component(place.component, 1, "component");
    return;
  }
  double length = 0;
  for (const double one : place.direction) length = std::hypot(length, one);
  if (!(length > 0) || !std::isfinite(length))
    throw InputError(pointer + "/direction", "the direction has no length; expected three numbers, not all 0");
  static const char* const axes[] = {"ux", "uy", "uz"};
  for (std::size_t axis = 0; axis < place.direction.size() && axis < 3; ++axis)
    if (place.direction[axis] != 0) component(axes[axis], place.direction[axis] / length, "direction");
}

}  // namespace

PlaceRow AssembledStructure::row(const Place& place, const std::string& pointer) const {
  if (joined) return joined->row(place, pointer);
  if (modes) return point_row(*this, place, pointer);
  if (!place.point.empty())
    throw InputError(pointer,
                     "points are those of a modal structure; expected node and component, node and direction, or dofs");
  if (place.x)
    throw InputError(pointer,
                     "x has no meaning for matrices that are given; expected node and component, node and "
                     "direction, or dofs");
  PlaceRow out;
  const auto add = [&](int dof, double weight) {
    const Where& at = where[static_cast<std::size_t>(dof) - 1];
    if (at.free >= 0) out.free.emplace_back(at.free, weight);
    if (at.support >= 0) out.held.emplace_back(at.support, weight);
  };
  if (!place.dofs.empty()) {
    for (std::size_t i = 0; i < place.dofs.size(); ++i) {
      const auto [dof, weight] = place.dofs[i];
      if (dof < 1 || dof > static_cast<int>(where.size()))
        throw InputError(fmt::format("{}/dofs/{}/dof", pointer, i),
                         fmt::format("dof {} of a structure of {}; expected 1 to {}", dof, where.size(), where.size()));
      add(dof, weight);
      for (const auto& [name, node] : nodes)
        if (i == 0)
          for (const auto& [component, number] : node.dofs)
            if (number == dof) out.x = node.place[0];
    }
  } else {
    add_node(*this, place, pointer, out, add);
  }
  out.free = gathered(std::move(out.free));
  out.held = gathered(std::move(out.held));
  return out;
}

}  // namespace ricochet
