#pragma once
#include <cmath>
#include <optional>

#include "runners/store/record.hpp"

/// \file
/// What a record holds, by name.
namespace ricochet {

/// The measure of this name, if the case has it.
std::optional<double> measure(const CaseRecord& record, const std::string& name);

/// The case's value on this axis; null where it has no such axis.
nlohmann::ordered_json axis(const CaseRecord& record, const std::string& column);

/// The case's values on these axes, in their order.
std::vector<nlohmann::ordered_json> axes_of(const CaseRecord& record, const std::vector<std::string>& columns);

/// A cell of a table: null for what is absent or not finite.
nlohmann::ordered_json number(std::optional<double> value);

}  // namespace ricochet
