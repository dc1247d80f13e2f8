#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "runners/asks/ask.hpp"
#include "runners/command/manual.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/store/record_values.hpp"
#include "runners/study/fields.hpp"
#include "runners/study/study_kind.hpp"
#include "runners/table/text.hpp"

namespace ricochet {

std::string plain(const nlohmann::ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_null()) return "none";
  if (value.is_number_float()) {
    const auto number = value.get<double>();
    const std::string exact = fmt::format("{}", number), brief = fmt::format("{:g}", number);
    return brief.size() < exact.size() && number_in(brief) == number ? brief : exact;
  }
  return value.dump();
}

namespace {

constexpr const char* whole_study = "study";
constexpr const char* all_asks = "ask";
constexpr const char* see_below = "see below";

/// A word of the study format on which the keys of an object depend.
struct FormWord {
  std::string name, place;  ///< place: pointer of the key that has it as its value
  const Field* key;
  const ObjectForm* form;  ///< the keys that come with it
};

void collect(const ObjectForm& form, const std::string& place, std::vector<FormWord>& words) {
  const auto key = std::find_if(form.fields.begin(), form.fields.end(),
                                [&](const Field& field) { return "/" + field.key() == form.discriminator; });
  for (const Variant& variant : form.variants) {
    if (key != form.fields.end())
      for (const std::string& word : variant.words)
        words.push_back({word, place + form.discriminator, &*key, &variant.keys});
    collect(variant.keys, place, words);
  }
  for (const Field& field : form.fields) {
    if (field.form == Field::Form::bodies) continue;  // as `structure`
    for (const ObjectForm& nested : field.nested) collect(nested, place + "/" + field.key(), words);
  }
}

std::vector<FormWord> form_words() {
  std::vector<FormWord> words;
  collect(study_form(), "", words);
  return words;
}

std::string type_of(const Field& field) {
  const std::string list = field.axis ? ", or a list" : "";
  switch (field.form) {
    case Field::Form::scalar:
      return (field.or_flag ? "true, false or " : "") + std::string(type_word(field.spec)) +
             (field.per_body ? ", or by body" : "") + list;
    case Field::Form::text:
      return "text";
    case Field::Form::formula:
      return "number or formula in " + std::string(field.variables == "xt" ? "x and t" : field.variables) + list;
    case Field::Form::places:
      return "word or positions" + list;
    case Field::Form::place:
      return field.plain ? "number or place" : "place";
    case Field::Form::object:
      if (!field.given.empty()) return "object, or objects by body";
      return field.listed.empty() ? "object" : "object, or a list of objects";
    case Field::Form::bodies:
      return "structures by name";
    case Field::Form::named:
    case Field::Form::files:
      return "object";
    case Field::Form::objects:
      return field.count == 0 ? "list of objects" : fmt::format("list of {} objects", field.count);
    case Field::Form::methods:
      return "method, or a list";
    case Field::Form::numbers:
      return field.count == 3 ? "three numbers" : "number, or a list";
    case Field::Form::words:
      return "word, or a list";
    case Field::Form::starts:
      return "word or object, or a list";
    case Field::Form::share:
      return "share or per cent";
    case Field::Form::levels:
      return "object of levels";
    case Field::Form::excludes:
      break;
  }
  return "list";
}

std::string default_of(const Field& field) {
  constexpr std::size_t longest = 30;
  if (!field.unless.empty()) return "or " + field.unless;
  if (field.required()) return "required";
  const std::string text = plain(*field.fallback);
  return text.size() > longest ? see_below : text;
}

/// The key that a way of an object cannot be without; "" where none is required.
std::string key_of_way(const ObjectForm& way) {
  const auto key = std::find_if(way.fields.begin(), way.fields.end(), [](const Field& one) { return one.required(); });
  return key == way.fields.end() ? "" : key->key();
}

/// A row per key, those of nested objects by their path; `given`: the words under which it is there, `way`: the key of
/// its way.
void add_keys(const ObjectForm& form, const std::string& path, const std::string& given, std::vector<KeyRow>& rows,
              const std::optional<std::string>& way = std::nullopt) {
  for (const Field& field : form.fields) {
    const std::string name = path + field.key();
    const bool names_it = !way || way->empty() || *way == field.key();
    const std::string when = given + (!way ? "" : names_it ? " (one way)" : " (with " + *way + ")");
    const bool listed = field.form == Field::Form::scalar || field.form == Field::Form::numbers;
    const bool number = listed && field.spec.type != ParameterSpec::Type::word;
    rows.push_back({name, type_of(field), field.spec.unit, default_of(field),
                    number ? admissible_values(field.spec) : "", field.spec.text + when,
                    default_of(field) == see_below ? plain(*field.fallback) : ""});
    if (field.form == Field::Form::bodies) continue;  // as `structure`
    for (const ObjectForm& nested : field.nested) add_keys(nested, name + ".", when, rows);
    for (const ObjectForm& one : field.listed) add_keys(one, name + "[].", when + " (in a list)", rows);
  }
  for (const Variant& variant : form.variants)
    add_keys(variant.keys, path, fmt::format(" (with {})", fmt::join(variant.words, ", ")), rows);
  for (const ObjectForm& one : form.ways) add_keys(one, path, "", rows, key_of_way(one));
}

std::string key_table(const std::vector<KeyRow>& rows) {
  TextTable table({"key", "type", "unit", "default", "range", "meaning"});
  std::string below;
  for (const KeyRow& row : rows) {
    table.add({row.key, row.type, row.unit, row.fallback, row.range, row.meaning});
    if (!row.below.empty()) below += fmt::format("    {}: {}\n", row.key, row.below);
  }
  return table.text(2) + (below.empty() ? "" : "\n  long defaults\n" + below);
}

std::vector<KeyRow> rows_of(const ObjectForm& form) {
  std::vector<KeyRow> rows;
  add_keys(form, "", "", rows);
  return rows;
}

void print(const FormWord& word, std::ostream& out) {
  const StudyKind* kind = word.place == "/kind" ? find_study_kind(word.name) : nullptr;
  out << fmt::format("{} (a value of {}): {}\n", word.name, word.place, kind ? kind->text : word.key->spec.text);
  out << (word.form->fields.empty() ? "\nno keys of its own\n" : "\nkeys\n" + key_table(rows_of(*word.form)));
}

/// Every key of the study format.
void print_study(std::ostream& out) {
  const char* before = "";
  for (const KeySection& section : study_sections()) {
    out << before << section.title << ": " << section.text << "\n\n" << key_table(section.rows);
    before = "\n";
  }
}

/// Whether a measure is called so, in full or by what follows its last dot ("error.tip-l2").
bool is_called(const MeasureInfo& measure, const std::string& name) {
  const std::string own = measure.name;
  return own == name || own.ends_with("." + name);
}

void print(const asks::Verb& verb, std::ostream& out) {
  out << fmt::format("{} (a verb of asks): {}\n\nkeys\n{}", verb.name, verb.text,
                     key_table(rows_of({verb.keys, "", {}})));
}

/// What a study may ask.
void print_asks(std::ostream& out) {
  out << "asks (the list `ask` of a study): what it wants to know; each entry has one verb\n\n";
  TextTable table({"verb", "what it asks"});
  for (const asks::Verb* verb : asks::verbs()) table.add({verb->name, verb->text});
  out << table.text(2);
}

std::string unit_in_words(const std::string& unit) {
  return unit == "1" ? "a ratio or a count" : "in " + unit;
}

void print(const MeasureInfo& measure, std::ostream& out) {
  out << fmt::format("{} (a measure of a case, {}): {}\n", measure.name, unit_in_words(measure.unit), measure.text);
}

/// The columns of cases.csv that are no measures: status, steps, times.
std::vector<Column> columns_of_cases() {
  std::vector<Column> columns = cases_table({}).columns;
  std::erase_if(columns, [](const Column& column) { return measure_info(column.name) != nullptr; });
  return columns;
}

void print(const Column& column, std::ostream& out) {
  out << fmt::format("{} (a column of cases.csv{}): {}\n", column.name,
                     column.unit.empty() ? "" : ", " + unit_in_words(column.unit), column.text);
}

/// Each once, in the order met.
std::vector<std::string> each_once(const std::vector<std::string>& words) {
  std::vector<std::string> once;
  for (const std::string& word : words)
    if (std::find(once.begin(), once.end(), word) == once.end()) once.push_back(word);
  return once;
}

}  // namespace

