#pragma once
#include <functional>
#include <ricochet/measure/attractors/basin_grid.hpp>
#include <string>
#include <vector>

#include "runners/asks/evidence.hpp"

/// \file
/// What the kinds that find motions answer alike: whether a choice changes them.
namespace ricochet {

/// "period 2", "period 2 with chatter", "chaos", "no contact".
std::string motion_words(const MotionClass& motion);
/// Of the words of text(): "periodic 2", or another word as it is.
std::string motion_words(const std::string& motion);

/// Two cases, place by place: cells of a grid, values of a parameter.
struct MotionCounts {
  std::size_t both = 0;     ///< decided in both
  std::size_t changed = 0;  ///< of these
  std::size_t open = 0;     ///< undecided or failed in one, and not failed in both
};
/// A place has changed where class or period are others, or where it goes over to another of the motions that both
/// have. Motions of one class are matched by the places that they share, the most first, whatever their numbers.
MotionCounts compare_motions(const std::vector<GridCell>& one, const std::vector<GridCell>& other);

/// The places of a case, in an order that all cases have; null where it has none.
using MotionsOf = std::function<const std::vector<GridCell>*(const CaseRecord& record)>;

/// What a kind calls its places: "starts", "values".
asks::Answered effect_on_motions(const asks::Ask& ask, const asks::Evidence& evidence, const MotionsOf& motions,
                                 const std::string& places);
/// Refuses a choice that does not vary, and "from" beside "within".
void check_effect_on_motions(const Study& study, const Json& ask, const std::string& pointer);

/// What a study of motions that asks nothing is asked: its motions, then the effect of what it compares on them, or of
/// every role and every number of steps that vary.
Json default_motion_asks(const Json& resolved, const std::string& subject);

}  // namespace ricochet
