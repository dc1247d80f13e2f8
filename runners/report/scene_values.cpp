#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/scene.hpp>

#include "runners/report/html.hpp"
#include "runners/report/scene_sketch.hpp"
#include "runners/table/text.hpp"

namespace ricochet::report {
namespace {

using SceneJson = nlohmann::ordered_json;

constexpr std::size_t most_stops = 12, most_ends = 2, most_listed = 6;
constexpr int scene_digits = 4;

/// A stop's formula at x; nothing where there is no stop or no formula that can be read.
std::optional<double> stop_at(const SceneJson* formula, double x) {
  if (formula && formula->is_array() && !formula->empty()) formula = &formula->front();
  if (!formula) return std::nullopt;
  if (formula->is_number()) return formula->get<double>();
  if (!formula->is_string()) return std::nullopt;
  try {
    return Formula(formula->get<std::string>(), "/scene/stops", "x")(x);
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

std::string with(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + " " + unit;
}

constexpr const char* one_structure = "/scene/structure";

}  // namespace

std::optional<double> first_number(const SceneJson* value) {
  if (value && value->is_array() && !value->empty()) value = &value->front();
  return value && value->is_number() ? std::optional(value->get<double>()) : std::nullopt;
}

std::optional<double> number_at(const SceneJson& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  return found == object.end() ? std::nullopt : first_number(&*found);
}

std::string place_words(const SceneJson& one) {
  std::string where = one.value("body", "");
  const auto add = [&where](const std::string& part) { where += (where.empty() || part.empty() ? "" : " ") + part; };
  if (const auto x = number_at(one, "x")) add("x = " + number_text(*x, scene_digits) + " m");
  add(one.value("node", ""));
  if (one.contains("point")) add("point " + one.value("point", ""));
  if (one.contains("component")) add((one.contains("x") ? "along " : "") + one.value("component", ""));
  if (one.contains("direction")) add("along " + one["direction"].dump());
  for (const SceneJson& dof : one.value("dofs", SceneJson::array()))
    add(fmt::format("{}{} × dof {}", where.empty() ? "" : "+ ",
                    number_text(number_at(dof, "weight").value_or(1), scene_digits), dof.value("dof", 0)));
  return where;
}

std::string SceneValues::real(const std::string& pointer) const {
  return pointer.starts_with(one_structure) ? structure_ + pointer.substr(std::string(one_structure).size()) : pointer;
}

std::vector<std::pair<std::string, SceneValues>> SceneValues::bodies() const {
  std::vector<std::pair<std::string, SceneValues>> out;
  if (const SceneJson* bodies = at("/scene/bodies"); bodies && bodies->is_object())
    for (const auto& [name, ignored] : bodies->items())
      out.emplace_back(name, SceneValues(study_, "/scene/bodies/" + name));
  if (out.empty()) out.emplace_back("", *this);
  return out;
}

const SceneJson* SceneValues::at(const std::string& pointer) const {
  const SceneJson::json_pointer place(real(pointer));
  return study_.contains(place) && !study_.at(place).is_null() ? &study_.at(place) : nullptr;
}

std::string SceneValues::word(const std::string& pointer) const {
  const SceneJson* value = at(pointer);
  return value && value->is_string() ? value->get<std::string>() : "";
}

std::optional<double> SceneValues::number(const std::string& pointer) const {
  if (const std::vector<double> values = swept(pointer); !values.empty()) return values.back();
  return first_number(at(pointer));
}

std::vector<double> SceneValues::swept(const std::string& pointer) const {
  std::vector<const SceneJson*> sweeps;
  if (const SceneJson* one = at("/parameter")) sweeps.push_back(one);
  if (const SceneJson* axes = at("/axes"); axes && axes->is_array())
    for (const SceneJson& one : *axes) sweeps.push_back(&one);
  for (const SceneJson* one : sweeps) {
    if (!one->is_object() || one->value("pointer", "") != real(pointer)) continue;
    if (one->contains("values") && (*one)["values"].is_array()) {
      std::vector<double> out;
      for (const SceneJson& value : (*one)["values"])
        if (value.is_number()) out.push_back(value.get<double>());
      return out;
    }
    if (!one->contains("from") || !one->contains("to")) continue;
    const auto from = first_number(&one->at("from")), to = first_number(&one->at("to"));
    if (from && to) return {*from, *to};
  }
  return {};
}

std::string SceneValues::text(const std::string& pointer, const std::string& unit) const {
  const SceneJson* value = at(pointer);
  const bool nothing = value && (*value == 0 || *value == "0");
  return nothing && swept(pointer).empty() ? "" : said(pointer, unit);
}

std::string SceneValues::said(const std::string& pointer, const std::string& unit, bool varies) const {
  if (const std::vector<double> values = swept(pointer); !values.empty()) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return "from " + number_text(*low, scene_digits) + " to " + with(number_text(*high, scene_digits), unit) +
           ", swept";
  }
  const SceneJson* value = at(pointer);
  if (!value || value->is_object()) return "";
  const auto all = value->is_array() ? value->get<std::vector<SceneJson>>() : std::vector<SceneJson>{*value};
  std::vector<double> numbers;
  std::vector<std::string> words;
  for (const SceneJson& one : all) {
    const auto number = one.is_string() ? number_in(one.get<std::string>()) : first_number(&one);
    if (number) numbers.push_back(*number);
    words.push_back(number            ? number_text(*number, scene_digits)
                    : one.is_string() ? one.get<std::string>()
                                      : one.dump());
  }
  const bool numeric = numbers.size() == all.size();
  if (words.empty()) return "none";
  if (numeric && all.size() > (varies ? most_ends : most_listed)) {
    const auto [low, high] = std::minmax_element(numbers.begin(), numbers.end());
    return fmt::format("from {} to {} ({} values)", number_text(*low, scene_digits),
                       with(number_text(*high, scene_digits), unit), numbers.size());
  }
  if (all.size() > most_listed) return count_text(all.size(), "value", "values");
  const std::string last = words.back();
  words.pop_back();
  return fmt::format("{}{}{}", fmt::join(words, ", "), words.empty() ? "" : " and ", with(last, numeric ? unit : ""));
}

std::vector<SceneValues::Stop> SceneValues::stops(double length) const {
  if (const SceneJson* list = at("/scene/stops"); list && list->is_array()) {
    std::vector<Stop> out;
    for (const SceneJson& stop : *list)
      out.push_back({stop.value("at", SceneJson()), stop.value("to", SceneJson()), number_at(stop, "lower"),
                     number_at(stop, "upper"), number_at(stop.value("clearance", SceneJson()), "radius"),
                     stop.value("name", ""), number_at(stop, "normal_force")});
    return out;
  }
  const SceneJson *lower = at("/scene/stops/lower"), *upper = at("/scene/stops/upper"), *where = at("/scene/stops/at");
  if (!lower && !upper) return {};
  std::vector<double> places;
  if (where && where->is_array()) {
    for (const SceneJson& x : *where)
      if (x.is_number()) places.push_back(x.get<double>());
  } else if (word("/scene/stops/at") == "tip") {
    // The tip of a bar is its end that is not held.
    places = {word("/scene/structure/type") == "bar" && word("/scene/structure/fixed") != "left" ? 0 : length};
  } else {
    // At nodes: a few of them stand for all.
    const auto elements = static_cast<std::size_t>(std::max(1.0, number("/mesh/elements").value_or(most_stops)));
    const std::size_t shown = std::min(elements, most_stops);
    for (std::size_t k = 1; k <= shown; ++k)
      places.push_back(length * static_cast<double>(k) / static_cast<double>(shown));
    // Nothing touches where the beam is held.
    if (const SceneJson* supports = at("/scene/structure/supports"); supports && supports->is_array())
      for (const SceneJson& one : *supports)
        if (const auto x = one.contains("x") ? first_number(&one["x"]) : std::nullopt;
            x && (one.value("type", "") == "clamped" || one.value("type", "") == "pinned"))
          std::erase_if(places, [&](double place) { return std::abs(place - *x) <= 1e-9 * length; });
  }
  if (places.size() > most_stops) places.resize(most_stops);
  std::vector<Stop> out;
  for (const double x : places) {
    Stop stop{SceneJson::object(), {}, stop_at(lower, x), stop_at(upper, x), {}};
    stop.at["x"] = x;
    if (stop.lower || stop.upper) out.push_back(stop);
  }
  return out;
}

std::optional<SceneValues::Section> SceneValues::section() const {
  const std::string of = "/scene/structure/section/";
  ricochet::Section section;
  const std::pair<const char*, ricochet::Section::Type> types[] = {{"tube", ricochet::Section::Type::tube},
                                                                   {"circle", ricochet::Section::Type::circle},
                                                                   {"rectangle", ricochet::Section::Type::rectangle},
                                                                   {"given", ricochet::Section::Type::given}};
  const auto type =
      std::find_if(std::begin(types), std::end(types), [&](const auto& one) { return one.first == word(of + "type"); });
  if (type == std::end(types)) return std::nullopt;
  section.type = type->second;
  for (const auto& [key, value] : {std::pair("outer_diameter", &section.outer_diameter),
                                   {"wall", &section.wall},
                                   {"diameter", &section.diameter},
                                   {"width", &section.width},
                                   {"height", &section.height},
                                   {"EI", &section.EI},
                                   {"rhoS", &section.rhoS}}) {
    if (const SceneJson* there = at(of + key); there && there->is_array()) return std::nullopt;
    *value = number(of + key).value_or(0);
  }
  const SceneJson *young = at("/scene/structure/young"), *density = at("/scene/structure/density");
  if ((young && young->is_array()) || (density && density->is_array())) return std::nullopt;
  try {
    const SectionProperties found =
        section_properties(section, first_number(young).value_or(0), first_number(density).value_or(0));
    return found.EI > 0 && found.rhoS > 0 ? std::optional(Section{found.EI, found.rhoS}) : std::nullopt;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace ricochet::report