std::vector<KeySection> study_sections() {
  ObjectForm common = study_form();
  common.variants.clear();
  std::vector<KeySection> sections = {
      {"study (a file that asks one question)", "the keys that every study has", rows_of(common)}};
  for (const StudyKind* kind : study_kinds())
    sections.push_back({"kind " + kind->name, kind->text, rows_of({kind->keys, "", {}})});
  return sections;
}

const char* type_word(const ParameterSpec& spec) {
  switch (spec.type) {
    case ParameterSpec::Type::real:
      return "number";
    case ParameterSpec::Type::integer:
      return "whole number";
    case ParameterSpec::Type::boolean:
      return "true or false";
    case ParameterSpec::Type::table:
      return "table";
    case ParameterSpec::Type::word:
      break;
  }
  return "word";
}

std::string admissible_values(const ParameterSpec& spec) {
  switch (spec.type) {
    case ParameterSpec::Type::real:
    case ParameterSpec::Type::integer:
      return spec.range.text();
    case ParameterSpec::Type::boolean:
      return "true, false";
    case ParameterSpec::Type::table:
      return table_words;
    case ParameterSpec::Type::word:
      break;
  }
  return fmt::format("{}", fmt::join(spec.words, ", "));
}

bool describe_word(const std::string& name, std::ostream& out) {
  bool found = false;
  const auto next = [&] {
    if (found) out << "\n";
    found = true;
  };
  if (name == whole_study) {
    next();
    print_study(out);
  }
  if (name == all_asks) {
    next();
    print_asks(out);
  }
  if (const asks::Verb* verb = asks::find_verb(name)) {
    next();
    print(*verb, out);
  }
  for (const FormWord& word : form_words())
    if (word.name == name) {
      next();
      print(word, out);
    }
  for (const MeasureInfo& measure : all_measures())
    if (is_called(measure, name)) {
      next();
      print(measure, out);
    }
  for (const Column& column : columns_of_cases())
    if (column.name == name) {
      next();
      print(column, out);
    }
  // Those of a stop, "impulse[bar-a]", are as many as there are names.
  if (const MeasureInfo* of_stop = measure_info(name.ends_with("]") ? name : name + "[NAME]")) {
    next();
    print(*of_stop, out);
  }
  return found;
}

std::vector<std::string> words_of_studies() {
  std::vector<std::string> names = {whole_study, all_asks};
  for (const asks::Verb* verb : asks::verbs()) names.emplace_back(verb->name);
  for (const FormWord& word : form_words()) names.push_back(word.name);
  return each_once(names);
}

std::vector<std::string> words_of_results() {
  std::vector<std::string> names;
  for (const MeasureInfo& measure : all_measures()) {
    const std::string name = measure.name;
    names.push_back(name);
    if (const auto dot = name.rfind('.'); dot != std::string::npos) names.push_back(name.substr(dot + 1));
  }
  for (const Column& column : columns_of_cases()) names.push_back(column.name);
  return names;
}

}  // namespace ricochet
