#include <fmt/format.h>

#include <algorithm>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/named_stops.hpp>
#include <ricochet/scene/planes.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>
#include <ricochet/scene/supports.hpp>

namespace ricochet {
namespace {

// The number of a support; throws InputError with the nearest name.
std::size_t number_of(const std::string& name, const std::vector<std::string>& names, const std::string& pointer) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
  const std::string nearest = nearest_name(name, names);
  throw InputError(pointer, fmt::format("no support \"{}\"{}", name,
                                        nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest)));
}

// The supports that move along y, or along z, as motions call them.
struct Along {
  std::vector<std::size_t> numbers;
  std::vector<std::string> names;
};

Along supports_along(const StructureSpec& structure, int plane) {
  Along out;
  const std::vector<std::string> names = support_names(structure);
  const auto* beam = std::get_if<BeamSpec>(&structure);
  const JoinedBodies* bodies = bodies_of(structure);
  const std::size_t first = names.size() / static_cast<std::size_t>(beam ? beam->planes : 1);
  for (std::size_t j = 0; j < names.size(); ++j) {
    const bool across = bodies ? bodies->across(j) : j >= first;
    if (across != (plane == 1)) continue;
    out.numbers.push_back(j);
    out.names.push_back(bodies && across ? names[j].substr(0, names[j].rfind('.')) : names[j]);
  }
  return out;
}

// Whether a motion is one along z.
int plane_of(const StructureSpec& structure, const std::string& component, const std::string& pointer) {
  if (component.empty()) return 0;
  const auto* beam = std::get_if<BeamSpec>(&structure);
  const bool two_planes = !supports_along(structure, 1).numbers.empty();
  if (!beam && !two_planes)
    throw InputError(pointer + "/component", "only supports of a beam in two planes move along a component");
  Place towards;
  towards.component = component;
  return plane_shares(towards, two_planes, pointer)[1] == 1 ? 1 : 0;
}

}  // namespace

MovedSupports moved_supports(const SceneSpec& scene) {
  const std::vector<std::string> names = support_names(scene.structure);
  if (names.empty())
    throw InputError("/scene/motions", "nothing holds the structure; expected a support that could move");
  MovedSupports moved{{}, std::vector<int>(names.size(), -1)};
  for (std::size_t k = 0; k < scene.motions.size(); ++k) {
    const MotionSpec& motion = scene.motions[k];
    const std::string pointer = fmt::format("/scene/motions/{}/supports", k);
    std::vector<std::size_t>& mine = moved.supports.emplace_back();
    const Along known = supports_along(
        scene.structure, plane_of(scene.structure, motion.component, fmt::format("/scene/motions/{}", k)));
    if (motion.supports.empty()) mine = known.numbers;
    for (const std::string& name : motion.supports)
      mine.push_back(known.numbers[number_of(name, known.names, pointer)]);
    for (const std::size_t j : mine) {
      if (moved.motion[j] >= 0)
        throw InputError(pointer, fmt::format("motions/{} moves the support \"{}\" too; expected one motion of each "
                                              "support",
                                              moved.motion[j], names[j]));
      moved.motion[j] = static_cast<int>(k);
    }
  }
  return moved;
}

std::string carrier_pointer(const SceneSpec& scene, std::size_t stop) {
  return scene.stops.named.empty() ? "/scene/stops/moves_with" : fmt::format("/scene/stops/{}/moves_with", stop);
}

const std::string& carrier_of(const SceneSpec& scene, std::size_t stop) {
  return scene.stops.named.empty() ? scene.stops.moves_with : scene.stops.named[stop].moves_with;
}

