#pragma once
#include <string>

#include "runners/study/fields.hpp"

namespace ricochet {

/// Checks a place of the structure, Field::Form::place: {"x"}, {"node", "component"}, {"node", "direction"} or
/// {"dofs": [{"dof", "weight"}]}, and returns it complete. Throws InputError by pointer.
Json check_place(const Field& field, const Json& value, const std::string& pointer);

/// Checks the three numbers of a direction. Throws InputError by pointer.
Json check_direction(const Json& value, const std::string& pointer);

/// JSON Schemas of a place, and of a direction.
Json direction_schema();
Json place_schema(const Field& field);

/// Checks what the program wrote of the files that a study names, Field::Form::files, or null.
Json check_files(const Json& value, const std::string& pointer);
/// Checks an object of any names, each with a text, Field::Form::named.
Json check_named(const Field& field, const Json& value, const std::string& pointer);

}  // namespace ricochet
