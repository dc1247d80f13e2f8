// Kinds of special points as asks name them.
#include <algorithm>

#include "runners/asks/kind_verbs.hpp"
#include "runners/json/json_text.hpp"
#include "runners/kinds/continuation/continuation.hpp"
#include "runners/kinds/continuation/point_speaker.hpp"

namespace ricochet {

std::string point_kind(std::string asked) {
  std::replace(asked.begin(), asked.end(), '_', ' ');
  std::replace(asked.begin(), asked.end(), '-', ' ');
  if (asked == "lift off") return "lift-off";
  return asked == "grazing" ? "first contact" : asked;
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
    if (kind != "all" && !is_point_kind(point_kind(kind)))
      throw InputError(pointer_to(pointer, k), "no kind of point is called " + quote(kind) + "; expected one of " +
                                                   quoted_list(askable_kinds()) + did_you_mean(kind, askable_kinds()));
  }
}

}  // namespace ricochet
