#pragma once
#include <array>
#include <cmath>
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/scene/place.hpp>
#include <ricochet/scene/scene.hpp>
#include <string>
#include <vector>

/// \file
/// Clearances: circles within which a place moves. Compliant laws meet the circle itself (circle_solver.hpp), rigid
/// ones a polygon of rows round it.
namespace ricochet {

/// A circle round a place, as a study says it.
struct ClearanceSpec {
  double radius = 0;                                  ///< m
  int sides = 16;                                     ///< of the polygon round the circle, 3 at least
  std::array<double, 2> offset = {0, 0};              ///< u₁, u₂ of the centre, m
  std::array<std::string, 2> components{"uy", "uz"};  ///< the displacements in its plane; of modes, what follows the
                                                      ///< name of their points and a dot
};

/// The rows of a clearance: a stop at its place for each pair of opposite sides, of an odd number for each side. The
/// polygon is circumscribed: its corners are radius/cos(π/sides) away. Throws InputError for bounds of its own, for
/// places that say a component, a direction or dofs.
std::vector<NamedStop> clearance_rows(const NamedStop& stop, const ClearanceSpec& clearance);

/// The two rows u₁, u₂ of the circle itself, from the first row of a clearance. Their bounds are those of the circle
/// along u₁ and u₂.
std::array<NamedStop, 2> circle_rows(const NamedStop& first);
/// The stops as a compliant law meets them: clearances are circles.
StopsSpec with_circles(StopsSpec stops);

/// What a polygon leaves of a circle, m: its corners lie r(1/cos(π/sides) − 1) beyond.
double polygon_error(double radius, int sides);

/// (cos α, sin α), exactly 0 where round-off alone is left of it.
inline std::array<double, 2> side_direction(double angle) {
  const auto exact = [](double value) { return std::abs(value) < 1e-15 ? 0.0 : value; };
  return {exact(std::cos(angle)), exact(std::sin(angle))};
}

/// Throws InputError where a place has no motion along a component of its clearance.
void check_clearance(const SceneSpec& scene, const FiniteElementSpace& space, const NamedStop& stop,
                     std::size_t number);

/// The displacement along an axis of a clearance, 0 or 1: at less that of to. `number`: of the stop's row, for
/// pointers. Throws InputError below its place, or at its components.
PlaceRow axis_row(const SceneSpec& scene, const FiniteElementSpace& space, const NamedStop& stop, std::size_t number,
                  int axis);

/// The row of a side, cos α u₁ + sin α u₂.
PlaceRow side_row(const SceneSpec& scene, const FiniteElementSpace& space, const NamedStop& stop, std::size_t number);

/// a x + b y; the place stays that of x.
PlaceRow combined(double a, const PlaceRow& x, double b, const PlaceRow& y);

/// A clearance among the contact points of a problem: rows first, first + 1, …, one after the other.
struct Clearance {
  std::string name;
  int first = 0;
  std::vector<double> angles;             ///< α of each row, rad
  double radius = 0;                      ///< m
  std::array<double, 2> offset = {0, 0};  ///< of the centre, m
  int sides = 0;                          ///< of its polygon
  bool circle = false;                    ///< whether its rows are u₁ and u₂, and the circle itself bounds them
  int last() const { return first + static_cast<int>(angles.size()) - 1; }
};
/// Those of a scene, in order.
std::vector<Clearance> clearances_of(const StopsSpec& stops);
/// A sentence for each polygon, which says how far it is from its circle.
std::vector<std::string> polygon_notes(const std::vector<Clearance>& clearances);

}  // namespace ricochet
