#pragma once
#include <cstddef>
#include <functional>
#include <ricochet/scene/scene.hpp>
#include <string>
#include <vector>

#include "runners/study/check_object.hpp"

/// \file
/// Several bodies in the place of one structure, and what meshes and modes they have.
namespace ricochet {

/// An object of names, each with a structure.
Json check_bodies(const Field& field, const Json& value, const std::string& pointer, std::vector<Axis>& axes);

/// Whether an object speaks of bodies by name: all that it holds are objects.
bool by_body(const Json& value);
/// The object that may stand for a value; of an object, one by body.
Json check_given(const Field& field, const Json& value, const std::string& pointer, std::vector<Axis>& axes);

/// A number for each body by name.
Json check_per_body(const Field& field, const Json& value, const std::string& pointer);

/// A mesh as a study says it: what it is called by, and the elements of each body where it says them.
struct MeshChoice {
  int elements = 1;
  Json of_bodies = nullptr;
};
/// Those of `mesh.elements`. Throws InputError for a body that has no number or is not there, and for two meshes with
/// as many elements in all.
std::vector<MeshChoice> meshes_of(const Json& mesh, const Json& scene);

/// What a study says of mesh.elements or mesh.modes (`key`) where a case calls it by this number: an entry by body, or
/// the number itself.
Json said_of_mesh(const Json& study, const std::string& key, const Json& number);

/// A scene that says the elements of each body; null: of none.
Json with_meshes(Json scene, const Json& of_bodies);

/// The entries of an object with a number for each body, in the order of the bodies; `pointer` names the object.
std::vector<int> of_bodies(const Json& numbers, const Json& scene, const std::string& pointer);

/// The structure of a scene, or its bodies.
const Json& structures_of(const Json& scene);

/// Whether some structure of a scene has a type out of these.
bool has_structure(const Json& scene, const std::vector<std::string>& types);

/// The structures of a checked scene that has bodies, which on_mesh() joins; scene["elements"] says the elements of
/// each. One body is a structure like any other.
StructureSpec read_bodies(const Json& scene, const std::function<StructureSpec(const Json&)>& read);

/// The scene of one body without the name of that body at its places; else as it is.
Json without_body(Json scene);

/// Of an error below /scene/structure in a scene of one body: the pointer that the study has.
std::string pointer_in_bodies(const std::string& pointer, const Json& scene);

// Where bodies that meet at stops are drawn: a study gives each its own x, and none a place among the others.

/// What a body looks like. Its x, m, goes from `first` over `length`; one that moves along its axis is `along`.
struct BodyShape {
  double first = 0, length = 0;
  bool along = false;
};

/// Two bodies at a stop, and where each has it, m. `below`: the first goes upwards to close it.
struct BodyMeeting {
  std::size_t at = 0, to = 0;
  double at_x = 0, to_x = 0;
  bool below = true;
};

/// x of a body is drawn at x + shift, m, in the row `row`, from 0 upwards.
struct BodyPlace {
  double shift = 0;
  int row = 0;
};

/// Bodies so that the first stop of each with those before it stands across from its partner. The one that goes upwards
/// is in the row beneath. Bodies that would overlap in a row take others; bodies that meet none stand above all.
std::vector<BodyPlace> body_places(const std::vector<BodyShape>& bodies, const std::vector<BodyMeeting>& meetings);

/// Whether every body moves along its axis: then rows go to the right, and each holds one.
bool all_along(const std::vector<BodyShape>& bodies);

}  // namespace ricochet
