#include "runners/study/check_object.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <ricochet/scene/formula.hpp>

#include "runners/json/json_text.hpp"
#include "runners/json/share.hpp"
#include "runners/study/body_keys.hpp"
#include "runners/study/scene_keys.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

std::string unit_text(const ParameterSpec& spec) {
  return spec.unit.empty() || spec.unit == "1" || spec.unit.starts_with("as the ") ? std::string()
                                                                                   : ", in " + spec.unit;
}

ParameterValue to_parameter(const Json& value, ParameterSpec::Type type, const std::string& pointer,
                            const std::string& expected) {
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number()) {
    const auto real = value.get<double>();
    // 1e2 is a whole number however it is spelled; 2^53 bounds what a double counts.
    if (type == ParameterSpec::Type::integer && std::floor(real) == real && std::abs(real) <= 9007199254740992.0)
      return static_cast<long long>(real);
    return real;
  }
  throw InputError(pointer, expected + ", found " + quote(value));
}

std::string expectation(const Field& field) {
  const ParameterSpec& spec = field.spec;
  switch (spec.type) {
    case ParameterSpec::Type::real:
      return "expected a number in " + spec.range.text() + unit_text(spec);
    case ParameterSpec::Type::integer:
      return "expected a whole number in " + spec.range.text();
    case ParameterSpec::Type::boolean:
      return "expected true or false";
    case ParameterSpec::Type::table:
      return std::string("expected a table, ") + table_words + unit_text(spec);
    case ParameterSpec::Type::word:
      break;
  }
  return (field.or_flag ? "expected true, false or one of " : "expected one of ") + quoted_list(spec.words);
}

Json check_scalar(const Field& field, const Json& value, const std::string& pointer) {
  if ((field.nullable && value.is_null()) || (field.or_flag && value.is_boolean())) return value;
  if (field.spec.type == ParameterSpec::Type::table) return check_rows(value, pointer, expectation(field));
  const ParameterValue given = to_parameter(value, field.spec.type, pointer, expectation(field));
  if (check_parameter(field.spec, given)) {
    std::string hint;
    if (field.spec.type == ParameterSpec::Type::word && value.is_string())
      hint = did_you_mean(value.get<std::string>(), field.spec.words);
    throw InputError(pointer, expectation(field) + ", found " + quote(value) + hint);
  }
  return to_json(given);
}

Json check_formula(const Field& field, const Json& value, const std::string& pointer, std::vector<Axis>& axes) {
  if (value.is_null() && field.nullable) return value;
  if (value.is_number()) return value.get<double>();
  if (value.is_string()) {
    Formula(value.get<std::string>(), pointer, field.variables);
    return value;
  }
  const bool listed = !field.nested.empty();
  if (listed && value.is_array() && !value.empty()) {
    Json result = Json::array();
    for (std::size_t i = 0; i < value.size(); ++i)
      result.push_back(check_object(field.nested.front(), value[i], pointer_to(pointer, i), axes));
    return result;
  }
  const std::string variables = field.variables == "xt" ? "x and t" : field.variables;
  throw InputError(pointer, "expected a number or a formula in " + variables + (field.nullable ? " or null" : "") +
                                unit_text(field.spec) + (listed ? ", or a list of objects" : "") +
                                (field.given.empty() ? "" : ", or a table or spectrum as an object") + ", found " +
                                quote(value));
}

Json check_places(const Json& value, const std::string& pointer) {
  const std::string expected = "expected \"nodes\", \"tip\" or a list of positions x in ]0, L], in m";
  if (value.is_string()) {
    const std::vector<std::string> words = {"nodes", "tip"};
    const auto word = value.get<std::string>();
    if (word == "nodes" || word == "tip") return value;
    throw InputError(pointer, expected + ", found " + quote(value) + did_you_mean(word, words));
  }
  if (!value.is_array()) throw InputError(pointer, expected + ", found " + quote(value));
  if (value.empty()) throw InputError(pointer, "an empty list of positions; for no stops, set both stops to null");
  Json result = Json::array();
  for (std::size_t i = 0; i < value.size(); ++i) {
    const std::string here = pointer_to(pointer, i);
    if (!value[i].is_number())
      throw InputError(here, "expected a position x in ]0, L], in m, found " + quote(value[i]));
    result.push_back(value[i].get<double>());
  }
  return result;
}

