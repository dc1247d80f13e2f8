#include <fmt/format.h>

#include <algorithm>

#include "runners/report/html.hpp"
#include "runners/report/scene_sketch.hpp"
#include "runners/report/sketch_pieces.hpp"

namespace ricochet::report {
namespace {

/// A history: its formula, its file, its amplitude and pulsation (of a displacement), or its spectrum.
std::string history_words(const nlohmann::ordered_json& given) {
  if (given.is_string()) return given.get<std::string>();
  if (!given.is_object()) return given.dump();
  for (const char* key : {"file", "formula"})
    if (given.contains(key)) return history_words(given[key]);
  if (given.contains("amplitude"))
    return fmt::format("{} m sin({} rad/s t + {})", given["amplitude"].dump(), given["pulsation"].dump(),
                       given["phase"].dump());
  if (!given.contains("psd")) return given.dump();
  const auto& psd = given["psd"];
  return fmt::format("random, one-sided density {} N²/Hz from {} to {} Hz", history_words(psd),
                     number_text(number_at(psd, "from").value_or(0)), number_text(number_at(psd, "to").value_or(0)));
}

/// Motions of supports: which supports, what is given, and where it stands.
std::vector<std::string> motion_words(const SceneValues& scene) {
  std::vector<std::string> words;
  const auto* motions = scene.at("/scene/motions");
  if (!motions || !motions->is_array()) return words;
  for (const auto& motion : *motions) {
    const bool accelerates = motion.contains("acceleration");
    const auto& given = motion[accelerates ? "acceleration" : "displacement"];
    std::string who;
    for (const auto& name : motion["supports"]) who += (who.empty() ? "" : ", ") + name.get<std::string>();
    words.push_back(fmt::format("{} of {}: {}", accelerates ? "acceleration" : "displacement",
                                who == "all" ? "all supports" : who, history_words(given)));
  }
  return words;
}

/// Loads in words, a line for each term.
std::vector<std::string> load_words(const SceneValues& scene) {
  const auto* load = scene.at("/scene/load");
  if (!load || !load->is_array()) return {scene.text("/scene/load", "")};
  std::vector<std::string> words;
  for (const auto& term : *load) {
    if (!term.is_object()) return {scene.text("/scene/load", "")};
    if (term.contains("force")) {
      const auto place = term.contains("at") ? term["at"] : nlohmann::ordered_json();
      const std::string where = place.is_number()   ? "x = " + place.dump() + " m"
                                : place.is_object() ? place_words(place)
                                                    : "";
      words.push_back(fmt::format("F(t){} = {}", where.empty() ? "" : " at " + where, history_words(term["force"])));
    } else {
      const std::string body = term.value("body", "");
      words.push_back(fmt::format("{} times {}{}", term.contains("shape") ? history_words(term["shape"]) : "f(x)",
                                  term.contains("time") ? history_words(term["time"]) : "g(t)",
                                  body.empty() ? "" : " along " + body));
    }
  }
  return words;
}

struct Structure {
  const char* name;
  std::vector<std::tuple<const char*, const char*, const char*>> numbers;  ///< symbol, key, unit
};

const std::vector<Structure>& structures() {
  static const std::vector<Structure> all = {
      {"beam",
       {{"L", "length", "m"},
        {"E", "young", "Pa"},
        {"ρ", "density", "kg/m³"},
        {"added mass", "added_mass", "kg/m"},
        {"tension", "tension", "N"},
        {"foundation", "foundation", "N/m²"},
        {"α (damping, of K)", "damping/stiffness", "s"},
        {"η (damping, of M)", "damping/mass", "1/s"},
        {"damping ratio", "damping/ratio", ""}}},
      {"oscillator",
       {{"m", "mass", "kg"},
        {"k", "stiffness", "N/m"},
        {"c", "damping", "N s/m"},
        {"F", "force/amplitude", "N"},
        {"ω of F", "force/pulsation", "rad/s"},
        {"ψ", "force/phase", "rad"}}},
      {"bar",
       {{"L", "length", "m"},
        {"EA", "EA", "N"},
        {"ρA", "rhoA", "kg/m"},
        {"α (damping, of K)", "damping/stiffness", "s"},
        {"η (damping, of M)", "damping/mass", "1/s"}}},
      {"modal", {{"modes", "modes", ""}, {"shapes", "shapes", ""}, {"residual", "residual", ""}}},
      {"assembled",
       {{"K", "stiffness", ""},
        {"M", "mass", ""},
        {"α (damping, of K)", "damping/stiffness", "s"},
        {"η (damping, of M)", "damping/mass", "1/s"},
        {"damping ratio", "damping/ratio", ""},
        {"C", "damping/file", ""}}}};
  return all;
}

const Structure* structure_of(const SceneValues& scene) {
  const auto found = std::find_if(structures().begin(), structures().end(), [&](const Structure& one) {
    return one.name == scene.word("/scene/structure/type");
  });
  return found == structures().end() ? nullptr : &*found;
}

std::vector<std::pair<std::string, std::string>> structure_numbers(const SceneValues& scene) {
  std::vector<std::pair<std::string, std::string>> out;
  const auto add = [&](const std::string& symbol, const std::string& text) {
    if (!text.empty()) out.emplace_back(symbol, text);
  };
  const Structure* structure = structure_of(scene);
  if (!structure) return out;
  for (const auto& [symbol, key, unit] : structure->numbers)
    add(symbol, scene.text(std::string("/scene/structure/") + key, unit));
  if (const auto section = scene.section()) {
    add("EI", number_text(section->EI, 4) + " N m²");
    add("ρS", number_text(section->rhoS, 4) + " kg/m");
  }
  for (const auto& [symbol, text] : held_beam_words(scene)) add(symbol, text);
  return out;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> scene_numbers(const nlohmann::ordered_json& study) {
  const SceneValues scene(study);
  std::vector<std::pair<std::string, std::string>> out;
  const auto add = [&](const std::string& symbol, const std::string& text) {
    if (!text.empty()) out.emplace_back(symbol, text);
  };
  const auto bodies = scene.bodies();
  for (const auto& [name, body] : bodies) {
    const auto said = structure_numbers(body);
    if (name.empty()) out = said;
    if (name.empty() || said.empty()) continue;
    std::string words = body.word("/scene/structure/type");
    for (const auto& [symbol, text] : said) words += ", " + symbol + " " + text;
    add("body " + name, words);
  }
  if (out.empty()) return out;
  for (const auto& [symbol, key] : {std::pair("lower stop", "lower"), {"upper stop", "upper"}}) {
    const std::string pointer = std::string("/scene/stops/") + key;
    const auto* stop = scene.at(pointer);
    // A stop at rest is one all the same.
    add(symbol,
        stop && scene.text(pointer, "m").empty() ? "0 m" : scene.text(pointer, stop && stop->is_string() ? "" : "m"));
  }
  for (const auto& [name, text] : scene.named_stops()) add("stop " + name, text);
  const auto* at = scene.at("/scene/stops/at");
  if (at) add("stops at", at->is_string() ? at->get<std::string>() : scene.text("/scene/stops/at", "m"));
  add("A₀ (clamp)", scene.text("/scene/support/amplitude", "m"));
  if (!scene.text("/scene/support/amplitude", "").empty())
    add("ω (clamp)", scene.text("/scene/support/pulsation", "rad/s"));
  for (const std::string& words : motion_words(scene)) add("motion", words);
  for (const std::string& words : load_words(scene)) add("load", words);
  add("u(x, 0)", scene.text("/scene/initial/displacement", ""));
  add("u_t(x, 0)", scene.text("/scene/initial/velocity", ""));
  if (const auto* initial = scene.at("/scene/initial"))
    for (const auto& [name, one] : initial->items())
      if (one.is_object()) {
        add("u(x, 0) of " + name, scene.text("/scene/initial/" + name + "/displacement", ""));
        add("u_t(x, 0) of " + name, scene.text("/scene/initial/" + name + "/velocity", ""));
      }
  add("duration", scene.text("/duration", "s"));
  return out;
}

}  // namespace ricochet::report
