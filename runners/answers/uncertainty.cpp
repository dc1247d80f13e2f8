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
    const double all = *step + mesh.value_or(0) + sampling.value_or(0);
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
    if (record.status == Status::done)
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
    const double value = method->limit->value;
    if (!out) out = Spread{value, value, value, 0, false, {}, {}, {}};
    out->least = std::min(out->least, value);
    out->largest = std::max(out->largest, value);
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
  const double most = std::max({*spread.step, spread.mesh.value_or(0), spread.sampling.value_or(0)});
  return most == *spread.step ? "step" : most == spread.mesh.value_or(-1) ? "mesh" : "sampling";
}

}  // namespace

MeasureWords prefixed(MeasureWords words, double scale) {
  constexpr double thousandths = 0.1, millionths = 1e-4;
  if ((words.unit != "W" && words.unit != "m") || scale == 0) return words;
  if (scale < millionths) {
    words.factor *= 1e6;
    words.unit = "µ" + words.unit;
  } else if (scale < thousandths) {
    words.factor *= 1e3;
    words.unit = "m" + words.unit;
  }
  return words;
}

namespace {

// "rms force at bar-a: 0.17 to 0.19 N; methods differ by 0.02; the step leaves 4e-4, the mesh 2e-4".
std::string interval_text(const Choices& study, const MeasureLimits& limits, const Spread& spread) {
  const MeasureWords words = prefixed(limits.words, spread.scale());
  const std::string name = capitalised(words.words);
  const std::optional<double> margin = spread.margin();
  if (!margin)
    return fmt::format("{}: {}; what the step leaves open is not known.", name,
                       range_text(words, spread.least, spread.largest));
  std::string out = fmt::format("{}: {}", name, range_text(words, spread.low(*margin), spread.largest + *margin));
  // What is below it is round-off, or nothing beside the interval.
  const double floor = std::max(1e-9 * spread.scale(), 1e-3 * *margin);
  MeasureWords bare = words;
  bare.unit.clear();
  if (spread.methods > 1 && spread.size() > floor)
    out += fmt::format("; {} differ by {}", scene_varies(study) ? "cases" : "methods",
                       uncertainty_text(bare, spread.size()));
  std::string left;
  const auto add = [&](const char* what, const std::optional<double>& by) {
    if (!by || !(*by > floor)) return;
    left += fmt::format("{} {} {}", left.empty() ? ";" : ",", what + std::string(left.empty() ? " leaves" : ""),
                        uncertainty_text(bare, *by));
  };
  add("the step", spread.step);
  add(study.varies("modes") ? "the number of modes" : "the mesh", spread.mesh);
  add("sampling", spread.sampling);
  return out + left + ".";
}

Spread signed_spread(Spread spread, const std::string& measure) {
  spread.either_sign = measure.starts_with("window_displacement_m");  // mean, min, max
  return spread;
}

}  // namespace

const TableType<StopRange>& uncertainty_type() {
  static const TableType<StopRange> all = [] {
    RowType<StopRange> rows;
    rows.add({"measure", "", "The measure, without its stop."}, &StopRange::measure)
        .add({"stop", "", "Name of the stop, or of the point of a spectrum."}, &StopRange::stop)
        .add({"unit", "", "Unit of the numbers."}, &StopRange::unit)
        .add({"value", "", "That of the first method at its finest step and mesh."}, &StopRange::value)
        .add({"least", "", "The least over the methods, each at its finest step and mesh."}, &StopRange::least)
        .add({"largest", "", "The largest of them."}, &StopRange::largest)
        .add({"methods", "1", "Methods that have a value."}, &StopRange::methods)
        .add({"step_gap", "", "The largest that the step still moves a method by; empty of a single step."},
             &StopRange::step)
        .add({"mesh_gap", "", "The same of the mesh."}, &StopRange::mesh)
        .add({"sampling", "",
              "Half the 95 % interval of a mean over seeds, or over the parts of the window; the largest."},
             &StopRange::sampling)
        .add({"low", "",
              "The least less the sum of the three, 0 where none is below 0; empty where that of the step is not "
              "known."},
             &StopRange::low)
        .add({"high", "", "The largest and the sum of the three."}, &StopRange::high)
        .add({"verdict", "",
              "settled: within 1 %; methods, step, mesh, sampling: what leaves it open; unknown: of a single step, or "
              "of what grows without bound."},
             &StopRange::verdict)
        .add({"sentence", "", "The same in words."}, &StopRange::sentence);
    return TableType<StopRange>{"uncertainty", "One measure of one stop over all methods: between which values it is.",
                                rows};
  }();
  return all;
}

bool scene_varies(const Choices& study) {
  return std::any_of(study.varying().begin(), study.varying().end(), [](const std::string& column) {
    return is_of_scene(column) && column != "march" && column != seed_axis;
  });
}

Table uncertainty_table(const Choices& study) {
  std::vector<StopRange> rows;
  for (const std::string& name : measures_of_stops(study.results())) {
    const MeasureLimits limits = limits_of(study, name, false, all_cases(study.results()));
    const std::optional<Spread> found = spread_of(limits);
    if (!found) continue;
    const auto [measure, stop] = *measure_of_stop(name);
    const Spread spread = signed_spread(*found, measure);
    const double factor = limits.words.factor;
    const auto scaled = [factor](std::optional<double> value) {
      if (value) *value *= factor;
      return value;
    };
    StopRange row{measure,
                  stop,
                  limits.words.unit,
                  factor * spread.value,
                  factor * spread.least,
                  factor * spread.largest,
                  spread.methods,
                  scaled(spread.step),
                  scaled(spread.mesh),
                  scaled(spread.sampling)};
    if (const auto margin = spread.margin()) {
      row.low = factor * spread.low(*margin);
      row.high = factor * (spread.largest + *margin);
    }
    row.verdict = verdict(spread);
    row.sentence = interval_text(study, limits, spread);
    rows.push_back(std::move(row));
  }
  return uncertainty_type().with(rows);
}

}  // namespace ricochet::answers
