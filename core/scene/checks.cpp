#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <ricochet/contract/errors.hpp>
#include <ricochet/kernels/floating_point.hpp>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/beam.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/checks.hpp>
#include <ricochet/scene/named_stops.hpp>
#include <ricochet/scene/planes.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>
#include <ricochet/scene/supports.hpp>
#include <ricochet/scene/surfaces.hpp>

namespace ricochet {

namespace {

void require(bool holds, const std::string& pointer, const std::string& message) {
  if (!holds) throw InputError(pointer, message);
}

void check_structure(const BeamSpec& beam, int elements) {
  require_positive(beam.length, "length", "the length", "m");
  check_beam(beam, elements);
  require(
      std::isfinite(beam.damping.stiffness) && beam.damping.stiffness >= 0, "/scene/structure/damping/stiffness",
      fmt::format("the stiffness damping α is {:.6g} s; expected a finite number, 0 or above", beam.damping.stiffness));
  require(std::isfinite(beam.damping.mass) && beam.damping.mass >= 0, "/scene/structure/damping/mass",
          fmt::format("the mass damping η is {:.6g} 1/s; expected a finite number, 0 or above", beam.damping.mass));
}

void check_structure(const OscillatorSpec& oscillator, int) {
  require_positive(oscillator.mass, "mass", "the mass", "kg");
  const auto not_negative = [](double value, const char* key, const char* what, const char* unit) {
    require(std::isfinite(value) && value >= 0, std::string("/scene/structure/") + key,
            fmt::format("the {} is {:.6g} {}; expected a finite number, 0 or above", what, value, unit));
  };
  not_negative(oscillator.stiffness, "stiffness", "stiffness", "N/m");
  not_negative(oscillator.damping, "damping", "damping", "N s/m");
  require(std::isfinite(oscillator.force.amplitude), "/scene/structure/force/amplitude",
          "the amplitude of the force is not finite");
  not_negative(oscillator.force.pulsation, "force/pulsation", "pulsation of the force", "rad/s");
  require(std::isfinite(oscillator.force.phase), "/scene/structure/force/phase",
          "the phase of the force is not finite");
}

void check_structure(const BarSpec& bar, int) {
  require_positive(bar.length, "length", "the length", "m");
  require_positive(bar.EA, "EA", "the stiffness EA", "N");
  require_positive(bar.rhoA, "rhoA", "the mass per length ρA", "kg/m");
  for (const double value : {bar.damping.stiffness, bar.damping.mass})
    require(std::isfinite(value) && value >= 0, "/scene/structure/damping",
            "the damping of the bar is not a finite number, 0 or above");
}

void check_structure(const AssembledSpec& spec, int) {
  for (const auto& [value, key, unit] :
       {std::tuple(spec.damping.stiffness, "stiffness", "s"), {spec.damping.mass, "mass", "1/s"}})
    require(std::isfinite(value) && value >= 0, std::string("/scene/structure/damping/") + key,
            fmt::format("the damping is {:.6g} {}; expected a finite number, 0 or above", value, unit));
}

void check_support(const SupportSpec& support) {
  require(std::isfinite(support.amplitude), "/scene/support/amplitude", "the amplitude of the support is not finite");
  require(std::isfinite(support.pulsation) && support.pulsation >= 0, "/scene/support/pulsation",
          fmt::format("the pulsation of the support is {:.6g} rad/s; expected a finite number, 0 or above",
                      support.pulsation));
  require(std::isfinite(support.phase), "/scene/support/phase", "the phase of the support is not finite");
}

void check_variables(const SceneSpec& scene) {
  const auto only_x = [](const Formula& formula, const std::string& pointer, const char* what) {
    require(!formula.uses_t(), pointer,
            fmt::format("the formula \"{}\" depends on t; expected {} as a formula in x only",
                        shortened(formula.text()), what));
  };
  if (scene.stops.lower) only_x(*scene.stops.lower, "/scene/stops/lower", "a stop");
  if (scene.stops.upper) only_x(*scene.stops.upper, "/scene/stops/upper", "a stop");
  only_x(scene.initial.displacement, "/scene/initial/displacement", "the initial displacement");
  only_x(scene.initial.velocity, "/scene/initial/velocity", "the initial velocity");
  const auto* beam = std::get_if<BeamSpec>(&scene.structure);
  for (const auto& [formula, key] :
       {std::pair(&scene.initial.displacement_z, "displacement_z"), {&scene.initial.velocity_z, "velocity_z"}})
    require(formula->is_zero() || (beam && beam->planes == 2), std::string("/scene/initial/") + key,
            "only a beam of planes 2 moves along uz; expected 0");
}

std::string load_pointer(std::size_t term, const char* key) {
  return fmt::format("/scene/load/{}/{}", term, key);
}

}  // namespace

bool on_free_part(const SceneSpec& scene, double x) {
  return x >= 0 && x <= structure_length(scene) && !displacement_held(scene, x);
}
std::string free_part(const SceneSpec& scene) {
  const double length = structure_length(scene);
  std::string text = fmt::format("0 {} x {} {:.6g} m", displacement_held(scene, 0) ? "<" : "≤",
                                 displacement_held(scene, length) ? "<" : "≤", length);
  for (const HeldPlace& place : held_places(scene))
    if (place.displacement && place.x > 0 && place.x < length) return text + ", apart from the supports";
  return text;
}

namespace {

/// Every term acts somewhere, and is finite there at t = 0.
void check_load(const SceneSpec& scene, const FiniteElementSpace& space) {
  const bool oscillator = std::holds_alternative<OscillatorSpec>(scene.structure);
  for (std::size_t k = 0; k < scene.load.terms.size(); ++k) {
    const LoadTerm& term = scene.load.terms[k];
    const char* one_point = "an oscillator has one point, x = 0; expected an entry {\"force\": formula in t, in N}";
    require(!oscillator || term.force, load_pointer(k, "shape"), one_point);
    require(!oscillator || term.at.value_or(0) == 0, load_pointer(k, "at"), one_point);
    require(!term.place || term.force, load_pointer(k, "body"),
            "the scene has one structure; expected no body of the load");
    require(!term.place, load_pointer(k, "at"),
            fmt::format("the {} has no nodes that are called; expected x in m", space.structure));
    require(oscillator || !term.force || term.at, load_pointer(k, "at"),
            "missing; expected where the force acts, x in m");
    if (term.at) {
      const double x = *term.at;
      if (check_force_across(scene, space, k)) continue;
      const bool held = displacement_held(scene, x);
      require(on_free_part(scene, x), load_pointer(k, "at"),
              fmt::format("a force at x = {:.6g} m {}; expected {}", x,
                          held ? "would act where the structure is held" : "is beyond the " + space.structure,
                          free_part(scene)));
    }
    term.history(0, 0);
    if (term.force) continue;
    plane_shares(term.towards, !space.across.empty(), fmt::format("/scene/load/{}", k));
    for (const auto& element : space.elements)
      for (const auto& point : gauss_points()) term.shape(element.left + point.xi * element.length);
  }
}

void check_positions(const SceneSpec& scene) {
  const bool touched = scene.stops.lower || scene.stops.upper;
  require(!touched || scene.stops.place != StopsSpec::Place::tip || structure_length(scene) == 0 ||
              !displacement_held(scene, 0) || !displacement_held(scene, structure_length(scene)),
          "/scene/stops/at", "the beam is held at both ends and has no tip; expected a list of positions x");
  if (scene.stops.place != StopsSpec::Place::positions) return;
  const auto& positions = scene.stops.positions;
  const double length = structure_length(scene);
  require(!std::holds_alternative<OscillatorSpec>(scene.structure), "/scene/stops/at",
          "an oscillator has one point, its tip; expected \"tip\"");
  require(!positions.empty(), "/scene/stops/at", "the list of positions is empty; expected at least one x");
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const std::string pointer = fmt::format("/scene/stops/at/{}", i);
    const double x = positions[i];
    require(on_free_part(scene, x), pointer,
            fmt::format("a stop at x = {:.6g} m is not on the free part of the structure; expected {}", x,
                        free_part(scene)));
    for (std::size_t j = 0; j < i; ++j)
      require(std::abs(positions[i] - positions[j]) > 1e-9 * length, pointer,
              fmt::format("two stops at x = {:.6g} m; expected different positions", positions[i]));
  }
}

/// Where a stop may be touched: the contact points, and between nodes when there is one at every node (a finer mesh
/// would touch there).
std::vector<double> touchable(const SceneSpec& scene, int elements) {
  std::vector<double> x = contact_positions(scene, elements);
  if (x.empty() || scene.stops.place != StopsSpec::Place::nodes || structure_length(scene) == 0) return x;
  constexpr int fine = 200;
  const auto between = node_positions(structure_length(scene), fine);
  std::copy_if(between.begin(), between.end(), std::back_inserter(x),
               [&](double place) { return !displacement_held(scene, place); });
  std::sort(x.begin(), x.end());
  return x;
}

bool pushed_back(const ForceBeyond& beyond, double depth) {
  return beyond && beyond(depth);
}

/// Stops that pass each other leave a point no place that is beyond neither.
void check_order(const std::vector<double>& x, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                 const ForceBeyond& beyond) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (lower[row] <= upper[row] || pushed_back(beyond, 0.5 * (lower[row] - upper[row]))) continue;
    throw BeyondStop("/scene/stops/lower",
                     fmt::format("at x = {:.6g} m the lower stop, {:.6g} m, is above the upper stop, {:.6g} m. "
                                 "Expected lower ≤ upper everywhere, or a compliant law that lets points pass both",
                                 x[i], lower[row], upper[row]));
  }
}

