#include "runners/answers/uncertainty.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "runners/answers/limits.hpp"

namespace ricochet::answers {
namespace {

/// What is known of one measure of one stop, in the measure's unit.
struct Spread {
  double value = 0, least = 0, largest = 0;
  std::size_t methods = 0;
  bool either_sign = false;  // whether a value below 0 means something
  std::optional<double> step, mesh, sampling;

  double size() const { return largest - least; }
  double scale() const { return std::max(std::abs(least), std::abs(largest)); }
  double low(double margin) const { return either_sign ? least - margin : std::max(0.0, least - margin); }
  std::optional<double> margin() const {
    if (!step || !std::isfinite(*step)) return std::nullopt;
    const double all = std::max({*step, mesh.value_or(0), sampling.value_or(0)});
    return std::isfinite(all) ? std::optional(all) : std::nullopt;
  }
};

// "rms_force[bar-a]": the measure and its stop.
std::optional<std::pair<std::string, std::string>> measure_of_stop(const std::string& name) {
  const std::size_t open = name.find('[');
  if (open == std::string::npos || !name.ends_with("]") || name.starts_with("confidence.")) return std::nullopt;
  return std::pair(name.substr(0, open), name.substr(open + 1, name.size() - open - 2));
}

std::vector<std::string> measures_of_stops(const StudyResults& results) {
  std::vector<std::string> names;
  std::set<std::string> seen;
  for (const CaseRecord& record : results.cases)
    if (record.status == "done")
      for (const auto& [name, value] : record.measures)
        if (measure_of_stop(name) && seen.insert(name).second) names.push_back(name);
  return names;
}

void widen(std::optional<double>& gap, const std::optional<Limit>& limit) {
  if (limit && limit->uncertainty) gap = std::max(gap.value_or(0), *limit->uncertainty);
}

std::optional<Spread> spread_of(const MeasureLimits& limits) {
  std::optional<Spread> out;
  for (const Method* method : limits.with_limit()) {
    const auto value = scaled_value(limits.words, *method->finest);
    if (!value) continue;
    if (!out) out = Spread{*value, *value, *value, 0, false, {}, {}, {}};
    out->least = std::min(out->least, *value);
    out->largest = std::max(out->largest, *value);
    ++out->methods;
    widen(out->step, method->step);
    widen(out->mesh, method->mesh);
    if (method->half > 0) out->sampling = std::max(out->sampling.value_or(0), method->half);
  }
  return out;
}

const char* verdict(const Spread& spread) {
  const std::optional<double> margin = spread.margin();
  if (!margin) return "unknown";
  if (spread.size() + 2 * *margin <= tolerance * spread.scale()) return "settled";
  if (spread.size() > 2 * *margin) return "methods";
  return *margin == *spread.step ? "step" : *margin == spread.mesh.value_or(-1) ? "mesh" : "sampling";
}

std::string with_unit(const MeasureWords& words, const std::string& number) {
  return words.unit.empty() ? number : number + " " + words.unit;
}

std::string sentence(const MeasureWords& words, const Spread& spread) {
  const auto shown = [&](double value) { return cell_text(words, value); };
  const auto range = [&](double low, double high) {
    const std::string from = shown(low), to = shown(high);
    return with_unit(words, from == to ? from : from + " to " + to);
  };
  const std::optional<double> margin = spread.margin();
  const std::string name = capitalised(words.words);
  if (!margin)
    return fmt::format("{}: {}; what the step leaves open is not known.", name, range(spread.least, spread.largest));
  // What is below it is round-off.
  const double floor = 1e-9 * spread.scale();
  std::string moves;
  const auto add = [&](const char* what, const std::optional<double>& by) {
    if (by && *by > floor) moves += fmt::format("{}{} ({})", moves.empty() ? "" : ", ", what, shown(*by));
  };
  if (spread.methods > 1) add("methods", spread.size());
  add("the step", spread.step);
  add("the mesh", spread.mesh);
  add("sampling", spread.sampling);
  return fmt::format("{}: {}{}.", name, range(spread.low(*margin), spread.largest + *margin),
                     moves.empty() ? "" : "; moved by " + moves);
}

}  // namespace

Table uncertainty_table(const Compared& study) {
  Table table{
      "uncertainty",
      "One measure of one stop over all methods: between which values it is.",
      {{"measure", "", "The measure, without its stop."},
       {"stop", "", "Name of the stop."},
       {"unit", "", "Unit of the numbers."},
       {"value", "", "That of the first method at its finest step and mesh."},
       {"least", "", "The least over the methods, each at its finest step and mesh."},
       {"largest", "", "The largest of them."},
       {"methods", "1", "Methods that have a value."},
       {"step_gap", "", "The largest that the step still moves a method by; empty of a single step."},
       {"mesh_gap", "", "The same of the mesh."},
       {"sampling", "", "Half the 95 % interval of a mean over the parts of the window, the largest."},
       {"low", "",
        "The least less the largest of the three, 0 where none is below 0; empty where that of the step is not known."},
       {"high", "", "The largest and the largest of the three."},
       {"verdict", "",
        "settled: within 1 %; methods, step, mesh, sampling: what leaves it open; unknown: a single step."},
       {"sentence", "", "The same in words."}},
      {}};
  for (const std::string& name : measures_of_stops(study.results())) {
    const MeasureLimits limits = limits_of(study, name, false, all_cases(study.results()));
    std::optional<Spread> found = spread_of(limits);
    if (!found) continue;
    const auto [measure, stop] = *measure_of_stop(name);
    found->either_sign = measure.starts_with("window_displacement_m");  // mean, min, max
    const Spread& spread = *found;
    const double factor = limits.words.factor;
    const auto scaled = [factor](std::optional<double> value) { return value ? Cell(*value * factor) : Cell(); };
    const std::optional<double> margin = spread.margin();
    table.rows.push_back({measure, stop, limits.words.unit, factor * spread.value, factor * spread.least,
                          factor * spread.largest, spread.methods, scaled(spread.step), scaled(spread.mesh),
                          scaled(spread.sampling), margin ? Cell(factor * spread.low(*margin)) : Cell(),
                          margin ? Cell(factor * (spread.largest + *margin)) : Cell(), verdict(spread),
                          sentence(limits.words, spread)});
  }
  return table;
}

}  // namespace ricochet::answers
