#include "runners/asks/ask.hpp"

#include <algorithm>

#include "runners/asks/evidence.hpp"
#include "runners/asks/verbs.hpp"
#include "runners/json/json_text.hpp"
#include "runners/json/share.hpp"
#include "runners/study/axis_meaning.hpp"

namespace ricochet::asks {

std::string Ask::text(const char* key) const {
  const auto found = keys.find(key);
  return found != keys.end() && found->is_string() ? found->get<std::string>() : "";
}

std::optional<double> Ask::real(const char* key) const {
  const auto found = keys.find(key);
  return found != keys.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

std::optional<double> Ask::share(const char* key) const {
  const auto found = keys.find(key);
  return found != keys.end() ? share_of(*found) : std::nullopt;
}

std::string Ask::subject() const {
  return text(verb->name);
}

std::string Ask::pointer(const std::string& key) const {
  return pointer_to(pointer_to("/ask", number - 1), key.empty() ? verb->name : key);
}

const std::vector<const Verb*>& verbs() {
  static const std::vector<const Verb*> all = {&value_verb(),     &rank_verb(),     &limit_verb(), &effect_verb(),
                                               &threshold_verb(), &cheapest_verb(), &order_verb(), &enough_verb(),
                                               &motions_verb(),   &points_verb(),   &steps_verb(), &runs_verb()};
  return all;
}

const Verb* find_verb(const std::string& name) {
  for (const Verb* verb : verbs())
    if (name == verb->name) return verb;
  return nullptr;
}

Ask ask_of(const Json& keys, std::size_t number) {
  Ask out{number, nullptr, keys};
  for (const auto& [key, value] : keys.items())
    if (const Verb* verb = find_verb(key)) {
      out.verb = verb;
      break;
    }
  return out;
}

std::vector<Ask> asks_of_list(const Json& list) {
  std::vector<Ask> out;
  for (const Json& keys : list) out.push_back(ask_of(keys, out.size() + 1));
  return out;
}

std::vector<Ask> asks_of(const Json& study) {
  const auto list = study.find("ask");
  return list != study.end() && list->is_array() ? asks_of_list(*list) : std::vector<Ask>();
}

std::string verb_of_kind(const Ask& ask) {
  const std::string name = ask.verb->name;
  return name == "effect" && ask.text("on") == "motions" ? "effect on motions" : name;
}

namespace {

/// Names of stops, or none where the scene has none with names.
std::vector<std::string> stops_of(const Json& resolved) {
  std::vector<std::string> out;
  if (const Json& stops = resolved.at("scene").at("stops"); stops.is_array())
    for (const Json& stop : stops) out.push_back(stop.at("name").get<std::string>());
  return out;
}

void check_stops(const Ask& ask, const Study& study) {
  if (!ask.has("stops")) return;
  const std::vector<std::string> known = stops_of(study.resolved);
  const Json& asked = ask.keys["stops"];
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const auto name = asked[i].get<std::string>();
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError(
          pointer_to(ask.pointer("stops"), i),
          known.empty() ? std::string("the scene has no stops with names")
                        : "no stop " + quote(name) + "; there is: " + quoted_list(known) + did_you_mean(name, known));
  }
  const auto [measure, stop] = split_measure(ask.has("on") ? ask.text("on") : ask.subject());
  if (!stop.empty() && std::find(known.begin(), known.end(), stop) != known.end() &&
      std::find(asked.begin(), asked.end(), stop) == asked.end())
    throw InputError(ask.pointer("stops"), "leaves out " + quote(stop) + ", of which the measure is; expected " +
                                               quote(measure) + " or this stop");
  for (const Field& key : find_study_kind(study.kind)->keys)
    if (const auto& of = key.of_each; !of.empty() && std::find(of.begin(), of.end(), measure) == of.end())
      throw InputError(ask.pointer("stops"),
                       quote(measure) + " is no measure of single stops; leave this out, or ask one that is");
}

bool matches(const StudyCase& one, const std::string& column, const Json& level) {
  return std::any_of(one.axes.begin(), one.axes.end(),
                     [&](const auto& axis) { return axis.first == column && same_level(level, axis.second); });
}

/// A level that some case has, and all of them together.
void check_where(const Ask& ask, const Study& study) {
  if (!ask.has("where")) return;
  const Json& where = ask.keys["where"];
  for (const auto& item : where.items()) {
    const std::string& column = item.key();
    const Json& level = item.value();
    const std::string pointer = pointer_to(ask.pointer("where"), column);
    if (std::find(study.columns.begin(), study.columns.end(), column) == study.columns.end())
      throw InputError(pointer, "no axis of this study is called " + quote(column) +
                                    "; there is: " + quoted_list(study.columns) + did_you_mean(column, study.columns));
    if (std::any_of(study.cases.begin(), study.cases.end(),
                    [&](const auto& one) { return matches(one, column, level); }))
      continue;
    std::vector<std::string> levels;
    for (const StudyCase& one : study.cases)
      for (const auto& [axis, value] : one.axes)
        if (const std::string text = value.dump();
            axis == column && std::find(levels.begin(), levels.end(), text) == levels.end())
          levels.push_back(text);
    std::string listed;
    for (const std::string& one : levels) listed += (listed.empty() ? "" : ", ") + one;
    throw InputError(pointer, "no case has the level " + quote(level) + "; there is: " + listed);
  }
  if (std::none_of(study.cases.begin(), study.cases.end(), [&](const StudyCase& one) { return speaks_of(ask, one); }))
    throw InputError(ask.pointer("where"), "no case has all of these levels together");
}

}  // namespace

bool speaks_of(const Ask& ask, const StudyCase& one) {
  const auto where = ask.keys.find("where");
  if (where == ask.keys.end()) return true;
  return std::all_of(where->items().begin(), where->items().end(),
                     [&](const auto& item) { return matches(one, item.key(), item.value()); });
}

void check(const Ask& ask, const Study& study) {
  const StudyKind& kind = *find_study_kind(study.kind);
  const std::string name = verb_of_kind(ask);
  const bool own = std::find(kind.verbs.begin(), kind.verbs.end(), name) != kind.verbs.end();
  if (!own && name == "effect on motions")
    throw InputError(ask.pointer("on"),
                     "a study of kind " + study.kind + " finds no motions; " + find_verb("motions")->remedy);
  if (!own && !ask.verb->answer)
    throw InputError(ask.pointer(), "a study of kind " + study.kind + " cannot tell this; " + ask.verb->remedy);
  check_stops(ask, study);
  check_where(ask, study);
  if (own && kind.check_ask) kind.check_ask(study, ask.keys, ask.pointer());
  if (!own && ask.verb->check) ask.verb->check(ask, study);
}

}  // namespace ricochet::asks

namespace ricochet {

std::vector<ObjectForm> ask_ways() {
  std::vector<ObjectForm> ways;
  for (const asks::Verb* verb : asks::verbs()) {
    ObjectForm way;
    way.fields = verb->keys;
    ways.push_back(std::move(way));
  }
  return ways;
}

void check_asks(const Study& study) {
  for (const asks::Ask& ask : asks::asks_of(study.resolved)) asks::check(ask, study);
}

}  // namespace ricochet
