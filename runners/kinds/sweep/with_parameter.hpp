#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runners/store/record.hpp"
#include "runners/study/study.hpp"

/// \file
/// Cases of the kinds that go through a parameter (bifurcation, basins): the case at one value, and what its settings
/// say.
namespace ricochet {

/// The case with one of its scalars changed: scene, scene_json, method parameters and axes follow. `pointer` names
///   · a number of the scene, "/scene/support/amplitude": set to `value`; so is a formula without variables ("-0.1"),
///   · a formula of the scene in x or t, "/scene/load": multiplied by `value`,
///   · a position of a list of stops, "/scene/stops/at/0",
///   · a real parameter of the case's own method, "/methods/contact/stiffness".
/// Throws InputError (with pointer) for a pointer that names none of these in this case, and for a value out of range.
/// Also for a scene that check_scene() refuses at this value. For cases that step by the forcing period, also for what
/// check_forcing() refuses.
StudyCase with_parameter(const StudyCase& study_case, const std::string& pointer, double value);

/// The same for several scalars at once; the scene is checked when all are changed.
StudyCase with_parameters(const StudyCase& study_case, const std::vector<std::pair<std::string, double>>& values);

/// The case at rest in the laboratory frame, u = u_t = 0, whatever its scene's initial state.
StudyCase at_rest(const StudyCase& study_case);

/// The values of the parameter, ascending.
std::vector<double> parameter_values(const Json& settings);

/// How an orbit begins.
struct StartSpec {
  enum Kind { rest, state, up, down, random };
  Kind kind = rest;
  int index = 0;           ///< of a random state, from 1; else 0
  std::uint64_t seed = 0;  ///< of the random states; else 0
  std::string name;        ///< as in the tables: "rest", "state", "up", "down", "random-1", …
  /// From the scene's own initial state; every other start is at rest in the laboratory frame, or random from there.
  bool own_state() const { return kind == state; }
};
/// The starts in the order of the study, random ones one by one.
std::vector<StartSpec> starts_of(const Json& settings);
/// Whether a start of that name is a random state.
bool is_random_start(const std::string& name);
/// Whether some start is of that sort.
bool any_start(const std::vector<StartSpec>& starts, bool own_state);

/// One axis of a grid of basins.
struct GridAxis {
  std::string pointer;
  std::vector<double> values;
};
/// The two axes of kind `basins`, x then y.
std::vector<GridAxis> grid_axes(const Json& settings);
/// Whether a pointer names a coordinate of the initial state: along it the scene, hence what it can end in, stays.
bool names_initial_state(const std::string& pointer);

/// Every scalar of a scene (with its values, lists included) that may be a parameter, as JSON pointers.
std::vector<std::string> scene_scalars(const Json& scene);

/// What a sweep goes through, as columns: the parameter of a diagram, or the two axes of a grid.
struct SweptColumns {
  Column parameter{"parameter", "that of the parameter", "Value of the swept parameter."};
  Column x{"x", "that of the axis", "Value on the first axis of the grid."};
  Column y{"y", "that of the axis", "Value on the second axis of the grid."};
};
/// The same with the names and units that the study gives them.
SweptColumns swept_columns(const StudyResults& results);
/// The axis that a pointer of the study goes through; a formula there is multiplied by the value.
struct SweptAxis {
  Column axis;
  bool factor = false;
};
/// That of {"pointer": …} in a study; nothing where there is no pointer.
std::optional<SweptAxis> swept_axis(const StudyResults& results, const nlohmann::ordered_json& where);
/// The parameter of a study as the column of an axis would be called: "support.amplitude"; "" without one.
std::string swept_name(const StudyResults& results);

}  // namespace ricochet