namespace {

// The motion of a support along y or z, or of them all; −1: they rest.
int motion_of(const std::string& carrier, const SceneSpec& scene, const MovedSupports& moved,
              const std::string& pointer, int plane) {
  const Along known = supports_along(scene.structure, plane);
  if (known.numbers.empty()) return -1;
  if (carrier != all_supports) return moved.motion[known.numbers[number_of(carrier, known.names, pointer)]];
  const int first = moved.motion[known.numbers.front()];
  if (!std::all_of(known.numbers.begin(), known.numbers.end(), [&](std::size_t j) { return moved.motion[j] == first; }))
    throw InputError(pointer, "the supports move apart; expected the name of one");
  return first;
}

// Whether a support of the table of dofs holds a component, and moves along it.
bool holds(const AssembledStructure& structure, const std::string& support, const std::string& component) {
  return std::any_of(structure.nodes.begin(), structure.nodes.end(), [&](const auto& node) {
    const auto found = node.second.dofs.find(component);
    if (found == node.second.dofs.end()) return false;
    const int held = structure.where[static_cast<std::size_t>(found->second) - 1].support;
    return held >= 0 && (support == all_supports || structure.supports[static_cast<std::size_t>(held)] == support);
  });
}

// The word for what a place of a clearance moves along.
std::string component_of(const Place& at) {
  return at.point.empty() ? at.component : at.point.substr(at.point.rfind('.') + 1);
}

}  // namespace

double own_share(const NamedStop& stop, std::size_t number) {
  const std::string pointer = fmt::format("/scene/stops/{}/moves_with/component", number);
  if (!stop.side && !stop.motion->component.empty())
    throw InputError(pointer, "a stop moves along its row; only a clearance has a component to move along");
  if (!stop.side) return 1;
  const std::array<std::string, 2> components{component_of(stop.at), component_of(stop.side->across)};
  const std::string& along = stop.motion->component;
  for (const std::size_t axis : {0, 1})
    if (along.empty() || along == components[axis]) return side_direction(stop.side->angle)[axis];
  throw InputError(pointer, fmt::format("\"{}\" is no component of the clearance; expected {} or {}", shortened(along),
                                        components[0], components[1]));
}

std::vector<std::pair<double, int>> carried_by(const SceneSpec& scene, std::size_t number, const MovedSupports& moved) {
  const std::string &carrier = carrier_of(scene, number), pointer = carrier_pointer(scene, number);
  if (carrier.empty()) return {};
  std::vector<std::pair<double, int>> out;
  const auto carry = [&](double share, const std::string& name, int plane) {
    if (share != 0) out.emplace_back(share, motion_of(name, scene, moved, pointer, plane));
  };
  const NamedStop* stop = scene.stops.named.empty() ? nullptr : &scene.stops.named[number];
  const JoinedBodies* bodies = bodies_of(scene.structure);
  const StructureSpec& own = bodies && stop ? bodies->of(stop->at, pointer).alone.structure : scene.structure;
  const auto* given = std::get_if<AssembledSpec>(&own);
  if (!stop || !stop->side || !given) {
    const std::array<double, 2> shares = stop_shares(scene, number);
    for (const int plane : {0, 1}) carry(shares[static_cast<std::size_t>(plane)], carrier, plane);
  } else {
    // A support of a table moves along what it holds. One called "plate.uy" moves the stop that moves with "plate".
    const std::vector<std::string> names = support_names(own);
    const std::array<double, 2> shares = side_direction(stop->side->angle);
    const std::array<std::string, 2> components{component_of(stop->at), component_of(stop->side->across)};
    bool any = false;
    for (const std::size_t axis : {0, 1}) {
      std::string name = carrier + "." + components[axis];
      if (std::find(names.begin(), names.end(), name) == names.end()) {
        if (!holds(*given->structure, carrier, components[axis])) continue;
        name = carrier;
      }
      any = true;
      carry(shares[axis], name, 0);
    }
    if (!any) {
      motion_of(carrier, scene, moved, pointer, 0);
      throw InputError(pointer, fmt::format("nothing tells along what support \"{0}\" moves in the plane of the "
                                            "clearance; expected one that holds {1} or {2}, or is called {0}.{1}",
                                            carrier, components[0], components[1]));
    }
  }
  return out;
}

}  // namespace ricochet
