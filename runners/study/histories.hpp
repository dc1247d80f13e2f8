#pragma once
#include <ricochet/scene/scene.hpp>
#include <string>
#include <vector>

#include "runners/study/fields.hpp"

/// \file
/// Quantities over time that a scene gives otherwise than by a formula: tables, random loads, motions of supports.
namespace ricochet {

class StudyFiles;

/// What may stand in the place of a load's formula in t: a table in a file, or a spectrum.
ObjectForm load_history(const char* unit);
/// What may stand in the place of a surface's speed: a table in a file, or a formula that is sampled.
ObjectForm speed_history();
/// One entry of scene.motions.
ObjectForm motion_form();
/// The same of a stop.
ObjectForm stop_motion_form();

/// The history of a term of the load, as it was checked; `number` tells random loads of one seed apart. Throws
/// InputError for a table that is none, a spectrum that is none.
void read_load_history(const Json& json, const std::string& pointer, StudyFiles* files, long long seed,
                       std::size_t number, LoadTerm& term);
MotionSpec read_motion(const Json& json, const std::string& pointer, StudyFiles* files);
/// A speed of a surface: its mean where it repeats, and what is beside it.
void read_speed(const Json& json, const std::string& pointer, StudyFiles* files, TangentSpec& tangent);

/// Throws InputError where a table of the scene begins after t = 0 or ends before `duration` (s) and does not say what
/// holds there.
void check_tables(const SceneSpec& scene, double duration);

/// Every history of a scene that names a file.
std::vector<Json*> histories_with_files(Json& scene);

}  // namespace ricochet
