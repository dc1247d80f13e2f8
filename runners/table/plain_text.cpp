#include "runners/table/plain_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ricochet {

std::size_t shown_width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string TextTable::text(std::size_t indent) const {
  const std::size_t columns = rows_.front().size();
  std::vector<std::size_t> widths(columns, 0), shown;
  for (std::size_t column = 0; column < columns; ++column) {
    bool empty = true;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      widths[column] = std::max(widths[column], shown_width(rows_[row][column]));
      empty = empty && (row == 0 || rows_[row][column].empty());
    }
    if (!empty) shown.push_back(column);
  }
  std::string result;
  for (const auto& row : rows_) {
    std::string line(indent, ' ');
    for (const std::size_t column : shown)
      line += row[column] + std::string(widths[column] - shown_width(row[column]) + 2, ' ');
    while (!line.empty() && line.back() == ' ') line.pop_back();
    result += line + "\n";
  }
  return result;
}

std::string duration_text(double seconds) {
  constexpr long long minute = 60, hour = 3600;
  const auto two = [](double value) {
    return value < 9.95 ? fmt::format("{:.1f}", value) : fmt::format("{:.0f}", value);
  };
  if (seconds < 1e-3) return two(seconds * 1e6) + " µs";
  if (seconds < 1) return two(seconds * 1e3) + " ms";
  if (seconds < 9.95) return two(seconds) + " s";
  const long long whole = std::llround(seconds);
  if (whole < minute) return fmt::format("{} s", whole);
  if (whole < hour) return fmt::format("{} min {:02} s", whole / minute, whole % minute);
  return fmt::format("{} h {:02} min", whole / hour, whole % hour / minute);
}

std::string size_text(double bytes) {
  constexpr const char* units[] = {"B", "kB", "MB", "GB", "TB", "PB"};
  constexpr double thousand = 1000, two_digits = 9.95;
  std::size_t unit = 0;
  while (bytes >= thousand - 0.5 && unit + 1 < std::size(units)) {
    bytes /= thousand;
    ++unit;
  }
  return fmt::format("{:.{}f} {}", bytes, unit > 0 && bytes < two_digits ? 1 : 0, units[unit]);
}

}  // namespace ricochet
