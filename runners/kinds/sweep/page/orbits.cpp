#include "runners/kinds/sweep/page/orbits.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
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

std::vector<Orbit> orbits_of(const CaseRecord& record) {
  std::vector<Orbit> out;
  const Table* table = find_table(record.tables, "values");
  if (!table) return out;
  const TableReader rows(*table);
  const size_t parameter = rows.column("parameter"), start = rows.column("start"), regime = rows.column("class"),
               period = rows.column("period"), status = rows.column_if_any("status"),
               method = rows.column_if_any("exponent_method"), marginal = rows.column_if_any("marginal"),
               exponent = rows.column_if_any("exponent_1");
  for (size_t row = 0; row < rows.size(); ++row) {
    const auto periods = rows.number(row, period);
    out.push_back({rows.number(row, parameter).value_or(0), rows.text(row, start), rows.text(row, regime),
                   rows.text(row, status), rows.text(row, method), rows.text(row, marginal),
                   periods ? std::optional(static_cast<int>(*periods)) : std::nullopt, rows.number(row, exponent)});
  }
  return out;
}

std::string regime_text(const Orbit& orbit) {
  if (!orbit.done()) return orbit.status;
  return regime_text(orbit.regime, orbit.period);
}

std::string regime_text(const std::string& regime, std::optional<double> period) {
  const auto motion = motion_class(regime, period);
  return motion ? text(*motion) : regime;
}

size_t regime_group(std::string_view regime, std::optional<int> period) {
  const auto motion = period ? motion_class(regime, *period) : motion_class(regime);
  if (!motion) return regime == "refused" || regime == "diverged" ? failed_group : undecided_group;
  switch (motion->regime) {
    case Regime::no_contact:
      return 0;
    case Regime::at_rest:
      return 1;
    case Regime::periodic:
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

size_t regime_group(const Orbit& orbit) {
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
    for (const Orbit& orbit : orbits_of(*record))
      if (std::find(out.begin(), out.end(), orbit.start) == out.end()) out.push_back(orbit.start);
  std::stable_sort(out.begin(), out.end(), [](const std::string& a, const std::string& b) {
    return std::pair(start_kind(a), random_number(a)) < std::pair(start_kind(b), random_number(b));
  });
  return out;
}

Quantity pointer_quantity(std::string_view pointer) {
  for (const std::string_view prefix : {"/scene/", "/methods/"})
    if (pointer.starts_with(prefix)) pointer.remove_prefix(prefix.size());
  std::string name(pointer);
  std::replace(name.begin(), name.end(), '/', '.');
  return {name, axis_unit(name)};
}

Quantity scene_quantity(const nlohmann::ordered_json& study, const std::string& pointer) {
  Quantity out = pointer_quantity(pointer);
  try {
    const nlohmann::ordered_json::json_pointer place(pointer);
    if (study.contains(place) && study.at(place).is_string() && pointer.starts_with("/scene/"))
      return {"factor of " + out.name, ""};
  } catch (const nlohmann::ordered_json::exception&) {
    // A pointer that is none keeps its text as its name.
  }
  return out;
}

Quantity swept_parameter(const StudyResults& results) {
  const auto found = results.study.find("parameter");
  if (found == results.study.end() || !found->is_object()) return {"parameter", ""};
  return scene_quantity(results.study, found->value("pointer", "parameter"));
}

}  // namespace ricochet::report
