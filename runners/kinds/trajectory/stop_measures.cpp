#include "runners/kinds/trajectory/stop_measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <ricochet/measure/statistics/spectra.hpp>
#include <utility>

#include "runners/answers/answer.hpp"
#include "runners/json/json_text.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

using Known = std::optional<double>;

/// What a study has to say for a measure to be known.
enum class Needs { nothing, window, shocks, tangent, friction };

struct StopMeasure {
  const char *name, *unit, *text, *words;
  Known (*value)(const StopReading& of);
  Needs needs = Needs::nothing;
  bool column = false;  ///< of stops.csv too
  /// Whether it is the size of a force while it acts. A rigid law throws a point with mass back within a step: then the
  /// force is the impulse over the step, and has no limit.
  bool size_of_force = false;
  const char* whole_steps = "";  ///< as of MeasureInfo
  const char* floor = "";        ///< likewise
  bool mean = true;              ///< of a window; the others are extremes and sums
};

constexpr StopMeasure no_mean(StopMeasure one) {
  one.mean = false;
  return one;
}

template <double (*of)(const RunningMoments&)>
Known displaced(const StopReading& reading) {
  return reading.displacement && reading.displacement->any() ? Known(of(*reading.displacement)) : std::nullopt;
}
template <double (*of)(const PushTotals&, double)>
Known pushed(const StopReading& reading) {
  return reading.pushed ? Known(of(*reading.pushed, reading.window)) : std::nullopt;
}
/// The same of what is over the time in contact: nothing where there was none.
template <double (*of)(const PushTotals&, double)>
Known while_pushed(const StopReading& reading) {
  return reading.pushed && reading.pushed->contact_time > 0 ? pushed<of>(reading) : std::nullopt;
}
template <double (*of)(const ShockTotals&)>
Known shocked(const StopReading& reading) {
  return reading.shocks && reading.shocks->shocks > 0 ? Known(of(*reading.shocks)) : std::nullopt;
}

template <double (*of)(const FrictionTotals&, double)>
Known rubbed(const StopReading& reading) {
  return reading.friction ? Known(of(*reading.friction, reading.rubbed_over)) : std::nullopt;
}
/// The same of what is over the time in which something presses.
template <double (*of)(const FrictionTotals&, double)>
Known while_rubbed(const StopReading& reading) {
  return reading.friction && reading.friction->time > 0 ? rubbed<of>(reading) : std::nullopt;
}

using Moments = const RunningMoments&;
using Rubbed = const FrictionTotals&;
using Push = const PushTotals&;
using Shocks = const ShockTotals&;

