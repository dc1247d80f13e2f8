#pragma once
#include <optional>
#include <string>

#include "runners/kinds/continuation/study_points.hpp"

/// \file
/// Special points in words.
namespace ricochet {

/// What an orbit does at a point of a kind, and the point as a thing.
struct PointWords {
  const char *kind, *does, *thing;
};
const PointWords& point_words(const std::string& kind);
bool is_point_kind(const std::string& kind);
/// The kind of a name that an ask may use: "first contact" of "grazing".
std::string point_kind(std::string asked);
/// Whether two points are of one kind and their intervals overlap.
bool at_one_place(const StudyPoint& a, const StudyPoint& b);

/// "0.1005650 ± 1.2e-6": to the first digit of u, to the second where that is a 1; four digits without u.
std::string point_value(double value, std::optional<double> half);

}  // namespace ricochet
