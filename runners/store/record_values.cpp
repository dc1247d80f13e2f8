#include "runners/store/record_values.hpp"

namespace ricochet {

std::optional<double> measure(const CaseRecord& record, const std::string& name) {
  for (const auto& [key, value] : record.measures)
    if (key == name) return value;
  return std::nullopt;
}

nlohmann::ordered_json axis(const CaseRecord& record, const std::string& column) {
  for (const auto& [name, value] : record.axes)
    if (name == column) return value;
  return nullptr;
}

nlohmann::ordered_json number(std::optional<double> value) {
  return value && std::isfinite(*value) ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

std::vector<nlohmann::ordered_json> axes_of(const CaseRecord& record, const std::vector<std::string>& columns) {
  std::vector<nlohmann::ordered_json> row;
  for (const std::string& column : columns) row.push_back(axis(record, column));
  return row;
}

}  // namespace ricochet
