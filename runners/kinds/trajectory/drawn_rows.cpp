#include "runners/kinds/trajectory/drawn_rows.hpp"

#include <algorithm>
#include <ricochet/scene/named_stops.hpp>
#include <ricochet/scene/structure/node_layout.hpp>

namespace ricochet {
namespace {

constexpr std::array<const char*, 3> components = {"ux", "uy", "uz"};

DrawnRows as_rows(Snapshots shape, const std::vector<PlaceRow>& places, const SemiDiscrete& problem) {
  DrawnRows out{std::move(shape), SparseRows(static_cast<Eigen::Index>(places.size()), problem.space.dofs), {}};
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd held = Eigen::MatrixXd::Zero(out.rows.rows(), problem.static_modes.cols());
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (const auto& [dof, value] : places[i].free) entries.emplace_back(static_cast<int>(i), dof, value);
    for (const auto& [support, weight] : places[i].held) held(static_cast<Eigen::Index>(i), support) += weight;
  }
  out.rows.setFromTriplets(entries.begin(), entries.end());
  out.on_supports = out.rows * problem.static_modes + held;
  return out;
}

DrawnRows plane(const SceneSpec& scene, const AssembledStructure& structure, const NodeLayout& layout,
                const SemiDiscrete& problem) {
  Snapshots shape;
  shape.axes = layout.axes;
  shape.names = layout.names;
  shape.links = layout.links;
  shape.held = layout.held;
  std::vector<PlaceRow> places;
  for (std::size_t i = 0; i < layout.names.size(); ++i) {
    shape.x.push_back(layout.places[i][0]);
    shape.y.push_back(layout.places[i][1]);
    const AssembledStructure::Node& node = structure.nodes.at(layout.names[i]);
    for (const std::size_t axis : layout.axes) {
      Place place;
      place.node = layout.names[i];
      place.component = components[axis];
      places.push_back(node.dofs.contains(place.component) ? structure.row(place, "") : PlaceRow());
    }
  }
  for (const NamedStop& stop : scene.stops.named) {
    const DrawnPlace at = drawn_place(structure, layout, stop.at);
    shape.stops.push_back({at.node, stop.to ? drawn_place(structure, layout, *stop.to).node : -1, at.direction});
  }
  return as_rows(std::move(shape), places, problem);
}

DrawnRows bars(const SceneSpec& scene, const AssembledStructure& structure, const SemiDiscrete& problem) {
  Snapshots shape;
  std::vector<PlaceRow> places;
  const auto add = [&](const std::string& name, PlaceRow row) {
    shape.x.push_back(static_cast<double>(places.size()));
    shape.names.push_back(name);
    places.push_back(std::move(row));
    return static_cast<int>(places.size()) - 1;
  };
  if (structure.modes)
    for (const auto& [name, row] : structure.modes->points)
      if (places.size() < static_cast<std::size_t>(Snapshots::most_places)) add(name, row);
  for (std::size_t i = 0; i < scene.stops.named.size(); ++i) {
    const NamedStop& stop = scene.stops.named[i];
    const auto known = std::find(shape.names.begin(), shape.names.end(), stop.at.point);
    const bool own = stop.to || stop.at.point.empty() || known == shape.names.end();
    const int place =
        own ? add(stop.name, stop_row(scene, problem.space, stop, i)) : static_cast<int>(known - shape.names.begin());
    shape.stops.push_back({place, -1, {0, 1}});
  }
  if (!structure.modes)
    for (const PointSpec& point : scene.points) add(point.name, structure.row(point.at, ""));
  if (places.empty()) add("tip", given_tip(std::get<AssembledSpec>(scene.structure), scene));
  return as_rows(std::move(shape), places, problem);
}

}  // namespace

std::optional<DrawnRows> drawn_rows(const SceneSpec& scene, const SemiDiscrete& problem) {
  const auto* spec = std::get_if<AssembledSpec>(&scene.structure);
  if (!spec) return std::nullopt;
  const AssembledStructure& structure = *spec->structure;
  std::vector<std::string> wanted;
  for (const NamedStop& stop : scene.stops.named)
    for (const Place* place : {&stop.at, stop.to ? &*stop.to : nullptr})
      if (place) wanted.push_back(node_of(structure, *place));
  const std::optional<NodeLayout> layout = node_layout(structure, wanted, Snapshots::most_nodes);
  return layout ? plane(scene, structure, *layout, problem) : bars(scene, structure, problem);
}

}  // namespace ricochet
