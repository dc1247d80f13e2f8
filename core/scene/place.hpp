#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace ricochet {

/// A place of a structure, as a study writes it. Exactly one of: x; node and component; node and direction; dofs;
/// point.
struct Place {
  std::optional<double> x;                   ///< m, along a beam or a bar
  std::string node, component;               ///< of matrices that are given
  std::vector<double> direction;             ///< three numbers, normalised when it is used
  std::vector<std::pair<int, double>> dofs;  ///< dof of the table, from 1, and weight
  std::string point;                         ///< of a structure in modes

  bool operator==(const Place&) const = default;
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
