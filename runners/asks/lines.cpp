#include "runners/asks/lines.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "runners/answers/set_names.hpp"
#include "runners/answers/uncertainty.hpp"
#include "runners/json/json_text.hpp"
#include "runners/store/record_values.hpp"
#include "runners/study/axis_meaning.hpp"

namespace ricochet::asks {

std::string Line::place() const {
  return (level.empty() ? "" : " with " + level) + (stop.empty() || one_stop ? "" : " at " + stop);
}

bool Line::applies() const {
  return !point.without_limit && std::any_of(point.cases.begin(), point.cases.end(),
                                             [](const CaseRecord* one) { return one->status != Status::refused; });
}

bool Lines::any_applies() const {
  return std::any_of(all.begin(), all.end(), [](const Line& line) { return line.applies(); });
}

std::vector<const Line*> Lines::known() const {
  std::vector<const Line*> out;
  for (const Line& line : all)
    if (line.known()) out.push_back(&line);
  return out;
}

std::string Lines::text(const Estimate& estimate) const {
  if (estimate.beyond) return "at least " + answers::value_text(words, estimate.value, {});
  return answers::with_uncertainty(words, estimate.value, estimate.u());
}

std::string Lines::number(double value, std::optional<double> u) const {
  return answers::value_text(words, value, u);
}

std::string Lines::given(double value) const {
  constexpr int digits = 12;  // what a decimal number times a power of ten keeps
  return short_number(words.factor * value, digits) + (words.unit.empty() ? "" : " " + words.unit);
}

VerdictRow Lines::row(const Line& line) const {
  VerdictRow out;
  out.measure = line.measure;
  out.level = line.level;
  out.stop = line.stop;
  out.unit = words.unit;
  out.of_case = line.point.first().id;
  out.cases = line.point.behind.size();
  out.left_out = line.point.cases.size() - line.point.behind.size();
  if (!line.known()) {
    out.reason = line.point.none;
    return out;
  }
  const Estimate& one = line.estimate();
  out.value = words.factor * one.value;
  if (one.u() && !one.beyond) {
    out.low = words.factor * one.low();
    out.high = words.factor * one.high();
  }
  out.reason = one.beyond ? "at least, beyond the range" : one.grows ? one.motion : one.unknown();
  return out;
}

namespace {

/// Whether a stop bounds a rotation.
bool turns(const Json& study, const std::string& stop) {
  if (!study.is_object() || !study.contains("scene") || !study["scene"].contains("stops")) return false;
  const Json& stops = study["scene"]["stops"];
  for (const Json& one : stops.is_array() ? stops : Json::array())
    if (one.is_object() && one.value("name", "") == stop && one.contains("at") && one["at"].is_object()) {
      const Json component = one["at"].value("component", Json());
      return component == "rx" || component == "ry" || component == "rz";
    }
  return false;
}

/// What a unit of forces and displacements is of moments and rotations; "" where they share it.
std::string unit_of_rotation(const std::string& unit) {
  static const std::map<std::string, std::string> units = {
      {"N", "N m"}, {"N s", "N m s"}, {"m", "rad"}, {"m/s", "rad/s"}};
  const auto found = units.find(unit);
  return found == units.end() ? "" : found->second;
}

/// The words of a measure without its stop.
answers::MeasureWords words_of(const std::string& measure) {
  answers::MeasureWords words = answers::measure_words(measure);
  const std::string stop = split_measure(measure).second, place = " at " + stop;
  if (const std::size_t at = words.words.find(place); !stop.empty() && at != std::string::npos)
    words.words.erase(at, place.size());
  return words;
}

}  // namespace

Lines lines_of(const Ask& ask, const Evidence& evidence, const std::string& measure, bool as_stored) {
  return lines_of(ask, evidence, measure, evidence.choices(evidence.cases(ask), measure), as_stored);
}

Lines lines_of(const Ask& ask, const Evidence& evidence, const std::string& measure,
               const std::vector<std::string>& columns, bool as_stored) {
  Lines out;
  const Cases cases = evidence.cases(ask);
  const std::vector<std::string> names = evidence.measures(ask, measure);
  out.words = words_of(names.front());
  const bool shares = !as_stored && std::all_of(names.begin(), names.end(), [&](const std::string& name) {
    return evidence.has_shares(name, cases);
  });
  if (!shares && out.words.scale == "energy_brought_in") {
    const MeasureInfo* info = measure_info(names.front());
    out.words.factor = 1;
    out.words.unit = info ? info->unit : "";
  }
  if (std::all_of(names.begin(), names.end(),
                  [&](const std::string& name) { return turns(evidence.results().study, split_measure(name).second); }))
    if (const MeasureInfo* info = measure_info(names.front()); info && !unit_of_rotation(info->unit).empty()) {
      out.words.factor = 1;
      out.words.unit = unit_of_rotation(info->unit);
    }
  // An oscillator has no length that a norm would run along.
  const Json& study = evidence.results().study;
  if (study.is_object() && study.contains("scene") &&
      study["scene"].value("structure", Json::object()).value("type", "") == "oscillator")
    for (const auto& [norm, plain] : {std::pair("m^3/2", "m"), {"m^3/2/s", "m/s"}})
      if (out.words.unit == norm) out.words.unit = plain;
  // Levels are said in the study's order, whatever is asked of them.
  std::vector<std::string> ordered;
  for (const std::string& column : evidence.results().columns)
    if (std::find(columns.begin(), columns.end(), column) != columns.end()) ordered.push_back(column);
  double largest = 0;
  std::set<std::string> told;
  std::set<const CaseRecord*> behind;  // of several stops a case stands behind each
  for (const std::string& name : names) {
    for (Point& point : evidence.points(name, cases, columns, shares)) {
      Line line{split_measure(name).first, split_measure(name).second, "", std::move(point)};
      line.level = evidence.level(line.point.first(), ordered);
      for (const std::string& column : ordered) line.attributes.push_back(evidence.level(line.point.first(), {column}));
      line.attributes.push_back(line.stop);
      if (line.known()) largest = std::max(largest, std::abs(line.estimate().value));
      behind.insert(line.point.behind.begin(), line.point.behind.end());
      out.all.push_back(std::move(line));
    }
    const LeftOut left = evidence.left_out(name, cases);
    for (const std::string& line : left.told())
      if (told.insert(line).second) out.aside.push_back(line);
    for (const LeftOut::Reason& one : left.reasons)
      if (std::find(out.without.begin(), out.without.end(), one.said()) == out.without.end())
        out.without.push_back(one.said());
  }
  out.cases = behind.size();
  out.left_out = cases.size() - behind.size();
  // One stop needs no name.
  if (names.size() == 1) {
    out.words.words = answers::measure_words(names.front()).words;
    for (Line& line : out.all) line.one_stop = true;
  }
  out.words = answers::prefixed(out.words, largest);
  return out;
}

std::string all_text(std::size_t count) {
  return count == 2 ? "both" : fmt::format("all {}", count);
}

std::string or_none(const std::string& level) {
  return level.empty() ? "none" : level;
}

bool is_plural(const std::string& words) {
  const std::string first = words.substr(0, words.find(' '));
  return first.ends_with("s") && !first.ends_with("ss") && !first.ends_with("us") && !first.ends_with("rms");
}

std::string set_name(const Lines& lines, const std::vector<const Line*>& set) {
  if (set.empty() || set.size() == lines.all.size()) return "";
  if (set.size() == 1) return set.front()->place().empty() ? "" : set.front()->place().substr(1);
  const std::size_t count = set.front()->attributes.size();
  // What they share and others do not.
  std::vector<std::size_t> shared;
  for (std::size_t k = 0; k < count; ++k) {
    const std::string& own = set.front()->attributes[k];
    const auto same = [&](const Line* line) { return line->attributes[k] == own; };
    const bool in_all = std::all_of(lines.all.begin(), lines.all.end(), [&](const Line& line) { return same(&line); });
    if (!own.empty() && !in_all && std::all_of(set.begin(), set.end(), same)) shared.push_back(k);
  }
  const auto picked = [&](const std::vector<std::size_t>& by) {
    const auto alike = [&](const Line& line) {
      return std::all_of(by.begin(), by.end(),
                         [&](std::size_t k) { return line.attributes[k] == set.front()->attributes[k]; });
    };
    return static_cast<std::size_t>(std::count_if(lines.all.begin(), lines.all.end(), alike));
  };
  if (shared.empty() || picked(shared) != set.size()) return "";
  // A parameter that its method alone has says nothing more.
  for (std::size_t k = shared.size(); k-- > 0 && shared.size() > 1;) {
    std::vector<std::size_t> fewer = shared;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
    if (picked(fewer) == set.size()) shared = std::move(fewer);
  }
  std::string levels, stop;
  for (const std::size_t k : shared)
    (k + 1 == count ? stop : levels) += (k + 1 == count   ? " at "
                                         : levels.empty() ? "with "
                                                          : ", ") +
                                        set.front()->attributes[k];
  if (levels.empty() && !stop.empty()) return stop.substr(1);
  return levels + stop;
}

Answered begin_answer(const Lines& lines) {
  Answered out;
  out.cases = lines.cases;
  out.left_out = lines.left_out;
  out.aside = lines.aside;
  return out;
}

std::optional<Answered> without_values(const Lines& lines, Answered begun, bool yes_or_no) {
  if (!lines.known().empty()) return std::nullopt;
  begun.reason = lines.without.empty() ? "no case has come to its end" : some_of(lines.without);
  begun.verdict = yes_or_no ? word(Verdict::open) : "no value";
  begun.passes = Verdict::open;
  begun.sentence =
      in_thirty_words(fmt::format("{} case has a value of {}", yes_or_no ? "Open: no" : "No", lines.words.words),
                      {{": " + begun.reason}});
  return begun;
}

Answered never_alone(Answered begun, const Lines& lines, const std::string& choice) {
  begun.verdict = word(Verdict::open);
  begun.passes = Verdict::open;
  begun.reason = choice + " never differs alone";
  for (const Line& line : lines.all) {
    begun.rows.push_back(lines.row(line));
    begun.rows.back().verdict = "value";
  }
  begun.sentence = fmt::format("Open: {}: no two cases that ran differ in nothing else.", begun.reason);
  return begun;
}

std::string short_reason(const std::string& reason) {
  const std::string first = ", the first";
  std::string out = reason.substr(0, reason.find(": "));
  if (out.ends_with(first)) out.resize(out.size() - first.size());
  return out;
}

std::string some_of(const std::vector<std::string>& names, std::size_t most) {
  if (names.size() <= most + 1) return answers::and_list(names);
  std::vector<std::string> first(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(most));
  return fmt::format("{} and {} more", fmt::join(first, ", "), names.size() - most);
}

void check_measure(const Ask& ask, const Study& study, const std::string& key, const std::string& measure) {
  const StudyKind& kind = *find_study_kind(study.kind);
  const std::string pointer = ask.pointer(key);
  if (measure == "status") throw InputError(pointer, "how cases ended is no measure; ask {\"runs\": true}");
  if (kind.check_measure) {
    kind.check_measure(study.resolved, measure, pointer);
    return;
  }
  std::vector<std::string> names;
  for (const MeasureInfo& info : all_measures()) names.emplace_back(info.name);
  if (std::find(names.begin(), names.end(), measure) == names.end() && !measure_info(measure))
    throw InputError(pointer, "no measure is called " + quote(measure) + did_you_mean(measure, names));
}

void check_subject(const Ask& ask, const Study& study) {
  check_measure(ask, study, ask.verb->name, ask.subject());
  check_one_unit(ask, study, ask.subject());
}

void check_one_unit(const Ask& ask, const Study& study, const std::string& measure) {
  const auto [base, stop] = split_measure(measure);
  const Json& stops = study.resolved.at("scene").at("stops");
  if (!stop.empty() || !stops.is_array() || stops.empty()) return;
  const MeasureInfo* info = measure_info(base + "[" + stops.front().at("name").get<std::string>() + "]");
  if (!info || unit_of_rotation(info->unit).empty()) return;
  std::vector<std::string> names;
  if (ask.has("stops"))
    names = ask.keys["stops"].get<std::vector<std::string>>();
  else
    for (const Json& one : stops) names.push_back(one.at("name").get<std::string>());
  const auto turning =
      std::find_if(names.begin(), names.end(), [&](const std::string& one) { return turns(study.resolved, one); });
  const bool all = std::all_of(names.begin(), names.end(), [&](const auto& one) { return turns(study.resolved, one); });
  if (turning == names.end() || all) return;
  throw InputError(ask.pointer(ask.has("stops") ? "stops" : ask.verb->name),
                   fmt::format("stop {} bounds a rotation: its {} is in {}, that of others in {}; name stops of one "
                               "kind by \"stops\"",
                               *turning, base, unit_of_rotation(info->unit), info->unit));
}

namespace {

/// Whether two cases differ in a choice and in nothing else but what refines and what is drawn.
bool differs_alone(const Ask& ask, const Study& study, const std::string& choice) {
  std::map<std::string, std::set<std::string>> levels;  // by all else
  for (const StudyCase& one : study.cases) {
    if (!speaks_of(ask, one)) continue;
    std::string own, others;
    for (const auto& [axis, value] : one.axes) {
      const bool is_own = axis == choice || (axis_role(choice) == choice && axis_role(axis) == choice);
      if (is_own)
        own += value.dump() + '\n';
      else if (axis != seed_axis && !is_refinement(axis))
        others += axis + '=' + value.dump() + '\n';
    }
    levels[others].insert(own);
  }
  return std::any_of(levels.begin(), levels.end(), [](const auto& one) { return one.second.size() > 1; });
}

}  // namespace

void check_choice(const Ask& ask, const Study& study, const std::string& key, const std::string& choice) {
  std::vector<std::string> varying, fixed;
  for (const std::string& column : study.columns) {
    std::set<std::string> levels;
    for (const StudyCase& one : study.cases)
      for (const auto& [axis, value] : one.axes)
        if (axis == column && speaks_of(ask, one)) levels.insert(value.dump());
    for (const std::string& name : {axis_role(column), column}) {
      std::vector<std::string>& list = levels.size() > 1 ? varying : fixed;
      if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
    }
  }
  if (std::find(varying.begin(), varying.end(), choice) != varying.end()) {
    if (!differs_alone(ask, study, choice))
      throw InputError(ask.pointer(key), quote(choice) +
                                             " never differs alone: cases that differ in it have other choices "
                                             "otherwise, too; expected a study that crosses them");
    return;
  }
  // Seeds are draws: no verb takes them.
  std::erase(varying, seed_axis);
  const std::string expected =
      varying.empty() ? "; no choice of this study varies" : "; expected one of " + quoted_list(varying);
  if (std::find(fixed.begin(), fixed.end(), choice) != fixed.end())
    throw InputError(ask.pointer(key), quote(choice) + " has one level in " +
                                           (ask.has("where") ? "the cases of \"where\"" : "this study") + expected);
  throw InputError(ask.pointer(key),
                   "no choice of this study is called " + quote(choice) + expected + did_you_mean(choice, varying));
}

void refuse_seeds(const Ask& ask, const std::string& key, const std::string& why, const std::string& measure) {
  if (ask.text(key.c_str()) == seed_axis)
    throw InputError(ask.pointer(key), "seeds are draws of one load and " + why + "; ask {\"value\": \"" + measure +
                                           "\"}, whose interval holds them");
}

Planned planned(const Study& study) {
  std::set<std::string> steps, meshes, seeds;
  for (const StudyCase& one : study.cases)
    for (const auto& [axis, value] : one.axes) {
      if (axis == "step" || axis == "steps_per_period") steps.insert(value.dump());
      if (axis == "elements" || axis == "modes") meshes.insert(axis + value.dump());
      if (axis == seed_axis) seeds.insert(value.dump());
    }
  const Json window = study.resolved.value("window", Json());
  const bool parts = window.is_object() && window.contains("parts") && window["parts"].is_number();
  return {steps.size(), meshes.size(), seeds.size(),
          !parts && seeds.size() < 2 && is_drawn(study.resolved.value("scene", Json::object()))};
}

std::string doubt_of_one_step(const Ask&, const Study& study) {
  return planned(study).steps == 1 ? "one step only: no interval, so no yes and no no" : "";
}

std::string doubt_of_values(const Ask& ask, const Study& study) {
  if (std::string one_step = doubt_of_one_step(ask, study); !one_step.empty()) return one_step;
  return planned(study).one_draw ? "one seed of a random load: what other draws leave is not known, so no yes and no no"
                                 : "";
}

Json bars(const Lines& lines, const std::vector<double>& at) {
  Json rows = Json::array();
  for (const Line& line : lines.all) {
    const VerdictRow row = lines.row(line);
    rows.push_back({{"name", line.level}, {"group", line.stop}});
    if (row.value) rows.back()["value"] = *row.value;
    if (row.low) rows.back()["low"] = *row.low, rows.back()["high"] = *row.high;
  }
  return {{"form", "bars"}, {"measure", lines.words.words}, {"unit", lines.words.unit}, {"rows", rows}, {"at", at}};
}

}  // namespace ricochet::asks
