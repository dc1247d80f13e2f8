#include "runners/study/structure_layout.hpp"

#include <ricochet/scene/structure/node_layout.hpp>

namespace ricochet {
namespace {

constexpr std::size_t most_nodes = 400, most_points = 40;

Json drawn(const AssembledStructure& structure, const NodeLayout& layout, const Place& at,
           const std::optional<Place>& to) {
  const DrawnPlace place = drawn_place(structure, layout, at);
  Json out = {{"at", place.node}, {"direction", place.direction}};
  if (to) out["to"] = drawn_place(structure, layout, *to).node;
  return out;
}

Json points_of(const AssembledStructure& structure) {
  Json points = Json::array();
  if (structure.modes)
    for (const auto& [name, ignored] : structure.modes->points)
      if (points.size() < most_points) points.push_back(name);
  return {{"points", std::move(points)}};
}

Json structure_layout(const SceneSpec& scene) {
  const auto* spec = std::get_if<AssembledSpec>(&scene.structure);
  if (!spec || spec->structure->joined) return nullptr;
  const AssembledStructure& structure = *spec->structure;
  std::vector<std::string> wanted;
  const auto want = [&](const std::optional<Place>& place) {
    if (place) wanted.push_back(node_of(structure, *place));
  };
  for (const NamedStop& stop : scene.stops.named) {
    want(stop.at);
    want(stop.to);
  }
  for (const LoadTerm& term : scene.load.terms) want(term.place);
  const std::optional<NodeLayout> layout = node_layout(structure, wanted, most_nodes);
  if (!layout) return points_of(structure);
  static const char* const axes[] = {"x", "y", "z"};
  Json out = {{"axes", {axes[layout->axes[0]], axes[layout->axes[1]]}},
              {"nodes", layout->names},
              {"x", Json::array()},
              {"y", Json::array()},
              {"held", layout->held},
              {"links", layout->links},
              {"stops", Json::array()},
              {"loads", Json::array()}};
  for (const auto& place : layout->places) {
    out["x"].push_back(place[0]);
    out["y"].push_back(place[1]);
  }
  for (const NamedStop& stop : scene.stops.named) out["stops"].push_back(drawn(structure, *layout, stop.at, stop.to));
  for (const LoadTerm& term : scene.load.terms)
    if (term.place) out["loads"].push_back(drawn(structure, *layout, *term.place, std::nullopt));
  return out;
}

}  // namespace

Json with_layout(Json said, const SceneSpec& scene) {
  if (Json layout = structure_layout(scene); !layout.is_null()) said["layout"] = std::move(layout);
  return said;
}

}  // namespace ricochet
