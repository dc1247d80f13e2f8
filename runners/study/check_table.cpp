#include <ricochet/contract/parameters.hpp>

#include "runners/json/json_text.hpp"
#include "runners/study/check_object.hpp"
#include "runners/study/fields.hpp"

namespace ricochet {

Json check_rows(const Json& value, const std::string& pointer, const std::string& expected) {
  if (!value.is_array()) throw InputError(pointer, expected + ", found " + quote(value));
  ParameterTable table;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const Json& row = value[i];
    if (!row.is_array() || row.size() != 2 || !row[0].is_number() || !row[1].is_number())
      throw InputError(pointer_to(pointer, i), expected + "; found " + quote(row) + " as a row");
    table.push_back({row[0].get<double>(), row[1].get<double>()});
  }
  if (const auto fault = check_table(table))
    throw InputError(table.size() < 2 ? pointer : pointer_to(pointer, fault->row), expected + "; " + fault->text);
  return to_json(table);
}

}  // namespace ricochet