/// With a stop along the whole structure what is held lies between the stops too, wherever the support takes it. It may
/// pass where a law lets points pass.
void check_held(const SceneSpec& scene, const HeldPlace& place, const ForceBeyond& beyond) {
  const double clamp = place.x;
  const double lower = scene.stops.lower ? (*scene.stops.lower)(clamp) : -infinity;
  const double upper = scene.stops.upper ? (*scene.stops.upper)(clamp) : infinity;
  const bool moves = scene.support.pulsation != 0;
  const double start = support_at_start(scene.support).position;
  const double highest = moves ? std::abs(scene.support.amplitude) : start, lowest = moves ? -highest : start;
  if (lower <= lowest && highest <= upper) return;
  if (pushed_back(beyond, std::max(lower - lowest, highest - upper))) return;
  const bool above = highest > upper;
  const char* side = above ? "upper" : "lower";
  const double stop = above ? upper : lower, reached = above ? highest : lowest;
  if (scene.support.amplitude == 0)
    throw BeyondStop(fmt::format("/scene/stops/{}", side),
                     fmt::format("the {} stop at x = {:.6g} is at {:.6g} m, beyond {} at 0 m; expected lower "
                                 "≤ 0 ≤ upper there",
                                 side, clamp, stop, place.name));
  throw BeyondStop("/scene/support/amplitude",
                   fmt::format("the support takes {} to {:.6g} m, through the {} stop at {:.6g} m (x = {:.6g}); "
                               "expected an amplitude of at most {:.6g} m",
                               place.name, reached, side, stop, clamp, std::max(0.0, std::min(-lower, upper))));
}

}  // namespace

