#include "runners/study/read_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/structure/node_layout.hpp>

#include "runners/json/json_text.hpp"
#include "runners/study/body_keys.hpp"
#include "runners/study/histories.hpp"
#include "runners/study/scene_keys.hpp"

namespace ricochet {
namespace {

Formula read_formula(const Json& value, const std::string& pointer, const std::string& variables) {
  if (value.is_number()) return Formula(value.get<double>());
  return Formula(value.get<std::string>(), pointer, variables);
}

std::optional<Place> optional_place(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional(read_place(json));
}

LoadSpec read_load(const Json& value, const std::string& pointer, StudyFiles* files, long long seed) {
  if (!value.is_array()) return read_formula(value, pointer, "xt");
  LoadSpec load;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const std::string here = pointer_to(pointer, i);
    LoadTerm& term = load.terms.emplace_back();
    term.force = value[i].contains("force");
    if (term.force && value[i].at("at").is_number()) term.at = value[i].at("at").get<double>();
    if (term.force && value[i].at("at").is_object()) {
      const Place place = read_place(value[i].at("at"));
      if (place.x && place.body.empty()) {
        term.at = place.x;
        term.towards.component = place.component;
        term.towards.direction = place.direction;
      } else {
        term.place = place;
      }
    }
    if (!term.force && !value[i].value("body", "").empty())
      term.place.emplace().body = value[i].at("body").get<std::string>();
    if (!term.force) term.towards.component = value[i].value("component", "");
    if (!term.force) term.shape = read_formula(value[i].at("shape"), here + "/shape", "x");
    const char* history = term.force ? "force" : "time";
    const Json& given = value[i].at(history);
    if (given.is_object())
      read_load_history(given, here + "/" + history, files, seed, i, term);
    else
      term.history = read_formula(given, here + "/" + history, "t");
  }
  return load;
}

Section read_section(const Json& json) {
  Section section;
  const auto type = json.at("type").get<std::string>();
  if (type == "tube") {
    section.type = Section::Type::tube;
    section.outer_diameter = json.at("outer_diameter").get<double>();
    section.wall = json.at("wall").get<double>();
  } else if (type == "circle") {
    section.type = Section::Type::circle;
    section.diameter = json.at("diameter").get<double>();
  } else if (type == "rectangle") {
    section.type = Section::Type::rectangle;
    section.width = json.at("width").get<double>();
    section.height = json.at("height").get<double>();
  } else {
    section.type = Section::Type::given;
    section.EI = json.at("EI").get<double>();
    section.rhoS = json.at("rhoS").get<double>();
    section.EI_z = json.value("EI_z", 0.0);
  }
  return section;
}

Damping read_damping(const Json& json) {
  Damping damping{json.at("stiffness").get<double>(), json.at("mass").get<double>()};
  const auto given = [&](const char* key) { return json.contains(key) && !json.at(key).is_null(); };
  if (given("ratios")) damping.ratios = json.at("ratios").get<std::vector<double>>();
  if (given("beyond")) damping.beyond = json.at("beyond").get<double>();
  if (given("ratio")) damping.beyond = json.at("ratio").get<double>();
  if (given("ratio") && (given("ratios") || given("beyond")))
    throw InputError("/scene/structure/damping/ratio", "stands beside ratios; expected one of both");
  if (given("beyond") && !given("ratios"))
    throw InputError("/scene/structure/damping/beyond", "has no ratios before it; expected ratios, or ratio alone");
  const bool file = !json.value("file", "").empty();
  if (file && (damping.by_modes() || damping.stiffness != 0 || damping.mass != 0))
    throw InputError("/scene/structure/damping/file",
                     "C of a file stands beside other damping; expected one of both, a file or numbers");
  if (damping.by_modes() && (damping.stiffness != 0 || damping.mass != 0))
    throw InputError("/scene/structure/damping",
                     "α or η stand beside damping ratios; expected one of both, C = αK + ηM or ratios");
  return damping;
}

/// What a beam, or a length of one, is made of.
template <class Part>
void read_material(const Json& json, Part& part) {
  part.section = read_section(json.at("section"));
  if (part.section.type == Section::Type::given) return;
  part.young = json.at("young").get<double>();
  part.density = json.at("density").get<double>();
}

BeamSupport read_support(const Json& json) {
  using Type = BeamSupport::Type;
  const auto type = json.at("type").get<std::string>();
  return {json.at("name").get<std::string>(),
          json.at("x").get<double>(),
          type == "clamped"   ? Type::clamped
          : type == "pinned"  ? Type::pinned
          : type == "sliding" ? Type::sliding
                              : Type::elastic,
          json.value("stiffness", 0.0),
          json.value("rotation", 0.0),
          read_components(json)};
}

BeamSpec read_beam(const Json& json) {
  BeamSpec beam;
  beam.length = json.at("length").get<double>();
  if (json.contains("section")) read_material(json, beam);
  beam.damping = read_damping(json.at("damping"));
  if (json.contains("supports")) {
    beam.supports.emplace();
    for (const Json& one : json.at("supports")) beam.supports->push_back(read_support(one));
  }
  for (const Json& one : json.value("sections", Json::array())) {
    read_material(one, beam.sections.emplace_back());
    beam.sections.back().to = one.at("to").get<double>();
  }
  for (const Json& one : json.value("masses", Json::array())) {
    const BeamMass mass{one.at("x").get<double>(), one.at("mass").get<double>(), one.at("inertia").get<double>()};
    if (mass.mass == 0 && mass.inertia == 0)
      throw InputError(fmt::format("/scene/structure/masses/{}", beam.masses.size()),
                       "neither a mass nor an inertia; expected one of them");
    beam.masses.push_back(mass);
  }
  beam.planes = json.value("planes", 1);
  beam.added_mass = json.value("added_mass", 0.0);
  beam.tension = json.value("tension", 0.0);
  beam.foundation = json.value("foundation", 0.0);
  if (json.contains("shear")) {
    const Json& shear = json.at("shear");
    beam.shear.emplace();
    beam.shear->poisson = shear.at("poisson").get<double>();
    beam.shear->rotary = shear.at("rotary").get<bool>();
    if (!shear.at("factor").is_null()) beam.shear->factor = shear.at("factor").get<double>();
  }
  return beam;
}

OscillatorSpec read_oscillator(const Json& json) {
  const Json& force = json.at("force");
  return {json.at("mass").get<double>(),
          json.at("stiffness").get<double>(),
          json.at("damping").get<double>(),
          {force.at("amplitude").get<double>(), force.at("pulsation").get<double>(), force.at("phase").get<double>()}};
}

BarSpec read_bar(const Json& json) {
  const auto fixed = json.at("fixed").get<std::string>();
  using Fixed = BarSpec::Fixed;
  return {json.at("length").get<double>(), json.at("EA").get<double>(), json.at("rhoA").get<double>(),
          fixed == "right" ? Fixed::right : (fixed == "left" ? Fixed::left : Fixed::none),
          read_damping(json.at("damping"))};
}

AssembledSpec read_assembled(const Json& json, StudyFiles* files) {
  if (!files) throw InputError("/scene/structure/type", "a scene that names files stands in a study alone");
  return {files->assembled(json), read_damping(json.at("damping")), optional_place(json.at("tip"))};
}

AssembledSpec read_modal(const Json& json, StudyFiles* files) {
  if (!files) throw InputError("/scene/structure/type", "a scene that names files stands in a study alone");
  AssembledSpec spec;
  spec.structure = files->modal(json, spec.damping.ratios);
  spec.tip = optional_place(json.at("tip"));
  return spec;
}

StructureSpec read_structure(const Json& json, StudyFiles* files) {
  const auto type = json.at("type").get<std::string>();
  if (type == "oscillator") return read_oscillator(json);
  if (type == "bar") return read_bar(json);
  if (type == "assembled") return read_assembled(json, files);
  if (type == "modal") return read_modal(json, files);
  return read_beam(json);
}

StopsSpec read_stops(const Json& json, StudyFiles* files) {
  StopsSpec stops;
  if (json.is_array()) {
    const auto bound = [](const Json& value) {
      return value.is_null() ? std::nullopt : std::optional(value.get<double>());
    };
    for (std::size_t i = 0; i < json.size(); ++i) {
      const Json& one = json[i];
      const Json with = one.value("moves_with", Json(""));
      NamedStop stop{one.at("name").get<std::string>(),
                     read_place(one.at("at")),
                     optional_place(one.at("to")),
                     bound(one.at("lower")),
                     bound(one.at("upper")),
                     with.is_string() ? with.get<std::string>() : ""};
      if (!with.is_string())
        stop.motion =
            std::make_shared<const MotionSpec>(read_motion(with, pointer_to("/scene/stops", i) + "/moves_with", files));
      stop.own = read_own(one);
      read_surface(one, pointer_to("/scene/stops", i), files, stop);
      add_stop(std::move(stop), one, i, stops.named);
    }
    return stops;
  }
  if (!json.at("lower").is_null()) stops.lower = read_formula(json.at("lower"), "/scene/stops/lower", "x");
  if (!json.at("upper").is_null()) stops.upper = read_formula(json.at("upper"), "/scene/stops/upper", "x");
  stops.moves_with = json.value("moves_with", "");
  const Json& at = json.at("at");
  if (at.is_string()) {
    stops.place = at == "tip" ? StopsSpec::Place::tip : StopsSpec::Place::nodes;
    return stops;
  }
  stops.place = StopsSpec::Place::positions;
  stops.positions = at.get<std::vector<double>>();
  return stops;
}

}  // namespace

