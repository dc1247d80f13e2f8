#include "runners/report/quantity.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <map>

#include "runners/report/html.hpp"
#include "runners/study/axis_meaning.hpp"

namespace ricochet::report {

std::string axis_text(const StudyResults& results, const std::string& column) {
  const std::size_t owner = column.find('.'), name = column.find('.', owner + 1);
  if (axis_role(column) != column || owner == std::string::npos) return column;
  const std::string last = in_words(column.substr(column.rfind('.') + 1));
  if (name != std::string::npos && column.starts_with("bodies."))
    return last + " of " + column.substr(owner + 1, name - owner - 1);
  if (name != std::string::npos && column.starts_with("stops.")) {
    const nlohmann::ordered_json::json_pointer place("/scene/stops/" + column.substr(owner + 1, name - owner - 1) +
                                                     "/name");
    if (results.study.contains(place) && results.study.at(place).is_string())
      return last + " of " + results.study.at(place).get<std::string>();
  }
  const std::string said = spoken_choice(column);
  return said.starts_with("the ") ? said.substr(4) : said;
}

std::string shown_unit(const std::string& unit) {
  return unit == "1" ? "" : unit;
}

std::string with_unit(const Quantity& quantity) {
  const std::string unit = shown_unit(quantity.unit);
  return unit.empty() ? quantity.name : quantity.name + " (" + unit + ")";
}

Quantity error_quantity(const std::string& error) {
  static const std::map<std::string, std::string> units = {
      {"tip-linf", "m"}, {"tip-l2", "m"}, {"energy", "J"}, {"impact-times", "s"}, {"impulse", "N s"}};
  const auto found = units.find(error);
  return {"error " + error, found == units.end() ? "1" : found->second};
}

std::string order_number(double order) {
  std::string text = fmt::format("{:.2f}", order);
  if (text == "-0.00") return "0.00";
  if (text[0] == '-') text.replace(0, 1, "−");
  return text;
}

std::string power_text(double value) {
  const double exponent = std::log10(value);
  if (std::abs(exponent - std::round(exponent)) > 1e-9) return number_text(value);
  static constexpr const char* digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  const auto whole = std::lround(exponent);
  std::string out = whole < 0 ? "10⁻" : "10";
  for (const char c : std::to_string(std::abs(whole))) out += digits[c - '0'];
  return out;
}

}  // namespace ricochet::report
