#include "runners/study/structure_layout.hpp"

#include <algorithm>
#include <map>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/structure/node_layout.hpp>

namespace ricochet {
namespace {

constexpr std::size_t most_nodes = 400, most_points = 40;

Json points_of(const AssembledStructure& structure) {
  Json points = Json::array();
  if (structure.modes)
    for (const auto& [name, ignored] : structure.modes->points)
      if (points.size() < most_points) points.push_back(name);
  return {{"points", std::move(points)}};
}

Json nodes_of(const NodeLayout& layout) {
  static const char* const axes[] = {"x", "y", "z"};
  Json out = {{"axes", {axes[layout.axes[0]], axes[layout.axes[1]]}},
              {"nodes", layout.names},
              {"x", Json::array()},
              {"y", Json::array()},
              {"held", layout.held},
              {"links", layout.links}};
  for (const auto& place : layout.places) {
    out["x"].push_back(place[0]);
    out["y"].push_back(place[1]);
  }
  return out;
}

// A structure of files, alone or a body, with the layout of its nodes.
struct DrawnBody {
  const AssembledStructure* structure = nullptr;
  std::optional<NodeLayout> layout = {};

  DrawnPlace of(const Place& place) const { return layout ? drawn_place(*structure, *layout, place) : DrawnPlace(); }
};

Json structure_layout(const SceneSpec& scene) {
  std::vector<std::optional<Place>> places;
  for (const NamedStop& stop : scene.stops.named) places.insert(places.end(), {stop.at, stop.to});
  for (const LoadTerm& term : scene.load.terms) places.push_back(term.place);
  std::map<std::string, DrawnBody> drawn;
  const auto add = [&](const std::string& body, const StructureSpec& structure) {
    const auto* spec = std::get_if<AssembledSpec>(&structure);
    if (!spec || spec->structure->joined) return;
    std::vector<std::string> wanted;
    for (const std::optional<Place>& place : places)
      if (place && place->body == body) wanted.push_back(node_of(*spec->structure, *place));
    drawn[body] = {spec->structure.get(), node_layout(*spec->structure, wanted, most_nodes)};
  };
  Json out = Json::object();
  const auto said = [](const DrawnBody& one) { return one.layout ? nodes_of(*one.layout) : points_of(*one.structure); };
  if (const JoinedBodies* bodies = bodies_of(scene.structure)) {
    for (const JoinedBody& body : bodies->all) add(body.name, body.alone.structure);
    for (const auto& [name, body] : drawn) out["bodies"][name] = said(body);
  } else {
    add("", scene.structure);
    if (drawn.contains("")) out = said(drawn.at(""));
  }
  if (drawn.empty()) return nullptr;
  if (std::none_of(drawn.begin(), drawn.end(), [](const auto& one) { return one.second.layout.has_value(); }))
    return out;
  const auto of = [&](const Place& place) { return drawn[place.body].of(place); };
  for (const char* key : {"stops", "loads"}) out[key] = Json::array();
  for (const NamedStop& stop : scene.stops.named) {
    if (stop.entry < out["stops"].size()) continue;  // another side of a clearance
    const DrawnPlace at = of(stop.at);
    Json& one = out["stops"].emplace_back(Json{{"at", at.node}, {"direction", at.direction}});
    if (stop.to) one["to"] = of(*stop.to).node;
  }
  for (const LoadTerm& term : scene.load.terms)
    if (term.place) out["loads"].push_back({{"at", of(*term.place).node}, {"direction", of(*term.place).direction}});
  return out;
}

}  // namespace

Json with_layout(Json said, const SceneSpec& scene) {
  if (Json layout = structure_layout(scene); !layout.is_null()) said["layout"] = std::move(layout);
  return said;
}

}  // namespace ricochet
