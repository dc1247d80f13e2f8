#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <ricochet/contract/errors.hpp>
#include <ricochet/contract/reference.hpp>
#include <ricochet/kernels/dense_solvers.hpp>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/beam.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/named_stops.hpp>
#include <ricochet/scene/observed_rows.hpp>
#include <ricochet/scene/planes.hpp>
#include <ricochet/scene/scene.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/supports.hpp>

namespace ricochet {
namespace {

// Rows of places as they are gathered.
class RowMaker {
 public:
  RowMaker(const SemiDiscrete& problem, std::size_t count) : problem_(problem) {
    rows_.on_support = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count));
    shares_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(count), problem.static_modes.cols());
  }
  /// `on_support`: how much of the motion that all supports share; `moved`: whether motions by histories are seen.
  void add(const std::string& name, const PlaceRow& row, double on_support, bool moved) {
    const auto i = static_cast<Eigen::Index>(rows_.names.size());
    rows_.names.push_back(name);
    rows_.on_support[i] = on_support;
    for (const auto& [dof, value] : row.free) entries_.emplace_back(static_cast<int>(i), dof, value);
    if (!moved || shares_.cols() == 0) return;  // nothing holds the structure
    for (const auto& [dof, value] : row.free) shares_.row(i) += value * problem_.static_modes.row(dof);
    for (const auto& [support, weight] : row.held) shares_(i, support) += weight;
  }
  ObservedRows make() {
    rows_.rows.resize(static_cast<Eigen::Index>(rows_.names.size()), problem_.space.dofs);
    rows_.rows.setFromTriplets(entries_.begin(), entries_.end());
    rows_.on_motions = of_motions(problem_.motions, shares_);
    return std::move(rows_);
  }

 private:
  const SemiDiscrete& problem_;
  ObservedRows rows_;
  Eigen::MatrixXd shares_;  // of the supports
  std::vector<Eigen::Triplet<double>> entries_;
};

std::string point_pointer(std::size_t number, const char* key) {
  return fmt::format("/scene/points/{}{}", number, key);
}

std::string tangent_pointer(std::size_t stop) {
  return fmt::format("/scene/stops/{}/tangent", stop);
}

PlaceRow scaled(PlaceRow row, double factor) {
  for (auto& [dof, value] : row.free) value *= factor;
  for (auto& [support, weight] : row.held) weight *= factor;
  return row;
}

// How much of a motion of all supports along y a place sees.
double share_along_y(const SceneSpec& scene, const Place& place) {
  const auto* beam = std::get_if<BeamSpec>(&scene.structure);
  return beam ? plane_shares(place, beam->planes == 2, "")[0] : 1.0;
}

// M = EI θ' or M' at a point of a beam; where the section changes, of what stands to the right.
PlaceRow field_row(const SceneSpec& scene, const FiniteElementSpace& space, const PointSpec& point, ShapeOf what,
                   const std::string& pointer) {
  const PlaceRow row = section_row(scene, space, point.at, what, pointer);
  const JoinedBodies* bodies = bodies_of(scene.structure);
  const StructureSpec& bent = bodies ? bodies->of(point.at, pointer).alone.structure : scene.structure;
  const auto& beam = std::get<BeamSpec>(bent);
  const double along = plane_shares(point.at, beam.planes == 2, pointer)[0];
  if (along != 0 && along != 1)
    throw InputError(pointer, "a moment bends in one plane; expected a point along uy or uz");
  return scaled(row, part_at(uniform_parts(in_plane(beam, along == 1 ? 0 : 1)), row.x).section.EI);
}