const StopMeasure stop_measures[] = {
    {"impulse", "N s", "Momentum that the stop {} gives, by magnitude.", "impulse at {}",
     [](const StopReading& of) -> Known { return of.run.impulse; }},
    {"impacts", "1", "Number of times that the stop {} closed; contact from the start is none.", "impacts at {}",
     [](const StopReading& of) -> Known { return static_cast<double>(of.run.impacts); }},
    {"peak_force", "N",
     "Largest force at the stop {}; blank where a rigid law has thrown back a point with mass (no limit).",
     "peak force at {}", [](const StopReading& of) -> Known { return of.run.peak_force; }, Needs::nothing, false, true,
     "", contact_steps_measure},
    {"rms_force", "N", "Root mean square of the force at the stop {} over the time in contact; blank as peak_force.",
     "rms force at {}", [](const StopReading& of) -> Known { return of.run.rms_force(); }, Needs::nothing, false, true},
    {"contact_time", "s", "Time in contact with the stop {}.", "time in contact at {}",
     [](const StopReading& of) -> Known { return of.run.contact_time; }, Needs::nothing, false, false, "impacts"},
    {"mean_force", "N", "Mean of the force at the stop {} over the time in contact.", "mean force at {}",
     [](const StopReading& of) { return of.run.contact_time > 0 ? Known(of.run.mean_force()) : std::nullopt; },
     Needs::nothing, false, true},
    {"window_displacement_mean", "m", "Mean over the window of the displacement that the stop {} bounds.",
     "mean displacement at {}", displaced<[](Moments m) { return m.mean; }>, Needs::window, true},
    {"window_displacement_deviation", "m",
     "Standard deviation over the window of the displacement that the stop {} bounds.",
     "deviation of the displacement at {}", displaced<[](Moments m) { return m.deviation(); }>, Needs::window, true},
    {"window_displacement_rms", "m", "Root mean square over the window of the displacement that the stop {} bounds.",
     "rms displacement at {}", displaced<[](Moments m) { return m.rms(); }>, Needs::window, true},
    no_mean({"window_displacement_min", "m",
             "Least displacement over the window that the stop {} bounds, with its sign.",
             "lower end of the displacement at {}", displaced<[](Moments m) { return m.least; }>, Needs::window, true}),
    no_mean(
        {"window_displacement_max", "m", "Largest displacement over the window that the stop {} bounds, with its sign.",
         "upper end of the displacement at {}", displaced<[](Moments m) { return m.largest; }>, Needs::window, true}),
    {"window_force", "N", "Mean over the window of the force at the stop {}: times the window it is the impulse.",
     "mean force at {} over the window", pushed<[](Push p, double time) { return p.mean(time); }>, Needs::window, true},
    {"window_rms_force", "N", "Root mean square over the window of the force at the stop {}.",
     "rms force at {} over the window", pushed<[](Push p, double time) { return p.rms(time); }>, Needs::window, true,
     true},
    {"window_contact_force", "N", "Mean of the force at the stop {} over the time in contact in the window.",
     "force in contact at {}", while_pushed<[](Push p, double) { return p.mean_pushed(); }>, Needs::window, true, true},
    {"window_contact_rms_force", "N",
     "Root mean square of the force at the stop {} over the time in contact in the window.",
     "rms force in contact at {}", while_pushed<[](Push p, double) { return p.rms_pushed(); }>, Needs::window, true,
     true},
    {"window_contact_share", "1", "Share of the window in contact with the stop {}.", "share in contact at {}",
     pushed<[](Push p, double time) { return p.contact_time / time; }>, Needs::window, true, false, "impacts"},
    {"window_impact_rate", "1/s", "How often the stop {} closes in a second of the window.", "impacts per second at {}",
     pushed<[](Push p, double time) { return static_cast<double>(p.impacts) / time; }>, Needs::window, true},
    {"shock_rate", "1/s", "Shocks per second at the stop {}.", "shocks per second at {}",
     [](const StopReading& of) -> Known {
       return of.shocks ? Known(static_cast<double>(of.shocks->shocks) / of.window) : std::nullopt;
     },
     Needs::shocks, true},
    {"shock_time", "s", "Mean duration of a shock at the stop {}, rebounds included.", "duration of a shock at {}",
     shocked<[](Shocks s) { return s.lasted / static_cast<double>(s.shocks); }>, Needs::shocks, true, false, "1"},
    {"rebound_time", "s", "Mean time for which a rebound of a shock at the stop {} is pushed.",
     "duration of a rebound at {}", shocked<[](Shocks s) { return s.pushed / static_cast<double>(s.rebounds); }>,
     Needs::shocks, true, false, "1"},
    {"shock_force_mean", "N", "Mean of the peak forces of the shocks at the stop {}.", "mean peak at {}",
     shocked<[](Shocks s) { return s.peaks.mean; }>, Needs::shocks, true, true},
    {"shock_force_deviation", "N", "Standard deviation of the peak forces of the shocks at the stop {}.",
     "deviation of the peaks at {}", shocked<[](Shocks s) { return s.peaks.deviation(); }>, Needs::shocks, true, true},
    no_mean({"shock_force_max", "N", "Largest peak force of the shocks at the stop {}.", "largest peak at {}",
             shocked<[](Shocks s) { return s.peaks.largest; }>, Needs::shocks, true, true, "", contact_steps_measure}),
    {"wear_power", "W",
     "Wear power of the stop {}, (1/T) Σ I ½(|V⁻| + |V⁺|): I impulse of an instant, V speeds along the surface.",
     "wear power at {}", [](const StopReading& of) { return of.wear_power; }, Needs::tangent, true},
    {"stick_share", "1", "Share of the time in which the surface of the stop {} is pressed that it sticks.",
     "stick share at {}", while_rubbed<[](Rubbed f, double) { return f.held / f.time; }>, Needs::friction, true, false,
     "stick_slip_changes"},
    {"friction_power", "W", "Power that friction at the stop {} turns to heat, mean over the window.",
     "friction power at {}",
     [](const StopReading& of) { return of.friction_works ? Known(of.friction->heat / of.rubbed_over) : std::nullopt; },
     Needs::friction, true},
    no_mean({"slip_distance", "m", "How far the surface of the stop {} slides while it is pressed, in the window.",
             "slip at {}", rubbed<[](Rubbed f, double) { return f.slipped; }>, Needs::friction, true}),
    no_mean(
        {"stick_slip_changes", "1",
         "How often the surface of the stop {} begins or ends to stick while it is pressed. A stick has two steps at "
         "least.",
         "changes between stick and slip at {}", rubbed<[](Rubbed f, double) { return f.changes; }>, Needs::friction,
         true}),
    no_mean({"friction_impulse", "N s", "Momentum that friction at the stop {} gives, by magnitude, in the window.",
             "friction impulse at {}", rubbed<[](Rubbed f, double) { return f.impulse; }>, Needs::friction, true}),
    {"tangent_force_rms", "N",
     "Root mean square of the force of friction at the stop {} while it is pressed; blank as peak_force.",
     "rms friction at {}", while_rubbed<[](Rubbed f, double) { return std::sqrt(f.squares / f.time); }>,
     Needs::friction, true, true},
    no_mean({"tangent_force_peak", "N", "Largest force of friction at the stop {}; blank as peak_force.",
             "peak friction at {}", rubbed<[](Rubbed f, double) { return f.peak; }>, Needs::friction, true, true}),
    {"drift_of_sticking", "m/s", "How fast the surface of the stop {} creeps while it sticks.", "creep at {}",
     [](const StopReading& of) -> Known {
       return of.friction_works && of.friction->held > 0 ? Known(of.friction->drifted / of.friction->held)
                                                         : std::nullopt;
     },
     Needs::friction, true}};

