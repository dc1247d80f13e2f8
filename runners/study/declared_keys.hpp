#pragma once
#include <string>
#include <vector>

#include "runners/study/fields.hpp"

/// \file
/// Where the study format declares what stands in a study.
namespace ricochet {

/// The keys of a scene.
const ObjectForm& scene_form();

/// An object that stands at a key: the key's own, one of a list, or that of a body.
struct StandingObject {
  std::string step;  ///< of a list its number, of bodies a name; "" for the key's own
  const ObjectForm* form = nullptr;
  const Json* value = nullptr;
};
/// The objects that make up the value of a key; none where it is no object.
std::vector<StandingObject> objects_at(const Field& field, const Json& value);

/// The declaration of the key at a JSON pointer, "/scene/stops/0/lower", in the form that this study has there; null
/// where the format has none. Of a place or a list of numbers also that of what it holds.
const Field* declared_at(const std::string& pointer, const Json& study);

/// What sentences call the key at a pointer, whatever study it stands in; "" where there are no such words.
std::string words_at(const std::string& pointer);

}  // namespace ricochet
