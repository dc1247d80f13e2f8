#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <ricochet/contract/registry.hpp>
#include <ricochet/measure/orbits/point_kind.hpp>
#include <string>
#include <vector>

#include "runners/study/fields.hpp"
#include "runners/study/study.hpp"

/// \file
/// What a study of kind `continuation` says, and what is refused of it.
namespace ricochet {

/// Where an orbit is looked for.
enum class OrbitSource { rest, state, free, stored };

/// Whether an orbit is solved by half its period and the change of sign.
enum class HalfMap { automatic, yes, no };

/// An orbit that branches begin with.
struct WantedOrbit {
  std::string name;  ///< "orbit-1": what its branches are called by
  double at = 0;     ///< value of the parameter
  OrbitSource from = OrbitSource::rest;
  int periods = 300;  ///< marched before the first solve
  int period = 1;     ///< p of P^p(x) = x
  HalfMap symmetric = HalfMap::automatic;
  std::string study, case_id, start;  ///< of a stored orbit
  std::optional<double> parameter;
};

/// How branches are followed.
enum class Follow { automatic, pieces, steps, none };

/// The keys of a study in the form in which a case uses them.
struct ContinuationPlan {
  std::string pointer;
  double from = 0, to = 0;
  std::vector<WantedOrbit> orbits;
  Follow follow = Follow::automatic;
  bool both_ways = true;
  std::vector<PointKind> branch_at, stop_at;  ///< kinds of special points
  int depth = 1;                              ///< of branches that begin on branches
  std::optional<double> prominence;           ///< in units of the parameter
  int multipliers = 4;
  std::vector<double> marks;
  long long most_pieces = 200000;
  std::optional<double> longest;  ///< arc, m
  double range() const { return to - from; }
  /// Arclength at which a branch ends, m. Without one of the study ten times the gap and the range: a branch that goes
  /// to and fro over both some times ends at ends of its own. `metres`: of one unit of the parameter.
  double longest_arc(double gap, double metres) const { return longest.value_or(10 * (gap + metres * range())); }
};

std::vector<Field> continuation_keys();
/// Everything that determines the results of a case.
Json continuation_settings(const Json& resolved);
/// Throws InputError where keys contradict each other.
void check_continuation(const Json& resolved);
/// Throws InputError where the pointer names no real number of the scene or of a method.
void check_followed(const Json& resolved, const Json& settings, const Registry& registry, double cases, int dofs);
/// Whether the scene is possible at an end of the range or at an orbit.
bool some_orbit_possible(const StudyCase& study_case);
/// Throws InputError where no case has a forcing period, or none can run.
void check_continued_cases(const Study& study);
/// The settings of a case.
ContinuationPlan continuation_plan(const Json& settings);

/// Points of the section of a bifurcation study.
struct PointsBeneath {
  std::vector<double> parameter, tip;  ///< tip: m, at the strobe, absolute
  std::size_t stored = 0;              ///< of which these are evenly chosen
};
/// Those of the folder that a study of kind `continuation` names as `beneath`, at most so many. Throws InputError where
/// it holds no strobes at phase 0 of the same scene along the same parameter.
PointsBeneath points_beneath(const nlohmann::ordered_json& study, std::size_t most);
/// Throws what points_beneath() does; nothing where the study names no folder.
void check_beneath(const nlohmann::ordered_json& study);

}  // namespace ricochet
