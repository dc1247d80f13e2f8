#include "runners/report/scene_sketch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/report/held_beam.hpp"
#include "runners/report/html.hpp"
#include "runners/report/scene_values.hpp"
#include "runners/report/sketch_lines.hpp"
#include "runners/report/structure_sketch.hpp"

namespace ricochet::report {
namespace {

// Pixels of the drawing: where the structure begins, how long it is, its line at rest, and how far stops may lie off.
constexpr double sketch_width = 640, sketch_height = 184, sketch_left = 76, sketch_span = 480, sketch_rest = 84,
                 nearest_gap = 9, widest_gap = 44;

/// A stop above (or below) a point: its face level at y, hatched away from the structure.
std::string level_stop(double x, double y, double side) {
  std::string hatch;
  for (double u = -9; u <= 9; u += 6) hatch += fmt::format("M{:.1f} {:.1f}l5 {:.1f}", x + u, y, side * 6);
  return line(x - 12, y, x + 12, y, "stop") + path(hatch, "stop");
}

/// A stop across the way of a tip that moves along x.
std::string upright_stop(double x, double y, double side) {
  std::string hatch;
  for (double v = -14; v <= 14; v += 7) hatch += fmt::format("M{:.1f} {:.1f}l{:.1f} 5", x, y + v, side * 6);
  return line(x, y - 18, x, y + 18, "stop") + path(hatch, "stop");
}

std::string metres(double gap) {
  return number_text(gap, 4) + " m";
}

/// Pixels between rest and a stop: gaps are to scale among each other, none so small that it does not show.
class Gaps {
 public:
  explicit Gaps(const std::vector<SceneValues::Stop>& stops) {
    for (const SceneValues::Stop& stop : stops)
      for (const auto& gap : {stop.lower, stop.upper})
        if (gap && std::isfinite(*gap)) largest_ = std::max(largest_, std::abs(*gap));
  }
  double operator()(double gap) const {
    return largest_ == 0 || gap == 0
               ? 4
               : nearest_gap + (widest_gap - nearest_gap) * std::min(1.0, std::abs(gap) / largest_);
  }

 private:
  double largest_ = 0;
};

/// A motion: its formula, its file, or its amplitude and pulsation.
std::string motion_text(const nlohmann::ordered_json& given) {
  for (const char* key : {"file", "formula"})
    if (given.contains(key)) return given[key].is_string() ? given[key].get<std::string>() : given[key].dump();
  return fmt::format("{} m sin({} rad/s t + {})", given["amplitude"].dump(), given["pulsation"].dump(),
                     given["phase"].dump());
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
                                who == "all" ? "all supports" : who, motion_text(given)));
  }
  return words;
}

/// A history: its formula, its file, or its spectrum.
std::string history_words(const nlohmann::ordered_json& given) {
  if (given.is_string()) return given.get<std::string>();
  if (!given.is_object()) return given.dump();
  if (given.contains("file")) return given["file"].get<std::string>();
  if (!given.contains("psd")) return given.dump();
  const auto& psd = given["psd"];
  const auto& density = psd.contains("formula") ? psd["formula"] : psd.value("file", nlohmann::ordered_json(""));
  return fmt::format("random, one-sided density {} N²/Hz from {} to {} Hz",
                     density.is_string() ? density.get<std::string>() : density.dump(), psd["from"].dump(),
                     psd["to"].dump());
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
      const std::string where = place.is_number()                          ? "x = " + place.dump() + " m"
                                : place.is_object() && place.contains("x") ? "x = " + place["x"].dump() + " m"
                                : place.is_object()                        ? place_words(place)
                                                                           : "";
      words.push_back(fmt::format("F(t){} = {}", where.empty() ? "" : " at " + where, history_words(term["force"])));
    } else {
      words.push_back(fmt::format("{} times {}", term.contains("shape") ? term["shape"].dump() : "f(x)",
                                  term.contains("time") ? history_words(term["time"]) : "g(t)"));
    }
  }
  return words;
}

std::string support_words(const SceneValues& scene) {
  if (const auto* motions = scene.at("/scene/motions"); motions && !motions->empty())
    return motions->front().contains("acceleration") ? "a(t)" : "φ(t)";
  const std::string amplitude = scene.text("/scene/support/amplitude", "m");
  return amplitude.empty() ? "" : "A₀ sin(ωt)";
}

bool loaded(const SceneValues& scene) {
  const auto* load = scene.at("/scene/load");
  return load && (load->is_string()   ? load->get<std::string>() != "0"
                  : load->is_number() ? load->get<double>() != 0
                                      : !load->empty());
}

