#pragma once
#include <optional>
#include <string>

#include "runners/kinds/continuation/study_points.hpp"

/// \file
/// Special points in words.
namespace ricochet {

/// What an orbit does at a point of a kind, and the point as a thing.
struct PointWords {
  const char *does, *thing;
};
const PointWords& point_words(PointKind kind);
/// The kind that an ask names: a first contact of "grazing". Nothing where it names none at which an orbit changes.
std::optional<PointKind> point_kind(std::string asked);
/// Whether two points are of one kind and their intervals overlap.
bool at_one_place(const StudyPoint& a, const StudyPoint& b);

/// "0.1005650 ± 1.2e-6": to the first digit of u, to the second where that is a 1; four digits without u.
std::string point_value(double value, std::optional<double> half);

}  // namespace ricochet
