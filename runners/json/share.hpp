#pragma once
#include <nlohmann/json.hpp>
#include <optional>

namespace ricochet {

/// A share as a study writes it: 0.05 of 0.05 and of "5 %"; nothing of what is none.
std::optional<double> share_of(const nlohmann::ordered_json& value);

}  // namespace ricochet
