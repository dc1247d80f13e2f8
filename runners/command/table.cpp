#include "runners/command/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ricochet {
namespace {

std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

}  // namespace

std::string TextTable::text(std::size_t indent) const {
  const std::size_t columns = rows_.front().size();
  std::vector<std::size_t> widths(columns, 0), shown;
  for (std::size_t column = 0; column < columns; ++column) {
    bool empty = true;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      widths[column] = std::max(widths[column], width(rows_[row][column]));
      empty = empty && (row == 0 || rows_[row][column].empty());
    }
    if (!empty) shown.push_back(column);
  }
  std::string result;
  for (const auto& row : rows_) {
    std::string line(indent, ' ');
    for (const std::size_t column : shown)
      line += row[column] + std::string(widths[column] - width(row[column]) + 2, ' ');
    while (!line.empty() && line.back() == ' ') line.pop_back();
    result += line + "\n";
  }
  return result;
}

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

std::string plain_seconds(double seconds) {
  // Two digits, never in scientific notation.
  const auto two = [](double value) {
    return value < 9.95 ? fmt::format("{:.1f}", value) : fmt::format("{:.0f}", value);
  };
  if (seconds < 1e-3) return two(seconds * 1e6) + " µs";
  if (seconds < 1) return two(seconds * 1e3) + " ms";
  if (seconds < 99.5) return two(seconds) + " s";
  const double whole = std::round(seconds), minutes = std::floor(whole / 60);
  if (minutes < 100) return fmt::format("{:.0f} min {:.0f} s", minutes, whole - 60 * minutes);
  return fmt::format("{:.0f} h {:.0f} min", std::floor(minutes / 60), minutes - 60 * std::floor(minutes / 60));
}

}  // namespace ricochet
