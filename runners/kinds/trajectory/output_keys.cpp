#include "runners/kinds/trajectory/output_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/json/json_text.hpp"

namespace ricochet {
namespace {

std::vector<std::string> names_in(const Json& study, const char* list) {
  std::vector<std::string> names;
  const Json& scene = study.at("scene");
  if (scene.contains(list) && scene.at(list).is_array())
    for (const Json& one : scene.at(list)) names.push_back(one.at("name").get<std::string>());
  return names;
}

void check_spectra(const Json& study, const Json& outputs) {
  const std::vector<std::string> stops = names_in(study, "stops"), points = names_in(study, "points");
  std::vector<std::string> all = stops;
  all.insert(all.end(), points.begin(), points.end());
  const Json& spectra = outputs.at("spectra");
  for (std::size_t i = 0; i < spectra.size(); ++i) {
    const std::string pointer = fmt::format("/outputs/spectra/{}/of", i);
    const auto name = spectra[i].at("of").get<std::string>();
    const bool force = spectra[i].at("quantity") == "force";
    if (all.empty())
      throw InputError(pointer, "the scene has neither points nor stops with names; expected one of them");
    const std::vector<std::string>& known = force ? stops : all;
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError(
          pointer, known.empty() ? "the scene has no stops with names; expected a displacement of: " + quoted_list(all)
                                 : fmt::format("no {} \"{}\"; there is: {}{}", force ? "stop" : "stop or point",
                                               shortened(name), quoted_list(known), did_you_mean(name, known)));
    for (std::size_t j = 0; j < i; ++j)
      if (spectra[j] == spectra[i])
        throw InputError(fmt::format("/outputs/spectra/{}", i), fmt::format("the same as spectra/{}", j));
  }
  for (const char* key : {"rate", "segment"})
    if (!outputs.contains(key) || outputs.at(key).is_null())
      throw InputError(fmt::format("/outputs/{}", key), "missing; spectra need rate, in Hz, and segment, in s");
  const double rate = outputs.at("rate").get<double>(), segment = outputs.at("segment").get<double>();
  for (const double step : one_or_each<double>(study.at("step")))
    if (step * rate > 1)
      throw InputError("/outputs/rate", fmt::format("{:.6g} Hz is above one sample in a step of {:.6g} s; expected at "
                                                    "most {:.6g} Hz",
                                                    rate, step, 1 / step));
  constexpr double most = 1 << 22;
  const double samples = rate * segment, whole = std::round(samples);
  if (std::abs(samples - whole) > 1e-6 * whole || std::fmod(whole, 2) != 0 || whole < 4 || whole > most)
    throw InputError("/outputs/segment", fmt::format("{:.6g} s at {:.6g} Hz are {:.10g} samples; expected an even "
                                                     "number from 4 to {}",
                                                     segment, rate, samples, most));
  const Json window = study.value("window", Json());
  const double from = window.is_object() ? window.at("from").get<double>() : 0;
  const double to = window.is_object() ? window.at("to").get<double>() : study.at("duration").get<double>();
  if (segment > (to - from) * (1 + 1e-9))
    throw InputError("/outputs/segment",
                     fmt::format("{:.6g} s in {:.6g} s that are looked at; expected at most that", segment, to - from));
}

}  // namespace

int AskedOutputs::segment_samples() const {
  return static_cast<int>(std::lround(rate * segment));
}

Field outputs_key() {
  using namespace keys;
  ObjectForm shocks;
  shocks.fields = {single(real("force_above", "N", non_negative, 0.0, "Contact is a shock while its force is above.")),
                   single(real("rest", "s", non_negative, 0.0, "Apart by less, two are one shock."))};
  ObjectForm spectrum;
  spectrum.fields = {of_form(Field::Form::text, "of", std::nullopt, "Name of a stop or of a point."),
                     word("quantity", {"displacement", "force"}, std::nullopt, "Force: of a stop alone.")};
  ObjectForm outputs;
  outputs.fields = {
      quiet(object("shocks", Json(nullptr), "Shocks at the stops, for shocks.csv; absent: none.", shocks)),
      quiet(integer("classes", {1, 1000, false, false}, 10, "Classes of histogram.csv.")),
      quiet(objects("spectra", "Power spectral densities, for spectra.csv, over the window.", spectrum)),
      quiet(keys::optional(real("rate", "Hz", positive, std::nullopt, "Samples per second of spectra."))),
      quiet(keys::optional(real("segment", "s", positive, std::nullopt, "Length of a segment of Welch's method.")))};
  outputs.fields.front().nullable = true;
  Field field = quiet(object("outputs", Json(nullptr), "What is kept beside measures and curves.", outputs));
  field.nullable = true;
  return field;
}

void check_outputs(const Json& study) {
  const Json outputs = study.value("outputs", Json());
  const Json window = study.value("window", Json());
  const std::size_t stops = names_in(study, "stops").size();
  constexpr std::size_t most = 1000000;
  if (window.is_object() && window.at("parts").is_number() && stops * window.at("parts").get<std::size_t>() > most)
    throw InputError("/window/parts", fmt::format("{} parts of {} stops; expected at most {} together",
                                                  window.at("parts").get<std::size_t>(), stops, most));
  if (!outputs.is_object()) return;
  if (outputs.contains("spectra") && !outputs.at("spectra").empty()) check_spectra(study, outputs);
}

AskedOutputs asked_outputs(const StudyCase& study_case) {
  AskedOutputs asked;
  asked.window.to = study_case.duration;
  const Json settings = study_case.settings.is_object() ? study_case.settings : Json::object();
  if (settings.contains("window")) {
    const Json& window = settings.at("window");
    asked.windowed = true;
    asked.window = {window.at("from").get<double>(), window.at("to").get<double>(),
                    window.at("parts").is_number() ? window.at("parts").get<int>() : 1};
  }
  if (!settings.contains("outputs")) return asked;
  const Json& outputs = settings.at("outputs");
  asked.any = true;
  if (outputs.contains("shocks"))
    asked.shocks =
        ShockRule{outputs.at("shocks").at("force_above").get<double>(), outputs.at("shocks").at("rest").get<double>()};
  asked.classes = outputs.value("classes", 10);
  for (const Json& one : outputs.value("spectra", Json::array()))
    asked.spectra.push_back({one.at("of").get<std::string>(), one.at("quantity") == "force"});
  asked.rate = outputs.value("rate", 0.0);
  asked.segment = outputs.value("segment", 0.0);
  return asked;
}

}  // namespace ricochet