/// Where forces at points push, of a load that is made of these alone.
std::vector<double> point_forces(const SceneValues& scene) {
  std::vector<double> places;
  const auto* load = scene.at("/scene/load");
  if (!load || !load->is_array()) return places;
  for (const auto& term : *load) {
    if (!term.is_object() || !term.contains("force") || !term.contains("at")) return {};
    const auto& at = term["at"].is_object() && term["at"].contains("x") ? term["at"]["x"] : term["at"];
    if (!at.is_number()) return {};
    // Forces along y and z at one place are one arrow.
    if (const double x = at.get<double>(); std::find(places.begin(), places.end(), x) == places.end())
      places.push_back(x);
  }
  return places;
}

std::string beam(const SceneValues& scene) {
  const double length = scene.number("/scene/structure/length").value_or(1);
  const auto x_of = [&](double x) { return sketch_left + sketch_span * std::clamp(x / length, 0.0, 1.0); };
  const HeldBeam held = held_beam(scene, length, {sketch_left, sketch_span, sketch_rest, sketch_height - 14});
  std::string out = (held.given ? held.svg : wall(sketch_left, sketch_rest - 30, sketch_rest + 30, -1)) +
                    line(sketch_left, sketch_rest, sketch_left + sketch_span, sketch_rest, "structure") + held.masses;
  if (const std::string shaken = support_words(scene); !shaken.empty())
    out += arrow(sketch_left - 24, sketch_rest - 24, sketch_left - 24, sketch_rest + 24, true) +
           label(sketch_left - 24, sketch_rest + 48, shaken);
  const std::vector<double> forces = point_forces(scene);
  for (const double x : forces)
    out += arrow(x_of(x), sketch_rest - 34, x_of(x), sketch_rest - 6) + label(x_of(x), sketch_rest - 38, "F(t)");
  if (loaded(scene) && forces.empty()) {
    for (int k = 1; k <= 6; ++k)
      out += arrow(sketch_left + sketch_span * k / 7.0, sketch_rest - 30, sketch_left + sketch_span * k / 7.0,
                   sketch_rest - 8);
    out += label(sketch_left + sketch_span / 14.0 - 6, sketch_rest - 34, "f(x, t)");
  }
  const std::vector<SceneValues::Stop> stops = scene.stops(length);
  const Gaps gaps(stops);
  const bool few = stops.size() <= 4;
  for (const SceneValues::Stop& stop : stops) {
    const double x = x_of(stop.x);
    if (stop.upper) out += level_stop(x, sketch_rest - gaps(*stop.upper), -1);
    if (stop.lower) out += level_stop(x, sketch_rest + gaps(*stop.lower), 1);
    if (!stop.name.empty()) out += label(x, sketch_rest - widest_gap - 24, stop.name);
    if (!few && &stop != &stops.back()) continue;
    if (stop.upper) out += label(x, sketch_rest - gaps(*stop.upper) - 11, metres(*stop.upper));
    if (stop.lower) out += label(x, sketch_rest + gaps(*stop.lower) + 20, metres(*stop.lower));
  }
  out += line(sketch_left, sketch_height - 14, sketch_left + sketch_span, sketch_height - 14, "measure") +
         line(sketch_left, sketch_height - 19, sketch_left, sketch_height - 9, "measure") +
         line(sketch_left + sketch_span, sketch_height - 19, sketch_left + sketch_span, sketch_height - 9, "measure");
  return out + (held.measured ? held.spans
                              : label(sketch_left + sketch_span / 2, sketch_height - 18,
                                      "L = " + scene.text("/scene/structure/length", "m")));
}

/// A pin on what moves along x, between the stops of its tip.
std::string tip_stops(const SceneValues& scene, double length, double x, double y) {
  const std::vector<SceneValues::Stop> stops = scene.stops(length);
  const Gaps gaps(stops);
  std::string out;
  for (const SceneValues::Stop& stop : stops) {
    const std::string name = stop.name.empty() ? "" : stop.name + " ";
    if (stop.upper)
      out += upright_stop(x + 4 + gaps(*stop.upper), y, 1) +
             label(x + 14 + gaps(*stop.upper), y + 4, name + metres(*stop.upper), "start");
    if (stop.lower)
      out += upright_stop(x - 4 - gaps(*stop.lower), y, -1) +
             label(x - 14 - gaps(*stop.lower), y + 4, name + metres(*stop.lower), "end");
  }
  return out + (stops.empty() ? "" : line(x, y - 10, x, y + 22, "structure"));
}