Json check_words(const Field& field, const Json& value, const std::string& pointer) {
  if (field.nullable && value.is_null()) return value;
  Json result = Json::array();
  const bool list = value.is_array();
  const bool names = field.spec.words.empty();
  if (list && value.empty())
    throw InputError(pointer, "an empty list; expected at least one " +
                                  (names ? std::string("name") : "of " + quoted_list(field.spec.words)));
  for (std::size_t i = 0; i < (list ? value.size() : 1); ++i) {
    const std::string here = list ? pointer_to(pointer, i) : pointer;
    const Json& one = list ? value[i] : value;
    if ((names && !one.is_string()) || (list && one.is_null()))
      throw InputError(here,
                       (names ? std::string("expected a name") : "expected one of " + quoted_list(field.spec.words)) +
                           ", found " + quote(one));
    result.push_back(names || is_of_each(field, one, here) ? one : check_scalar(field, one, here));
    for (std::size_t j = 0; j < i; ++j)
      if (result[j] == result[i]) throw InputError(here, "repeats " + quote(result[i]));
  }
  return result;
}

Json check_numbers(const Field& field, const Json& value, const std::string& pointer) {
  Json result = Json::array();
  const bool list = value.is_array();
  if (list && value.empty()) throw InputError(pointer, "an empty list; expected at least one number");
  for (std::size_t i = 0; i < (list ? value.size() : 1); ++i) {
    const std::string here = list ? pointer_to(pointer, i) : pointer;
    if (list && value[i].is_null()) throw InputError(here, "expected a number, found null");
    result.push_back(check_scalar(field, list ? value[i] : value, here));
    result.back() = result.back().get<double>();
  }
  std::map<double, std::size_t> seen;
  for (std::size_t i = 0; i < result.size() && !field.repeats; ++i)
    if (const auto [first, fresh] = seen.emplace(result[i].get<double>(), i); !fresh)
      throw InputError(pointer_to(pointer, i), "repeats the value " + quote(value[i]) + " of " +
                                                   shortened(pointer_to(pointer, first->second)) +
                                                   ": the same point would run twice");
  return result;
}

Json check_starts(const Field& field, const Json& value, const std::string& pointer, std::vector<Axis>& axes) {
  Json result = Json::array();
  const bool list = value.is_array();
  if (list && value.empty()) throw InputError(pointer, "an empty list; expected at least one start");
  bool object = false;
  for (std::size_t i = 0; i < (list ? value.size() : 1); ++i) {
    const std::string here = list ? pointer_to(pointer, i) : pointer;
    const Json& one = list ? value[i] : value;
    if (one.is_object()) {
      if (object) throw InputError(here, "a second object of starts; give one, with their number");
      object = true;
      result.push_back(check_object(field.nested.front(), one, here, axes));
      continue;
    }
    if (!one.is_string())
      throw InputError(here, expectation(field) +
                                 " or an object {\"random\": number of states, \"seed\": number}, found " + quote(one));
    result.push_back(check_scalar(field, one, here));
    for (std::size_t j = 0; j < i; ++j)
      if (result[j] == result[i]) throw InputError(here, "repeats " + quote(result[i]));
  }
  return result;
}

// A share as a number: of 0.05 or "5 %".
Json check_share(const Json& value, const std::string& pointer) {
  const std::optional<double> share = share_of(value);
  if (!share) throw InputError(pointer, "expected a share, as 0.05 or \"5 %\"; found " + quote(value));
  constexpr double most = 1000, hundred = 100;
  constexpr int digits = 12;
  if (!(*share > 0 && *share <= most))
    throw InputError(pointer, "expected a share above 0 and at most \"100000 %\"; found " + quote(value));
  if (*share <= 1) return *share;
  // A number above 1 is per cent that were meant. More than the whole is kept as it is written.
  if (value.is_number())
    throw InputError(pointer, value.dump() + " is above 1, the whole; expected \"" + value.dump() + " %\", or \"" +
                                  short_number(hundred * *share, digits) + " %\" where that is meant");
  return value;
}

Json check_levels(const Json& value, const std::string& pointer) {
  if (!value.is_object() || value.empty())
    throw InputError(pointer,
                     "expected an object of axes and their levels, as {\"step\": 1e-5}; found " + quote(value));
  for (const auto& [key, level] : value.items())
    if (!level.is_primitive() || level.is_null())
      throw InputError(pointer_to(pointer, key), "expected one level, a number or a word; found " + quote(level));
  return value;
}

