#pragma once
#include <string>
#include <vector>

#include "runners/study/fields.hpp"

namespace ricochet {

/// A list given where a scalar is expected.
struct Axis {
  std::string pointer;       ///< of the list
  std::vector<Json> values;  ///< checked; numbers of real fields are doubles
};

/// Checks a closed object against its form and returns it complete: keys in the order of the form, defaults written
/// out, lists kept. Lists that are axes are appended to `axes`. Methods and excludes are copied unchecked: they need
/// plugins and cases. Throws InputError for an unknown or missing key, a wrong type, a value out of range, a formula
/// that does not parse, an empty list.
Json check_object(const ObjectForm& form, const Json& value, const std::string& pointer, std::vector<Axis>& axes);

/// Checks a number, boolean or word as the field declares it.
Json check_single(const Field& field, const Json& value, const std::string& pointer);

/// Whether a list is one value of a formula that may also be a list of objects, and no axis.
bool is_object_list(const Field& field, const Json& value);

/// The fields that an object has, its variants resolved. Throws InputError when a discriminator is missing or unknown.
std::vector<const Field*> fields_of(const ObjectForm& form, const Json& value, const std::string& pointer);

/// Checks a place of the structure, Field::Form::place: {"x"}, {"node", "component"}, {"node", "direction"} or
/// {"dofs": [{"dof", "weight"}]}, and returns it complete. Throws InputError by pointer.
Json check_place(const Field& field, const Json& value, const std::string& pointer);

/// Checks the rows of a table. Throws InputError by pointer, with a sentence that begins with what was expected.
Json check_rows(const Json& value, const std::string& pointer, const std::string& expected);

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
