#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <ricochet/contract/errors.hpp>
#include <ricochet/kernels/floating_point.hpp>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/checks.hpp>
#include <ricochet/scene/clearances.hpp>
#include <ricochet/scene/named_stops.hpp>
#include <ricochet/scene/planes.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>
#include <ricochet/scene/supports.hpp>

namespace ricochet {
namespace {

const AssembledStructure* assembled_of(const SceneSpec& scene) {
  const auto* spec = std::get_if<AssembledSpec>(&scene.structure);
  return spec ? spec->structure.get() : nullptr;
}

std::string stop_pointer(std::size_t number, const char* key) {
  return fmt::format("/scene/stops/{}{}", number, key);
}

void check_bounds(const NamedStop& stop, std::size_t number, const ForceBeyond& beyond) {
  if (stop.normal_force) {
    if (stop.lower || stop.upper || stop.side)
      throw InputError(stop_pointer(number, "/normal_force"),
                       fmt::format("stop {} has a normal force and bounds; expected one of them", stop.name));
    if (!stop.friction)
      throw InputError(
          stop_pointer(number, "/normal_force"),
          fmt::format("stop {} has a normal force and no friction: nothing acts there; expected friction", stop.name));
    return;
  }
  if (!stop.lower && !stop.upper)
    throw InputError(stop_pointer(number, ""),
                     fmt::format("stop {} has no bound; expected lower, upper or both, in m", stop.name));
  if (stop.lower && stop.upper && *stop.lower > *stop.upper && !(beyond && beyond(0.5 * (*stop.lower - *stop.upper))))
    throw BeyondStop(stop_pointer(number, "/lower"),
                     fmt::format("stop {}: lower {:.6g} m > upper {:.6g} m. Expected lower ≤ upper, or a compliant law "
                                 "that lets points pass both",
                                 stop.name, *stop.lower, *stop.upper));
}

void check_friction(const NamedStop& stop, std::size_t number) {
  if (stop.across && stop.side)
    throw InputError(stop_pointer(number, "/tangent"),
                     fmt::format("stop {} is a clearance, which has its own tangents; expected one object", stop.name));
  for (const auto* tangent : {&stop.tangent, &stop.across})
    if (*tangent && !(*tangent)->given() && !stop.normal_force && !stop.side)
      throw InputError(
          stop_pointer(number, "/tangent"),
          fmt::format("the tangent of stop {} says nothing; expected slope_radius, direction or component", stop.name));
  if (!stop.friction) return;
  const FrictionSpec& mu = *stop.friction;
  if (mu.held < mu.sliding)
    throw InputError(stop_pointer(number, "/friction/static"),
                     fmt::format("static {:g} is below dynamic {:g}; expected static ≥ dynamic", mu.held, mu.sliding));
  if (stop.side) return;
  if (stop.normal_force) {
    if (stop.across || (stop.tangent && stop.tangent->given()))
      throw InputError(stop_pointer(number, "/tangent"),
                       fmt::format("stop {} has a normal force: what slides is its own displacement; expected speed "
                                   "alone, or no tangent",
                                   stop.name));
    return;
  }
  if (!stop.tangent || !stop.tangent->given())
    throw InputError(stop_pointer(number, "/friction"),
                     fmt::format("stop {} has no tangent: nothing slides there; expected a tangent", stop.name));
}

}  // namespace

void check_name(const std::string& name, const std::string& pointer) {
  const auto allowed = [](unsigned char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_';
  };
  constexpr std::size_t longest = 40;
  if (name.empty() || name.size() > longest || !std::all_of(name.begin(), name.end(), allowed))
    throw InputError(pointer, fmt::format("\"{}\"; expected a name of 1 to {} letters, digits, '-' or '_'",
                                          shortened(name), longest));
}

namespace {

// What a beam, a bar or an oscillator has at x: of two planes, a sum of what each has.
PlaceRow beam_row(const SceneSpec& scene, const FiniteElementSpace& space, const Place& place, ShapeOf what,
                  const std::string& pointer) {
  const std::array<double, 2> shares = plane_shares(place, !space.across.empty(), pointer);
  const std::vector<double> supports = support_places(scene.structure);
  const std::size_t count = space.across.empty() ? supports.size() : supports.size() / 2;
  PlaceRow out;
  out.x = *place.x;
  for (const int plane : {0, 1}) {
    const double share = shares[static_cast<std::size_t>(plane)];
    if (share == 0) continue;
    const FiniteElementSpace own = plane_elements(space, plane);
    const auto first = static_cast<std::ptrdiff_t>(plane == 0 ? 0 : count);
    const std::vector<double> places(supports.begin() + first,
                                     supports.begin() + first + static_cast<std::ptrdiff_t>(count));
    for (const auto& [dof, value] : displacement_row(own, out.x, what)) out.free.emplace_back(dof, share * value);
    for (const auto& [support, weight] : held_by(places, own, out.x, what))
      out.held.emplace_back(support + static_cast<int>(first), share * weight);
  }
  std::sort(out.free.begin(), out.free.end());
  return out;
}

}  // namespace

std::array<double, 2> stop_shares(const SceneSpec& scene, std::size_t stop) {
  if (scene.stops.named.empty()) return {1, 0};
  const NamedStop& one = scene.stops.named[stop];
  const JoinedBodies* bodies = bodies_of(scene.structure);
  const auto* beam =
      std::get_if<BeamSpec>(bodies ? &bodies->of(one.at, stop_pointer(stop, "/at")).alone.structure : &scene.structure);
  if (!beam) return {1, 0};
  const auto shares_at = [&](const Place& place) {
    return plane_shares(place, beam->planes == 2, stop_pointer(stop, "/at"));
  };
  std::array<double, 2> shares = shares_at(one.at);
  if (!one.side) return shares;
  const std::array<double, 2> across = shares_at(one.side->across);
  const auto [first, second] = side_direction(one.side->angle);
  for (const std::size_t p : {0, 1}) shares[p] = first * shares[p] + second * across[p];
  return shares;
}

PlaceRow place_row(const SceneSpec& scene, const FiniteElementSpace& space, const Place& place,
                   const std::string& pointer) {
  const AssembledStructure* assembled = assembled_of(scene);
  if (!place.body.empty() && !(assembled && assembled->joined))
    throw InputError(pointer + "/body",
                     fmt::format("\"{}\" in a scene of one structure; expected no body", shortened(place.body)));
  if (assembled) return assembled->row(place, pointer);
  if (!place.x)
    throw InputError(pointer, fmt::format("the {} has no nodes that are called; expected {{\"x\": position in m}}",
                                          space.structure));
  const double length = structure_length(scene), x = *place.x;
  if (!(x >= 0 && x <= length))
    throw InputError(pointer + "/x",
                     fmt::format("{:.6g} m is beyond the {}; expected 0 to {:.6g} m", x, space.structure, length));
  return beam_row(scene, space, place, ShapeOf::displacement, pointer);
}

PlaceRow section_row(const SceneSpec& scene, const FiniteElementSpace& space, const Place& place, ShapeOf what,
                     const std::string& pointer) {
  if (const JoinedBodies* bodies = bodies_of(scene.structure))
    return bodies->row(place, pointer, [&](const SceneSpec& alone, const FiniteElementSpace& own, const Place& there) {
      return section_row(alone, own, there, what, pointer);
    });
  if (!std::holds_alternative<BeamSpec>(scene.structure) || !place.x)
    throw InputError(pointer, fmt::format("nothing bends in this {}; expected a beam", space.structure));
  place_row(scene, space, place, pointer);
  return beam_row(scene, space, place, what, pointer);
}

PlaceRow stop_row(const SceneSpec& scene, const FiniteElementSpace& space, const NamedStop& stop, std::size_t number) {
  if (stop.side) return side_row(scene, space, stop, number);
  const PlaceRow at = place_row(scene, space, stop.at, stop_pointer(number, "/at"));
  return stop.to ? difference(at, place_row(scene, space, *stop.to, stop_pointer(number, "/to"))) : at;
}

bool check_force_across(const SceneSpec& scene, const FiniteElementSpace& space, std::size_t k) {
  const LoadTerm& term = scene.load.terms[k];
  const std::string pointer = fmt::format("/scene/load/{}/at", k);
  if (plane_shares(term.towards, !space.across.empty(), pointer)[1] == 0) return false;
  Place place = term.towards;
  place.x = term.at;
  if (place_row(scene, space, place, pointer).free.empty())
    throw InputError(pointer, "the force acts where the structure is held: nothing there can move");
  term.history(0, 0);
  return true;
}

ContactPoints contact_points(const SceneSpec& scene, const FiniteElementSpace& space, int elements) {
  ContactPoints out;
  const auto supports = static_cast<Eigen::Index>(support_names(scene.structure).size());
  if (scene.stops.named.empty()) {
    out.x = contact_positions(scene, elements);
    out.rows = displacement_rows(space, out.x);
    out.lower = stop_values(scene.stops.lower, out.x, -infinity);
    out.upper = stop_values(scene.stops.upper, out.x, infinity);
    out.on_supports = Eigen::MatrixXd::Zero(out.rows.rows(), supports);
    const std::vector<double> places = support_places(scene.structure);
    for (std::size_t i = 0; i < out.x.size(); ++i)
      for (const auto& [support, weight] : held_by(places, space, out.x[i]))
        out.on_supports(static_cast<Eigen::Index>(i), support) += weight;
    return out;
  }
  const auto count = static_cast<Eigen::Index>(scene.stops.named.size());
  out.lower = Eigen::VectorXd::Constant(count, -infinity);
  out.upper = Eigen::VectorXd::Constant(count, infinity);
  out.on_supports = Eigen::MatrixXd::Zero(count, supports);
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index i = 0; i < count; ++i) {
    const NamedStop& stop = scene.stops.named[static_cast<std::size_t>(i)];
    const PlaceRow row = stop_row(scene, space, stop, static_cast<std::size_t>(i));
    for (const auto& [dof, value] : row.free) entries.emplace_back(static_cast<int>(i), dof, value);
    for (const auto& [support, weight] : row.held) out.on_supports(i, support) += weight;
    if (stop.side && stop.side->circle && stop.side->number == 0) out.circles.push_back(static_cast<int>(i));
    out.x.push_back(row.x);
    out.names.push_back(stop.name);
    if (stop.lower) out.lower[i] = *stop.lower;
    if (stop.upper) out.upper[i] = *stop.upper;
  }
  out.rows.resize(count, space.dofs);
  out.rows.setFromTriplets(entries.begin(), entries.end());
  const auto& named = scene.stops.named;
  if (std::any_of(named.begin(), named.end(), [](const NamedStop& stop) { return stop.own.any(); }))
    for (const NamedStop& stop : named) out.own.push_back(stop.own);
  return out;
}