void check_at_most(const Field& field, const Json& value, const std::string& pointer) {
  if (field.at_most != 0 && value.size() > field.at_most)
    throw InputError(pointer, "expected at most " + std::to_string(field.at_most) + " objects, found " +
                                  std::to_string(value.size()));
}

// A list of objects in the place of one object. An empty one is the key left out.
Json check_listed(const Field& field, const Json& value, const std::string& pointer, std::vector<Axis>& axes) {
  if (value.empty() && field.fallback->is_null()) return *field.fallback;
  if (value.empty()) return check_object(field.nested.front(), *field.fallback, pointer, axes);
  check_at_most(field, value, pointer);
  Json result = Json::array();
  for (std::size_t i = 0; i < value.size(); ++i)
    result.push_back(check_object(field.listed.front(), value[i], pointer_to(pointer, i), axes));
  return result;
}

Json check_objects(const Field& field, const Json& value, const std::string& pointer, std::vector<Axis>& axes) {
  const std::string expected = field.count == 0 ? "expected a list of objects"
                                                : "expected a list of " + std::to_string(field.count) + " objects";
  if (!value.is_array()) throw InputError(pointer, expected + ", found " + quote(value));
  if (field.count != 0 && value.size() != field.count)
    throw InputError(pointer, expected + ", found " + std::to_string(value.size()));
  check_at_most(field, value, pointer);
  Json result = Json::array();
  for (std::size_t i = 0; i < value.size(); ++i)
    result.push_back(check_object(field.nested.front(), value[i], pointer_to(pointer, i), axes));
  return result;
}

// A list of positions, of objects or of rows is one value; a list that holds words or lists of these is an axis.
bool is_axis(const Field& field, const Json& value) {
  if (!field.axis || !value.is_array()) return false;
  if (field.spec.type == ParameterSpec::Type::table)
    return std::any_of(value.begin(), value.end(), [](const Json& item) {
      return item.is_null() ||
             (item.is_array() && std::any_of(item.begin(), item.end(), [](const Json& row) { return row.is_array(); }));
    });
  if (field.form == Field::Form::formula) return !is_object_list(field, value);
  if (field.form != Field::Form::places) return true;
  return std::any_of(value.begin(), value.end(), [](const Json& item) { return item.is_string() || item.is_array(); });
}

Json check_value(const Field& field, const Json& value, const std::string& pointer, std::vector<Axis>& axes);

// A list of values, each of which makes cases.
Json check_axis(const Field& field, const Json& value, const std::string& pointer, std::vector<Axis>& axes) {
  if (value.empty()) throw InputError(pointer, "an empty list makes no cases; give at least one value");
  Field element = field;
  element.axis = false;
  Axis axis{pointer, {}};
  Json list = Json::array();
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < value.size(); ++i) {
    axis.values.push_back(check_value(element, value[i], pointer_to(pointer, i), axes));
    list.push_back(axis.values.back());
    const auto [first, fresh] = seen.emplace(list.back().dump(), i);
    if (!fresh)
      throw InputError(pointer_to(pointer, i), "repeats the value " + quote(value[i]) + " of " +
                                                   shortened(pointer_to(pointer, first->second)) +
                                                   ": the same case would run twice");
  }
  axes.push_back(std::move(axis));
  return list;
}

