#include "runners/asks/kind_verbs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ricochet/measure/orbits/regime.hpp>

#include "runners/answers/set_names.hpp"
#include "runners/asks/verbs.hpp"
#include "runners/json/json_text.hpp"
#include "runners/store/record.hpp"
#include "runners/table/in_order_met.hpp"

// Verbs that kinds of study answer: what they are, here; what answers them, in the kinds.
namespace ricochet::asks {

const Verb& cheapest_verb() {
  static const Verb verb{
      "cheapest",
      "Which method reaches an error for the least time.",
      {keys::of_form(Field::Form::text, "cheapest", std::nullopt, "The error."),
       keys::of_form(Field::Form::share, "within", std::nullopt, "The error to reach, as a share of the reference.")},
      "only one that times methods against a reference can: kind work-precision"};
  return verb;
}

const Verb& order_verb() {
  static const Verb verb{"order",
                         "Which order of convergence an error has.",
                         {keys::of_form(Field::Form::text, "order", std::nullopt, "The error.")},
                         "only one that has a reference can: kind convergence"};
  return verb;
}

const Verb& motions_verb() {
  static const Verb verb{"motions",
                         "Which motions there are, where they change, and their shares.",
                         {keys::of_form(Field::Form::text, "motions", std::nullopt,
                                        "The parameter of a sweep, or \"share\" of the starts of basins.")},
                         "only one that finds motions can: kinds bifurcation and basins",
                         {},
                         [](const Ask&, const Study& study) { return too_short_to_judge(study.resolved); }};
  return verb;
}

const Verb& points_verb() {
  static const Verb verb = [] {
    Field kinds =
        keys::of_form(Field::Form::words, "points", std::nullopt, "Kinds of special points; \"all\": every kind.");
    return Verb{"points",
                "Where branches touch, fold and change their stability.",
                {std::move(kinds)},
                "only one that follows orbits can: kind continuation"};
  }();
  return verb;
}

const Verb& steps_verb() {
  static const Verb verb{"steps",
                         "Which step is allowed, and what bounds it.",
                         {keys::word("steps", {"limit"}, std::nullopt, "\"limit\".")},
                         "only one of kind stability can"};
  return verb;
}

std::string too_short_to_judge(const Json& resolved) {
  if (!resolved.contains("keep")) return "";
  const int kept = resolved.at("keep").get<int>();
  if (kept >= zero_one_readings || resolved.value("exponents", 0) > 0) return "";
  return fmt::format("{} kept periods{} leave undecided whatever does not repeat; {} tell regular from chaotic", kept,
                     resolved.contains("exponents") ? " without an exponent" : "", zero_one_readings);
}

void warn_too_short(Answered& out, const Json& resolved) {
  if (const std::string why = too_short_to_judge(resolved); !why.empty()) out.aside.push_back(why + ".");
}

std::string fitting(const std::vector<std::string>& sentences) {
  for (const std::string& one : sentences)
    if (fits(one)) return one;
  return sentences.back();
}

Ask ask_at(const Json& keys, const std::string& pointer) {
  const Json::json_pointer place(pointer);
  return ask_of(keys, std::stoul(place.parent_pointer().back()) + 1);
}

std::function<void(const Json&, const std::string&, const std::string&)> measures_alone(
    const std::vector<MeasureInfo>& measures) {
  std::vector<std::string> names;
  for (const MeasureInfo& one : measures)
    if (std::find(names.begin(), names.end(), one.name) == names.end()) names.emplace_back(one.name);
  return [names](const Json&, const std::string& measure, const std::string& pointer) {
    if (std::find(names.begin(), names.end(), measure) == names.end())
      throw InputError(pointer, "cases of this kind have no measure " + quote(measure) +
                                    (measure_info(measure) ? ", which other kinds have" : "") + "; expected one of " +
                                    quoted_list(names) + did_you_mean(measure, names));
  };
}

void refuse_stops(const Ask& ask) {
  if (ask.has("stops"))
    throw InputError(ask.pointer("stops"),
                     quote(std::string(ask.verb->name)) + " speaks of no single stop; leave it out");
}

void leave_out(Answered& out, const Cases& left) {
  InOrderMet<std::string, LeftOut::Reason> groups;
  for (const CaseRecord* one : left) {
    LeftOut::Reason& group = groups[ending_key(*one)];
    if (group.count++ > 0) continue;
    const bool done = one->status == Status::done;
    group.text = std::string(one->partial ? "still running"
                             : done       ? "without a result"
                                          : word(one->status)) +
                 (done || one->reason().empty() ? "" : ": " + one->reason());
  }
  LeftOut all;
  for (auto& [key, group] : std::move(groups).list()) all.reasons.push_back(std::move(group));
  for (std::string& line : all.told()) out.aside.push_back(std::move(line));
  out.left_out = left.size();
}

Answered runs_of_places(const Ask& ask, const Evidence& evidence, const std::string& name,
                        const std::function<Places(const CaseRecord&)>& places) {
  Answered out = runs_verb().answer(ask, evidence);
  Places sum;
  for (const CaseRecord* record : evidence.cases(ask)) {
    const Places own = places(*record);
    sum.all += own.all;
    for (const auto& [status, count] : own.ended) sum.ended[status] += count;
  }
  std::size_t ended = 0;
  std::vector<std::string> counts;
  for (const auto& [status, count] : sum.ended) {
    VerdictRow row;
    row.level = name + " " + status;
    row.value = static_cast<double>(count);
    row.unit = "1";
    row.verdict = status;
    out.rows.push_back(std::move(row));
    counts.push_back(fmt::format("{} {}", count, status));
    ended += count;
  }
  if (ended == 0) return out;
  const std::string told = fmt::format("of their {} {}, {}", sum.all, name, answers::and_list(counts));
  const bool refused = sum.ended.size() == 1 && sum.ended.contains(word(Status::refused));
  if (out.passes == Verdict::yes) {
    out.passes = refused ? Verdict::open : Verdict::no;
    out.verdict = refused ? "some refused" : "no";
    out.sentence = fmt::format("{} of {} cases run; {}.", out.cases, out.cases, told);
  } else {
    out.sentence.pop_back();
    out.sentence = fitting({fmt::format("{}; {}.", out.sentence, told), out.sentence + "."});
  }
  return out;
}

}  // namespace ricochet::asks
