#include "runners/plan_files/plan_reader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runners/json/json_text.hpp"

namespace ricochet {
namespace {

std::string text_of(const JsonPlace& place, const char* key) {
  return place.has(key) ? place.at(key).text("a text") : std::string();
}

double bound(const JsonPlace& place, double unbounded) {
  if (place.value().is_null()) return unbounded;
  if (!place.value().is_number()) place.unexpected("a number, or null where there is no bound");
  return place.value().get<double>();
}

// "]0, 1]": the notation in which `describe` prints a range.
Range range_of(const std::string& text, const JsonPlace& place) {
  const std::string expected = "a range such as [0, 0.5], [0, null] or \"]0, 1[\"";
  const auto comma = text.find(',');
  const auto is_bracket = [](char c) { return c == '[' || c == ']'; };
  if (text.size() < 5 || comma == std::string::npos || !is_bracket(text.front()) || !is_bracket(text.back()))
    place.unexpected(expected);
  const auto number = [&](std::string word, double unbounded) {
    word.erase(0, word.find_first_not_of(' '));
    word.erase(word.find_last_not_of(' ') + 1);
    if (word == "∞" || word == "-∞" || word == "−∞") return unbounded;
    try {
      std::size_t end = 0;
      const double value = std::stod(word, &end);
      if (end == word.size() && std::isfinite(value)) return value;
    } catch (const std::exception&) {
    }
    place.unexpected(expected);
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return {number(text.substr(1, comma - 1), -infinity),
          number(text.substr(comma + 1, text.size() - comma - 2), infinity), text.front() == ']', text.back() == '['};
}

Range range_of(const JsonPlace& place) {
  Range range;
  if (place.value().is_string()) {
    range = range_of(place.value().get<std::string>(), place);
  } else {
    const std::vector<JsonPlace> ends = place.items("a range such as [0, 0.5], [0, null] or \"]0, 1[\"");
    if (ends.size() != 2) place.unexpected("two bounds, [low, high]");
    range = {bound(ends[0], range.low), bound(ends[1], range.high), false, false};
  }
  if (!(range.low <= range.high)) place.unexpected("a range whose low end is not above its high end");
  return range;
}

ParameterSpec::Type type_of(const JsonPlace& place) {
  if (!place.has("type"))
    return place.has("default") && place.at("default").value().is_boolean() ? ParameterSpec::Type::boolean
                                                                            : ParameterSpec::Type::real;
  const std::string word = place.at("type").word({"number", "integer", "boolean"});
  return word == "number"    ? ParameterSpec::Type::real
         : word == "integer" ? ParameterSpec::Type::integer
                             : ParameterSpec::Type::boolean;
}

ParameterValue value_of(const JsonPlace& place, ParameterSpec::Type type) {
  if (place.value().is_boolean()) return place.value().get<bool>();
  if (!place.value().is_number()) place.unexpected("a number, or true or false");
  const auto value = place.value().get<double>();
  constexpr double countable = 9007199254740992.0;
  if (type == ParameterSpec::Type::integer && std::floor(value) == value && std::abs(value) <= countable)
    return static_cast<long long>(value);
  return value;
}

ParameterSpec parameter(const std::string& key, const JsonPlace& place) {
  place.close({"default", "range", "unit", "text", "type", "role"});
  const auto allowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  if (key.empty() || key[0] < 'a' || key[0] > 'z' || !std::all_of(key.begin(), key.end(), allowed))
    throw InputError(place.pointer(), "the parameter \"" + shortened(key) +
                                          "\" cannot be written in a study; names of parameters begin with a letter "
                                          "and are made of a-z, 0-9 and '_'");
  // What the object of a method holds beside its parameters.
  for (const char* taken : {"name", "file", "plan"})
    if (key == taken)
      throw InputError(place.pointer(), "a method has the key \"" + key + "\" already; choose another name");
  ParameterSpec spec;
  spec.key = key;
  spec.type = type_of(place);
  spec.unit = place.has("unit") ? place.at("unit").text("an SI unit, \"1\" where there is none") : "1";
  spec.text = text_of(place, "text");
  if (place.has("role"))
    spec.role = place.at("role").word({"restitution", "stiffness"}) == "restitution" ? ParameterRole::restitution
                                                                                     : ParameterRole::stiffness;
  if (place.has("range")) spec.range = range_of(place.at("range"));
  if (!place.has("default")) return spec;
  const JsonPlace given = place.at("default");
  const ParameterValue value = value_of(given, spec.type);
  if (const auto wrong = check_parameter(spec, value))
    throw InputError(given.pointer(), "the default " + quote(given.value()) + " does not fit: " + *wrong);
  spec.fallback = value;
  return spec;
}

std::string name_of(const JsonPlace& plan) {
  const JsonPlace place = plan.at("name", "a plan has a name, by which tables call the scheme");
  const std::string expected = "a name made of a-z, 0-9 and '-'";
  const std::string name = place.text(expected);
  const auto allowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-'; };
  if (!std::all_of(name.begin(), name.end(), allowed)) place.unexpected(expected);
  if (name == "plan") place.unexpected("a name of its own: in a study \"plan\" stands for any scheme given by a file");
  return name;
}

}  // namespace

PluginManual read_plan_manual(const JsonPlace& plan) {
  plan.close({"name", "summary", "text", "source", "parameters", "let", "refuse", "slots", "start", "start_advances",
              "stages", "energy", "velocity", "facts"});
  PluginManual manual;
  manual.name = name_of(plan);
  manual.summary = text_of(plan, "summary");
  if (manual.summary.empty()) manual.summary = "A scheme stated as a plan";
  manual.text = text_of(plan, "text");
  manual.source = text_of(plan, "source");
  if (plan.has("parameters"))
    for (const auto& [key, place] :
         plan.at("parameters").members("an object of parameters, {\"beta\": {\"default\": 0.25, \"range\": [0, 0.5]}}"))
      manual.parameters.push_back(parameter(key, place));
  return manual;
}

}  // namespace ricochet