/// The measure that every stop has which may have one with such needs, touched or not.
const char* witness(Needs needs) {
  switch (needs) {
    case Needs::nothing:
      return "contact_time";
    case Needs::window:
      return "window_force";
    case Needs::shocks:
      return "shock_rate";
    case Needs::tangent:
      return "wear_power";
    case Needs::friction:
      return "slip_distance";
  }
  return "";
}

const StopMeasure* find_measure(const std::string& name) {
  const auto one = std::find_if(std::begin(stop_measures), std::end(stop_measures),
                                [&](const StopMeasure& candidate) { return name == candidate.name; });
  return one == std::end(stop_measures) ? nullptr : &*one;
}

std::string name_of(const std::string& measure, const std::string& stop) {
  return measure + "[" + stop + "]";
}

/// Measure and stop of such a name.
std::optional<std::pair<std::string, std::string>> parts_of(const std::string& name) {
  const std::size_t open = name.find('[');
  if (open == std::string::npos || !name.ends_with("]") || open + 2 >= name.size()) return std::nullopt;
  return std::pair(name.substr(0, open), name.substr(open + 1, name.size() - open - 2));
}

// How the measure begins that is half the interval of another.
const std::string confidence = "confidence.";

/// Keeps the texts that a MeasureInfo points to.
struct Described {
  std::string name, text, words;
  MeasureInfo info;
};

// Levels of spectra in thirds of octaves, as measures: "third_octave_force_63Hz[bar-a]", "…_displacement_…[mid]".

constexpr int lowest_band = -10, highest_band = 43;  // 0.1 Hz, 20 kHz