Json check_value(const Field& field, const Json& value, const std::string& pointer, std::vector<Axis>& axes) {
  if (is_axis(field, value)) return check_axis(field, value, pointer, axes);
  if (value.is_object() && !field.given.empty() && (field.form != Field::Form::object || by_body(value)))
    return check_given(field, value, pointer, axes);
  switch (field.form) {
    case Field::Form::bodies:
      return check_bodies(field, value, pointer, axes);
    case Field::Form::scalar:
      if (field.per_body && value.is_object()) return check_per_body(field, value, pointer);
      if (value.is_array() && !field.axis && field.spec.type != ParameterSpec::Type::table)
        throw InputError(pointer, expectation(field) + "; a list is not possible here");
      return check_scalar(field, value, pointer);
    case Field::Form::text:
      if (!value.is_string()) throw InputError(pointer, "expected a text, found " + quote(value));
      return value;
    case Field::Form::formula:
      return check_formula(field, value, pointer, axes);
    case Field::Form::place:
      return check_place(field, value, pointer);
    case Field::Form::named:
      return check_named(field, value, pointer);
    case Field::Form::files:
      return check_files(value, pointer);
    case Field::Form::places:
      return check_places(value, pointer);
    case Field::Form::object:
      if (field.nullable && value.is_null()) return value;
      if (value.is_array() && !field.listed.empty()) return check_listed(field, value, pointer, axes);
      return check_object(field.nested.front(), value, pointer, axes);
    case Field::Form::objects:
      return check_objects(field, value, pointer, axes);
    case Field::Form::numbers:
      return field.count == 3 ? check_direction(value, pointer) : check_numbers(field, value, pointer);
    case Field::Form::words:
      return check_words(field, value, pointer);
    case Field::Form::starts:
      return check_starts(field, value, pointer, axes);
    case Field::Form::share:
      return check_share(value, pointer);
    case Field::Form::levels:
      return check_levels(value, pointer);
    case Field::Form::methods:
    case Field::Form::excludes:
      break;
  }
  return value;
}

std::vector<std::string> keys_of(const std::vector<Field>& fields) {
  std::vector<std::string> keys;
  for (const Field& field : fields) keys.push_back(field.key());
  return keys;
}

// No key of a study: the program writes beside the name of a file what it holds.
constexpr const char* written_digest = "digest";

// Keys of the way that is taken, of all where none is, each once. The nearest name of a wrong one may be of another.
std::vector<std::string> keys_here(const ObjectForm& form, const ObjectForm* taken) {
  std::vector<std::string> keys = keys_of(form.fields);
  const bool one = taken && !taken->fields.empty();
  for (const ObjectForm& way : form.ways)
    if (!one || &way == taken)
      for (const std::string& key : keys_of(way.fields))
        if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  return keys;
}

// The one of the ways whose keys the object has.
const ObjectForm& find_way(const ObjectForm& form, const Json& object, const std::string& pointer) {
  std::string expected;
  std::vector<std::string> all = keys_of(form.fields);
  const ObjectForm* found = nullptr;
  std::string first;
  for (const ObjectForm& way : form.ways) {
    const std::vector<std::string> keys = keys_of(way.fields);
    all.insert(all.end(), keys.begin(), keys.end());
    if (keys.empty()) found = &way;
    if (!keys.empty()) expected += (expected.empty() ? "" : ", or ") + quoted_list(keys);
  }
  for (const ObjectForm& way : form.ways)
    for (const Field& field : way.fields) {
      // A key that several ways have tells none of them.
      const bool shared = std::count(all.begin(), all.end(), field.key()) > 1;
      if (!object.contains(field.key()) || shared) continue;
      if (found && found != &way && !found->fields.empty())
        throw InputError(pointer_to(pointer, field.key()),
                         "does not go together with \"" + first + "\"; expected either " + expected);
      if (!found || found->fields.empty()) first = field.key();
      found = &way;
    }
  for (const auto& [key, ignored] : object.items())
    if (key != written_digest && std::find(all.begin(), all.end(), key) == all.end())
      throw InputError(pointer_to(pointer, key), "unknown key \"" + shortened(key) + "\"" + did_you_mean(key, all) +
                                                     " (keys here: " + quoted_list(keys_here(form, found)) + ")");
  if (!found) throw InputError(pointer, "expected either " + expected);
  return *found;
}

// The value at `discriminator`, a path of keys inside `object`; a misspelt key on the way is told as such.
const Json& discriminate(const std::vector<const Field*>& declared, const Json& object, const std::string& pointer,
                         const std::string& discriminator, const std::vector<std::string>& words) {
  const Json* here = &object;
  std::string where = pointer;
  for (std::size_t begin = 1; begin <= discriminator.size();) {
    const std::size_t end = std::min(discriminator.find('/', begin), discriminator.size());
    const std::string key = discriminator.substr(begin, end - begin);
    if (!here->is_object()) throw InputError(where, "expected an object, found " + quote(*here));
    const auto found = here->find(key);
    if (found == here->end()) {
      for (const auto& item : here->items()) {
        const std::string& other = item.key();
        const bool known =
            std::any_of(declared.begin(), declared.end(), [&](const Field* field) { return field->key() == other; });
        if (!known && nearest_name(other, {key}) == key)
          throw InputError(pointer_to(where, other),
                           "unknown key \"" + shortened(other) + "\"; did you mean \"" + key + "\"?");
      }
      throw InputError(pointer_to(where, key), end < discriminator.size()
                                                   ? "missing; this key is required"
                                                   : "missing; expected one of " + quoted_list(words));
    }
    here = &*found;
    where = pointer_to(where, key);
    begin = end + 1;
  }
  return *here;
}

