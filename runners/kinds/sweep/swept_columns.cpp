#include "runners/kinds/sweep/swept_columns.hpp"

#include <algorithm>

#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

// "/scene/support/amplitude" as the column of an axis.
std::string column_name(std::string pointer) {
  for (const std::string prefix : {"/scene/", "/methods/"})
    if (pointer.starts_with(prefix)) {
      pointer.erase(0, prefix.size());
      break;
    }
  std::replace(pointer.begin(), pointer.end(), '/', '.');
  return pointer;
}

// What a pointer of the study goes through, in the column `plain`.
Column swept_column(const StudyResults& results, const Column& plain, const nlohmann::ordered_json& where) {
  const std::optional<SweptAxis> swept = swept_axis(results, where);
  if (!swept) return plain;
  const auto& [axis, factor] = *swept;
  return {plain.name, factor ? "1" : axis.unit,
          plain.text + (factor ? " It multiplies " : " It is ") + axis.name + ": " + axis.text};
}

}  // namespace

std::optional<SweptAxis> swept_axis(const StudyResults& results, const nlohmann::ordered_json& where) {
  if (!where.is_object() || !where.contains("pointer") || !where.at("pointer").is_string()) return std::nullopt;
  const auto pointer = where.at("pointer").get<std::string>();
  SweptAxis out{axis_column(results, column_name(pointer))};
  try {
    const nlohmann::ordered_json::json_pointer place(pointer);
    out.factor = pointer.starts_with("/scene/") && results.study.contains(place) && results.study.at(place).is_string();
  } catch (const nlohmann::ordered_json::exception&) {
    return std::nullopt;
  }
  return out;
}

std::string swept_name(const StudyResults& results) {
  const auto parameter = results.study.find("parameter");
  if (parameter == results.study.end() || !parameter->is_object()) return "";
  return column_name(parameter->value("pointer", ""));
}

SweptColumns swept_columns(const StudyResults& results) {
  SweptColumns out;
  if (results.study.contains("parameter"))
    out.parameter = swept_column(results, out.parameter, results.study.at("parameter"));
  const auto axes = results.study.find("axes");
  if (axes == results.study.end() || !axes->is_array() || axes->size() != 2) return out;
  out.x = swept_column(results, out.x, axes->at(0));
  out.y = swept_column(results, out.y, axes->at(1));
  return out;
}

}  // namespace ricochet