std::string band_measure(bool force, const std::string& nominal) {
  return fmt::format("third_octave_{}_{}Hz", force ? "force" : "displacement", nominal);
}

struct OctaveName {
  bool force = false;
  std::string nominal;
};

const std::map<std::string, OctaveName>& octave_names() {
  static const std::map<std::string, OctaveName> all = [] {
    std::map<std::string, OctaveName> out;
    for (int n = lowest_band; n <= highest_band; ++n)
      for (const bool force : {false, true}) {
        const std::string nominal = ThirdOctave{n}.nominal();
        out[band_measure(force, nominal)] = {force, nominal};
      }
    return out;
  }();
  return all;
}

// Keeps the texts that a MeasureInfo points to.
struct OctaveInfo {
  std::string name, text, words;
  MeasureInfo info;
};

// Names of the bands that spectra of a study have.
std::vector<std::string> bands_of(const nlohmann::ordered_json& outputs) {
  const double rate = outputs.at("rate").get<double>(), segment = outputs.at("segment").get<double>();
  const auto lines = static_cast<std::size_t>(std::lround(rate * segment / 2)) + 1;
  std::vector<std::string> names;
  for (const ThirdOctave& band : third_octaves(std::vector<double>(lines, 0.0), 1 / segment))
    names.push_back(band.nominal());
  return names;
}

/// Their names without the stop or point, of all bands from 0.1 Hz to 20 kHz.
const std::vector<std::string>& octave_measures() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const bool force : {false, true})
      for (int n = lowest_band; n <= highest_band; ++n) out.push_back(band_measure(force, ThirdOctave{n}.nominal()));
    return out;
  }();
  return names;
}

/// What such a measure means; null for any other name.
const MeasureInfo* octave_measure_info(const std::string& name) {
  static std::map<std::string, std::unique_ptr<OctaveInfo>> known;
  if (const auto found = known.find(name); found != known.end()) return &found->second->info;
  const std::size_t open = name.find('[');
  const auto found = octave_names().find(name.substr(0, open));
  if (open == std::string::npos || !name.ends_with("]") || found == octave_names().end()) return nullptr;
  const std::string of = name.substr(open + 1, name.size() - open - 2);
  const char* quantity = found->second.force ? "force" : "displacement";
  auto made = std::make_unique<OctaveInfo>();
  made->name = name;
  made->text =
      fmt::format("Root mean square of the {} of {} in the third of an octave around {} Hz, from its spectrum.",
                  quantity, of, found->second.nominal);
  made->words = fmt::format("rms {} of {} around {} Hz", quantity, of, found->second.nominal);
  made->info = {made->name.c_str(), found->second.force ? "N" : "m", made->text.c_str()};
  made->info.reading.words = made->words.c_str();
  made->info.aside = true;
  made->info.mean = true;
  return &(known[name] = std::move(made))->info;
}

/// Throws InputError at `pointer` where a study asks for no spectrum of that, or where its spectra have no such band.
/// `measure`, `of`: the name and what stands in its brackets. False for any other name.
bool check_observed_octave(const nlohmann::ordered_json& study, const std::string& measure, const std::string& of,
                           const std::string& pointer) {
  const auto found = octave_names().find(measure);
  if (found == octave_names().end()) return false;
  const char* quantity = found->second.force ? "force" : "displacement";
  const Json outputs = study.value("outputs", Json());
  const Json spectra = outputs.is_object() ? outputs.value("spectra", Json::array()) : Json::array();
  if (std::none_of(spectra.begin(), spectra.end(),
                   [&](const Json& one) { return one.at("of") == of && one.at("quantity") == quantity; }))
    throw InputError(pointer, fmt::format("{} needs the spectrum of {}; give outputs.spectra with {{\"of\": \"{}\", "
                                          "\"quantity\": \"{}\"}}",
                                          measure, of, of, quantity));
  const std::vector<std::string> bands = bands_of(outputs);
  if (std::find(bands.begin(), bands.end(), found->second.nominal) == bands.end())
    throw InputError(pointer, bands.empty() ? "spectra of this rate and segment have no third of an octave"
                                            : fmt::format("spectra of this rate and segment have bands from {} to {} "
                                                          "Hz, and none of {} Hz",
                                                          bands.front(), bands.back(), found->second.nominal));
  return true;
}

}  // namespace