std::vector<double> named_positions(const StopsSpec& stops) {
  std::vector<double> x;
  for (const NamedStop& stop : stops.named) x.push_back(stop.at.x.value_or(0));
  return x;
}

PlaceRow given_tip(const AssembledSpec& spec, const SceneSpec& scene) {
  if (!scene.points.empty()) return spec.structure->row(scene.points.front().at, "/scene/points/0/at");
  if (spec.tip) return spec.structure->row(*spec.tip, "/scene/structure/tip");
  if (!scene.stops.named.empty()) return spec.structure->row(scene.stops.named.front().at, "/scene/stops/0/at");
  for (std::size_t k = 0; k < scene.load.terms.size(); ++k)
    if (scene.load.terms[k].place)
      return spec.structure->row(*scene.load.terms[k].place, fmt::format("/scene/load/{}/at", k));
  throw InputError("/scene/structure/tip",
                   "missing; without stops and loads expected the place whose displacement is shown");
}

SparseRows tip_row(const SceneSpec& scene, const FiniteElementSpace& space) {
  const auto* spec = std::get_if<AssembledSpec>(&scene.structure);
  if (!spec) return displacement_rows(space, {shown_position(scene)});
  SparseRows row(1, space.dofs);
  for (const auto& [dof, value] : given_tip(*spec, scene).free) row.insert(0, dof) = value;
  row.makeCompressed();
  return row;
}