double structure_length(const SceneSpec& scene) {
  if (const auto* beam = std::get_if<BeamSpec>(&scene.structure)) return beam->length;
  if (const auto* bar = std::get_if<BarSpec>(&scene.structure)) return bar->length;
  return 0;
}

std::vector<HeldPlace> held_places(const SceneSpec& scene) {
  std::vector<HeldPlace> places;
  if (const auto* beam = std::get_if<BeamSpec>(&scene.structure)) {
    for (const BeamSupport& support : supports_of(*beam))
      if (support.in_plane[0] && (support.holds_displacement() || support.holds_rotation()))
        places.push_back({support.x, support.holds_displacement(), support.holds_rotation(),
                          beam->supports ? "the support " + support.name : "the clamp"});
  } else if (const auto* bar = std::get_if<BarSpec>(&scene.structure); bar && bar->fixed != BarSpec::Fixed::none) {
    places.push_back({bar->fixed == BarSpec::Fixed::left ? 0 : bar->length, true, false, "the clamp"});
  }
  return places;
}

bool displacement_held(const SceneSpec& scene, double x) {
  if (const auto* bar = std::get_if<BarSpec>(&scene.structure))
    return (bar->fixed == BarSpec::Fixed::left && x == 0) || (bar->fixed == BarSpec::Fixed::right && x == bar->length);
  const auto* beam = std::get_if<BeamSpec>(&scene.structure);
  if (!beam) return false;
  if (!beam->supports) return x == 0;
  const double rounding = one_place * beam->length;
  return std::any_of(beam->supports->begin(), beam->supports->end(), [&](const BeamSupport& support) {
    return support.in_plane[0] && support.holds_displacement() && std::abs(support.x - x) <= rounding;
  });
}

double tip_position(const SceneSpec& scene) {
  const auto* bar = std::get_if<BarSpec>(&scene.structure);
  if (bar) return bar->fixed != BarSpec::Fixed::left ? 0 : bar->length;
  const double length = structure_length(scene);
  if (length == 0 || !displacement_held(scene, length)) return length;
  if (!displacement_held(scene, 0)) return 0;
  std::vector<double> held;
  for (const HeldPlace& place : held_places(scene))
    if (place.displacement) held.push_back(place.x);
  std::sort(held.begin(), held.end());
  double middle = 0, longest = 0;
  for (std::size_t i = 0; i + 1 < held.size(); ++i)
    if (const double span = held[i + 1] - held[i]; span > (1 + one_place) * longest) {
      longest = span;
      middle = held[i] + span / 2;
    }
  return middle;
}

double shown_position(const SceneSpec& scene) {
  return !scene.points.empty() && scene.points.front().at.x ? *scene.points.front().at.x : tip_position(scene);
}

std::vector<double> mesh_nodes(const SceneSpec& scene, int elements) {
  if (const auto* beam = std::get_if<BeamSpec>(&scene.structure)) return beam_nodes(*beam, elements);
  if (structure_length(scene) == 0) return {};
  return node_positions(structure_length(scene), elements);
}

