// Kinds of special points as asks name them, and their values in words.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/asks/kind_verbs.hpp"
#include "runners/json/json_text.hpp"
#include "runners/kinds/continuation/continuation.hpp"
#include "runners/kinds/continuation/point_words.hpp"

namespace ricochet {

std::optional<PointKind> point_kind(std::string asked) {
  std::replace(asked.begin(), asked.end(), '_', ' ');
  std::replace(asked.begin(), asked.end(), '-', ' ');
  if (asked == "lift off") return PointKind::lift_off;
  if (asked == "grazing") return PointKind::first_contact;
  const auto kind = of_word<PointKind>(asked);
  return kind && changes_orbit(*kind) ? kind : std::nullopt;
}

std::string point_value(double value, std::optional<double> half) {
  if (!half || !(*half > 1e-12 * std::abs(value))) return short_number(value, 7);
  int places = -static_cast<int>(std::floor(std::log10(*half)));
  constexpr double begins_with_one = 1.95;
  const bool fine = *half * std::pow(10, places) < begins_with_one;
  constexpr int most = 15;
  std::string text = fmt::format("{:.{}f}", value, std::clamp(places + fine, 0, most));
  if (text.starts_with('-')) text.replace(0, 1, "−");
  return text + " ± " + short_number(*half, fine ? 2 : 1);
}

namespace {

const std::vector<std::string>& askable_kinds() {
  static const std::vector<std::string> kinds = {"all",           "fold",    "torus",    "symmetry", "flip",
                                                 "first contact", "grazing", "lift-off", "contact"};
  return kinds;
}

}  // namespace

void check_points_ask(const Study&, const Json& keys, const std::string& pointer) {
  asks::refuse_stops(asks::ask_at(keys, pointer));
  const Json& asked = keys.at("points");
  for (std::size_t k = 0; k < asked.size(); ++k) {
    const std::string kind = asked[k].get<std::string>();
    if (kind != "all" && !point_kind(kind))
      throw InputError(pointer_to(pointer, k), "no kind of point is called " + quote(kind) + "; expected one of " +
                                                   quoted_list(askable_kinds()) + did_you_mean(kind, askable_kinds()));
  }
}

}  // namespace ricochet
