#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/beam.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/named_stops.hpp>
#include <ricochet/scene/observed_rows.hpp>
#include <ricochet/scene/planes.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>
#include <ricochet/scene/supports.hpp>
#include <tuple>

namespace ricochet {
namespace {

// One support that holds the structure as a whole: its static mode is the translation.
void hold_rigidly(SemiDiscrete& problem) {
  problem.static_modes = Eigen::MatrixXd::Zero(problem.space.dofs, 1);
  const std::vector<DofPlace> places = dof_places(problem.space);
  for (Eigen::Index i = 0; i < problem.space.dofs; ++i)
    problem.static_modes(i, 0) = places[static_cast<std::size_t>(i)].slope ? 0 : 1;
  problem.support_loads = problem.support_shape;
}

void hold(const BeamSpec& beam, int elements, SemiDiscrete& problem) {
  problem.held = rigid_freedom(beam).held();
  if (!beam.supports && beam.foundation == 0 && beam.planes == 1) return hold_rigidly(problem);
  StaticModes found = static_modes(beam, elements);
  problem.static_modes = std::move(found.modes);
  problem.support_loads = std::move(found.loads);
}

void hold(const BarSpec& bar, int, SemiDiscrete& problem) {
  problem.held = bar.fixed != BarSpec::Fixed::none;
  if (problem.held) return hold_rigidly(problem);
  problem.static_modes.resize(problem.space.dofs, 0);
  problem.support_loads.resize(problem.space.dofs, 0);
}

void hold(const OscillatorSpec&, int, SemiDiscrete& problem) {
  problem.static_modes = Eigen::MatrixXd::Ones(1, 1);
  problem.support_loads = problem.support_shape;
}

void hold(const AssembledSpec& spec, int, SemiDiscrete& problem) {
  const AssembledStructure& structure = *spec.structure;
  problem.held = structure.definite;
  problem.static_modes = structure.static_modes;
  problem.support_loads = structure.support_loads;
}

}  // namespace

std::vector<std::string> support_names(const StructureSpec& structure) {
  if (const auto* beam = std::get_if<BeamSpec>(&structure)) {
    std::vector<std::string> names;
    for (int plane = 0; plane < beam->planes; ++plane)
      for (const BeamSupport& support : supports_of(*beam)) names.push_back(support.name);
    return names;
  }
  if (const auto* assembled = std::get_if<AssembledSpec>(&structure)) return assembled->structure->supports;
  if (const auto* bar = std::get_if<BarSpec>(&structure))
    return bar->fixed == BarSpec::Fixed::none ? std::vector<std::string>{} : std::vector<std::string>{"clamp"};
  return {"base"};
}

std::vector<double> support_places(const StructureSpec& structure) {
  constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
  if (const auto* beam = std::get_if<BeamSpec>(&structure)) {
    std::vector<double> places;
    for (int plane = 0; plane < beam->planes; ++plane)
      for (const BeamSupport& support : supports_of(in_plane(*beam, plane)))
        places.push_back(support.holds_displacement() ? support.x : nowhere);
    return places;
  }
  const auto* bar = std::get_if<BarSpec>(&structure);
  return std::vector<double>(support_names(structure).size(), !bar                                 ? nowhere
                                                              : bar->fixed == BarSpec::Fixed::left ? 0.0
                                                                                                   : bar->length);
}

std::vector<std::pair<int, double>> held_by(const std::vector<double>& supports, const FiniteElementSpace& space,
                                            double x, ShapeOf what) {
  std::vector<std::pair<int, double>> held;
  for (const auto& [where, weight] : held_row(space, x, what)) {
    std::size_t nearest = 0;
    double away = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < supports.size(); ++j)
      if (std::abs(supports[j] - where) < away) {
        away = std::abs(supports[j] - where);
        nearest = j;
      }
    held.emplace_back(static_cast<int>(nearest), weight);
  }
  return held;
}

void check_motions(const SceneSpec& scene) {
  const std::size_t stops = std::max<std::size_t>(1, scene.stops.named.size());
  for (std::size_t i = 0; i < scene.stops.named.size(); ++i)
    if (scene.stops.named[i].motion) own_share(scene.stops.named[i], i);
  if (scene.motions.empty()) {
    if (scene.from_supports)
      throw InputError("/scene/frame", "\"supports\" has no motion to count from; expected motions");
    for (std::size_t i = 0; i < stops; ++i)
      if (!carrier_of(scene, i).empty())
        throw InputError(carrier_pointer(scene, i),
                         "no support moves by motions; expected motions, or stops that stand still");
    return;
  }
  if (scene.support.amplitude != 0)
    throw InputError("/scene/support",
                     "support and motions stand together; expected the motion of supports among motions");
  const MovedSupports moved = moved_supports(scene);
  for (std::size_t i = 0; i < stops; ++i) carried_by(scene, i, moved);
}

