#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/contract/stage_facts.hpp>

#include "runners/json/json_text.hpp"
#include "runners/plan_files/plan_file.hpp"
#include "runners/plan_files/plan_reader.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

/// Formulas are evaluated anew for each plan: nothing is shared between threads but the text.
class PlanScheme final : public TimeScheme {
 public:
  PlanScheme(std::shared_ptr<const PlanSource> source, Parameters parameters)
      : source_(std::move(source)), parameters_(std::move(parameters)) {}

  PlanOrRefusal plan(double h, const ProblemFacts& facts) const override {
    try {
      const JsonPlace place(source_->plan, source_->pointer);
      PlanValues values(place, h, facts, parameters_, Finite::demanded);
      if (auto refusal = plan_refusal(place, values)) return *refusal;
      return read_step_plan(place, values);
    } catch (const InputError& error) {
      // The text is sound; it is these parameters that make no plan of it.
      throw std::runtime_error(source_->explain(error));
    }
  }

 private:
  std::shared_ptr<const PlanSource> source_;
  Parameters parameters_;
};

// Some value in the range of a parameter that has no default: enough to read formulas with.
ParameterValue some_value(const ParameterSpec& spec) {
  if (spec.fallback) return *spec.fallback;
  if (spec.type == ParameterSpec::Type::boolean) return false;
  const Range& range = spec.range;
  double value = 1;
  if (std::isfinite(range.low) && std::isfinite(range.high))
    value = 0.5 * (range.low + range.high);
  else if (std::isfinite(range.low))
    value = range.low + 1;
  else if (std::isfinite(range.high))
    value = range.high - 1;
  return value;
}

// Where the sentence of check_plan() points: it begins with the part that is wrong.
std::string pointer_of(const std::string& sentence, const JsonPlace& plan) {
  if (sentence.starts_with("stage ")) {
    const auto stage = std::strtoul(sentence.c_str() + std::strlen("stage "), nullptr, 10);
    return pointer_to(plan.pointer_of("stages"), stage > 0 ? stage - 1 : 0);
  }
  for (const char* key : {"start", "energy", "velocity", "facts"})
    if (sentence.starts_with(key) && plan.has(key)) return plan.pointer_of(key);
  return plan.pointer();
}

void require_well_formed(const JsonPlace& plan, const Parameters& defaults, double h, const ProblemFacts& facts) {
  PlanValues values(plan, h, facts, defaults, Finite::demanded);
  if (plan_refusal(plan, values)) return;
  const StepPlan step = read_step_plan(plan, values);
  auto wrong = check_plan(step);
  // A plan of numbers cannot tell its h; this one can.
  if (const double own = wrong ? 0.0 : derive(step).h; own != 0 && !(std::abs(own - h) <= 2e-8 * h))
    wrong = fmt::format("a step of {:g} s carries a free mass at 1 m/s by {:g} m", h, own);
  if (wrong)
    throw InputError(pointer_of(*wrong, plan),
                     fmt::format("with the default parameters and h = {:g} s the plan is ill-formed: {}", h, *wrong));
}

}  // namespace

std::string PlanSource::explain(const InputError& error) const {
  if (file.empty()) return error.pointer().empty() ? error.what() : "at " + error.pointer() + ": " + error.what();
  return explained(error, file.string(), text);
}

PlanSource read_plan_file(const std::filesystem::path& file) {
  PlanSource source;
  source.file = file;
  try {
    source.text = read_text(file, "a plan");
    source.plan = parse_json(source.text);
  } catch (const InputError& error) {
    throw InputError("", source.explain(error));
  }
  return source;
}

PluginManual check_plan_source(const PlanSource& source) {
  const JsonPlace plan(source.plan, source.pointer);
  PluginManual manual = read_plan_manual(plan);
  constexpr double h = 1e-3;
  ProblemFacts facts;
  facts.dofs = 1;
  facts.damped = facts.contact = true;
  Parameters sample;
  bool complete = true;
  for (const ParameterSpec& spec : manual.parameters) {
    sample.set(spec.key, some_value(spec));
    complete = complete && spec.fallback.has_value();
  }
  PlanValues values(plan, h, facts, sample, Finite::ignored);
  plan_refusal(plan, values);
  read_step_plan(plan, values);
  if (complete) require_well_formed(plan, sample, h, facts);
  return manual;
}

void register_plan(const PlanSource& source, Registry& registry) {
  PluginManual manual = check_plan_source(source);
  const auto shared = std::make_shared<const PlanSource>(source);
  registry.set_current_file(source.file.string());
  registry.add_time(std::move(manual), [shared](const Parameters& parameters) {
    return std::make_unique<PlanScheme>(shared, parameters);
  });
  registry.set_current_file("");
}

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
    if (const auto value = number_in(word); value && std::isfinite(*value)) return *value;
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
