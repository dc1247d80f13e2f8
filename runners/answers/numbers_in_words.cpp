#include "runners/answers/numbers_in_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/report/html.hpp"
#include "runners/table/text.hpp"

namespace ricochet::answers {
namespace {

constexpr double smallest_percent = 1e-9;  // as a share
constexpr double many = 1e5;
constexpr double begins_with_one = 1.95;  // an uncertainty that does has two digits

double magnitude(double value) {
  return std::pow(10, std::floor(std::log10(std::abs(value))));
}

/// Decimal places that an uncertainty leaves: to its first digit, to the second where that is a 1 and `fine`.
int decimals(double uncertainty, bool fine) {
  int exponent = static_cast<int>(std::floor(std::log10(uncertainty)));
  if (fine && uncertainty / std::pow(10, exponent) < begins_with_one) --exponent;
  constexpr int most = 14;
  return std::clamp(-exponent, 0, most);
}

std::string fixed(double value, int places) {
  std::string text = fmt::format("{:.{}f}", value, places);
  if (text.find_first_not_of("-0.") == std::string::npos) return "0";
  return with_minus(text);
}

std::string unit_after(const MeasureWords& measure) {
  return measure.unit.empty() ? "" : " " + measure.unit;
}

}  // namespace

std::string capitalised(std::string text) {
  // A first letter beyond ASCII stays: β, θ.
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

MeasureWords measure_words(const std::string& measure) {
  MeasureWords out;
  out.measure = measure;
  const MeasureInfo* info = measure_info(measure);
  out.words = info && *info->reading.words ? info->reading.words : report::in_words(measure);
  if (!info) return out;
  out.scale = info->scale;
  out.decades = info->reading.decades;
  out.direction = info->reading.direction;
  out.truth = info->reading.truth;
  if (out.direction > 0) out.most = out.truth;
  out.unit = std::string(info->unit) == "1" ? "" : info->unit;
  if (out.scale == "1" || out.scale == "energy_brought_in") {
    out.unit = out.decades ? "of the energy" : "%";
    out.factor = out.decades ? 1 : 100;
  }
  return out;
}

namespace {

/// Significant digits of v down to the last digit of an uncertainty u > 0.
int digits_down_to(double v, double u, bool fine) {
  const int extra = fine && u < begins_with_one * magnitude(u) ? 1 : 0;
  return static_cast<int>(std::floor(std::log10(std::abs(v))) - std::floor(std::log10(u))) + 1 + extra;
}

/// Decimal places with which what a per cent lacks of 100 keeps two digits.
int places_of_percent(double v) {
  const double lacking = 100 - std::abs(v);
  const int wanted = lacking > 0 && lacking < 1 ? 1 - static_cast<int>(std::floor(std::log10(lacking))) : 2;
  return std::max(wanted, std::abs(v) < 1 ? 3 : 2);
}

/// `few`: no more digits than are read, whatever u allows; else as many as u asks for, so that value ± u holds the
/// value.
std::string value_to(const MeasureWords& measure, double value, std::optional<double> uncertainty, bool with_unit,
                     bool fine, bool few = true) {
  const std::string unit = with_unit ? unit_after(measure) : "";
  const double v = value * measure.factor;
  double u = std::isfinite(uncertainty.value_or(0)) ? measure.factor * uncertainty.value_or(0) : 0;
  if (measure.decades) return short_number(v, 2) + unit;
  // Of a sequence that is the same within round-off the value alone is said.
  constexpr double round_off = 1e-9;
  const bool known = u > 0 && u <= round_off * std::abs(v);
  if (known) u = 0;
  if (v == 0 && u == 0) return "0" + unit;
  if (measure.unit.empty() && u < 1 && v == std::round(v) && std::abs(v) < many) return fmt::format("{:.0f}", v);
  // All of it, as far as four digits of a per cent say.
  constexpr double all_of_it = 5e-5;
  const double lacking = std::abs(v - 100);
  if (measure.unit == "%" && lacking < all_of_it && (few || u == 0 || lacking <= u)) return "100" + unit;
  constexpr double negligible = 0.05;  // half of what the last digit of u tells
  if (std::abs(v) < negligible * u) return "0" + unit;
  constexpr double small = 1e-3, large = 1e5;
  if (std::abs(v) < small || std::abs(v) >= large) {
    constexpr int least = 2, read = 4, of_known = 6;
    const int digits = u > 0 ? std::max(least, digits_down_to(v, u, fine)) : known ? of_known : read;
    return short_number(v, few && u > 0 ? std::min(digits, read) : digits) + unit;
  }
  const bool of_percent = few && measure.factor == 100 && std::abs(v) < 100;
  if (u <= 0) return (of_percent && lacking < 1 ? fixed(v, places_of_percent(v)) : short_number(v)) + unit;
  const double shown = std::min(u, std::abs(v) > 0 ? std::abs(v) : u);
  int places = decimals(!few && measure.factor == 100 ? u : shown, fine);
  u = shown;
  if (of_percent) places = std::min(places, places_of_percent(v));
  constexpr int read_places = 6;
  if (few) places = std::min(places, read_places);
  if (u >= 10 && std::abs(v) >= 10) {
    const double digit = magnitude(u) / (fine && u < begins_with_one * magnitude(u) ? 10 : 1);
    return fixed(std::round(v / digit) * digit, 0) + unit;
  }
  return fixed(v, places) + unit;
}

}  // namespace

std::string value_text(const MeasureWords& measure, double value, std::optional<double> uncertainty, bool with_unit) {
  return value_to(measure, value, uncertainty, with_unit, true);
}

std::string range_text(const MeasureWords& measure, double low, double high, std::optional<double> uncertainty) {
  if (low > high) std::swap(low, high);
  const double half = 0.5 * (high - low);
  const auto bound = [&](double value, bool with_unit) {
    return value_to(measure, value, half > 0 ? half : uncertainty, with_unit, half <= 0);
  };
  const std::string from = bound(low, false), to = bound(high, false);
  if (from == to) return value_text(measure, 0.5 * (low + high), std::max(half, uncertainty.value_or(0)));
  return from + " to " + to + unit_after(measure);
}

std::string uncertainty_text(const MeasureWords& measure, double uncertainty) {
  const double u = measure.factor * uncertainty;
  const int digits = u > 0 && u < begins_with_one * magnitude(u) ? 2 : 1;
  // As the value: 159 of two digits is 160, and 1.04 is 1.0.
  constexpr double small = 1e-3, whole = 10;
  if (u >= small && u < whole) return fixed(u, decimals(u, true)) + unit_after(measure);
  return short_number(to_digits(u, digits), digits) + unit_after(measure);
}

std::string with_uncertainty(const MeasureWords& measure, double value, std::optional<double> uncertainty) {
  constexpr double round_off = 1e-9;
  if (!uncertainty || !(*uncertainty > round_off * std::abs(value)) || !std::isfinite(*uncertainty))
    return value_text(measure, value, uncertainty);
  return value_to(measure, value, uncertainty, false, true, false) + " ± " + uncertainty_text(measure, *uncertainty);
}

std::string percent(double share) {
  const double size = std::abs(share);
  constexpr double times = 10, whole = 0.995;
  if (size < smallest_percent) return "0 %";
  if (size >= times) return short_number(share, 2) + " times";
  if (size >= whole) return fmt::format("{:.0f} %", 100 * share);
  return short_number(100 * share, 2) + " %";
}

std::string percent_beside(double share, double other) {
  std::string text = percent(share);
  constexpr int most = 15;
  for (int digits = 3; share != other && text == percent(other) && digits <= most; ++digits)
    if (std::string more = short_number(100 * share, digits) + " %"; more != text) text = std::move(more);
  return text;
}

}  // namespace ricochet::answers
