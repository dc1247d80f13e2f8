#pragma once
#include <ricochet/scene/scene.hpp>
#include <string>

#include "runners/study/fields.hpp"

/// \file
/// How a scene begins: formulas, a file, or an object of these by body.
namespace ricochet {

class StudyFiles;

/// `initial` of a scene.
Field initial_key();
/// The initial state of a checked scene. Throws InputError for an unknown body, factors without a file.
InitialSpec read_initial(const Json& scene, StudyFiles* files);
/// The initial state of a scene, or those of its bodies.
std::vector<Json*> initial_objects(Json& scene);

}  // namespace ricochet
