#include "runners/command/plain.hpp"

#include <fmt/format.h>

namespace ricochet {

std::string plain(const nlohmann::ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_null()) return "none";
  if (value.is_number_float()) {
    const auto number = value.get<double>();
    const std::string exact = fmt::format("{}", number), brief = fmt::format("{:g}", number);
    return brief.size() < exact.size() && std::stod(brief) == number ? brief : exact;
  }
  return value.dump();
}

}  // namespace ricochet