std::string oscillator(const SceneValues& scene) {
  const double mass = 330, low = 128;
  std::string spring = fmt::format("M{:.1f} {:.1f}h20", sketch_left, low - 22);
  for (int k = 0; k < 8; ++k) spring += k % 2 == 0 ? "l10 -9l10 9" : "l10 9l10 -9";
  std::string out =
      wall(sketch_left, low - 44, low, -1) + line(sketch_left, low, sketch_left + sketch_span, low, "hatch") +
      fmt::format("<rect class=\"body\" x=\"{}\" y=\"{}\" width=\"70\" height=\"44\"/>", mass - 35, low - 44) +
      label(mass, low - 17, "m");
  if (!scene.text("/scene/structure/stiffness", "").empty())
    out += path(spring + fmt::format("L{:.1f} {:.1f}", mass - 35, low - 22), "spring") +
           label(sketch_left + 110, low - 36, "k");
  if (!scene.text("/scene/structure/force/amplitude", "").empty())
    out += arrow(mass + 37, low - 22, mass + 92, low - 22) + label(mass + 98, low - 18, "F cos(ωt + ψ)", "start");
  if (const std::string shaken = support_words(scene); !shaken.empty())
    out +=
        arrow(sketch_left - 56, low - 22, sketch_left - 12, low - 22, true) + label(sketch_left - 34, low - 34, shaken);
  return out + tip_stops(scene, 0, mass, low - 68);
}

std::string bar(const SceneValues& scene) {
  const std::string fixed = scene.word("/scene/structure/fixed");
  const bool right = fixed == "right", held = fixed == "left" || right;
  const double from = sketch_left + 60, to = sketch_left + sketch_span - 60, tip = fixed == "left" ? to : from;
  std::string out = fmt::format("<rect class=\"body\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"18\"/>", from,
                                sketch_rest + 14, to - from);
  if (held)
    out += right ? wall(to, sketch_rest - 4, sketch_rest + 50, 1) : wall(from, sketch_rest - 4, sketch_rest + 50, -1);
  if (loaded(scene))
    out += arrow((from + to) / 2 - 25, sketch_rest + 2, (from + to) / 2 + 25, sketch_rest + 2) +
           label((from + to) / 2, sketch_rest - 6, "f(x, t)");
  out += tip_stops(scene, scene.number("/scene/structure/length").value_or(1), tip, sketch_rest - 8);
  return out + label((from + to) / 2, sketch_rest + 54, "L = " + scene.text("/scene/structure/length", "m"));
}

struct Structure {
  const char* name;
  std::string (*draw)(const SceneValues&);
  std::vector<std::tuple<const char*, const char*, const char*>> numbers;  ///< symbol, key, unit
};

const std::vector<Structure>& structures() {
  static const std::vector<Structure> all = {
      {"beam",
       beam,
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
       oscillator,
       {{"m", "mass", "kg"},
        {"k", "stiffness", "N/m"},
        {"c", "damping", "N s/m"},
        {"F", "force/amplitude", "N"},
        {"ω of F", "force/pulsation", "rad/s"},
        {"ψ", "force/phase", "rad"}}},
      {"bar",
       bar,
       {{"L", "length", "m"},
        {"EA", "EA", "N"},
        {"ρA", "rhoA", "kg/m"},
        {"α (damping, of K)", "damping/stiffness", "s"},
        {"η (damping, of M)", "damping/mass", "1/s"}}},
      {"modal", nullptr, {{"modes", "modes", ""}, {"shapes", "shapes", ""}, {"residual", "residual", ""}}},
      {"assembled",
       nullptr,
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

}  // namespace

std::string scene_svg(const nlohmann::ordered_json& study) {
  const SceneValues scene(study);
  const Structure* structure = structure_of(scene);
  if (!structure) return "";
  const StructureSketch files = structure->draw ? StructureSketch() : structure_sketch(scene, sketch_width);
  const std::string drawn = structure->draw ? structure->draw(scene) : files.svg;
  if (drawn.empty()) return "";
  std::string said = std::string("Sketch of the scene: ") + structure->name;
  for (const auto& [symbol, text] : scene_numbers(study)) said += ", " + symbol + " " + text;
  return fmt::format("<svg class=\"sketch\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">{}</svg>\n",
                     sketch_width, structure->draw ? sketch_height : files.height, escape(said), drawn);
}

std::vector<std::pair<std::string, std::string>> scene_numbers(const nlohmann::ordered_json& study) {
  const SceneValues scene(study);
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
