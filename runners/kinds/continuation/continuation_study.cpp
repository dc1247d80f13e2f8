#include "runners/kinds/continuation/continuation_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ricochet/scene/semi_discrete.hpp>
#include <utility>

#include "runners/json/json_text.hpp"
#include "runners/kinds/sweep/forcing.hpp"
#include "runners/kinds/sweep/sweep.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/store.hpp"
#include "runners/study/check_object.hpp"

namespace ricochet {
namespace {

constexpr std::array<std::pair<const char*, OrbitSource>, 3> sources = {
    {{"rest", OrbitSource::rest}, {"state", OrbitSource::state}, {"free", OrbitSource::free}}};
constexpr std::array<std::pair<const char*, HalfMap>, 3> halves = {
    {{"auto", HalfMap::automatic}, {"yes", HalfMap::yes}, {"no", HalfMap::no}}};
constexpr std::array<std::pair<const char*, Follow>, 4> follows = {
    {{"auto", Follow::automatic}, {"pieces", Follow::pieces}, {"steps", Follow::steps}, {"none", Follow::none}}};

template <class Words>
std::vector<std::string> words_of(const Words& words) {
  std::vector<std::string> names;
  for (const auto& [word, value] : words) names.emplace_back(word);
  return names;
}

template <class Words>
auto value_of(const Words& words, const Json& given) {
  // A flag stands for its word.
  const std::string word = given.is_boolean() ? (given.get<bool>() ? "yes" : "no") : given.get<std::string>();
  for (const auto& [known, value] : words)
    if (word == known) return value;
  return words.front().second;
}

Field flag(const char* key, bool fallback, const char* text) {
  Field field;
  field.spec.type = ParameterSpec::Type::boolean;
  field.spec.key = key;
  field.spec.text = text;
  field.fallback = fallback;
  return field;
}

std::vector<std::string> words_of_kinds(const std::vector<PointKind>& kinds) {
  std::vector<std::string> words;
  for (const PointKind kind : kinds) words.emplace_back(word(kind));
  return words;
}

Field kinds_of_points(const char* key, const std::vector<PointKind>& kinds, std::optional<Json> fallback,
                      const char* text) {
  Field field = keys::of_form(Field::Form::words, key, std::nullopt, text);
  field.spec = word_parameter(key, words_of_kinds(kinds), std::nullopt, text);
  field = keys::optional(std::move(field));
  if (fallback) field.fallback = std::move(*fallback);
  return field;
}

}  // namespace

std::vector<Field> continuation_keys() {
  using namespace keys;
  // In the order of the tables.
  const std::vector<PointKind> switches = {PointKind::symmetry, PointKind::flip},
                               all_kinds = {PointKind::fold,    PointKind::symmetry, PointKind::flip, PointKind::torus,
                                            PointKind::contact, PointKind::mark,     PointKind::end};
  ObjectForm parameter;
  parameter.fields = {swept_pointer(), single(real("from", "as the parameter", any, std::nullopt, "Least value.")),
                      single(real("to", "as the parameter", any, std::nullopt, "Largest value."))};

  ObjectForm stored;
  stored.fields = {of_form(Field::Form::text, "study", std::nullopt, "Folder of results of a bifurcation study."),
                   of_form(Field::Form::text, "case", std::nullopt, "Case of it, or the beginning of its id."),
                   single(real("parameter", "as the parameter", any, std::nullopt, "Value at which it was marched.")),
                   of_form(Field::Form::text, "start", std::nullopt, "Start of the orbit there.")};
  Field from =
      of_form(Field::Form::starts, "from", Json::array({"rest"}),
              "Where the orbit is looked for: rest, state (the scene's own), free (the orbit without contact), "
              "or an orbit of a bifurcation study.");
  from.spec = word_parameter("from", words_of(sources), std::nullopt, from.spec.text);
  from.nested.push_back(std::move(stored));
  Field symmetric = word("symmetric", words_of(halves), "auto",
                         "Half a period and the change of sign: auto where the scene and the orbit allow it.");
  symmetric.or_flag = true;
  ObjectForm orbit;
  orbit.fields = {
      single(real("at", "as the parameter", any, std::nullopt, "Value at which the orbit is solved.")), std::move(from),
      integer("periods", {0, 100000000, false, false}, 300, "Forcing periods marched before the first solve."),
      integer("period", {1, 1000, false, false}, 1, "Forcing periods after which the orbit repeats."),
      std::move(symmetric)};
  Field orbits = of_form(Field::Form::objects, "orbits", std::nullopt, "The orbits that branches begin with.");
  orbits.nested.push_back(std::move(orbit));

  Field marked =
      of_form(Field::Form::numbers, "parameter", std::nullopt, "Values at which the orbit is solved exactly.");
  marked.spec = real_parameter("parameter", "as the parameter", std::nullopt, any, marked.spec.text);
  ObjectForm mark;
  mark.fields = {std::move(marked)};
  Field marks = object("mark", Json(nullptr), "Points of the user's own; null: none.", std::move(mark));
  marks.nullable = true;

  ObjectForm at_most;
  at_most.fields = {
      integer("pieces", {1, 1000000000, false, false}, 200000, "Pieces or steps of a branch."),
      optional(single(real("arc", "m", positive, std::nullopt,
                           "Length of a branch; null: ten times the sum of the gap and the range in metres.")))};
  Field reference = methods("reference", Role::reference,
                            "A reference whose orbits are followed too, or a list, whose first counts; null: none.");
  reference.fallback = Json(nullptr);
  reference.nullable = reference.quiet = true;
  Field beneath = of_form(Field::Form::text, "beneath", Json(""),
                          "Folder of results of a bifurcation study of the scene, whose points are drawn beneath.");
  beneath.quiet = true;
  return {
      object("parameter", std::nullopt, "What branches are followed along.", std::move(parameter)),
      steps_per_period(),
      std::move(orbits),
      word("follow", words_of(follows), "auto",
           "By pieces of a piecewise affine map, by steps of arclength, or not at all."),
      flag("both_ways", true, "Whether branches are followed both ways from their first orbit."),
      kinds_of_points("switch", switches, words_of_kinds(switches),
                      "Kinds of points at which other branches begin that are followed too; null: none."),
      integer("switch_depth", {0, 8, false, false}, 1, "Branches on branches, at most so deep."),
      optional(real("prominence", "as the parameter", positive, std::nullopt,
                    "Least way that the parameter goes back by at a fold; null: 1e-4 of the gap, or of the value. For "
                    "folds that no other case has, it is 25 times what the two finest steps disagree about.")),
      integer("multipliers", {1, 64, false, false}, 4, "Number of multipliers told, largest first."),
      kinds_of_points("stop_at", all_kinds, std::nullopt, "Kinds of points at which a branch ends; null: none."),
      std::move(marks),
      std::move(reference),
      std::move(beneath),
      object("at_most", Json::object(), "Where a branch ends at the latest.", std::move(at_most)),
      budget()};
}

Json continuation_settings(const Json& resolved) {
  Json settings = given_settings(resolved, {"parameter", "orbits", "follow", "both_ways", "switch", "switch_depth",
                                            "prominence", "multipliers", "stop_at", "mark", "at_most", "budget"});
  return settings;
}

void check_continuation(const Json& resolved) {
  const Json& parameter = resolved.at("parameter");
  const auto from = parameter.at("from").get<double>(), to = parameter.at("to").get<double>();
  if (!(from < to))
    throw InputError("/parameter/from", fmt::format("the range from {} to {} is empty; expected from < to", from, to));
  const Json& orbits = resolved.at("orbits");
  if (orbits.empty()) throw InputError("/orbits", "an empty list of orbits; expected at least one to begin with");
  for (std::size_t i = 0; i < orbits.size(); ++i) {
    const std::string here = pointer_to("/orbits", i);
    const auto at = orbits[i].at("at").get<double>();
    if (at < from || at > to)
      throw InputError(pointer_to(here, "at"),
                       fmt::format("the orbit at {} is outside the range from {} to {}", at, from, to));
    if (value_of(halves, orbits[i].at("symmetric")) == HalfMap::yes && orbits[i].at("period").get<int>() % 2 == 0)
      throw InputError(pointer_to(here, "symmetric"),
                       fmt::format("an orbit of {} periods is not its own image after half of them; expected an odd "
                                   "period",
                                   orbits[i].at("period").get<int>()));
  }
  if (const Json& mark = resolved.at("mark"); mark.is_object())
    for (std::size_t i = 0; i < mark.at("parameter").size(); ++i)
      if (const auto at = mark["parameter"][i].get<double>(); at < from || at > to)
        throw InputError(pointer_to("/mark/parameter", i),
                         fmt::format("the mark at {} is outside the range from {} to {}", at, from, to));
  check_beneath(resolved);
}

void check_followed(const Json& resolved, const Json& settings, const Registry& registry, double, int) {
  const auto pointer = settings.at("parameter").at("pointer").get<std::string>();
  const std::string where = "/parameter/pointer";
  if (names_initial_state(pointer))
    throw InputError(where, fmt::format("{} is where motions begin, which no periodic orbit depends on; expected a "
                                        "number that the steps depend on",
                                        pointer));
  try {
    // A key of a method is that of the first one of its role.
    std::string first = pointer;
    const std::string methods = "/methods/";
    if (const auto key = pointer.find('/', methods.size()); pointer.starts_with(methods) && key != std::string::npos)
      first.insert(key, "/0");
    const Json::json_pointer place(resolved.contains(Json::json_pointer(first)) ? first : pointer);
    if (resolved.contains(place) && !pointer.starts_with("/scene/stops/")) {
      const Json& named = resolved.at(place);
      std::string what;
      if (pointer.starts_with("/steps_per_period") || named.is_number_integer()) what = "a count";
      if (pointer.starts_with("/mesh")) what = "part of the mesh";
      if (named.is_boolean()) what = "true or false";
      if (pointer.starts_with("/scene/") && named.is_number()) what = "";
      if (named.is_string() && (pointer.ends_with("/type") || pointer.starts_with("/methods/")))
        what = "the word " + named.dump();
      if (!what.empty())
        throw InputError(where, fmt::format("continuation follows a real number; {} is {}", pointer, what));
    }
  } catch (const Json::exception&) {  // no pointer at all: told below
  }
  check_swept_pointer(resolved, pointer, where, registry);
}

namespace {

std::vector<double> looked_at(const Json& settings) {
  std::vector<double> values;
  for (const Json& orbit : settings.at("orbits")) values.push_back(orbit.at("at").get<double>());
  for (const char* end : {"from", "to"}) values.push_back(settings.at("parameter").at(end).get<double>());
  return values;
}

}  // namespace

bool some_orbit_possible(const StudyCase& study_case) {
  const auto pointer = study_case.settings.at("parameter").at("pointer").get<std::string>();
  for (const double value : looked_at(study_case.settings)) {
    if (!pointer.starts_with("/scene/")) return true;
    try {
      with_parameter(at_rest(study_case), pointer, value);
      return true;
    } catch (const InputError&) {
    }
  }
  return false;
}

void check_continued_cases(const Study& study) {
  std::optional<InputError> first;
  for (const StudyCase& one : study.cases) {
    if (one.excluded) continue;
    const auto pointer = one.settings.at("parameter").at("pointer").get<std::string>();
    for (const double value : looked_at(one.settings)) {
      try {
        const StudyCase at = with_parameter(at_rest(one), pointer, value);
        if (is_forced(at.scene) || forcing_pulsation(at.scene) > 0) return;
      } catch (const InputError& error) {
        if (!first) first = error;
      }
    }
  }
  if (first) throw InputError(*first);
  throw InputError("/exclude", "every case is excluded; nothing would run");
}

namespace {

// Words that were checked when the study was read.
std::vector<PointKind> kinds_in(const Json& words) {
  std::vector<PointKind> kinds;
  for (const Json& one : words) kinds.push_back(of_word<PointKind>(one.get_ref<const std::string&>()).value());
  return kinds;
}

}  // namespace

ContinuationPlan continuation_plan(const Json& settings) {
  ContinuationPlan plan;
  const Json& parameter = settings.at("parameter");
  plan.pointer = parameter.at("pointer").get<std::string>();
  plan.from = parameter.at("from").get<double>();
  plan.to = parameter.at("to").get<double>();
  for (const Json& orbit : settings.at("orbits"))
    for (const Json& from : orbit.at("from")) {
      WantedOrbit one;
      one.name = fmt::format("orbit-{}", plan.orbits.size() + 1);
      one.at = orbit.at("at").get<double>();
      one.periods = orbit.at("periods").get<int>();
      one.period = orbit.at("period").get<int>();
      one.symmetric = value_of(halves, orbit.at("symmetric"));
      if (from.is_object()) {
        one.from = OrbitSource::stored;
        one.study = from.at("study").get<std::string>();
        one.case_id = from.at("case").get<std::string>();
        one.start = from.at("start").get<std::string>();
        one.parameter = from.at("parameter").get<double>();
      } else {
        one.from = value_of(sources, from);
      }
      plan.orbits.push_back(std::move(one));
    }
  plan.follow = value_of(follows, settings.at("follow"));
  plan.both_ways = settings.at("both_ways").get<bool>();
  if (const auto given = settings.find("switch"); given != settings.end()) plan.branch_at = kinds_in(*given);
  if (const auto given = settings.find("stop_at"); given != settings.end()) plan.stop_at = kinds_in(*given);
  plan.depth = settings.at("switch_depth").get<int>();
  if (const auto given = settings.find("prominence"); given != settings.end()) plan.prominence = given->get<double>();
  plan.multipliers = settings.at("multipliers").get<int>();
  if (const auto given = settings.find("mark"); given != settings.end())
    plan.marks = given->at("parameter").get<std::vector<double>>();
  plan.most_pieces = settings.at("at_most").at("pieces").get<long long>();
  if (const Json& arc = settings.at("at_most").at("arc"); arc.is_number()) plan.longest = arc.get<double>();
  return plan;
}

namespace {

const char* const where = "/beneath";

// The scene without what the parameter replaces.
Json fixed_scene(const Json& study, const std::string& pointer) {
  Json fixed = {{"scene", study.at("scene")}};
  const Json::json_pointer place(pointer);
  if (fixed.contains(place)) fixed[place] = nullptr;
  return fixed;
}

StudyResults results_beneath(const Json& study) {
  const auto folder = study.at("beneath").get<std::string>();
  StudyResults results;
  try {
    results = read_store(folder);
  } catch (const StoreError& error) {
    throw InputError(where, error.what());
  }
  const auto refuse = [&](const std::string& what) { throw InputError(where, folder + " " + what); };
  const Json& other = results.study;
  if (results.kind != "bifurcation")
    refuse(fmt::format("holds a study of kind {}; expected bifurcation", results.kind));
  const auto own = study.at("parameter").at("pointer").get<std::string>(),
             theirs = other.at("parameter").at("pointer").get<std::string>();
  if (own != theirs) refuse(fmt::format("goes along {}; expected {}", theirs, own));
  if (other.value("section", "strobe") != "strobe" || other.value("phase", 0.0) != 0)
    refuse(fmt::format("has another section, {} at phase {:g}; expected strobe at phase 0",
                       other.value("section", "strobe"), other.value("phase", 0.0)));
  const Json difference = Json::diff(fixed_scene(study, own), fixed_scene(other, own));
  if (!difference.empty())
    refuse(fmt::format("has another scene: {} differs", difference.front().at("path").get<std::string>()));
  return results;
}

}  // namespace

void check_beneath(const Json& study) {
  if (study.contains("beneath")) results_beneath(study);
}

PointsBeneath points_beneath(const Json& study, std::size_t most) {
  const StudyResults results = results_beneath(study);
  const auto type = points_type();
  std::vector<SectionColumns> all;
  PointsBeneath out;
  for (const CaseRecord& record : results.cases)
    if (const NumberTable* table = type.find(record.numbers)) {
      const SectionColumns columns = type.read(*table);
      if (!columns.parameter || !columns.displacement) continue;
      all.push_back(columns);
      out.stored += columns.parameter->size();
    }
  const std::size_t stride = std::max<std::size_t>(1, (out.stored + most - 1) / std::max<std::size_t>(1, most));
  std::size_t number = 0;
  for (const SectionColumns& columns : all) {
    const std::vector<double>&parameter = *columns.parameter, &tip = *columns.displacement;
    for (std::size_t k = 0; k < parameter.size(); ++k, ++number)
      if (number % stride == 0 && std::isfinite(tip[k])) {
        out.parameter.push_back(parameter[k]);
        out.tip.push_back(tip[k]);
      }
  }
  return out;
}

}  // namespace ricochet