void hold_by_supports(const StructureSpec& structure, int elements, SemiDiscrete& problem) {
  problem.supports = support_names(structure);
  problem.support_x = support_places(structure);
  std::visit([&](const auto& spec) { hold(spec, elements, problem); }, structure);
}

Eigen::MatrixXd support_shapes(const SemiDiscrete& problem, const std::vector<double>& x) {
  if (problem.supports.empty()) return Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(x.size()), 0);
  if (problem.space.given) return problem.tip_on_supports.replicate(static_cast<Eigen::Index>(x.size()), 1);
  Eigen::MatrixXd shapes = displacement_rows(problem.space, x) * problem.static_modes;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (const auto& [support, weight] : held_by(problem.support_x, problem.space, x[i]))
      shapes(static_cast<Eigen::Index>(i), support) += weight;
  return shapes;
}

Eigen::MatrixXd of_motions(const SupportMotions& motions, const Eigen::MatrixXd& shapes) {
  Eigen::MatrixXd shares = Eigen::MatrixXd::Zero(shapes.rows(), static_cast<Eigen::Index>(motions.supports.size()));
  for (std::size_t k = 0; k < motions.supports.size(); ++k)
    for (const std::size_t j : motions.supports[k])
      shares.col(static_cast<Eigen::Index>(k)) += shapes.col(static_cast<Eigen::Index>(j));
  return shares;
}

Eigen::MatrixXd motion_shapes(const SemiDiscrete& problem, const std::vector<double>& x) {
  return of_motions(problem.motions, support_shapes(problem, x));
}

void add_motions(const SceneSpec& scene, const Eigen::MatrixXd& on_supports, SemiDiscrete& problem,
                 DistributedLoad& load) {
  if (!moves_by_histories(scene)) return;
  SupportMotions& motions = problem.motions;
  const MovedSupports moved = scene.motions.empty() ? MovedSupports{} : moved_supports(scene);
  motions.supports = moved.supports;
  motions.from_supports = scene.from_supports;
  for (std::size_t k = 0; k < scene.motions.size(); ++k) {
    const std::shared_ptr<const TimeHistory>& history = motions.histories.emplace_back(scene.motions[k].history);
    Eigen::VectorXd push = Eigen::VectorXd::Zero(problem.space.dofs);
    for (const std::size_t j : moved.supports[k]) push -= problem.support_loads.col(static_cast<Eigen::Index>(j));
    load.add(push, Formula([history](double t) { return history->acceleration(t); }, "motion of supports",
                           fmt::format("/scene/motions/{}", k)));
  }
  // A stop that moves by itself is one more motion, of no support: a clearance along one of its components.
  std::vector<std::tuple<Eigen::Index, Eigen::Index, double>> alone;
  for (std::size_t i = 0; i < scene.stops.named.size(); ++i) {
    const NamedStop& stop = scene.stops.named[i];
    if (!stop.motion) continue;
    if (!stop.side || stop.side->number == 0) {
      motions.histories.push_back(stop.motion->history);
      motions.supports.emplace_back();
      motions.carry_stops = true;
    }
    alone.emplace_back(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(motions.histories.size()) - 1,
                       own_share(stop, i));
  }
  motions.at_points = of_motions(motions, problem.contact * problem.static_modes + on_supports);
  motions.at_tip = motion_shapes(problem, {shown_position(scene)});
  if (scene.from_supports) motions.at_tip.setZero();
  for (Eigen::Index i = 0; i < problem.points(); ++i) {
    const auto stop = static_cast<std::size_t>(i);
    motions.carry_stops = motions.carry_stops || !carrier_of(scene, stop).empty();
    for (const auto& [share, motion] : carried_by(scene, stop, moved))
      if (motion >= 0) motions.at_points(i, motion) -= share;
  }
  for (const auto& [stop, motion, share] : alone) motions.at_points(stop, motion) = -share;
}

