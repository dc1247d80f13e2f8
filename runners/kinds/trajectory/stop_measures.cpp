#include "runners/kinds/trajectory/stop_measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "runners/json/json_text.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

struct StopMeasure {
  const char *name, *unit, *text, *words;
  double (*value)(const StopTotals& lower, const StopTotals& upper);
};

const StopMeasure table[] = {
    {"impulse", "N s", "Momentum that the stop {} gives, by magnitude.", "impulse at {}",
     [](const StopTotals& a, const StopTotals& b) { return a.impulse + b.impulse; }},
    {"impacts", "1", "Number of times that the stop {} closed; contact from the start is none.", "impacts at {}",
     [](const StopTotals& a, const StopTotals& b) { return static_cast<double>(a.impacts + b.impacts); }},
    {"peak_force", "N", "Largest force at the stop {}. That of an impact on a rigid stop grows as the step shrinks.",
     "peak force at {}", [](const StopTotals& a, const StopTotals& b) { return std::max(a.peak_force, b.peak_force); }},
    {"rms_force", "N", "Root mean square of the force at the stop {} over the time in contact.", "rms force at {}",
     [](const StopTotals& a, const StopTotals& b) {
       const double time = a.contact_time + b.contact_time;
       return time > 0 ? std::sqrt((a.squares + b.squares) / time) : 0.0;
     }},
    {"contact_time", "s", "Time in contact with the stop {}.", "time in contact at {}",
     [](const StopTotals& a, const StopTotals& b) { return a.contact_time + b.contact_time; }}};

std::string name_of(const std::string& measure, const std::string& stop) {
  return measure + "[" + stop + "]";
}

/// Measure and stop of such a name.
std::optional<std::pair<std::string, std::string>> parts_of(const std::string& name) {
  const std::size_t open = name.find('[');
  if (open == std::string::npos || !name.ends_with("]") || open + 2 >= name.size()) return std::nullopt;
  return std::pair(name.substr(0, open), name.substr(open + 1, name.size() - open - 2));
}

/// Keeps the texts that a MeasureInfo points to.
struct Described {
  std::string name, text, words;
  MeasureInfo info;
};

}  // namespace

const std::vector<std::string>& measures_of_stops() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const StopMeasure& one : table) out.emplace_back(one.name);
    return out;
  }();
  return names;
}

const MeasureInfo* stop_measure_info(const std::string& name) {
  static std::map<std::string, std::unique_ptr<Described>> known;
  if (const auto found = known.find(name); found != known.end()) return &found->second->info;
  const auto parts = parts_of(name);
  if (!parts) return nullptr;
  const auto one = std::find_if(std::begin(table), std::end(table),
                                [&](const StopMeasure& candidate) { return parts->first == candidate.name; });
  if (one == std::end(table)) return nullptr;
  auto made = std::make_unique<Described>();
  made->name = name;
  made->text = fmt::format(fmt::runtime(one->text), parts->second);
  made->words = fmt::format(fmt::runtime(one->words), parts->second);
  made->info = {made->name.c_str(), one->unit, made->text.c_str()};
  made->info.reading.words = made->words.c_str();
  return &(known[name] = std::move(made))->info;
}

void put_stop_measures(CaseRecord& record, const std::string& stop, const StopTotals& lower, const StopTotals& upper) {
  for (const StopMeasure& one : table) put_measure(record, name_of(one.name, stop), one.value(lower, upper));
}

void check_observed_stops(const nlohmann::ordered_json& study) {
  const auto observed = study.find("observe");
  if (observed == study.end() || !observed->is_array()) return;
  std::vector<std::string> stops;
  if (const auto& list = study.at("scene").at("stops"); list.is_array())
    for (const auto& stop : list) stops.push_back(stop.at("name").get<std::string>());
  for (std::size_t i = 0; i < observed->size(); ++i) {
    const auto parts = parts_of((*observed)[i].get<std::string>());
    if (!parts || std::find(stops.begin(), stops.end(), parts->second) != stops.end()) continue;
    throw InputError(fmt::format("/observe/{}", i),
                     stops.empty() ? "the scene has no stops with names; expected a list of stops, or " +
                                         quoted_list(measures_of_stops()) + " without a name"
                                   : fmt::format("no stop \"{}\"; there is: {}{}", parts->second, quoted_list(stops),
                                                 did_you_mean(parts->second, stops)));
  }
}

}  // namespace ricochet
