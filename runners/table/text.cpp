#include "runners/table/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/nil_generator.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>

namespace ricochet {

namespace {

/// The character that begins a text, its bytes taken from it; nothing where they are no UTF-8, one byte taken then.
std::optional<char32_t> take_character(std::string_view& text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xC2 ? 0
                             : first < 0xE0 ? 2
                             : first < 0xF0 ? 3
                             : first < 0xF5 ? 4
                                            : 0;
  char32_t code = length == 1 ? first : first & (0xFFU >> (length + 1));
  bool valid = length > 0 && length <= text.size();
  for (std::size_t i = 1; valid && i < length; ++i) {
    valid = (byte(i) & 0xC0U) == 0x80U;
    code = code << 6U | (byte(i) & 0x3FU);
  }
  // Longer than it needs to be, half of a pair of UTF-16, beyond the last one.
  valid = valid && !(length == 3 && code < 0x800) && !(length == 4 && (code < 0x10000 || code > 0x10FFFF)) &&
          !(code >= 0xD800 && code < 0xE000);
  text.remove_prefix(valid ? length : 1);
  return valid ? std::optional(code) : std::nullopt;
}

/// Whether a character steers what shows it: C0 without tab and line break, DEL, C1, marks of direction and of lines.
bool steers(char32_t code) {
  return (code < 0x20 && code != '\t' && code != '\n') || (code >= 0x7F && code < 0xA0) || code == 0x61C ||
         (code >= 0x200E && code <= 0x200F) || (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
}

}  // namespace

bool is_plain(std::string_view text) {
  while (!text.empty()) {
    const auto sign = static_cast<unsigned char>(text.front());
    if ((sign >= 0x20 && sign < 0x7F) || sign == '\t' || sign == '\n') {
      text.remove_prefix(1);
      continue;
    }
    const auto code = take_character(text);
    if (!code || steers(*code)) return false;
  }
  return true;
}

std::string plain_text(std::string_view text) {
  if (is_plain(text)) return std::string(text);
  std::string out;
  while (!text.empty()) {
    const std::string_view before = text;
    const auto code = take_character(text);
    if (!code)
      out += "\uFFFD";
    else if (steers(*code))
      out += fmt::format("<U+{:04X}>", static_cast<std::uint32_t>(*code));
    else
      out += before.substr(0, before.size() - text.size());
  }
  return out;
}

void append_csv_number(double value, std::string& text) {
  if (!std::isfinite(value)) return;
  std::array<char, 32> digits{};
  text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

std::string csv_number(double value) {
  std::string text;
  append_csv_number(value, text);
  return text;
}

std::string csv_field(std::string_view text) {
  if (!is_plain(text)) return csv_field(plain_text(text));
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string field = "\"";
  for (const char c : text) {
    if (c == '"') field += '"';
    field += c;
  }
  return field + '"';
}

std::string csv_cell(const Cell& cell) {
  return csv_field(cell.text());
}

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i > 0) line += ',';
    line += fields[i];
  }
  return line + '\n';
}

std::vector<std::string> csv_head(const std::vector<Column>& columns) {
  std::vector<std::string> fields;
  for (const Column& column : columns) fields.push_back(csv_field(column.name));
  return fields;
}

std::string table_csv(const Table& table) {
  std::string text = csv_line(csv_head(table.columns));
  std::vector<std::string> fields;
  for (const Row& row : table.rows) {
    fields.clear();
    for (const Cell& cell : row) fields.push_back(csv_cell(cell));
    text += csv_line(fields);
  }
  return text;
}

std::optional<double> number_in(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

void replace_all(std::string& text, std::string_view what, std::string_view with) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
}

std::string shell_quoted(std::string text) {
  replace_all(text, "'", "'\\''");
  return "'" + text + "'";
}

double to_digits(double value, int digits) {
  // Rounding the largest one would give none.
  return number_in(fmt::format("{:.{}e}", value, digits - 1)).value_or(value);
}

std::string with_minus(std::string text) {
  if (text.starts_with('-')) text.replace(0, 1, "−");
  return text;
}

std::string short_number(double value, int digits) {
  if (value == 0) return "0";
  if (std::isinf(value)) return value > 0 ? "∞" : "−∞";
  constexpr double small = 1e-3;
  if (std::abs(value) < small) {
    // "1e-4", not 0.0001.
    std::string text = fmt::format("{:.{}e}", value, digits - 1);
    const std::size_t at = text.find('e');
    std::string mantissa = text.substr(0, at);
    if (mantissa.find('.') != std::string::npos) {
      mantissa.erase(mantissa.find_last_not_of('0') + 1);
      if (mantissa.ends_with('.')) mantissa.pop_back();
    }
    return with_minus(fmt::format("{}e{}", mantissa, number_in(text.substr(at + 1)).value_or(0)));
  }
  constexpr double written_out = 1e5;
  // Of the rounded one: 9.9 to one digit is 10, not 1e1.
  value =
      to_digits(value, std::max(digits, std::abs(value) >= 1 ? static_cast<int>(std::log10(std::abs(value))) + 1 : 0));
  const int whole =
      std::abs(value) >= 1 && std::abs(value) < written_out ? static_cast<int>(std::log10(std::abs(value))) + 1 : 0;
  std::string text = fmt::format("{:.{}g}", value, std::max(digits, whole));
  if (const std::size_t at = text.find('e'); at != std::string::npos) {
    const double exponent = number_in(text.substr(at + 1)).value_or(0);
    text = fmt::format("{}e{}", text.substr(0, at), exponent);
  }
  return with_minus(text);
}

std::string short_number_down(double value, int digits) {
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - (digits - 1));
  constexpr double round_off = 1e-9;
  return short_number(std::floor(value / digit * (1 + round_off)) * digit, digits);
}

std::string fraction_text(double value) {
  if (value == 0.5) return "½";
  if (value == 0.25) return "¼";
  if (value == 0.75) return "¾";
  return short_number(value);
}

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

std::string content_hash(std::string_view content) {
  const boost::uuids::name_generator_sha1 generator(boost::uuids::nil_uuid());
  std::string text;
  for (const auto byte : generator(content.data(), content.size())) text += fmt::format("{:02x}", byte);
  return text;
}

}  // namespace ricochet
