#include "runners/kinds/sweep/page/orbits.hpp"

#include <algorithm>
#include <charconv>
#include <ricochet/measure/orbits/regime.hpp>

namespace ricochet::report {
namespace {

int random_number(std::string_view start) {
  int number = 0;
  const size_t dash = start.find('-');
  if (dash != std::string_view::npos) std::from_chars(start.data() + dash + 1, start.data() + start.size(), number);
  return number;
}

}  // namespace

size_t regime_group(std::string_view regime, std::optional<int> period) {
  const auto motion = period ? motion_class(regime, *period) : motion_class(regime);
  if (!motion) return regime == "refused" || regime == "diverged" ? failed_group : undecided_group;
  switch (motion->regime) {
    case Regime::no_contact:
      return 0;
    case Regime::at_rest:
      return 1;
    case Regime::periodic:
    case Regime::chattering:
      return motion->period <= 4 ? static_cast<size_t>(motion->period) + 1 : motion->period <= 8 ? 6 : 7;
    case Regime::quasi_periodic:
      return 8;
    case Regime::chaotic:
      return 9;
    case Regime::undecided:
      return undecided_group;
    case Regime::failed:
      break;
  }
  return failed_group;
}

size_t regime_group(const OrbitRow& orbit) {
  return orbit.done() ? regime_group(orbit.regime, orbit.period) : failed_group;
}

size_t start_kind(std::string_view start) {
  if (start == "rest") return 0;
  if (start == "state") return 1;
  if (start == "up") return 2;
  if (start == "down") return 3;
  return 4;
}

std::vector<std::string> starts_in(const Cases& cases) {
  std::vector<std::string> out;
  for (const CaseRecord* record : cases)
    for (const OrbitRow& orbit : orbits_of(*record))
      if (std::find(out.begin(), out.end(), orbit.start) == out.end()) out.push_back(orbit.start);
  std::stable_sort(out.begin(), out.end(), [](const std::string& a, const std::string& b) {
    return std::pair(start_kind(a), random_number(a)) < std::pair(start_kind(b), random_number(b));
  });
  return out;
}

Quantity swept_quantity(const StudyResults& results, const nlohmann::ordered_json& where, const std::string& name) {
  const std::optional<SweptAxis> swept = swept_axis(results, where);
  if (!swept) return {name, ""};
  if (swept->factor) return {"factor of " + swept->axis.name, ""};
  return {swept->axis.name, swept->axis.unit};
}

Quantity swept_parameter(const StudyResults& results) {
  const auto found = results.study.find("parameter");
  return swept_quantity(results, found == results.study.end() ? nlohmann::ordered_json() : *found, "parameter");
}

}  // namespace ricochet::report
