#include <fmt/format.h>

#include <algorithm>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/beam.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/named_stops.hpp>
#include <ricochet/scene/observed_rows.hpp>
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
    if (!moved) return;
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

// M = EI θ' or M' at a point of a beam; where the section changes, of what stands to the right.
PlaceRow field_row(const SceneSpec& scene, const FiniteElementSpace& space, const PointSpec& point, ShapeOf what,
                   const std::string& pointer) {
  const PlaceRow row = section_row(scene, space, point.at, what, pointer);
  const JoinedBodies* bodies = bodies_of(scene.structure);
  const StructureSpec& bent = bodies ? bodies->of(point.at, pointer).alone.structure : scene.structure;
  return scaled(row, part_at(uniform_parts(std::get<BeamSpec>(bent)), row.x).section.EI);
}

// The place of a node with another component or direction.
Place turned(const Place& place, const TangentSpec& tangent) {
  Place out;
  out.node = place.node;
  out.component = tangent.component;
  out.direction = tangent.direction;
  return out;
}

PlaceRow tangent_row(const SceneSpec& scene, const FiniteElementSpace& space, const NamedStop& stop,
                     std::size_t number) {
  const TangentSpec& tangent = *stop.tangent;
  const std::string pointer = tangent_pointer(number);
  const auto row = [&](const Place& place) {
    if (tangent.slope_radius > 0) {
      if (!place.x)
        throw InputError(pointer + "/slope_radius",
                         "the slope is that of a beam; expected direction or component, or a stop at {\"x\"}");
      return scaled(section_row(scene, space, place, ShapeOf::rotation, pointer), tangent.slope_radius);
    }
    if (place.node.empty())
      throw InputError(pointer, fmt::format("stop {} is not at a node; expected {}", stop.name,
                                            place.x ? "slope_radius" : "a stop at {\"node\"}"));
    return place_row(scene, space, turned(place, tangent), pointer);
  };
  return stop.to ? difference(row(stop.at), row(*stop.to)) : row(stop.at);
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
    if (point.moment || point.shear) field_row(scene, space, point, ShapeOf::curvature, point_pointer(i, "/fields"));
  }
  const auto* assembled = std::get_if<AssembledSpec>(&scene.structure);
  if (assembled && assembled->tip && !scene.points.empty())
    throw InputError("/scene/structure/tip", "does not go together with points: the first point is the tip");
}

void check_tangents(const SceneSpec& scene, const FiniteElementSpace& space) {
  for (std::size_t i = 0; i < scene.stops.named.size(); ++i)
    if (scene.stops.named[i].tangent) tangent_row(scene, space, scene.stops.named[i], i);
}

void observe_rows(const SceneSpec& scene, SemiDiscrete& problem) {
  RowMaker points(problem, scene.points.size());
  // All supports of a beam, a bar or an oscillator move by φ, and what stands between them with them.
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    const PointSpec& point = scene.points[i];
    points.add(point.name, place_row(scene, problem.space, point.at, point_pointer(i, "/at")),
               point.from_supports ? 0.0 : 1.0, !point.from_supports);
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
  RowMaker tangents(problem, stops.size());
  problem.tangent_of.assign(stops.size(), -1);
  int count = 0;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    if (!stops[i].tangent) continue;
    problem.tangent_of[i] = count++;
    tangents.add(stops[i].name, tangent_row(scene, problem.space, stops[i], i), 0, true);
  }
  problem.tangents = tangents.make();
}

}  // namespace ricochet
