#include "runners/asks/evidence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>

#include "runners/answers/answer.hpp"
#include "runners/answers/limits.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/asks/verdicts.hpp"
#include "runners/store/record_values.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/in_order_met.hpp"
#include "runners/table/text.hpp"

namespace ricochet::asks {

std::pair<std::string, std::string> split_measure(const std::string& name) {
  const std::size_t open = name.find('[');
  if (open == std::string::npos || !name.ends_with("]")) return {name, ""};
  return {name.substr(0, open), name.substr(open + 1, name.size() - open - 2)};
}

bool names_step(const std::vector<std::string>& columns) {
  return std::any_of(columns.begin(), columns.end(),
                     [](const std::string& one) { return one == "step" || one == "steps_per_period"; });
}

bool same_level(const Json& asked, const Json& own) {
  return asked.is_number() && own.is_number() ? asked.get<double>() == own.get<double>() : asked == own;
}

bool is_drawn(const Json& scene) {
  return scene.is_structured() &&
         ((scene.is_object() && scene.contains("psd")) || std::any_of(scene.begin(), scene.end(), is_drawn));
}

std::string ending_key(const CaseRecord& record) {
  std::string key = record.partial ? "still running" : word(record.status);
  for (const Said& one : record.reasons) key += one.without_numbers();
  return key;
}

bool untouched(const Point& point) {
  return std::all_of(point.behind.begin(), point.behind.end(),
                     [](const CaseRecord* one) { return measure(*one, "contact_instants") == 0.0; });
}

bool is_idle(const Point& point, const std::string& stop) {
  if (!point.estimate) return point.of_untouched_stop;
  const std::string impulse = "impulse[" + stop + "]";
  const bool zero = std::all_of(point.values.begin(), point.values.end(), [](const auto& at) {
    return std::all_of(at.second.begin(), at.second.end(), [](const auto& one) { return one.second == 0; });
  });
  return zero && (untouched(point) ||
                  (!stop.empty() && std::all_of(point.behind.begin(), point.behind.end(),
                                                [&](const CaseRecord* one) { return measure(*one, impulse) == 0.0; })));
}

bool doubtful(const Point& point) {
  const Cases& those = point.behind.empty() ? point.cases : point.behind;
  return std::all_of(those.begin(), those.end(), [](const CaseRecord* one) { return !one->reasons.empty(); });
}

namespace {

const Json* axis_value(const CaseRecord& record, const std::string& column) {
  for (const auto& [name, value] : record.axes)
    if (name == column) return &value;
  return nullptr;
}

bool contains(const std::vector<std::string>& list, const std::string& item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

}  // namespace

Cases Evidence::cases(const Ask& ask) const {
  Cases out;
  const Json where = ask.keys.value("where", Json::object());
  for (const CaseRecord& record : results().cases) {
    if (is_reference(record)) continue;
    bool inside = true;
    for (const auto& [column, level] : where.items()) {
      const Json* own = axis_value(record, column);
      inside = inside && own && same_level(level, *own);
    }
    if (inside) out.push_back(&record);
  }
  return out;
}

std::vector<std::string> Evidence::measures(const Ask& ask, const std::string& name) const {
  std::vector<std::string> stops;
  if (ask.has("stops")) stops = ask.keys["stops"].get<std::vector<std::string>>();
  std::vector<std::string> out;
  std::vector<std::string> untouched;
  const auto gather = [&](bool whole) {
    const auto add = [&](const std::string& one) {
      const auto [base, stop] = split_measure(one);
      const bool asked = whole ? one == name : base == name && !stop.empty();
      if (asked && (stops.empty() || contains(stops, stop)) && !contains(out, one)) out.push_back(one);
    };
    for (const CaseRecord& record : results().cases) {
      for (const auto& [one, value] : record.measures) {
        add(one);
        // A stop that is never touched has a line of what is told in contact alone, where it may have it.
        if (whole || value != 0 || record.status != Status::done || !one.starts_with("contact_time[")) continue;
        const std::string stop = split_measure(one).second, of_stop = "[" + stop + "]";
        const MeasureInfo* info = measure_info(name + of_stop);
        if ((!info || measure(record, info->stands_with + of_stop)) && !contains(untouched, stop))
          untouched.push_back(stop);
      }
      // What has no limit under a law has a line all the same.
      for (const auto& [item, why] : record.left_out) add(item);
    }
  };
  // Each stop for itself: what several stops have together is a sum that no stop has.
  gather(false);
  // Of a measure of stops that some stop has.
  if (!out.empty())
    for (const std::string& stop : untouched)
      if (const std::string one = name + "[" + stop + "]";
          (stops.empty() || contains(stops, stop)) && !contains(out, one))
        out.push_back(one);
  if (const bool by_stop = !stops.empty() || ask.text("over") == "stops"; !by_stop && out.size() < 2) {
    const std::vector<std::string> single = std::move(out);
    out.clear();
    gather(true);
    if (out.empty()) out = single;
  }
  if (out.empty()) gather(true);
  if (out.empty()) out.push_back(name);
  // In the order of the study's stops where it names them.
  if (!stops.empty())
    std::stable_sort(out.begin(), out.end(), [&](const std::string& a, const std::string& b) {
      const auto place = [&](const std::string& one) {
        return std::find(stops.begin(), stops.end(), split_measure(one).second) - stops.begin();
      };
      return place(a) < place(b);
    });
  return out;
}

std::vector<std::string> Evidence::varying(const Cases& cases) const {
  std::vector<std::string> out;
  for (const std::string& column : results().columns)
    if (std::any_of(cases.begin(), cases.end(), [&](const CaseRecord* record) {
          return study_.text(*record, column) != study_.text(*cases.front(), column);
        }))
      out.push_back(column);
  return out;
}

std::vector<std::string> Evidence::choices(const Cases& cases, const std::string& name,
                                           const std::vector<std::string>& own) const {
  const MeasureInfo* info = measure_info(name);
  const bool refines = !info || !info->of_each_size;
  std::vector<std::string> out = varying(cases);
  std::erase_if(out, [&](const std::string& column) {
    return column == seed_axis || contains(own, column) || (refines && is_refinement(column));
  });
  return out;
}

std::vector<std::string> Evidence::columns_of(const std::string& choice) const {
  std::vector<std::string> out;
  if (axis_role(choice) != choice) return {choice};
  for (const std::string& column : results().columns)
    if (column == choice || (axis_role(column) == choice && !is_crossed(column, choice))) out.push_back(column);
  return out;
}

// Whether every method of a role has the same values of a restitution: it is the scene's then, and pairs agree in it.
bool Evidence::is_crossed(const std::string& column, const std::string& role) const {
  if (!column.ends_with(".restitution")) return false;
  std::map<std::string, std::set<std::string>> values;
  for (const CaseRecord& record : results().cases)
    values[study_.text(record, role)].insert(study_.text(record, column));
  const std::set<std::string>& first = values.begin()->second;
  return values.size() > 1 && first.size() > 1 &&
         std::all_of(values.begin(), values.end(), [&](const auto& one) { return one.second == first; });
}

bool Evidence::has_shares(const std::string& name, const Cases& cases) const {
  const answers::MeasureWords words = answers::measure_words(name);
  return words.scale == "energy_brought_in" && std::all_of(cases.begin(), cases.end(), [&](const CaseRecord* record) {
           return record->status != Status::done || !measure(*record, name) || answers::scaled_value(words, *record);
         });
}

double Evidence::window() const {
  const Json& study = results().study;
  if (study.contains("window") && study["window"].is_object())
    return study["window"]["to"].get<double>() - study["window"]["from"].get<double>();
  return study.value("duration", 0.0);
}

double Evidence::kept_periods() const {
  const Json& study = results().study;
  return study.is_object() && study.contains("keep") && study["keep"].is_number() ? study["keep"].get<double>() : 0;
}

double Evidence::repeats_after() const {
  double soonest = INFINITY;
  const std::function<void(const Json&)> look = [&](const Json& value) {
    if (!value.is_structured()) return;
    // A spectrum by its lines: after 1/Δf its sum is the same.
    if (value.is_object() && value.contains("lines") && value.contains("from") && value.contains("to"))
      if (const double band = value["to"].get<double>() - value["from"].get<double>(); band > 0)
        soonest = std::min(soonest, value["lines"].get<double>() / band);
    for (const Json& one : value) look(one);
  };
  if (const Json& study = results().study; study.is_object()) look(study.value("scene", Json::object()));
  return soonest;
}

double Evidence::resolution(const std::string& name, const Point& point, bool by_steps) const {
  const MeasureInfo* info = measure_info(name);
  if (!info || !point.finest) return 0;
  const auto most = [&](const std::string& of, double least) {
    for (const CaseRecord* record : point.behind) least = std::max(least, measure(*record, of).value_or(least));
    return least;
  };
  const std::string floor = info->floor, count = info->whole_steps;
  if (floor == contact_steps_measure) {
    // Half a period of n steps, sampled half a step beside its top: 1 − cos(π/2n) < π²/8n².
    const double n = most(floor, 0);
    if (!by_steps || n <= 0) return 0;
    double peak = 0;
    for (const auto& [seed, value] : point.values.at(*point.finest)) peak = std::max(peak, std::abs(value));
    const double turned = std::numbers::pi / n;
    return peak * std::min(1.0, turned * turned / 8);
  }
  if (!floor.empty()) return most(floor, 0);
  if (count.empty() || !by_steps || !contains(results().columns, "step")) return 0;
  const std::string stop = split_measure(name).second;
  const double steps = count == "1" ? 1 : most(count + (stop.empty() ? "" : "[" + stop + "]"), 1),
               over = info->unit == std::string("1") ? window() : 1;
  return steps * point.finest->first / over;
}

std::optional<double> least_of(const CaseRecord& record, const std::string& name) {
  if (record.status != Status::done || measure(record, name)) return std::nullopt;
  return measure(record, "least." + name);
}

namespace {

/// Beside what others have of a measure, values that are all round-off are zero.
void drop_round_off(Point& point, double largest_of_all) {
  constexpr double nothing = 1e-15;
  double largest = 0;
  for (const auto& [size, by_seed] : point.values)
    for (const auto& [seed, value] : by_seed) largest = std::max(largest, std::abs(value));
  if (largest > nothing * largest_of_all) return;
  for (auto& [size, by_seed] : point.values)
    for (auto& [seed, value] : by_seed) value = 0;
  point.floor = 0;
}

}  // namespace

std::vector<Point> Evidence::points(const std::string& name, const Cases& cases,
                                    const std::vector<std::string>& columns, bool shares) const {
  std::vector<Point> out = alone(name, cases, columns, shares);
  if (const auto varying = schemes(name, columns)) {
    test_by_schemes(out, name, *varying, shares);
    test_by_contact(out, name, *varying, shares);
  }
  return out;
}

namespace {

/// Whether each case has one rigid impact, all at one instant after the start. A rigid law sees it at the end of a
/// step; steps that are halves of each other may all end there.
bool has_one_instant(const Point& point) {
  constexpr double rounding = 1e-9;
  std::optional<double> at;
  for (const CaseRecord* one : point.behind) {
    const auto instant = measure(*one, "first_impact");
    if (measure(*one, "impacts") != 1.0 || !instant || *instant == 0) return false;
    if (at && std::abs(*instant - *at) > rounding * *at) return false;
    at = instant;
  }
  return at && point.errors == Errors::saw_toothed;
}

}  // namespace

std::vector<Point> Evidence::alone(const std::string& measure_of_all, const Cases& cases,
                                   const std::vector<std::string>& columns, bool shares) const {
  InOrderMet<std::string, Point> groups;
  for (const CaseRecord* record : cases) groups[study_.key(*record, columns)].cases.push_back(record);
  const bool has_step = names_step(results().columns);
  // A refinement that is a choice refines nothing.
  const bool steps_chosen = names_step(columns),
             mesh_chosen = contains(columns, "elements") || contains(columns, "modes");
  std::vector<Point> out;
  std::vector<std::optional<Limits>> limits;
  std::vector<double> round_off, solves;
  double largest_of_all = 0;
  const auto [base, stop] = split_measure(measure_of_all);
  const std::string at_stops = stop.empty() ? "" : base + "[";
  constexpr double of_solves = 1e-9;  // a solve multiplies round-off by the condition of its matrix
  const auto words = answers::measure_words(measure_of_all);
  const bool share = shares || words.scale == "1";
  for (auto& [key, point] : std::move(groups).list()) {
    double scale = 0, values = 0;  // of round-off, of solves
    bool counts = true;            // whole numbers have neither
    point.without_limit = answers::without_limit(study_, point.cases, measure_of_all);
    for (const CaseRecord* record : point.cases) {
      const auto value = record->status != Status::done || point.without_limit ? std::nullopt
                         : shares                                              ? answers::scaled_value(words, *record)
                                                                               : told_measure(*record, measure_of_all);
      if (!value || !std::isfinite(*value)) continue;
      point.behind.push_back(record);
      if (!mesh_chosen && !study_.on_finest_mesh(*record)) continue;
      const Size size{steps_chosen ? 1 : study_.step(*record).value_or(1),
                      mesh_chosen ? 1 : study_.elements(*record).value_or(1)};
      const std::string& seed = study_.text(*record, seed_axis);
      point.values[size][seed] = *value;
      if (const auto half = measure(*record, "confidence." + measure_of_all)) point.halves[size][seed] = *half;
      counts = counts && std::floor(*value) == *value;
      values = std::max(values, std::abs(*value));
      // Round-off is that of the scene, not of a value that it is all of.
      if (!share && !words.scale.empty())
        if (const auto of_case = measure(*record, words.scale)) scale = std::max(scale, std::abs(*of_case));
      // Forces of one stop are what those of all others and of the loads leave.
      if (!share && !at_stops.empty())
        for (const auto& [other, of_other] : record->measures)
          if (other.starts_with(at_stops)) values = std::max(values, std::abs(of_other));
      scale = std::max(scale, values);
      point.floor = std::max(point.floor, 0x1p-52 * static_cast<double>(record->steps));
    }
    if (point.behind.empty())
      for (const CaseRecord* record : point.cases)
        if (const auto least = least_of(*record, measure_of_all)) {
          point.behind.push_back(record);
          point.values[{1, mesh_chosen ? 1 : study_.elements(*record).value_or(1)}][""] = *least;
        }
    point.floor *= counts ? 0 : share ? 1 : scale;
    largest_of_all = std::max(largest_of_all, scale);
    // Places are known beside the largest displacement.
    if (words.unit == "m")
      for (const CaseRecord* record : point.behind)
        largest_of_all = std::max(largest_of_all, measure(*record, "largest_tip_displacement").value_or(0));
    solves.push_back(counts ? 0 : of_solves * values);
    for (const auto& [size, value] : point.values)
      if (!point.finest || finer(size, *point.finest)) point.finest = size;
    if (!point.finest) {
      point.none = left_out(measure_of_all, point.cases).reasons.front().said();
      point.of_untouched_stop = std::all_of(point.cases.begin(), point.cases.end(), [&](const CaseRecord* one) {
        return answers::of_untouched_stop(measure_of_all, *one);
      });
    }
    out.push_back(std::move(point));
  }
  for (std::size_t k = 0; k < out.size(); ++k) {
    Point& point = out[k];
    point.errors = answers::errors_of(point.behind);
    if (!share) drop_round_off(point, largest_of_all);
    round_off.push_back(point.floor);
    if (point.floor > 0) point.floor = std::max(point.floor, solves[k]);
    point.floor = std::max(point.floor, resolution(measure_of_all, point, !steps_chosen));
    limits.push_back(point.finest ? std::optional(limits_at(point.values, *point.finest, point.floor, point.errors))
                                  : std::nullopt);
    if (const auto most = answers::bound_of(words, share, point.behind); most && limits.back())
      for (auto* one : {&limits.back()->step, &limits.back()->mesh})
        if (*one) bound_growth(**one, *most);
  }
  std::vector<Limit*> all;
  for (auto& one : limits)
    if (one && one->step) all.push_back(&*one->step);
  doubt_chance(all);
  for (std::size_t k = 0; k < out.size(); ++k)
    if (limits[k])
      out[k].estimate =
          estimate_of(out[k].values, out[k].halves, *out[k].finest, *limits[k], has_step && !steps_chosen);
  const bool draws = results().study.is_object() && is_drawn(results().study.value("scene", Json::object()));
  for (std::size_t k = 0; k < out.size(); ++k) {
    if (!out[k].estimate) continue;
    Estimate& one = *out[k].estimate;
    if (std::abs(one.value) <= round_off[k]) {
      one.value = 0;
      for (auto* left : {&one.step, &one.mesh})
        if (*left && **left <= 2 * round_off[k]) *left = 0;
    }
    one.beyond = least_of(*out[k].behind.front(), measure_of_all).has_value();
    // What other meshes would say is not known where they have no value.
    one.one_mesh = !mesh_chosen && one.meshes == 1 &&
                   std::any_of(out[k].cases.begin(), out[k].cases.end(), [&](const CaseRecord* record) {
                     return study_.elements(*record).value_or(1) != out[k].finest->second;
                   });
    one.one_instant = one.steps > 1 && one.step && has_one_instant(out[k]);
    one.one_draw = draws && one.seeds == 1 && !one.sampling && one.value != 0;
    // What nothing refines and nothing draws is known as it is.
    if (!one.has_step && !one.grows && !one.u()) one.step = out[k].floor;
  }
  return out;
}

LeftOut Evidence::left_out(const std::string& name, const Cases& cases) const {
  InOrderMet<std::string, LeftOut::Reason> groups;  // reasons that differ in numbers alone are one
  LeftOut out;
  for (const CaseRecord* record : cases) {
    if (record->status == Status::done && (told_measure(*record, name) || least_of(*record, name))) continue;
    ++out.count;
    std::string why, key;
    if (record->partial) {
      why = key = "still running";
    } else if (record->status == Status::done) {
      const std::string reason = answers::why_without(name, *record);
      why = key = "without a value" + (reason.empty() ? "" : ": " + reason);
    } else {
      const std::string reason = record->reason();
      why = record->excluded || reason.empty() ? reason : word(record->status) + (": " + reason);
      key = ending_key(*record);
    }
    LeftOut::Reason& group = groups[key];
    if (group.count++ == 0) group.text = why;
    group.alike = group.alike && group.text == why;
  }
  for (auto& [key, group] : std::move(groups).list()) {
    if (const std::size_t colon = group.text.find(": "); !group.alike && colon != std::string::npos)
      group.text.insert(colon, ", the first");
    out.reasons.push_back(std::move(group));
  }
  return out;
}

std::vector<std::string> LeftOut::told() const {
  constexpr std::size_t all_told = 3, most = 2;
  std::vector<Reason> sorted = reasons;
  std::vector<std::string> out;
  if (reasons.size() > all_told)
    std::stable_sort(sorted.begin(), sorted.end(), [](const Reason& a, const Reason& b) { return a.count > b.count; });
  const std::size_t shown = reasons.size() > all_told ? most : reasons.size();
  std::size_t rest = 0;
  for (std::size_t k = 0; k < sorted.size(); ++k)
    if (k < shown) {
      const std::string& text = sorted[k].text;
      const std::size_t colon = std::min(text.size(), text.find(": "));
      out.push_back(answers::with_reason(fmt::format("Left out: {} {}", sorted[k].count, text.substr(0, colon)),
                                         text.substr(std::min(text.size(), colon + 2))));
    } else {
      rest += sorted[k].count;
    }
  if (rest > 0)
    out.push_back(
        fmt::format("Left out: {} more for {} other reasons, which are in reasons.csv.", rest, sorted.size() - shown));
  return out;
}

std::string Evidence::level(const CaseRecord& record, const std::vector<std::string>& columns) const {
  return study_.words(record, columns);
}

namespace {

/// Which methods end with more energy than was brought in; "" where none does.
std::string energy_made(const Choices& study) {
  const StudyResults& results = study.results();
  const answers::MeasureLimits limits =
      answers::limits_of(study, "energy_left", answers::keeps_energy(results), all_cases(results));
  Cases firsts;
  Members making;
  double most = 0;
  for (const answers::Method& method : limits.methods) {
    if (method.gains) {
      making.push_back(firsts.size());
      for (const answers::Valued& one : method.done) most = std::max(most, one.value);
    }
    firsts.push_back(&method.first());
  }
  if (making.empty()) return "";
  const auto with = [&](const std::string& who) {
    return fmt::format("Energy is made with {}: it ends with up to {} times what was brought in.", who,
                       short_number(most, 2));
  };
  if (making.size() == firsts.size()) return with("every method");
  const std::string named = with(answers::SetNames(study, firsts).of(making));
  return fits(named) ? named : with(fmt::format("{} of {} methods", making.size(), firsts.size()));
}

/// That steps which do not divide the duration end the runs at times of their own; "" where all end together.
std::string ends_apart(const Choices& study) {
  if (!contains(study.results().columns, "step")) return "";
  constexpr double rounding = 1e-9;
  double first = INFINITY, last = 0, coarsest = 0;
  for (const CaseRecord& record : study.results().cases) {
    const auto step = study.step(record);
    if (is_reference(record) || record.status != Status::done || !step || record.steps == 0) continue;
    first = std::min(first, *step * static_cast<double>(record.steps));
    last = std::max(last, *step * static_cast<double>(record.steps));
    coarsest = std::max(coarsest, *step);
  }
  // What is left of a duration is less than a step.
  if (!(last - first > rounding * last) || last - first > coarsest) return "";
  constexpr int digits = 6;
  return fmt::format(
      "Steps that do not divide the duration end the runs at {} to {} s: values at the end are of these.",
      short_number(first, digits), short_number(last, digits));
}

}  // namespace

std::vector<std::string> Evidence::warnings() const {
  std::vector<std::string> out;
  if (auto untouched = answers::say_untouched(study_)) out.push_back(untouched->text);
  for (const answers::Sentence& refused : answers::refused_references(study_)) out.push_back(refused.text);
  if (const std::string made = energy_made(study_); !made.empty()) out.push_back(made);
  if (std::string apart = ends_apart(study_); !apart.empty()) out.push_back(std::move(apart));
  return out;
}

}  // namespace ricochet::asks
