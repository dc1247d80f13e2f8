#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace ricochet {

/// A value of an axis as a person reads it: words bare, numbers in their shortest form, null as "none".
std::string plain(const nlohmann::ordered_json& value);

}  // namespace ricochet
