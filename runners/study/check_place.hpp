#pragma once
#include <string>

#include "runners/study/fields.hpp"

namespace ricochet {

/// Checks a place of the structure, Field::Form::place: {"x"}, {"node", "component"}, {"node", "direction"} or
/// {"dofs": [{"dof", "weight"}]}, and returns it complete. Throws InputError by pointer.
Json check_place(const Field& field, const Json& value, const std::string& pointer);

/// Its JSON Schema.
Json place_schema(const Field& field);

}  // namespace ricochet
