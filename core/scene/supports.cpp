#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/beam.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>
#include <ricochet/scene/supports.hpp>

namespace ricochet {
namespace {

// One support that holds the structure as a whole: its static mode is the translation.
void hold_rigidly(SemiDiscrete& problem, const char* name, double x) {
  problem.supports = {name};
  problem.support_x = {x};
  problem.static_modes = Eigen::MatrixXd::Zero(problem.space.dofs, 1);
  const std::vector<DofPlace> places = dof_places(problem.space);
  for (Eigen::Index i = 0; i < problem.space.dofs; ++i)
    problem.static_modes(i, 0) = places[static_cast<std::size_t>(i)].slope ? 0 : 1;
  problem.support_loads = problem.support_shape;
}

void hold(const BeamSpec& beam, int elements, SemiDiscrete& problem) {
  problem.held = rigid_freedom(beam).held();
  if (!beam.supports && beam.foundation == 0) return hold_rigidly(problem, "clamp", 0);
  StaticModes found = static_modes(beam, elements);
  problem.supports = std::move(found.supports);
  problem.static_modes = std::move(found.modes);
  problem.support_loads = std::move(found.loads);
  for (const BeamSupport& support : supports_of(beam))
    problem.support_x.push_back(support.holds_displacement() ? support.x : std::numeric_limits<double>::quiet_NaN());
}

void hold(const BarSpec& bar, int, SemiDiscrete& problem) {
  problem.held = bar.fixed != BarSpec::Fixed::none;
  if (problem.held) return hold_rigidly(problem, "clamp", bar.fixed == BarSpec::Fixed::left ? 0 : bar.length);
  problem.static_modes.resize(problem.space.dofs, 0);
  problem.support_loads.resize(problem.space.dofs, 0);
}

void hold(const OscillatorSpec&, int, SemiDiscrete& problem) {
  problem.supports = {"base"};
  problem.support_x = {std::numeric_limits<double>::quiet_NaN()};
  problem.static_modes = Eigen::MatrixXd::Ones(1, 1);
  problem.support_loads = problem.support_shape;
}

void hold(const AssembledSpec& spec, int, SemiDiscrete& problem) {
  const AssembledStructure& structure = *spec.structure;
  problem.held = structure.definite;
  problem.supports = structure.supports;
  problem.static_modes = structure.static_modes;
  problem.support_loads = structure.support_loads;
}

std::vector<std::string> support_names(const StructureSpec& structure) {
  if (const auto* beam = std::get_if<BeamSpec>(&structure)) {
    std::vector<std::string> names;
    for (const BeamSupport& support : supports_of(*beam)) names.push_back(support.name);
    return names;
  }
  if (const auto* assembled = std::get_if<AssembledSpec>(&structure)) return assembled->structure->supports;
  if (const auto* bar = std::get_if<BarSpec>(&structure))
    return bar->fixed == BarSpec::Fixed::none ? std::vector<std::string>{} : std::vector<std::string>{"clamp"};
  return {"base"};
}

// The number of a support; throws InputError with the nearest name.
std::size_t number_of(const std::string& name, const std::vector<std::string>& names, const std::string& pointer) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
  const std::string nearest = nearest_name(name, names);
  throw InputError(pointer, fmt::format("no support \"{}\"{}", name,
                                        nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest)));
}

// The supports that each motion moves, and the motion of each support, −1 where it rests.
struct Moved {
  std::vector<std::vector<std::size_t>> supports;
  std::vector<int> motion;
};