namespace {

// Whether all rows of a matrix have nothing across: then supports that move along y lift stops along y by 1.
bool along_y(const SemiDiscrete& problem, const SparseRows& rows) {
  const std::vector<int> across = plane_space(problem.space, 1).dofs;
  for (int i = 0; i < rows.outerSize(); ++i)
    for (SparseRows::InnerIterator it(rows, i); it; ++it)
      if (std::binary_search(across.begin(), across.end(), static_cast<int>(it.col()))) return false;
  return true;
}

// Without the columns of supports along z, which the harmonic motion leaves at rest.
Eigen::MatrixXd without_across(const SceneSpec& scene, Eigen::MatrixXd columns) {
  if (const JoinedBodies* bodies = bodies_of(scene.structure))
    for (const std::size_t j : bodies->supports_across) columns.col(static_cast<Eigen::Index>(j)).setZero();
  return columns;
}

// Whether the supports, moved together by 1, lift the stops and the tip by 1.
bool lift_alike(const SceneSpec& scene, const SemiDiscrete& problem, const Eigen::MatrixXd& on_supports) {
  if (!problem.space.given) return problem.space.across.empty() || along_y(problem, problem.contact);
  constexpr double alike = 1e-9;  // round-off of static modes
  const Eigen::VectorXd points =
      without_across(scene, problem.contact * problem.static_modes + on_supports).rowwise().sum();
  return (points.size() == 0 || (points.array() - 1).abs().maxCoeff() <= alike) &&
         std::abs(without_across(scene, problem.tip_on_supports).sum() - 1) <= alike;
}

}  // namespace

void add_support(const SceneSpec& scene, const Eigen::MatrixXd& on_supports, SemiDiscrete& problem,
                 DistributedLoad& load) {
  const bool lifts_alike = scene.support.amplitude == 0 || lift_alike(scene, problem, on_supports);
  if (scene.support.amplitude == 0 || (lifts_alike && !problem.space.given))
    return add_motions(scene, on_supports, problem, load);
  if (lifts_alike) {
    problem.support_shape = without_across(scene, problem.support_loads).rowwise().sum();
    return;
  }
  const auto* beam = std::get_if<BeamSpec>(&scene.structure);
  if (beam && beam->foundation > 0)
    throw InputError("/scene/support",
                     "the ground of the foundation would move too, past stops across; expected "
                     "motions, or stops along uy");
  const SupportSpec& support = scene.support;
  SceneSpec moved = scene;
  moved.support.amplitude = problem.support.amplitude = 0;
  moved.motions = {
      {.supports = {},
       .history = std::make_shared<const HarmonicMotion>(support.amplitude, support.pulsation, support.phase)}};
  add_motions(moved, on_supports, problem, load);
}

bool support_bends(const SceneSpec& scene) {
  const auto* beam = std::get_if<BeamSpec>(&scene.structure);
  const bool many = std::holds_alternative<AssembledSpec>(scene.structure) || (beam && beam->planes == 2);
  if (!many || scene.support.amplitude == 0) return false;
  SemiDiscrete problem;
  const JoinedBodies* bodies = bodies_of(scene.structure);
  problem.space = make_space(scene.structure, bodies ? bodies->mesh : 1);
  ContactPoints points = contact_points(scene, problem.space, 1);
  problem.contact = std::move(points.rows);
  hold_by_supports(scene.structure, 1, problem);
  show_tip(scene, problem);
  return !lift_alike(scene, problem, points.on_supports);
}

namespace {

// Of several sections, the stiffest says how stiff the beam is.
void add_stiffness(const BeamSpec& beam, SemiDiscrete& problem) {
  for (const UniformPart& part : uniform_parts(beam)) problem.rigidity = std::max(problem.rigidity, part.section.EI);
  problem.stiffness = beam_stiffness(beam, problem.space);
}
void add_stiffness(const BarSpec& bar, SemiDiscrete& problem) {
  problem.rigidity = bar.EA;
  problem.stiffness = axial_stiffness(problem.space, bar.EA);
}
void add_stiffness(const OscillatorSpec& oscillator, SemiDiscrete& problem) {
  problem.rigidity = oscillator.stiffness;
  problem.stiffness.resize(1, 1);
  problem.stiffness.insert(0, 0) = oscillator.stiffness;
  problem.stiffness.makeCompressed();
}

void add_stiffness(const AssembledSpec& spec, SemiDiscrete& problem) {
  const AssembledStructure& structure = *spec.structure;
  problem.stiffness = structure.stiffness;
  problem.notes = structure.notes;
}

}  // namespace

SemiDiscrete structure_alone(const StructureSpec& structure, int elements) {
  SemiDiscrete problem;
  problem.space = make_space(structure, elements);
  std::visit([&](const auto& spec) { add_stiffness(spec, problem); }, structure);
  problem.damping = damping_of(structure);
  problem.support_shape = rigid_motion_load(problem.space);
  hold_by_supports(structure, elements, problem);
  return problem;
}

}  // namespace ricochet