void show_tip(const SceneSpec& scene, SemiDiscrete& problem) {
  problem.tip = tip_row(scene, problem.space);
  problem.tip_on_supports = problem.tip * problem.static_modes;
  if (const auto* spec = std::get_if<AssembledSpec>(&scene.structure))
    for (const auto& [support, weight] : given_tip(*spec, scene).held) problem.tip_on_supports[support] += weight;
}

std::string tip_choice(const SceneSpec& scene) {
  const auto* spec = std::get_if<AssembledSpec>(&scene.structure);
  if (!spec || spec->tip || !scene.points.empty()) return "";
  return scene.stops.named.empty() ? "the place of the first load" : "the place of stop " + scene.stops.named[0].name;
}

void check_named_stops(const SceneSpec& scene, const FiniteElementSpace& space, const ForceBeyond& beyond) {
  std::map<std::string, std::size_t> names;
  for (std::size_t i = 0; i < scene.stops.named.size(); ++i) {
    const NamedStop& stop = scene.stops.named[i];
    check_name(stop.name, stop_pointer(i, "/name"));
    if (const auto [first, fresh] = names.emplace(stop.name, i);
        !fresh && !(stop.side && scene.stops.named[first->second].entry == stop.entry))
      throw InputError(stop_pointer(i, "/name"), fmt::format("two stops are called \"{}\"", stop.name));
    check_bounds(stop, i, beyond);
    check_friction(stop, i);
    if (stop.side && stop.side->number == 0) check_clearance(scene, space, stop, i);
    if (stop.to && scene.support.amplitude != 0 && !space.given)
      throw InputError(stop_pointer(i, "/to"),
                       fmt::format("stop {} is between two points of a structure whose clamp moves; expected an "
                                   "amplitude of 0, or a stop on the ground",
                                   stop.name));
    if (stop_row(scene, space, stop, i).free.empty())
      throw InputError(
          stop_pointer(i, "/at"),
          stop.to == stop.at
              ? fmt::format("stop {} joins a place to itself; expected two places, or no `to`", stop.name)
          : stop.to ? fmt::format("stop {} joins two held dofs: nothing there can move", stop.name)
          : !stop.at.dofs.empty()
              ? fmt::format("stop {}: nothing there can move: its dofs are held, or their weights are 0 or cancel",
                            stop.name)
              : fmt::format("stop {} is where the structure is held: nothing there can move", stop.name));
  }
}

