#include "runners/plan_files/plan_file.hpp"

#include <ricochet/contract/step_plan.hpp>

namespace ricochet {
namespace {

Json described(Json schema, const char* text) {
  schema["description"] = text;
  return schema;
}

Json reference(const char* name) {
  return {{"$ref", std::string("#/$defs/") + name}};
}
Json number() {
  return {{"type", Json::array({"number", "string"})}};
}
Json truth() {
  return {{"type", Json::array({"boolean", "string"})}};
}
Json optional_number() {
  return {{"type", Json::array({"number", "string", "null"})}};
}
Json text() {
  return {{"type", "string"}, {"minLength", 1}};
}
Json list(const Json& items) {
  return {{"type", "array"}, {"items", items}};
}
// Keys that the plan makes up.
Json named(const Json& values) {
  return {{"type", "object"}, {"additionalProperties", values}};
}
Json closed(const Json& properties, const std::vector<std::string>& required) {
  Json schema = {{"type", "object"}, {"additionalProperties", false}, {"patternProperties", {{"^//", true}}}};
  schema["properties"] = properties;
  if (!required.empty()) schema["required"] = required;
  return schema;
}
/// A string, or what `otherwise` says.
Json or_formula(Json otherwise) {
  return {{"if", {{"type", "string"}}}, {"then", true}, {"else", std::move(otherwise)}};
}
Json combination() {
  return reference("plan-combination");
}
Json matrices() {
  return reference("plan-matrices");
}

Json reading() {
  return closed({{"displacement", described(combination(), "g, where the law sees the contact point.")},
                 {"bound", described(named(number()), "Levels of the stop in g; derived when left out.")},
                 {"rate", described(combination(), "u, for laws with damping.")},
                 {"rate_bound", described(named(number()), "Levels of the stop's rate.")},
                 {"effort", described(list(number()), "π₀, π₁, …")},
                 {"impulse", described(number(), "ι of R w = ι Hᵀp; 1 when left out.")},
                 {"before", described(combination(), "g⁻, the displacement one step before.")},
                 {"before_bound", described(named(number()), "Levels of the stop in g⁻.")}},
                {"displacement"});
}

Json compliance() {
  Json all = Json::object();
  for (int k = 0; k < evaluations; ++k)
    all[evaluation_word(static_cast<Evaluation>(k))] =
        described(reference("plan-reading"), "What laws that read so are given.");
  return closed(all, {});
}

Json impact() {
  const Json gate = closed({{"predictor", described(combination(), "The position that closes a stop.")},
                            {"predictor_bound", described(named(number()), "Levels of the stop in it.")},
                            {"approach", described(combination(), "The velocity that rebounds.")},
                            {"approach_bound", described(named(number()), "Levels of the stop's rate in it.")},
                            {"restitution", described(number(), "e.")}},
                           {"predictor", "approach"});
  return closed({{"value", described(combination(), "y, what rigid laws keep between the stops.")},
                 {"bound", described(named(number()), "Levels of the stop in y; derived when left out.")},
                 {"gate", described(gate, "For a measure at velocity level.")},
                 {"effort", described(list(number()), "π₀, π₁, …")},
                 {"restores", described(number(), "How many stages before lies the one whose work is given back.")},
                 {"impulse", described(number(), "ι of R w = ι Hᵀp; 1 when left out.")}},
                {"value"});
}

Json term(const char* value, const char* meaning) {
  return closed({{"matrix", described({{"enum", {"M", "K"}}}, "Whose norm it is.")},
                 {"coefficient", described(number(), "Its factor.")},
                 {value, described(combination(), meaning)}},
                {"matrix", "coefficient", value});
}

Json stage() {
  const Json work = closed({{"displacement", described(combination(), "s.")},
                            {"rate", described(combination(), "r; none where nothing is damped.")},
                            {"load", described(named(number()), "F̄.")},
                            {"effort", described(list(number()), "p̄.")},
                            {"impulse", described(number(), "Weight of ι p in p̄, besides; 0 when left out.")},
                            {"support", described(named(number()), "What the stops move by; derived when left out.")}},
                           {"displacement"});
  const Json impulse = closed({{"R", described(matrices(), "R of R w = ι Hᵀp.")},
                               {"feed", described(matrices(), "What of w enters the equation of z.")}},
                              {"R"});
  return closed({{"matrix", described(matrices(), "S; none: no solve.")},
                 {"history", described(named(matrices()), "Rows of b by slot.")},
                 {"load", described(named(number()), "Weights of F by level.")},
                 {"impulse", described(impulse, "A second unknown w, of the effort alone.")},
                 {"impact", described(impact(), "For rigid laws.")},
                 {"compliance", described(compliance(), "For compliant laws, by how they read.")},
                 {"update", described(named(combination()), "What becomes of the slots; others stay.")},
                 {"work", described(work, "The balance of energy.")},
                 {"loss", described(list(term("value", "What is squared.")), "What the scheme dissipates.")}},
                {"update"});
}

Json plan() {
  const Json parameter = closed(
      {{"default", described({{"type", Json::array({"number", "boolean"})}}, "None: required.")},
       {"range", described({{"type", Json::array({"array", "string"})}}, "[0, 1], \"]0, 1[\".")},
       {"unit", described(text(), "SI; \"1\" without one.")},
       {"text", described(text(), "One sentence.")},
       {"type", described({{"enum", {"number", "integer", "boolean"}}}, "What it is.")},
       {"role", described({{"enum", {"restitution", "stiffness"}}}, "What it stands for, where others need to know.")}},
      {});
  const Json refusal = closed({{"when", described(truth(), "The formula that decides.")},
                               {"because", described(text(), "Why, and what to do.")}},
                              {"when", "because"});
  const Json facts =
      closed({{"order", described(number(), "In h, without contact.")},
              {"contact_order", described(optional_number(), "In h, at rigid stops; null: not known.")},
              {"restitution", described({{"enum", {"exact", "asymptotic", "ignored"}}}, "Whether e is kept.")},
              {"needs_regular_mass", described(truth(), "Whether a singular mass is out.")},
              {"stability_limit", described(optional_number(), "Largest stable h·ω; null: none.")},
              {"contact_never_gains", described(truth(), "Whether contact never adds energy.")}},
             {"order"});
  const Json pair = {{"type", "array"}, {"items", number()}, {"minItems", 2}, {"maxItems", 2}};
  const Json let = {{"type", Json::array({"number", "string", "object"})}};
  return closed({{"name", described(text(), "What tables call the scheme.")},
                 {"summary", described(text(), "One line.")},
                 {"text", described(text(), "One paragraph.")},
                 {"source", described(text(), "Author, year, equation.")},
                 {"parameters", described(named(parameter), "By name.")},
                 {"let", described(named(let), "Named formulas, each may use those before it.")},
                 {"refuse", described(list(refusal), "When the scheme does not apply.")},
                 {"slots", described(named(pair), "Weights of q₀ and v₀ before the start.")},
                 {"start", described(list(reference("plan-stage")), "Stages applied once.")},
                 {"start_advances", described(truth(), "Whether the start moves time by h.")},
                 {"stages", described(list(reference("plan-stage")), "Of a step.")},
                 {"energy", described(list(term("of", "What is squared, slots after the step.")), "Of the scheme.")},
                 {"velocity", described(combination(), "Of slots after the step; the slot v when left out.")},
                 {"facts", described(facts, "What the scheme declares of itself.")}},
                {"name", "slots", "stages", "facts"});
}

Json entry(const Json& properties, const std::vector<std::string>& required, const char* text) {
  return {{"type", "object"},
          {"title", "plan"},
          {"description", text},
          {"required", required},
          {"allOf", Json::array({{{"properties", properties}}})}};
}

}  // namespace

StatedPlanSchema stated_plan_schema() {
  StatedPlanSchema schema;
  schema.in_file = entry({{"name", {{"enum", {"plan"}}}}, {"file", text()}}, {"name", "file"},
                         "A scheme stated in a file, relative to the study.");
  schema.here = entry({{"name", text()}, {"plan", reference("plan")}}, {"name", "plan"}, "A scheme stated here.");
  schema.definitions = {{"plan", plan()},
                        {"plan-stage", stage()},
                        {"plan-reading", reading()},
                        {"plan-combination", or_formula(named(number()))},
                        {"plan-matrices", or_formula(closed({{"M", number()}, {"C", number()}, {"K", number()}}, {}))}};
  return schema;
}

}  // namespace ricochet
