#pragma once
#include <limits>
#include <optional>
#include <ricochet/contract/parameters.hpp>
#include <ricochet/contract/registry.hpp>
#include <string>
#include <vector>

#include "runners/study/study.hpp"

/// \file
/// The study format as data: each key is declared once, and the checker, the defaults and the JSON Schema all read the
/// declaration.
namespace ricochet {

struct Field;
struct Variant;

/// A closed JSON object: the keys it may have. With a discriminator (a pointer relative to the object, such as
/// "/type"), further keys depend on the word found there. Variants may have a discriminator of their own. With ways,
/// the object has the keys of exactly one of them, told by the keys that are present.
struct ObjectForm {
  std::vector<Field> fields;
  std::string discriminator;
  std::vector<Variant> variants;
  std::vector<ObjectForm> ways = {};
  std::string at_rest = "";  ///< the key, an amplitude, without which (0) the others mean nothing
};

/// One key of an object.
struct Field {
  enum class Form {
    scalar,    ///< a number, whole number, boolean, word or table, as `spec` declares
    text,      ///< any string
    formula,   ///< a number or a formula in `variables`; where there is a nested object, also a list of such objects
    place,     ///< one place of the structure (check_place.cpp)
    named,     ///< an object of any names, each with a text
    bodies,    ///< an object of any names, each with a nested object (body_keys.hpp)
    files,     ///< the folder of the files that a study names, and their digests
    places,    ///< where stops act: "nodes", "tip" or a list of positions
    object,    ///< a nested object
    methods,   ///< methods of `role`: a name, an object, or a list of either
    objects,   ///< a list of exactly `count` nested objects (0: of any number), one value together
    numbers,   ///< a number or a list of different numbers in `spec.range`, one value together
    words,     ///< a word or a list of words out of `spec.words` (empty: any names), one value together
    starts,    ///< a word out of `spec.words`, a nested object (at most one), or a list of these, one value together
    excludes,  ///< partial matches with a reason
    share,     ///< a share above 0, as a number up to 1 or in per cent: 0.05, "5 %"
    levels,    ///< an object of any names, each with a number, a word or a truth value
  };
  Form form = Form::scalar;
  ParameterSpec spec;                   ///< key, unit, text; for scalars also type, range, words
  std::optional<Json> fallback;         ///< what an absent key means; none: the study must give it
  bool axis = false;                    ///< a list here is an axis of the cross product
  bool nullable = false;                ///< null is a value (an absent stop, no limit)
  std::string variables;                ///< for formulas: a subset of "xt"
  Role role = Role::mass;               ///< for methods
  bool marched = false;                 ///< for references: marched_reference is one as well
  std::vector<ObjectForm> nested;       ///< one entry for Form::object, objects, starts and such formulas
  std::size_t count = 0;                ///< for Form::objects; 3 for Form::numbers: a direction
  std::size_t at_most = 0;              ///< for Form::objects: so many; 0: any number
  std::vector<ObjectForm> listed = {};  ///< of Form::object: a list of such objects is possible as well, one value
  bool or_flag = false;                 ///< of a word: true and false as well
  bool per_body = false;                ///< of Form::scalar: an object of such numbers by body as well
  bool plain = false;                   ///< of Form::place: a number is x
  bool node_alone = false;              ///< of Form::place: a node may stand without component
  std::vector<ObjectForm> given = {};  ///< an object that may stand for a formula or text; of an object, that of a body
  std::vector<std::string> of_each = {};  ///< of Form::words: words that a name in brackets may follow
  bool repeats = false;                   ///< of Form::numbers: one number may stand several times
  bool quiet = false;  ///< absent or its default, it is not written out: older studies keep their identity
  std::string unless;  ///< another key of the object in whose presence this one is not given
  /// What stands beside its value where a scene is said ("E", "lower stop"): absent, the key in words; "", nothing. An
  /// object that has one is said as one value, of a list each entry is; any other as the keys that it holds.
  std::optional<std::string> symbol = {};
  std::string words = {};  ///< what a sentence calls it, "the length"; "" of what no sentence speaks of

  const std::string& key() const { return spec.key; }
  bool required() const { return !fallback; }
  /// The field with its symbol and its words.
  Field as(std::string with_symbol, std::string with_words = "") const;
};

struct Variant {
  std::vector<std::string> words;  ///< values of the discriminator that lead here
  ObjectForm keys;                 ///< keys in addition to the enclosing object's
};

/// The keys of a whole study; its variants are the kinds, each with its own keys (study_kind.hpp).
const ObjectForm& study_form();

/// The reference that no plugin provides: the method itself, marched on finer steps and meshes.
inline constexpr const char* marched_reference = "self";

/// The keys of one method as a study writes it: "name" and the plugin's parameters, each of which may be a list.
ObjectForm method_form(const PluginManual& manual);

/// The ways in which an entry of `ask` may be written, one for each verb. Given by the registry of verbs.
std::vector<ObjectForm> ask_ways();

/// A value as JSON; a table that is empty is null.
Json to_json(const ParameterValue& value);
/// Such a value again, as its declaration reads it.
ParameterValue to_value(const ParameterSpec& spec, const Json& value);

}  // namespace ricochet

namespace ricochet::keys {

// Keys of the study format, as kinds of study declare theirs. A key whose value may be a list (an axis of the cross
// product) says so by `axis`; an absent fallback makes a key required.

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline const Range any{};
inline const Range positive{0, infinity, true, false};
inline const Range non_negative{0, infinity, false, false};

/// A number, or a list of numbers as an axis.
Field real(const char* key, const char* unit, const Range& range, std::optional<double> fallback, const char* text);
Field integer(const char* key, const Range& range, std::optional<long long> fallback, const char* text);
Field word(const char* key, std::vector<std::string> words, std::optional<std::string> fallback, const char* text);
/// A field of any other form, not an axis.
Field of_form(Field::Form form, const char* key, std::optional<Json> fallback, const char* text);
/// A number or a formula in `variables`, or a list of these as an axis.
Field formula(const char* key, const char* unit, const char* variables, bool nullable, std::optional<Json> fallback,
              const char* text);
Field object(const char* key, std::optional<Json> fallback, const char* text, ObjectForm keys);
/// A list of any number of objects, one value together.
Field objects(const char* key, const char* text, ObjectForm keys);
Field methods(const char* key, Role role, const char* text);
Field place(const char* key, std::optional<Json> fallback, const char* text);

/// The field as one value, never a list.
Field single(Field field);
/// The field, not written out where it is absent or its default.
Field quiet(Field field);
/// The field as one value that may be null: no such limit.
Field optional(Field field);

// The keys that several kinds have.
Field step();                           ///< s, an axis
Field steps_per_period();               ///< an axis
Field march(const char* unless_given);  ///< an axis
Field duration();                       ///< s
Field samples();
Field budget();  ///< s; null: no limit
/// The measures, out of these, that the answer of the study is made of; null: those that its kind asks for.
Field observe(std::vector<std::string> measures);

}  // namespace ricochet::keys