const std::vector<std::string>& measures_of_stops() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const StopMeasure& one : stop_measures) out.emplace_back(one.name);
    out.insert(out.end(), octave_measures().begin(), octave_measures().end());
    return out;
  }();
  return names;
}

const MeasureInfo* stop_measure_info(const std::string& name) {
  static std::map<std::string, std::unique_ptr<Described>> known;
  if (const auto found = known.find(name); found != known.end()) return &found->second->info;
  const bool half = name.starts_with(confidence);
  const auto parts = parts_of(half ? name.substr(confidence.size()) : name);
  if (!parts) return nullptr;
  const StopMeasure* one = find_measure(parts->first);
  if (!one) return octave_measure_info(name);
  auto made = std::make_unique<Described>();
  made->name = name;
  made->text = half ? fmt::format("Half the 95 % interval of {} (stationary block bootstrap of the parts).",
                                  name.substr(confidence.size()))
                    : fmt::format(fmt::runtime(one->text), parts->second);
  made->words = fmt::format(fmt::runtime(one->words), parts->second);
  made->info = {made->name.c_str(), one->unit, made->text.c_str()};
  made->info.reading.words = made->words.c_str();
  made->info.aside = one->column;
  made->info.whole_steps = one->whole_steps;
  made->info.floor = one->floor;
  made->info.stands_with = witness(one->needs);
  made->info.mean = one->needs != Needs::nothing && one->mean;
  if (half) made->info.of = MeasureInfo::Of::computation;
  return &(known[name] = std::move(made))->info;
}

std::vector<std::string> forces_while_they_act(const std::string& stop) {
  std::vector<std::string> names;
  for (const StopMeasure& one : stop_measures)
    if (one.size_of_force)
      for (const std::string& half : {std::string(), confidence}) names.push_back(half + name_of(one.name, stop));
  return names;
}

void put_stop_measures(CaseRecord& record, const std::string& stop, const StopReading& reading) {
  StopReading with_works = reading;
  with_works.friction_works = true;
  for (const StopMeasure& one : stop_measures)
    if (const Known value = one.value(reading))
      put_measure(record, name_of(one.name, stop), *value);
    else if (reading.friction && one.value(with_works))
      record.left_out.emplace_back(name_of(one.name, stop), answers::no_work_form);
}

std::vector<Column> stop_reading_columns(const StopReading& known) {
  std::vector<Column> columns;
  for (const StopMeasure& one : stop_measures)
    if (one.column &&
        ((one.needs == Needs::window && known.pushed) || (one.needs == Needs::shocks && known.shocks) ||
         (one.needs == Needs::tangent && known.wear_power) || (one.needs == Needs::friction && known.friction)))
      columns.push_back({one.name, one.unit, fmt::format(fmt::runtime(one.text), "of the row")});
  return columns;
}

Row stop_reading_cells(const StopReading& reading) {
  Row cells;
  for (const Column& column : stop_reading_columns(reading)) cells.push_back(find_measure(column.name)->value(reading));
  return cells;
}

std::vector<Column> all_stop_reading_columns() {
  StopReading all;
  all.pushed.emplace();
  all.shocks.emplace();
  all.wear_power = 0;
  all.friction.emplace();
  return stop_reading_columns(all);
}