SceneSpec read_scene(const Json& given, StudyFiles* files) {
  SceneSpec spec;
  const Json scene = without_body(given);
  const auto structure = [&](const Json& json) { return read_structure(json, files); };
  spec.structure = scene.contains("bodies") ? read_bodies(scene, structure) : structure(scene.at("structure"));
  spec.stops = read_stops(scene.at("stops"), files);
  const Json& support = scene.at("support");
  spec.support = {support.at("amplitude").get<double>(), support.at("pulsation").get<double>(),
                  support.at("phase").get<double>()};
  spec.load = read_load(scene.at("load"), "/scene/load", files, scene.value("seed", 0LL));
  // An oscillator is its one point.
  if (std::holds_alternative<OscillatorSpec>(spec.structure))
    for (LoadTerm& term : spec.load.terms)
      if (term.at == 0.0 && term.towards == Place{}) term.at.reset();
  const Json motions = scene.value("motions", Json::array());
  for (std::size_t i = 0; i < motions.size(); ++i)
    spec.motions.push_back(read_motion(motions[i], pointer_to("/scene/motions", i), files));
  spec.from_supports = scene.value("frame", "") == "supports";
  spec.initial = read_initial(scene, files);
  spec.points = read_points(scene);
  if (const Json basis = scene.value("basis", Json(nullptr)); !basis.is_null())
    spec.basis = BasisSpec{basis.at("modes").get<int>(), basis.at("residual") == "stops",
                           basis.value("of_bodies", std::vector<int>())};
  if (files) spec.notes = files->notes(given);
  return spec;
}

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
