#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <ricochet/contract/errors.hpp>
#include <ricochet/contract/reference.hpp>
#include <ricochet/kernels/dense_solvers.hpp>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/beam.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/clearances.hpp>
#include <ricochet/scene/named_stops.hpp>
#include <ricochet/scene/observed_rows.hpp>
#include <ricochet/scene/planes.hpp>
#include <ricochet/scene/scene.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/supports.hpp>
#include <ricochet/scene/surfaces.hpp>

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
  return combined(part_at(uniform_parts(in_plane(beam, along == 1 ? 0 : 1)), row.x).section.EI, row, 0, {});
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
    const std::vector<PlaceRow> rows = surface_rows(scene, problem.space, stops[i], i);
    if (rows.empty()) continue;
    problem.tangent_of[i] = count;
    // What moves the supports moves what a damper holds.
    const double held = stops[i].normal_force ? share_along_y(scene, stops[i].at) -
                                                    (stops[i].to ? share_along_y(scene, *stops[i].to) : 0.0)
                                              : 0.0;
    int own = count;
    for (const auto* tangent : {&stops[i].tangent, &stops[i].across}) {
      if (*tangent && ((*tangent)->speed != 0 || (*tangent)->motion))
        problem.surfaces.push_back(
            {own, (*tangent)->speed, (*tangent)->motion ? (*tangent)->motion->history : nullptr});
      ++own;
    }
    for (const PlaceRow& row : rows) {
      tangents.add(stops[i].name, row, held, true);
      ++count;
    }
  }
  problem.tangents = tangents.make();
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
  find_rubbing(scene, problem);
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
