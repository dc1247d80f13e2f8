#include "runners/json/share.hpp"

#include <string>

#include "runners/table/text.hpp"

namespace ricochet {

std::optional<double> share_of(const nlohmann::ordered_json& value) {
  if (value.is_number()) return value.get<double>();
  if (!value.is_string()) return std::nullopt;
  auto text = value.get<std::string>();
  if (!text.ends_with("%")) return std::nullopt;
  text.pop_back();
  while (text.ends_with(" ")) text.pop_back();
  constexpr double hundred = 100;
  const auto number = number_in(text);
  return number ? std::optional(*number / hundred) : std::nullopt;
}

}  // namespace ricochet
