#include "runners/march/table_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ricochet {
namespace {

std::vector<const TimeTable*> tables_of(const SceneSpec& scene) {
  std::vector<const TimeTable*> found;
  for (const LoadTerm& term : scene.load.terms)
    if (term.table) found.push_back(term.table.get());
  for (const MotionSpec& motion : scene.motions)
    if (motion.table) found.push_back(motion.table.get());
  for (const NamedStop& stop : scene.stops.named)
    if (stop.motion && stop.motion->table) found.push_back(stop.motion->table.get());
  return found;
}

// The shortest and the longest way from an entry to the next, s.
std::pair<double, double> spacing(const TimeTable& table) {
  double least = HUGE_VAL, most = 0;
  for (std::size_t i = 1; i < table.times.size(); ++i) {
    least = std::min(least, table.times[i] - table.times[i - 1]);
    most = std::max(most, table.times[i] - table.times[i - 1]);
  }
  return {least, most};
}

const char* pieces(TimeTable::Between between) {
  if (between == TimeTable::Between::cubic) return "cubic pieces";
  return between == TimeTable::Between::step ? "constant pieces" : "linear pieces";
}

}  // namespace

std::vector<std::string> table_notes(const StudyCase& study_case) {
  constexpr double many = 20, enough = 5;
  const double h = study_case.step;
  std::vector<std::string> notes;
  if (!(h > 0)) return notes;
  for (const TimeTable* table : tables_of(study_case.scene)) {
    const auto [least, most] = spacing(*table);
    const double steps = std::floor(least / h * (1 + 1e-9));
    if (steps < many) continue;
    const bool even = most <= least * (1 + 1e-6);
    notes.push_back(fmt::format("{} has {:.0f} steps of the march{} between entries: {}", table->name, steps,
                                even ? "" : " or more", pieces(table->between)));
  }
  const Json load = study_case.scene_json.is_object() ? study_case.scene_json.value("load", Json()) : Json();
  for (std::size_t k = 0; load.is_array() && k < load.size(); ++k)
    for (const char* key : {"force", "time"}) {
      const Json::json_pointer at(fmt::format("/{}/psd/to", key));
      if (!load[k].contains(at)) continue;
      const double longest = 1 / (enough * load[k].at(at).get<double>());
      if (h > longest * (1 + 1e-9))
        notes.push_back(
            fmt::format("the spectrum of the load {} to {:.6g} Hz needs h ≤ {:.3g} s, {:.0f} steps per period", k,
                        load[k].at(at).get<double>(), longest, enough));
    }
  return notes;
}

std::vector<std::string> coarse_tables(const SceneSpec& scene, const std::vector<double>& pulsations) {
  constexpr std::size_t samples = 16;  // fewer entries are a shape that somebody drew
  std::vector<std::string> found;
  for (const TimeTable* table : tables_of(scene)) {
    if (table->times.size() < samples || table->between == TimeTable::Between::step) continue;
    const double step = spacing(*table).first, highest = 1 / (2 * step);
    const auto above = std::find_if(pulsations.begin(), pulsations.end(),
                                    [&](double omega) { return omega > 2 * std::numbers::pi * highest; });
    if (above == pulsations.end()) continue;
    found.push_back(fmt::format("{}: its step {:.4g} s resolves nothing above {:.4g} Hz; mode {} is at {:.4g} Hz",
                                table->name, step, highest, above - pulsations.begin() + 1,
                                *above / (2 * std::numbers::pi)));
  }
  return found;
}

}  // namespace ricochet
