#include "runners/kinds/trajectory/octave_measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <ricochet/measure/statistics/spectra.hpp>

#include "runners/json/json_text.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

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

}  // namespace

const std::vector<std::string>& octave_measures() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const bool force : {false, true})
      for (int n = lowest_band; n <= highest_band; ++n) out.push_back(band_measure(force, ThirdOctave{n}.nominal()));
    return out;
  }();
  return names;
}

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
  return &(known[name] = std::move(made))->info;
}

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
        {of, force ? "force" : "displacement", std::stod(band.nominal()), band.from, band.to, band.rms});
  }
}

}  // namespace ricochet
