#pragma once
#include <array>
#include <optional>
#include <ricochet/scene/scene.hpp>
#include <string>
#include <vector>

#include "runners/study/fields.hpp"

/// \file
/// Keys of a scene beside those of its structure, with what is read of them.
namespace ricochet {

class StudyFiles;

/// The keys of a structure, alone or a body: beam, oscillator, bar, matrices or modes of files.
ObjectForm structure_form();

// How a scene begins: formulas, a file, or an object of these by body.

/// `initial` of a scene.
Field initial_key();
/// The initial state of a checked scene. Throws InputError for an unknown body, factors without a file.
InitialSpec read_initial(const Json& scene, StudyFiles* files);
/// The initial state of a scene, or those of its bodies.
std::vector<Json*> initial_objects(Json& scene);

// Keys of what is observed of a scene: points, and motions along the surfaces of stops; and parameters of stops.

/// `points` of a scene.
Field points_key();
/// What a stop of a list may say of its surface.
std::vector<Field> observed_of_stops();
/// What a stop of a list may have of its own, in the place of the methods' parameters.
std::vector<Field> parameters_of_stops();

Place read_place(const Json& json);
/// Whether a value is a word of `of_each` and a name in brackets: "impulse[bar-a]". Throws InputError for one that is
/// nearly so: another word in its place, or no name.
bool is_of_each(const Field& field, const Json& value, const std::string& pointer);
std::vector<PointSpec> read_points(const Json& scene);
/// Tangents, friction and normal force of a stop, which stands at `pointer`.
void read_surface(const Json& stop, const std::string& pointer, StudyFiles* files, NamedStop& out);
StopParameters read_own(const Json& stop);

// Keys of beams in two planes and of clearances.

/// `planes` of a beam, EI_z of a section that is given, `components` of a support.
Field planes_key();
Field EI_z_key();
Field components_of_support();
/// `component` of a load that is spread, and of a motion of supports.
Field component_key(const char* text);
/// u_z and its rate at t = 0.
std::vector<Field> initial_across_keys();
/// `clearance` of a stop.
Field clearance_key();

/// {u_y, u_z} of a support as it is checked.
std::array<bool, 2> read_components(const Json& support);

/// Adds a stop as its rows: itself, or of a clearance its sides. `one`: the stop as it is checked, of number `entry`.
/// Throws InputError for bounds beside a clearance, for a node without component where there is none.
void add_stop(NamedStop stop, const Json& one, std::size_t entry, std::vector<NamedStop>& rows);

/// A pointer that counts rows, as one that counts the stops of the study.
std::string pointer_in_study(const StopsSpec& stops, const std::string& pointer);

}  // namespace ricochet