// The place of a node with another component or direction.
Place turned(const Place& place, const TangentSpec& tangent) {
  Place out;
  out.node = place.node;
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
  if (!stop.tangent) return rows;
  const std::string pointer = tangent_pointer(number) + "/slope_radius";
  const bool slopes = bends(scene, stop.at, pointer) && (!stop.to || bends(scene, *stop.to, pointer));
  if (!(stop.tangent->slope_radius > 0) || !slopes) refuse_tangent(scene, stop, tangent_pointer(number));
  const auto turned_by = [&](const Place& at, const std::optional<Place>& to) {
    const PlaceRow row = section_row(scene, space, at, ShapeOf::rotation, pointer);
    return scaled(to ? difference(row, section_row(scene, space, *to, ShapeOf::rotation, pointer)) : row,
                  stop.tangent->slope_radius);
  };
  rows.push_back(turned_by(stop.at, stop.to));
  rows.push_back(turned_by(stop.side->across, stop.side->across_to));
  return rows;
}

PlaceRow tangent_row(const SceneSpec& scene, const FiniteElementSpace& space, const NamedStop& stop,
                     std::size_t number) {
  const TangentSpec& tangent = *stop.tangent;
  const std::string pointer = tangent_pointer(number);
  const auto row = [&](const Place& place) {
    if (tangent.slope_radius > 0) {
      if (!bends(scene, place, pointer)) refuse_tangent(scene, stop, pointer);
      return scaled(section_row(scene, space, place, ShapeOf::rotation, pointer), tangent.slope_radius);
    }
    if (place.node.empty()) refuse_tangent(scene, stop, pointer);
    return place_row(scene, space, turned(place, tangent), pointer);
  };
  return stop.to ? difference(row(stop.at), row(*stop.to)) : row(stop.at);
}

// Whether something slides along a stop with bounds, or through a damper.
bool slides(const NamedStop& stop) {
  return !stop.side && (stop.normal_force || (stop.tangent && stop.tangent->given()));
}

PlaceRow slide_row(const SceneSpec& scene, const FiniteElementSpace& space, const NamedStop& stop, std::size_t number) {
  return stop.normal_force ? stop_row(scene, space, stop, number) : tangent_row(scene, space, stop, number);
}

// Efforts along both would be one.
void check_across(const NamedStop& stop, std::size_t number, const PlaceRow& tangent, const PlaceRow& normal) {
  if (!stop.friction || stop.normal_force) return;
  double along = 0, own = 0, other = 0;
  for (const auto& [dof, value] : tangent.free) {
    own += value * value;
    for (const auto& [same, weight] : normal.free) along += dof == same ? value * weight : 0.0;
  }
  for (const auto& [dof, value] : normal.free) other += value * value;
  if (own * other - along * along <= 1e-12 * own * other)
    throw InputError(tangent_pointer(number),
                     fmt::format("stop {}: its tangent is its normal; expected a motion across "
                                 "that of the bounds",
                                 stop.name));
}

// What moves the supports moves what a damper holds.
double slide_on_support(const SceneSpec& scene, const NamedStop& stop) {
  if (!stop.normal_force) return 0;
  return share_along_y(scene, stop.at) - (stop.to ? share_along_y(scene, *stop.to) : 0.0);
}