namespace {

// What a study leaves out that a measure of a stop needs; "" where nothing.
std::string missing_for(const StopMeasure& one, const nlohmann::ordered_json& study, const std::string& stop) {
  const auto given = [&](const char* key) { return study.contains(key) && study.at(key).is_object(); };
  if (one.needs == Needs::window && !given("window")) return "is measured over a window; give one";
  if (one.needs == Needs::shocks && (!given("outputs") || !study.at("outputs").contains("shocks")))
    return "counts shocks; give outputs.shocks";
  if (one.needs == Needs::tangent)
    for (const auto& other : study.at("scene").at("stops"))
      if (other.at("name") == stop && !other.contains("tangent") && !other.contains("clearance") &&
          !other.contains("normal_force"))
        return "needs what slides there; give tangent to the stop";
  if (one.needs == Needs::friction)
    for (const auto& other : study.at("scene").at("stops"))
      if (other.at("name") == stop && !other.contains("friction"))
        return "needs friction there; give friction to the stop";
  return "";
}

/// Throws InputError at `pointer` where a measure of the whole structure is one over a window, or over its parts, that
/// the study has not.
void check_window_measure(const nlohmann::ordered_json& study, const std::string& measure, const std::string& pointer) {
  const std::string name = measure.starts_with(confidence) ? measure.substr(confidence.size()) : measure;
  const auto is_one_of = [&](std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const Json window = study.value("window", Json());
  if (is_one_of({"window_power", "window_force", "window_impact_rate", "window_tip_rms"}) &&
      !(window.is_object() && window.value("parts", Json()).is_number()))
    throw InputError(pointer,
                     measure + " is a mean over parts of a window; give window with \"from\", \"to\" and \"parts\"");
  if (is_one_of({"contact_force_mean", "contact_force_deviation"}) && !window.is_object())
    throw InputError(pointer, measure + " is measured over a window; give window with \"from\" and \"to\"");
}

}  // namespace

void check_stop_measure(const nlohmann::ordered_json& study, const std::string& measure, const std::string& pointer) {
  check_window_measure(study, measure, pointer);
  const auto parts = parts_of(measure);
  if (!parts || check_observed_octave(study, parts->first, parts->second, pointer)) return;
  std::vector<std::string> stops;
  if (const auto& list = study.at("scene").at("stops"); list.is_array())
    for (const auto& stop : list) stops.push_back(stop.at("name").get<std::string>());
  if (std::find(stops.begin(), stops.end(), parts->second) == stops.end())
    throw InputError(pointer, stops.empty()
                                  ? "the scene has no stops with names; expected a list of stops, or a measure "
                                    "without a name"
                                  : fmt::format("no stop \"{}\"; there is: {}{}", parts->second, quoted_list(stops),
                                                did_you_mean(parts->second, stops)));
  const StopMeasure* one = find_measure(parts->first);
  if (const std::string missing = one ? missing_for(*one, study, parts->second) : ""; !missing.empty())
    throw InputError(pointer, one->name + (" " + missing));
}

void check_observed_stops(const nlohmann::ordered_json& study) {
  const auto observed = study.find("observe");
  if (observed == study.end() || !observed->is_array()) return;
  for (std::size_t i = 0; i < observed->size(); ++i)
    check_stop_measure(study, (*observed)[i].get<std::string>(), fmt::format("/observe/{}", i));
}

Table third_octaves_head() {
  return {"third_octaves",
          "One third of an octave of one spectrum of one case.",
          {{"of", "", "Name of the stop or the point."},
           {"quantity", "", "Displacement or force."},
           {"centre", "Hz", "Nominal frequency of the band."},
           {"from", "Hz", "Its lower end."},
           {"to", "Hz", "Its upper end."},
           {"rms", "m or N", "Root mean square in the band: the root of the integral of the density over it."}},
          {}};
}

void put_third_octaves(CaseRecord& record, Table& table, const std::string& of, bool force,
                       const std::vector<double>& density, double spacing) {
  for (const ThirdOctave& band : third_octaves(density, spacing)) {
    const std::string measure = band_measure(force, band.nominal());
    if (!octave_names().contains(measure)) continue;
    put_measure(record, measure + "[" + of + "]", band.rms);
    table.rows.push_back(
        {of, force ? "force" : "displacement", number_in(band.nominal()).value_or(0), band.from, band.to, band.rms});
  }
}

}  // namespace ricochet