Moved moved_supports(const SceneSpec& scene) {
  const std::vector<std::string> names = support_names(scene.structure);
  if (names.empty())
    throw InputError("/scene/motions", "nothing holds the structure; expected a support that could move");
  Moved moved{{}, std::vector<int>(names.size(), -1)};
  for (std::size_t k = 0; k < scene.motions.size(); ++k) {
    const MotionSpec& motion = scene.motions[k];
    const std::string pointer = fmt::format("/scene/motions/{}/supports", k);
    std::vector<std::size_t>& mine = moved.supports.emplace_back();
    for (std::size_t j = 0; j < (motion.supports.empty() ? names.size() : motion.supports.size()); ++j)
      mine.push_back(motion.supports.empty() ? j : number_of(motion.supports[j], names, pointer));
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

// The motion that carries a stop, −1: none.
int carried_by(const std::string& carrier, const SceneSpec& scene, const Moved& moved, const std::string& pointer) {
  if (carrier.empty()) return -1;
  const int first = moved.motion.front();
  if (carrier != all_supports) return moved.motion[number_of(carrier, support_names(scene.structure), pointer)];
  if (!std::all_of(moved.motion.begin(), moved.motion.end(), [&](int one) { return one == first; }))
    throw InputError(pointer, "the supports move apart; expected the name of one");
  return first;
}

std::string carrier_pointer(const SceneSpec& scene, std::size_t stop) {
  return scene.stops.named.empty() ? "/scene/stops/moves_with" : fmt::format("/scene/stops/{}/moves_with", stop);
}

const std::string& carrier_of(const SceneSpec& scene, std::size_t stop) {
  return scene.stops.named.empty() ? scene.stops.moves_with : scene.stops.named[stop].moves_with;
}

}  // namespace

void check_motions(const SceneSpec& scene) {
  const std::size_t stops = std::max<std::size_t>(1, scene.stops.named.size());
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
  const Moved moved = moved_supports(scene);
  for (std::size_t i = 0; i < stops; ++i) carried_by(carrier_of(scene, i), scene, moved, carrier_pointer(scene, i));
}

void hold_by_supports(const StructureSpec& structure, int elements, SemiDiscrete& problem) {
  std::visit([&](const auto& spec) { hold(spec, elements, problem); }, structure);
}

Eigen::MatrixXd support_shapes(const SemiDiscrete& problem, const std::vector<double>& x) {
  const auto places = static_cast<Eigen::Index>(x.size());
  if (problem.supports.empty()) return Eigen::MatrixXd::Zero(places, 0);
  Eigen::MatrixXd shapes = displacement_rows(problem.space, x) * problem.static_modes;
  for (Eigen::Index i = 0; i < places; ++i)
    for (const auto& [where, share] : held_row(problem.space, x[static_cast<std::size_t>(i)])) {
      std::size_t nearest = 0;
      double away = std::numeric_limits<double>::infinity();
      for (std::size_t j = 0; j < problem.support_x.size(); ++j)
        if (std::abs(problem.support_x[j] - where) < away) {
          away = std::abs(problem.support_x[j] - where);
          nearest = j;
        }
      shapes(i, static_cast<Eigen::Index>(nearest)) += share;
    }
  return shapes;
}

Eigen::MatrixXd motion_shapes(const SemiDiscrete& problem, const std::vector<double>& x) {
  const auto count = static_cast<Eigen::Index>(problem.motions.supports.size());
  Eigen::MatrixXd shares = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(x.size()), count);
  if (count == 0) return shares;
  const Eigen::MatrixXd shapes = support_shapes(problem, x);
  for (Eigen::Index k = 0; k < count; ++k)
    for (const std::size_t j : problem.motions.supports[static_cast<std::size_t>(k)])
      shares.col(k) += shapes.col(static_cast<Eigen::Index>(j));
  return shares;
}

void add_motions(const SceneSpec& scene, const Eigen::MatrixXd& on_supports, SemiDiscrete& problem,
                 DistributedLoad& load) {
  if (scene.motions.empty()) return;
  SupportMotions& motions = problem.motions;
  const Moved moved = moved_supports(scene);
  motions.supports = moved.supports;
  motions.from_supports = scene.from_supports;
  const auto count = static_cast<Eigen::Index>(scene.motions.size());
  for (Eigen::Index k = 0; k < count; ++k) {
    const MotionSpec& motion = scene.motions[static_cast<std::size_t>(k)];
    motions.histories.push_back(motion.history);
    Eigen::VectorXd push = Eigen::VectorXd::Zero(problem.space.dofs);
    for (const std::size_t j : moved.supports[static_cast<std::size_t>(k)])
      push -= problem.support_loads.col(static_cast<Eigen::Index>(j));
    load.add(push, Formula([history = motion.history](double t) { return history->acceleration(t); },
                           "motion of " + motion.text, fmt::format("/scene/motions/{}", k)));
  }
  const auto shared = [&](const Eigen::MatrixXd& shapes) {
    Eigen::MatrixXd shares = Eigen::MatrixXd::Zero(shapes.rows(), count);
    for (Eigen::Index k = 0; k < count; ++k)
      for (const std::size_t j : moved.supports[static_cast<std::size_t>(k)])
        shares.col(k) += shapes.col(static_cast<Eigen::Index>(j));
    return shares;
  };
  motions.at_points = shared(problem.contact * problem.static_modes + on_supports);
  // Of places that lie on elements the space knows what supports add by themselves.
  motions.at_tip = shared(problem.space.elements.empty() ? Eigen::MatrixXd(problem.tip * problem.static_modes)
                                                         : support_shapes(problem, {tip_position(scene)}));
  if (scene.from_supports) motions.at_tip.setZero();
  for (Eigen::Index i = 0; i < problem.points(); ++i) {
    const auto stop = static_cast<std::size_t>(i);
    motions.carry_stops = motions.carry_stops || !carrier_of(scene, stop).empty();
    const int motion = carried_by(carrier_of(scene, stop), scene, moved, carrier_pointer(scene, stop));
    if (motion >= 0) motions.at_points(i, motion) -= 1;
  }
}

}  // namespace ricochet