void find_rubbing(const SceneSpec& scene, SemiDiscrete& problem) {
  const std::vector<NamedStop>& stops = scene.stops.named;
  const ObservedRows& all = problem.tangents;
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> speeds;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    if (!stops[i].friction || problem.tangent_of[i] < 0) continue;
    if (stops[i].friction->none()) {
      problem.notes.push_back(fmt::format("friction of stop {}: its coefficient is 0", stops[i].name));
      continue;
    }
    RubbingPoint& one = problem.rubbing.emplace_back();
    one.point = static_cast<int>(i);
    one.row = static_cast<int>(problem.rubbed.names.size());
    one.held = stops[i].friction->held;
    one.sliding = stops[i].friction->sliding;
    one.normal_force = stops[i].normal_force;
    speeds.push_back(stops[i].tangent ? stops[i].tangent->speed : 0.0);
    for (SparseRows::InnerIterator it(all.rows, problem.tangent_of[i]); it; ++it)
      entries.emplace_back(one.row, static_cast<int>(it.col()), it.value());
    problem.rubbed.names.push_back(stops[i].name);
  }
  const auto count = static_cast<Eigen::Index>(problem.rubbing.size());
  problem.rubbed.rows.resize(count, all.rows.cols());
  problem.rubbed.rows.setFromTriplets(entries.begin(), entries.end());
  problem.rubbed_speeds = Eigen::Map<const Eigen::VectorXd>(speeds.data(), count);
  problem.rubbed.on_support.resize(count);
  problem.rubbed.on_motions.resize(count, all.on_motions.cols());
  for (Eigen::Index k = 0; k < count; ++k) {
    const int from = problem.tangent_of[static_cast<std::size_t>(problem.rubbing[static_cast<std::size_t>(k)].point)];
    problem.rubbed.on_support[k] = all.on_support[from];
    // A damper's ground may move.
    const RubbingPoint& one = problem.rubbing[static_cast<std::size_t>(k)];
    problem.rubbed.on_motions.row(k) = one.normal_force && !problem.motions.empty()
                                           ? problem.motions.at_points.row(one.point).eval()
                                           : all.on_motions.row(from).eval();
  }
}

}  // namespace

void check_points(const SceneSpec& scene, const FiniteElementSpace& space) {
  std::vector<std::string> names;
  for (const NamedStop& stop : scene.stops.named) names.push_back(stop.name);
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    const PointSpec& point = scene.points[i];
    check_name(point.name, point_pointer(i, "/name"));
    if (point.name == "tip")
      throw InputError(point_pointer(i, "/name"), "\"tip\" is what tables call the first point; expected another name");
    if (std::find(names.begin(), names.end(), point.name) != names.end())
      throw InputError(point_pointer(i, "/name"),
                       fmt::format("another point or stop is called \"{}\"; expected another name", point.name));
    names.push_back(point.name);
    place_row(scene, space, point.at, point_pointer(i, "/at"));
    if (i == 0 && share_along_y(scene, point.at) != 1)
      throw InputError(point_pointer(i, "/at"), "the first point is the tip, along uy; expected one along uy first");
    if (point.moment || point.shear) field_row(scene, space, point, ShapeOf::curvature, point_pointer(i, "/fields"));
  }
  const auto* assembled = std::get_if<AssembledSpec>(&scene.structure);
  if (assembled && assembled->tip && !scene.points.empty())
    throw InputError("/scene/structure/tip", "does not go together with points: the first point is the tip");
}

void check_tangents(const SceneSpec& scene, const FiniteElementSpace& space) {
  for (std::size_t i = 0; i < scene.stops.named.size(); ++i)
    if (const NamedStop& stop = scene.stops.named[i]; stop.side && stop.side->number == 0)
      round_tangents(scene, space, stop, i);
    else if (slides(stop))
      check_across(stop, i, slide_row(scene, space, stop, i), stop_row(scene, space, stop, i));
}