namespace {

// The initial displacement of a beam, a bar or an oscillator at a place, m.
double initial_at(const SceneSpec& scene, const Place& place) {
  const std::array<double, 2> shares = plane_shares(place, true, "");
  double sum = 0;
  if (shares[0] != 0) sum += shares[0] * scene.initial.displacement(*place.x);
  if (shares[1] != 0) sum += shares[1] * scene.initial.displacement_z(*place.x);
  return sum;
}

}  // namespace

void check_named_start(const SceneSpec& scene, const FiniteElementSpace& space, const ForceBeyond& beyond) {
  const ContactPoints points = contact_points(scene, space, 1);
  Eigen::VectorXd start(points.rows.rows());
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    const NamedStop& stop = scene.stops.named[i];
    double& at = start[static_cast<Eigen::Index>(i)];
    at = initial_at(scene, stop.at) - (stop.to ? initial_at(scene, *stop.to) : 0);
    if (!stop.side) continue;
    const auto& [across, across_to] = std::tie(stop.side->across, stop.side->across_to);
    const auto [first, second] = side_direction(stop.side->angle);
    at = first * at + second * (initial_at(scene, across) - (across_to ? initial_at(scene, *across_to) : 0));
  }
  check_between_stops(points.x, start, points.lower, points.upper, "/scene/initial/displacement",
                      "the initial displacement", beyond, points.names, points.circles);
}

Eigen::VectorXd initial_dofs(const AssembledStructure& structure, const InitialSpec& initial, double DofState::*value) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(structure.dofs());
  for (const DofState& state : initial.dofs)
    if (const int free = structure.where[static_cast<std::size_t>(state.dof) - 1].free; free >= 0)
      out[free] = state.*value;
  return out;
}

