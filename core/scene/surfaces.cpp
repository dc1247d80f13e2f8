#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <ricochet/contract/errors.hpp>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/clearances.hpp>
#include <ricochet/scene/named_stops.hpp>
#include <ricochet/scene/scene.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/surfaces.hpp>

namespace ricochet {
namespace {

// `number`: of a row; clearances have several in one entry.
std::string tangent_pointer(const NamedStop& stop, std::size_t number, const TangentSpec& tangent) {
  const std::string pointer = fmt::format("/scene/stops/{}/tangent", number);
  return stop.across ? fmt::format("{}/{}", pointer, &tangent == &*stop.across ? 1 : 0) : pointer;
}

// The same place with another component or direction; of modes, what follows the last dot is the component.
Place turned(const Place& place, const TangentSpec& tangent) {
  Place out;
  out.x = place.x;
  out.body = place.body;
  out.node = place.node;
  if (!place.point.empty()) {
    out.point = place.point.substr(0, place.point.rfind('.')) + "." + tangent.component;
    return out;
  }
  out.component = tangent.component;
  out.direction = tangent.direction;
  return out;
}

// Whether a beam stands at a place, which has a slope there.
bool bends(const SceneSpec& scene, const Place& place, const std::string& pointer) {
  const JoinedBodies* bodies = bodies_of(scene.structure);
  const StructureSpec& own = bodies ? bodies->of(place, pointer).alone.structure : scene.structure;
  return place.x && std::holds_alternative<BeamSpec>(own);
}

// What a stop may say of its tangent, given what it said: something that its places have, or nothing.
[[noreturn]] void refuse_tangent(const SceneSpec& scene, const NamedStop& stop, const std::string& pointer) {
  const auto both = [&](auto&& has) { return has(stop.at) && (!stop.to || has(*stop.to)); };
  const bool slope = both([&](const Place&place) { return bends(scene, place, pointer); }),
             node = both([](const Place&place) { return !place.node.empty(); });
  const std::string why = stop.side                        ? "is a clearance, which knows its circle"
                          : stop.tangent->slope_radius > 0 ? "has no beam, whose slope it could be"
                                                           : "is not at a node";
  const std::string remedy = slope                ? "give slope_radius, or leave tangent out"
                             : node && !stop.side ? "give direction or component"
                                                  : "leave tangent out";
  throw InputError(pointer, fmt::format("stop {} {}: {}", stop.name, why, remedy));
}

// Of a clearance: u₁, u₂, and of a surface that bends r θ₁, r θ₂.
std::vector<PlaceRow> round_tangents(const SceneSpec& scene, const FiniteElementSpace& space, const NamedStop& stop,
                                     std::size_t number) {
  std::vector<PlaceRow> rows{axis_row(scene, space, stop, number, 0), axis_row(scene, space, stop, number, 1)};
  if (!stop.tangent || !stop.tangent->given()) return rows;
  const std::string pointer = tangent_pointer(stop, number, *stop.tangent) + "/slope_radius";
  const bool slopes = bends(scene, stop.at, pointer) && (!stop.to || bends(scene, *stop.to, pointer));
  if (!(stop.tangent->slope_radius > 0) || !slopes)
    refuse_tangent(scene, stop, tangent_pointer(stop, number, *stop.tangent));
  const auto turned_by = [&](const Place& at, const std::optional<Place>& to) {
    const PlaceRow row = section_row(scene, space, at, ShapeOf::rotation, pointer);
    return combined(stop.tangent->slope_radius,
                    to ? difference(row, section_row(scene, space, *to, ShapeOf::rotation, pointer)) : row, 0, {});
  };
  rows.push_back(turned_by(stop.at, stop.to));
  rows.push_back(turned_by(stop.side->across, stop.side->across_to));
  return rows;
}

PlaceRow tangent_row(const SceneSpec& scene, const FiniteElementSpace& space, const NamedStop& stop, std::size_t number,
                     const TangentSpec& tangent) {
  const std::string pointer = tangent_pointer(stop, number, tangent);
  const auto row = [&](const Place& place) {
    if (tangent.slope_radius > 0) {
      if (!bends(scene, place, pointer)) refuse_tangent(scene, stop, pointer);
      return combined(tangent.slope_radius, section_row(scene, space, place, ShapeOf::rotation, pointer), 0, {});
    }
    if (place.node.empty() && (tangent.component.empty() || !(place.x || place.point.find('.') != std::string::npos)))
      refuse_tangent(scene, stop, pointer);
    try {
      return place_row(scene, space, turned(place, tangent), pointer);
    } catch (const InputError& error) {
      // The point is not one that the study names.
      throw InputError(place.point.empty() ? error.pointer() : pointer + "/component", error.what());
    }
  };
  return stop.to ? difference(row(stop.at), row(*stop.to)) : row(stop.at);
}

// Whether two rows are one motion.
bool same_motion(const PlaceRow& a, const PlaceRow& b) {
  double along = 0, own = 0, other = 0;
  for (const auto& [dof, value] : a.free) {
    own += value * value;
    for (const auto& [same, weight] : b.free) along += dof == same ? value * weight : 0.0;
  }
  for (const auto& [dof, value] : b.free) other += value * value;
  return own * other - along * along <= 1e-12 * own * other;
}

// Efforts along both would be one. The disc of two tangents is round where they stand at right angles.
void check_across(const NamedStop& stop, std::size_t number, const std::vector<PlaceRow>& tangents,
                  const PlaceRow& normal) {
  const std::string pointer = fmt::format("/scene/stops/{}/tangent", number);
  if (stop.side) return;
  if (stop.friction && !stop.normal_force)
    for (const PlaceRow& tangent : tangents)
      if (same_motion(tangent, normal))
        throw InputError(pointer, fmt::format("stop {}: its tangent is its normal; expected a motion across "
                                              "that of the bounds",
                                              stop.name));
  if (!stop.across) return;
  const std::vector<double>&first = stop.tangent->direction, &second = stop.across->direction;
  double along = 0, own = 0, other = 0;
  for (std::size_t i = 0; i < std::min(first.size(), second.size()); ++i) {
    along += first[i] * second[i];
    own += first[i] * first[i];
    other += second[i] * second[i];
  }
  if (same_motion(tangents[0], tangents[1]) || along * along > 1e-18 * own * other)
    throw InputError(pointer + "/1",
                     fmt::format("stop {}: its tangents are not at right angles; expected two that are", stop.name));
}

}  // namespace

std::vector<PlaceRow> surface_rows(const SceneSpec& scene, const FiniteElementSpace& space, const NamedStop& stop,
                                   std::size_t number) {
  if (stop.side) return stop.side->number == 0 ? round_tangents(scene, space, stop, number) : std::vector<PlaceRow>();
  if (stop.normal_force) return {stop_row(scene, space, stop, number)};
  if (!stop.tangent || !stop.tangent->given()) return {};
  std::vector<PlaceRow> rows{tangent_row(scene, space, stop, number, *stop.tangent)};
  if (stop.across) rows.push_back(tangent_row(scene, space, stop, number, *stop.across));
  return rows;
}

void check_surfaces(const SceneSpec& scene, const FiniteElementSpace& space) {
  for (std::size_t i = 0; i < scene.stops.named.size(); ++i) {
    const NamedStop& stop = scene.stops.named[i];
    // One effort stands for both sides: the difference of what they press with.
    if (!stop.side && (stop.tangent || stop.friction) && stop.lower && stop.upper && *stop.lower > *stop.upper)
      throw InputError(fmt::format("/scene/stops/{}", i),
                       fmt::format("stop {} presses from both sides, and rubs with both: its lower bound, {:g} m, is "
                                   "above its upper one, {:g} m; give each side as a stop of its own",
                                   stop.name, *stop.lower, *stop.upper));
    if (const auto rows = surface_rows(scene, space, stop, i); !rows.empty())
      check_across(stop, i, rows, stop_row(scene, space, stop, i));
  }
}

SparseRows pushed_rows_of(const SceneSpec& scene, const SemiDiscrete& problem) {
  std::vector<Eigen::Triplet<double>> entries;
  auto count = static_cast<int>(problem.contact.rows());
  for (int i = 0; i < count; ++i)
    for (SparseRows::InnerIterator it(problem.contact, i); it; ++it)
      entries.emplace_back(i, static_cast<int>(it.col()), it.value());
  const auto add = [&](const PlaceRow& row) {
    for (const auto& [dof, value] : row.free) entries.emplace_back(count, dof, value);
    ++count;
  };
  const std::vector<NamedStop>& stops = scene.stops.named;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    if (!stops[i].friction || stops[i].friction->none() || stops[i].normal_force) continue;
    const std::vector<PlaceRow> rows = surface_rows(scene, problem.space, stops[i], i);
    // u₁ and u₂ of a circle are its own.
    for (std::size_t k = stops[i].side ? 2 : 0; k < rows.size(); ++k) add(rows[k]);
  }
  SparseRows out(count, problem.contact.cols());
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

void find_rubbing(const SceneSpec& scene, SemiDiscrete& problem) {
  const std::vector<NamedStop>& stops = scene.stops.named;
  const ObservedRows& all = problem.tangents;
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> speeds;
  const auto moves = [&](double share, const TangentSpec& tangent) {
    if (tangent.motion && share != 0)
      problem.rubbed_motions.push_back({static_cast<int>(speeds.size()), share, tangent.motion->history});
    speeds.push_back(share * tangent.speed);
  };
  constexpr int rim = -1;
  std::vector<int> from;  // of each row, the tangent that it is
  for (std::size_t i = 0; i < stops.size(); ++i) {
    if (!stops[i].friction || problem.tangent_of[i] < 0) continue;
    if (stops[i].friction->none()) {
      problem.notes.push_back(fmt::format("friction of stop {}: its coefficient is 0", stops[i].name));
      continue;
    }
    RubbingPoint& one = problem.rubbing.emplace_back();
    one.point = static_cast<int>(i);
    one.row = static_cast<int>(from.size());
    one.given = {stops[i].friction->held, stops[i].friction->sliding, stops[i].normal_force};
    one.round = stops[i].side.has_value();
    const TangentSpec along = stops[i].tangent.value_or(TangentSpec{});
    for (int k = problem.tangent_of[i]; k < all.count() && all.names[static_cast<std::size_t>(k)] == stops[i].name;
         ++k) {
      from.push_back(k);
      moves(one.round ? 0.0 : 1.0, one.round || k == problem.tangent_of[i] ? along : *stops[i].across);
      if (!one.round || k != problem.tangent_of[i] + 1) continue;
      from.push_back(rim);
      moves(-1, along);
    }
    one.rows = static_cast<int>(from.size()) - one.row;
    problem.rubbed.names.resize(from.size(), stops[i].name);
  }
  const auto count = static_cast<Eigen::Index>(from.size());
  problem.rubbed_speeds = Eigen::Map<const Eigen::VectorXd>(speeds.data(), count);
  problem.rubbed.on_support = Eigen::VectorXd::Zero(count);
  problem.rubbed.on_motions = Eigen::MatrixXd::Zero(count, all.on_motions.cols());
  for (Eigen::Index k = 0; k < count; ++k) {
    const int row = from[static_cast<std::size_t>(k)];
    if (row == rim) continue;
    for (SparseRows::InnerIterator it(all.rows, row); it; ++it)
      entries.emplace_back(static_cast<int>(k), static_cast<int>(it.col()), it.value());
    problem.rubbed.on_support[k] = all.on_support[row];
    problem.rubbed.on_motions.row(k) = all.on_motions.row(row);
  }
  // A damper's ground may move.
  if (!problem.motions.empty())
    for (const RubbingPoint& one : problem.rubbing)
      if (one.given.normal_force) problem.rubbed.on_motions.row(one.row) = problem.motions.at_points.row(one.point);
  problem.rubbed.rows.resize(count, all.rows.cols());
  problem.rubbed.rows.setFromTriplets(entries.begin(), entries.end());
}

void check_rest(const InitialSpec& initial, const Equilibrium& found, SemiDiscrete& problem) {
  const bool pressed = !found.pushed.isZero(0) ||
                       std::any_of(problem.rubbing.begin(), problem.rubbing.end(),
                                   [](const RubbingPoint& one) { return one.given.normal_force.has_value(); });
  if (problem.rubbing.empty() || !pressed) return;
  if (!initial.frictionless)
    throw InputError("/scene/initial/equilibrium",
                     "a state at rest with friction is not unique; expected \"frictionless\", that without it");
  problem.notes.push_back("the state at rest is found without friction: with friction it is not unique");
}

std::optional<Refusal> refuse_polygon(const StopsSpec& stops) {
  for (const NamedStop& stop : stops.named)
    if (stop.side && stop.friction && !stop.friction->none())
      return Refusal{
          said("stop {} rubs along its circle, and a rigid law meets a polygon: use a compliant law, which "
               "meets the circle itself",
               stop.name)};
  return std::nullopt;
}

}  // namespace ricochet
