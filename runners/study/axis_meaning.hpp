#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <ricochet/contract/registry.hpp>
#include <string>
#include <vector>

#include "runners/table/table.hpp"

namespace ricochet {

struct Study;

/// What an axis of a study means, as the study format declares it. Unit and sentence are those of the key that the
/// column names (`step`, `elements`, `support.amplitude`, …) in the study `resolved`. Of a method's parameter the
/// format knows only whose it is; its unit is then "".
Column axis_meaning(const std::string& column, const nlohmann::ordered_json& resolved);

/// The parts of a column between its dots: stops, 0, upper of stops.0.upper.
std::vector<std::string> column_parts(const std::string& column);

/// The roles of methods that a study crosses: mass, contact, friction, time.
const std::vector<std::string>& method_roles();
bool is_method_role(const std::string& column);

/// The role of a method's axis, "mass" of "mass.velocity" and of "mass"; the column itself where it is no method's.
std::string axis_role(const std::string& column);

/// A choice in a sentence: "the mass matrix", "the step"; the column itself where there is no such word. Two joined
/// by × are said together, of one method as that method.
std::string spoken_choice(const std::string& column);

/// Every axis of a study that is about to run; parameters of methods as their plugins declare them.
std::vector<Column> axis_meanings(const Study& study, const Registry& registry);

/// Study::method_words of a study that is about to run.
std::map<std::string, std::string> method_words(const Study& study, const Registry& registry);

}  // namespace ricochet