// Whether another key stands for the one on whose words further keys depend.
bool replaced(const ObjectForm& form, const Json& value) {
  return std::any_of(form.fields.begin(), form.fields.end(), [&](const Field& field) {
    return !field.unless.empty() && value.contains(field.unless) && !value.contains(field.key()) &&
           form.discriminator.starts_with("/" + field.key() + "/");
  });
}

}  // namespace

Json check_single(const Field& field, const Json& value, const std::string& pointer) {
  return check_scalar(field, value, pointer);
}

bool is_object_list(const Field& field, const Json& value) {
  return field.form == Field::Form::formula && !field.nested.empty() && value.is_array() && !value.empty() &&
         std::all_of(value.begin(), value.end(), [](const Json& item) { return item.is_object(); });
}

std::vector<const Field*> fields_of(const ObjectForm& form, const Json& value, const std::string& pointer) {
  if (!value.is_object()) throw InputError(pointer, "expected an object, found " + quote(value));
  std::vector<const Field*> fields;
  const ObjectForm* level = &form;
  while (true) {
    for (const Field& field : level->fields) fields.push_back(&field);
    if (!level->ways.empty())
      for (const Field& field : find_way(*level, value, pointer).fields) fields.push_back(&field);
    if (level->discriminator.empty() || replaced(*level, value)) return fields;
    std::vector<std::string> words;
    for (const Variant& variant : level->variants)
      words.insert(words.end(), variant.words.begin(), variant.words.end());
    const std::string key = level->discriminator.substr(level->discriminator.rfind('/') + 1);
    const std::string where = pointer + level->discriminator;
    const Json& found = discriminate(fields, value, pointer, level->discriminator, words);
    if (!found.is_string())
      throw InputError(where, "expected one of " + quoted_list(words) + ", found " + quote(found));
    const auto word = found.get<std::string>();
    const auto variant = std::find_if(level->variants.begin(), level->variants.end(), [&](const Variant& candidate) {
      return std::find(candidate.words.begin(), candidate.words.end(), word) != candidate.words.end();
    });
    if (variant == level->variants.end())
      throw InputError(where, "unknown " + key + " \"" + shortened(word) + "\"; there is: " + quoted_list(words) +
                                  did_you_mean(word, words));
    level = &variant->keys;
  }
}

Json check_object(const ObjectForm& form, const Json& value, const std::string& pointer, std::vector<Axis>& axes) {
  const std::vector<const Field*> fields = fields_of(form, value, pointer);
  std::vector<std::string> keys;
  for (const Field* field : fields) keys.push_back(field->key());
  for (const auto& [key, ignored] : value.items())
    if (std::find(keys.begin(), keys.end(), key) == keys.end())
      throw InputError(pointer_to(pointer, key), "unknown key \"" + shortened(key) + "\"" + did_you_mean(key, keys) +
                                                     " (keys here: " + quoted_list(keys) + ")");
  Json result = Json::object();
  for (const Field* field : fields) {
    const std::string here = pointer_to(pointer, field->key());
    const auto given = value.find(field->key());
    const bool stands_elsewhere = !field->unless.empty() && value.contains(field->unless);
    if (stands_elsewhere && given != value.end())
      throw InputError(here, "does not go together with \"" + field->unless + "\"; expected one of them");
    if (given == value.end() && (field->quiet || stands_elsewhere)) continue;
    if (given == value.end() && field->required()) {
      const bool scalar = field->form == Field::Form::scalar;
      throw InputError(here, "missing" + (scalar ? "; " + expectation(*field) : "; this key is required"));
    }
    Json checked = check_value(*field, given == value.end() ? *field->fallback : *given, here, axes);
    if (!field->quiet || checked != *field->fallback) result[field->key()] = std::move(checked);
  }
  return result;
}

}  // namespace ricochet