void observe_rows(const SceneSpec& scene, SemiDiscrete& problem) {
  RowMaker points(problem, scene.points.size());
  // All supports of a beam, a bar or an oscillator move by φ, and what stands between them with them.
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    const PointSpec& point = scene.points[i];
    points.add(point.name, place_row(scene, problem.space, point.at, point_pointer(i, "/at")),
               point.from_supports ? 0.0 : share_along_y(scene, point.at), !point.from_supports);
  }
  problem.observed = points.make();
  RowMaker fields(problem, 2 * scene.points.size());
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    const PointSpec& point = scene.points[i];
    const auto add = [&](const char* name, ShapeOf what) {
      fields.add(point.name + name, field_row(scene, problem.space, point, what, point_pointer(i, "/fields")), 0, true);
    };
    if (point.moment) add("_moment", ShapeOf::curvature);
    if (point.shear) add("_shear", ShapeOf::curvature_slope);
  }
  problem.fields = fields.make();

  const std::vector<NamedStop>& stops = scene.stops.named;
  RowMaker tangents(problem, 4 * stops.size());
  problem.tangent_of.assign(stops.size(), -1);
  int count = 0;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    if (stops[i].side && stops[i].side->number == 0) {
      problem.tangent_of[i] = count;
      for (const PlaceRow& row : round_tangents(scene, problem.space, stops[i], i)) {
        tangents.add(stops[i].name, row, 0, true);
        ++count;
      }
    }
    if (!slides(stops[i])) continue;
    problem.tangent_of[i] = count++;
    tangents.add(stops[i].name, slide_row(scene, problem.space, stops[i], i), slide_on_support(scene, stops[i]), true);
  }
  problem.tangents = tangents.make();
  find_rubbing(scene, problem);
  // What slides along a clearance does so against what it moves with.
  if (problem.motions.carry_stops)
    for (const Clearance& clearance : problem.clearances) {
      const Eigen::Index row = problem.tangent_of[static_cast<std::size_t>(clearance.first)];
      const auto [cosine, sine] = side_direction(clearance.angles[1]);
      const auto& at = problem.motions.at_points;
      problem.tangents.on_motions.row(row) = at.row(clearance.first);
      problem.tangents.on_motions.row(row + 1) =
          (at.row(clearance.first + 1) - cosine * at.row(clearance.first)) / sine;
    }
}

namespace {

// By LLᵀ, where dense_mass() takes LDLᵀ: stored errors have the last digits of this one.
Eigen::MatrixXd marched_mass(const Inertia& inertia) {
  if (inertia.assembled()) return Eigen::MatrixXd(inertia.mass);
  const MassFactors factors = mass_factors(inertia);
  const Eigen::MatrixXd B = factors.coupling, C = factors.velocity_mass;
  return B.transpose() * definite_solve(C, B);
}

}  // namespace

SparseRows place_rows(const SemiDiscrete& problem, const std::vector<double>& places) {
  if (!problem.space.given) return problem.on_unknowns(displacement_rows(problem.space, places));
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < places.size(); ++i)
    for (SparseRows::InnerIterator it(problem.tip, 0); it; ++it)
      entries.emplace_back(static_cast<int>(i), static_cast<int>(it.col()), it.value());
  SparseRows rows(static_cast<Eigen::Index>(places.size()), problem.dofs());
  rows.setFromTriplets(entries.begin(), entries.end());
  return rows;
}

SparseRows strain_rows(const SemiDiscrete& problem, const std::vector<double>& places) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < places.size(); ++i)
    for (const auto& [dof, value] : strain_row(problem.space, places[i]))
      entries.emplace_back(static_cast<int>(i), dof, value);
  SparseRows rows(static_cast<Eigen::Index>(places.size()), problem.space.dofs);
  rows.setFromTriplets(entries.begin(), entries.end());
  return problem.on_unknowns(std::move(rows));
}

DiscreteProblem discrete_problem(const SemiDiscrete& problem, const std::vector<double>& places) {
  DiscreteProblem discrete;
  discrete.mass = marched_mass(problem.inertia);
  discrete.stiffness = problem.stiffness;
  discrete.contact = problem.measured();
  discrete.lower = problem.lower;
  discrete.upper = problem.upper;
  discrete.support_shape = problem.support_shape;
  discrete.position = problem.position;
  discrete.velocity = problem.velocity;
  discrete.load_constant = Eigen::VectorXd::Zero(problem.dofs());
  if (!problem.load->absent()) problem.load->assemble(0, discrete.load_constant.data());
  discrete.tip = Eigen::MatrixXd(problem.tip).row(0);
  discrete.places = Eigen::MatrixXd(place_rows(problem, places));
  discrete.strains = Eigen::MatrixXd(strain_rows(problem, places));
  return discrete;
}

}  // namespace ricochet
