#pragma once
#include <string>
#include <vector>

#include "runners/kinds/continuation/point_tables.hpp"
#include "runners/kinds/continuation/study_points.hpp"

namespace ricochet {

/// What an orbit does at a point of a kind, and the point as a thing.
struct PointWords {
  const char *kind, *does, *thing;
};
const PointWords& point_words(const std::string& kind);
bool is_point_kind(const std::string& kind);

/// A point that an answer tells.
struct ToldPoint {
  const PointName* name = nullptr;
  const PointLimitRow* limit = nullptr;  ///< of the reference's method
  const StudyPoint* point = nullptr;     ///< of the reference case
  bool ends_stability = false;           ///< stable orbits lie on one side of it alone
};

/// The named points of the reference's method at which stable orbits end, and its first contacts; all where none ends
/// them. One of each kind stands before a second of any. A fold at a first contact is told as the contact.
std::vector<ToldPoint> told_points(const StudyPoints& study, const std::vector<PointLimitRow>& limits,
                                   const std::vector<PointOrderRow>& orders);

}  // namespace ricochet
