#pragma once
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace ricochet {

struct MotionSpec;

/// A place of a structure, as a study writes it. Exactly one of: x; node and component; node and direction; dofs;
/// point. Of several bodies with the name of one; that of an oscillator needs no more.
struct Place {
  std::optional<double> x;                   ///< m, along a beam or a bar
  std::string node, component;               ///< of matrices that are given
  std::vector<double> direction;             ///< three numbers, normalised when it is used
  std::vector<std::pair<int, double>> dofs;  ///< dof of the table, from 1, and weight
  std::string point;                         ///< of a structure in modes
  std::string body = {};                     ///< empty where there is one

  bool operator==(const Place&) const = default;
};

/// A point that is shown: its name, its place, and whether its displacement counts from the supports.
struct PointSpec {
  std::string name;  ///< letters, digits, '-' and '_'
  Place at;
  bool from_supports = false;
  bool moment = false, shear = false;  ///< of a beam: whether M = EI θ' (N m) and M' (N) are shown there too
};

/// What moves along the surface of a stop while it is pushed. At most one is given beside the speed; of a stop with a
/// normal force none, as what slides there is the displacement of the stop itself. Of a clearance, the speed is that
/// of the rim of what moves in it, counter-clockwise from u₁ to u₂: r Ω of a rod that turns.
struct TangentSpec {
  double slope_radius = 0;        ///< m: r of r θ, the surface of a tube that bends
  std::vector<double> direction;  ///< three numbers, at the nodes of the stop
  std::string component;          ///< of the places of the stop
  double speed = 0;               ///< of the surface along it, m/s
  /// What the surface does along it beside that speed; null: nothing.
  std::shared_ptr<const MotionSpec> motion = {};

  bool given() const { return slope_radius > 0 || !direction.empty() || !component.empty(); }
};

/// The displacement at a place (or the difference of two) as Σ value·q_dof + Σ weight·(displacement of a support).
struct PlaceRow {
  std::vector<std::pair<int, double>> free;  ///< dof of the marched problem, value; each dof once, in order
  std::vector<std::pair<int, double>> held;  ///< number of a support, weight
  double x = 0;                              ///< m
};

/// a − b; the place stays that of a.
PlaceRow difference(const PlaceRow& a, const PlaceRow& b);

}  // namespace ricochet