std::vector<double> contact_positions(const SceneSpec& scene, int elements) {
  if (!scene.stops.named.empty()) return named_positions(scene.stops);
  if (!scene.stops.lower && !scene.stops.upper) return {};
  if (scene.stops.place == StopsSpec::Place::tip || structure_length(scene) == 0) return {tip_position(scene)};
  if (scene.stops.place == StopsSpec::Place::positions) return scene.stops.positions;
  std::vector<double> nodes = mesh_nodes(scene, elements);
  std::erase_if(nodes, [&](double x) { return displacement_held(scene, x); });
  return nodes;
}

SupportMotion support_at_start(const SupportSpec& support) {
  const double w = support.pulsation, in_phase = support.amplitude * std::sin(support.phase),
               quadrature = support.amplitude * std::cos(support.phase);
  return {in_phase, w * quadrature, -w * w * in_phase, -w * w * w * quadrature};
}

Eigen::VectorXd stop_values(const std::optional<Formula>& stop, const std::vector<double>& x, double absent) {
  Eigen::VectorXd values = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(x.size()), absent);
  if (stop)
    for (std::size_t i = 0; i < x.size(); ++i) values[static_cast<Eigen::Index>(i)] = (*stop)(x[i]);
  return values;
}

namespace {

// Formulas give numbers at nodes and Gauss points.
void check_fields(const SceneSpec& scene, const FiniteElementSpace& space, int elements) {
  for (double node : mesh_nodes(scene, elements)) {
    scene.initial.displacement(node);
    scene.initial.velocity(node);
    scene.initial.displacement_z(node);
    scene.initial.velocity_z(node);
  }
  for (const auto& element : space.elements)
    for (const auto& point : gauss_points()) scene.load.formula(element.left + point.xi * element.length, 0);
  scene.load.formula(tip_position(scene), 0);
  check_load(scene, space);
}

}  // namespace

void check_structure_alone(const SceneSpec& scene, int elements) {
  std::visit([&](const auto& structure) { check_structure(structure, elements); }, scene.structure);
  check_magnitudes(scene, elements);
}

void check_scene(const SceneSpec& shared, int elements, const ForceBeyond& beyond) {
  // Formulas keep their variables inside: evaluate our own copies.
  const SceneSpec scene = on_mesh(shared, elements);
  std::visit([&](const auto& structure) { check_structure(structure, elements); }, scene.structure);
  const auto space = make_space(scene.structure, elements);
  check_support(scene.support);
  check_motions(scene);
  check_magnitudes(scene, elements);
  check_variables(scene);
  if (!scene.stops.named.empty()) check_named_stops(scene, space, beyond);
  require(!scene.initial.equilibrium || (scene.initial.displacement.is_zero() && scene.initial.dofs.empty()),
          "/scene/initial/equilibrium", "stands beside a displacement; expected one of both");
  check_points(scene, space);
  check_surfaces(scene, space);
  if (std::holds_alternative<AssembledSpec>(scene.structure)) return check_assembled(scene, space, beyond);
  require(scene.initial.dofs.empty(), "/scene/initial/file",
          fmt::format("the {} begins as formulas in x say; expected displacement and velocity", space.structure));
  check_positions(scene);
  if (const auto* bar = std::get_if<BarSpec>(&scene.structure))
    require(bar->fixed != BarSpec::Fixed::none || scene.support.amplitude == 0, "/scene/support/amplitude",
            "a bar with two free ends has no clamp that could move; expected an amplitude of 0");
  if (const auto* beam = std::get_if<BeamSpec>(&scene.structure))
    require(
        scene.support.amplitude == 0 || !rigid_freedom(*beam).translates, "/scene/support/amplitude",
        "no support of the beam would move it; expected an amplitude of 0, or a clamped, pinned or elastic support");

  if (moves_by_histories(scene) || scene.initial.equilibrium) {
    // discretise() knows where the stops are at t = 0.
  } else if (scene.stops.named.empty()) {
    const auto x = touchable(scene, elements);
    const auto lower = stop_values(scene.stops.lower, x, -infinity);
    const auto upper = stop_values(scene.stops.upper, x, infinity);
    check_order(x, lower, upper, beyond);
    if (scene.stops.place == StopsSpec::Place::nodes)
      for (const HeldPlace& place : held_places(scene))
        if (place.displacement) check_held(scene, place, beyond);
    Eigen::VectorXd start(static_cast<Eigen::Index>(x.size()));
    for (std::size_t i = 0; i < x.size(); ++i) start[static_cast<Eigen::Index>(i)] = scene.initial.displacement(x[i]);
    check_between_stops(x, start, lower, upper, "/scene/initial/displacement", "the initial displacement", beyond);
  } else {
    check_named_start(scene, space, beyond);
  }
  check_fields(scene, space, elements);
}

}  // namespace ricochet
