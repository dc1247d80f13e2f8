#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "runners/store/record.hpp"

namespace ricochet {

/// What a sweep goes through, as columns: the parameter of a diagram, or the two axes of a grid.
struct SweptColumns {
  Column parameter{"parameter", "that of the parameter", "Value of the swept parameter."};
  Column x{"x", "that of the axis", "Value on the first axis of the grid."};
  Column y{"y", "that of the axis", "Value on the second axis of the grid."};
};
/// The same with the names and units that the study gives them.
SweptColumns swept_columns(const StudyResults& results);
/// The axis that a pointer of the study goes through; a formula there is multiplied by the value.
struct SweptAxis {
  Column axis;
  bool factor = false;
};
/// That of {"pointer": …} in a study; nothing where there is no pointer.
std::optional<SweptAxis> swept_axis(const StudyResults& results, const nlohmann::ordered_json& where);
/// The parameter of a study as the column of an axis would be called: "support.amplitude"; "" without one.
std::string swept_name(const StudyResults& results);

}  // namespace ricochet