void check_given_initial(const AssembledStructure& structure, const InitialSpec& initial, const std::string& no_x) {
  for (const auto& [formula, key] : {std::pair(&initial.displacement, "displacement"), {&initial.velocity, "velocity"}})
    if (!formula->is_zero()) throw InputError(fmt::format("/scene/initial/{}", key), no_x);
  for (const DofState& state : initial.dofs)
    if (structure.where[static_cast<std::size_t>(state.dof) - 1].free < 0 &&
        (state.displacement != 0 || state.velocity != 0))
      throw InputError("/scene/initial/file",
                       fmt::format("dof {} is held, and would begin at {:.6g} with {:.6g}; expected 0 and 0", state.dof,
                                   state.displacement, state.velocity));
}

void check_assembled(const SceneSpec& scene, const FiniteElementSpace& space, const ForceBeyond& beyond) {
  const bool modal = assembled_of(scene)->modes.has_value(), bodies = assembled_of(scene)->joined != nullptr;
  const std::string no_x = bodies ? "bodies have no x in common; expected "
                                  : (modal ? "a " : "an ") + space.structure + " has no x; expected ";
  if (scene.support.amplitude != 0 && assembled_of(scene)->supports.empty())
    throw InputError("/scene/support/amplitude",
                     "the table of dofs names no support that could move; expected an amplitude of 0");
  if (scene.stops.lower || scene.stops.upper)
    throw InputError("/scene/stops", no_x + "a list of stops with name and place");
  if (!scene.load.formula.is_zero())
    throw InputError("/scene/load", no_x + "a list of entries {\"at\": place, \"force\": F(t)}");
  check_given_initial(*assembled_of(scene), scene.initial,
                      no_x + (bodies ? "an object by body, or equilibrium" : "0, or the file of an initial state"));
  if (bodies) check_initial_of_bodies(*assembled_of(scene)->joined, scene.initial);
  for (std::size_t k = 0; k < scene.load.terms.size(); ++k) {
    const LoadTerm& term = scene.load.terms[k];
    const std::string pointer = fmt::format("/scene/load/{}", k);
    if (bodies && !term.force && term.place) {
      const JoinedBody& body = assembled_of(scene)->joined->of(*term.place, pointer);
      if (body.space.given)
        throw InputError(pointer + "/body", "an assembled body has no x; expected forces at its places");
      for (const double x : mesh_nodes(body.alone, body.elements)) term.shape(x);
      term.history(0, 0);
      continue;
    }
    if (!term.force) throw InputError(pointer + "/shape", no_x + "{\"at\": place, \"force\": F(t)}");
    if (!term.place)
      throw InputError(pointer + "/at",
                       bodies  ? "expected the place of the force: body and its place there"
                       : modal ? "expected the place of the force: point"
                               : "expected the place of the force: node and component, node and direction, or dofs");
    if (place_row(scene, space, *term.place, pointer + "/at").free.empty())
      throw InputError(pointer + "/at", "the force acts where the structure is held: nothing there can move");
    term.history(0, 0);
  }
  tip_row(scene, space);
  if (moves_by_histories(scene) || scene.support.amplitude != 0 || scene.initial.equilibrium)
    return;  // discretise() knows where the stops are at t = 0
  const ContactPoints points = contact_points(scene, space, 1);
  SemiDiscrete begun;
  begun.position = begun.velocity = initial_dofs(*assembled_of(scene), scene.initial, &DofState::displacement);
  if (bodies) begin_bodies(*assembled_of(scene)->joined, scene.initial, begun);
  const Eigen::VectorXd start = points.rows * begun.position;
  const bool by_body = !scene.initial.of_bodies.empty();
  check_between_stops(points.x, start, points.lower, points.upper,
                      by_body                      ? "/scene/initial"
                      : scene.initial.dofs.empty() ? "/scene/stops"
                                                   : "/scene/initial/file",
                      "the initial displacement", beyond, points.names, points.circles);
}

}  // namespace ricochet
