#include "runners/study/fields.hpp"

namespace ricochet {

Field Field::as(std::string with_symbol, std::string with_words) const {
  Field field = *this;
  field.symbol = std::move(with_symbol);
  field.words = std::move(with_words);
  return field;
}

}  // namespace ricochet

namespace ricochet::keys {

Field real(const char* key, const char* unit, const Range& range, std::optional<double> fallback, const char* text) {
  Field field;
  field.spec = real_parameter(key, unit, fallback, range, text);
  if (fallback) field.fallback = *fallback;
  field.axis = true;
  return field;
}

Field single(Field field) {
  field.axis = false;
  return field;
}

Field integer(const char* key, const Range& range, std::optional<long long> fallback, const char* text) {
  Field field;
  field.spec = integer_parameter(key, fallback, range, text);
  if (fallback) field.fallback = *fallback;
  return field;
}

Field word(const char* key, std::vector<std::string> words, std::optional<std::string> fallback, const char* text) {
  Field field;
  field.spec = word_parameter(key, std::move(words), fallback, text);
  if (fallback) field.fallback = *fallback;
  return field;
}

Field of_form(Field::Form form, const char* key, std::optional<Json> fallback, const char* text) {
  Field field;
  field.form = form;
  field.spec.key = key;
  field.spec.text = text;
  if (form == Field::Form::words) field.spec.type = ParameterSpec::Type::word;
  field.fallback = std::move(fallback);
  return field;
}

Field formula(const char* key, const char* unit, const char* variables, bool nullable, std::optional<Json> fallback,
              const char* text) {
  Field field = of_form(Field::Form::formula, key, std::move(fallback), text);
  field.spec.unit = unit;
  field.variables = variables;
  field.nullable = nullable;
  field.axis = true;
  return field;
}

Field object(const char* key, std::optional<Json> fallback, const char* text, ObjectForm keys) {
  Field field = of_form(Field::Form::object, key, std::move(fallback), text);
  field.nested.push_back(std::move(keys));
  return field;
}

Field objects(const char* key, const char* text, ObjectForm keys) {
  Field field = of_form(Field::Form::objects, key, Json(nullptr), text);
  field.nested.push_back(std::move(keys));
  return field;
}

Field quiet(Field field) {
  field.quiet = true;
  return field;
}

Field methods(const char* key, Role role, const char* text) {
  Field field = of_form(Field::Form::methods, key, std::nullopt, text);
  field.role = role;
  return field;
}

Field place(const char* key, std::optional<Json> fallback, const char* text) {
  Field field = of_form(Field::Form::place, key, std::move(fallback), text);
  field.spec.unit = "m";  // of a place along the structure
  field.nullable = field.fallback.has_value();
  return field;
}

Field step() {
  return real("step", "s", positive, std::nullopt, "Time step h.").as("h", "the step");
}

Field duration() {
  return single(real("duration", "s", positive, std::nullopt, "Simulated time; the run ends at its last whole step."));
}

Field samples() {
  return integer("samples", {2, 1000000, false, false}, 200,
                 "Number of equal parts of the time of each sampled curve: one point more.");
}

Field optional(Field field) {
  field = single(std::move(field));
  field.nullable = true;
  field.fallback = Json(nullptr);
  return field;
}

Field budget() {
  return optional(
      real("budget", "s", positive, std::nullopt, "Processor time after which a case has failed; null: none."));
}

Field observe(std::vector<std::string> measures) {
  Field field = of_form(Field::Form::words, "observe", std::nullopt,
                        "What the answer is made of, the first first: measures, or status; null: the kind chooses.");
  field.spec = word_parameter("observe", std::move(measures), std::nullopt, field.spec.text.c_str());
  return optional(std::move(field));
}

Field march(const char* unless_given) {
  Field field =
      word("march", {"auto", "every-step", "flights"}, unless_given, "Leave out steps without change of contact.");
  field.axis = true;
  return field;
}

Field steps_per_period() {
  Field field = integer("steps_per_period", {8, 100000000, false, false}, std::nullopt,
                        "Steps per forcing period: h = 2π/(ω·steps_per_period).");
  field.axis = true;
  return field.as("steps per period", "the number of steps per period");
}

}  // namespace ricochet::keys
