#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/asks/lines.hpp"
#include "runners/asks/verbs.hpp"
#include "runners/json/json_text.hpp"

namespace ricochet::asks {
namespace {

struct Bounds {
  std::optional<double> below, above;  // in the unit of the measure
  bool holds(double value) const { return (!below || value < *below) && (!above || value > *above); }
};

/// Yes where the interval and each draw hold; no where the interval, or a draw with what refinement leaves of it, is
/// beyond.
Verdict verdict_of(const Line& line, const Bounds& bounds) {
  if (!line.known()) return Verdict::open;
  const Estimate& one = line.estimate();
  if (!one.has_interval()) return Verdict::open;
  const double refinement = one.step.value_or(0) + one.mesh.value_or(0);
  bool all = bounds.holds(one.low()) && bounds.holds(one.high()), beyond = false;
  const auto surely_beyond = [&](double value, double u) {
    return (bounds.below && value - u >= *bounds.below) || (bounds.above && value + u <= *bounds.above);
  };
  beyond = surely_beyond(one.value, *one.u());
  for (const auto& [seed, value] : line.point.values.at(*line.point.finest)) {
    all = all && bounds.holds(value - refinement) && bounds.holds(value + refinement);
    beyond = beyond || surely_beyond(value, refinement);
  }
  return beyond ? Verdict::no : all ? Verdict::yes : Verdict::open;
}

Answered answer_limit(const Ask& ask, const Evidence& evidence) {
  const Lines lines = lines_of(ask, evidence, ask.subject(), true);
  Answered out = begin_answer(lines);
  const Bounds bounds{ask.real("below"), ask.real("above")};
  std::vector<Verdict> verdicts;
  std::vector<const Line*> yes, no, open;
  for (const Line& line : lines.all) {
    VerdictRow row = lines.row(line);
    const Verdict verdict = verdict_of(line, bounds);
    row.verdict = word(verdict);
    if (verdict == Verdict::open && row.reason.empty()) row.reason = "the limit lies within its interval";
    out.rows.push_back(std::move(row));
    verdicts.push_back(verdict);
    (verdict == Verdict::yes ? yes : verdict == Verdict::no ? no : open).push_back(&line);
  }
  std::vector<double> at;
  std::string range;
  if (bounds.below) at.push_back(*bounds.below * lines.words.factor), range = "below " + lines.number(*bounds.below);
  if (bounds.above)
    at.push_back(*bounds.above * lines.words.factor),
        range += (range.empty() ? "" : " and ") + ("above " + lines.number(*bounds.above));
  out.figure = bars(lines, at);
  VerdictRow limit;
  limit.level = "the limit";
  limit.unit = lines.words.unit;
  for (const double one : at) limit.value = one, out.rows.push_back(limit);
  // A limit that is broken anywhere is broken.
  out.passes = !no.empty() ? Verdict::no : open.empty() && !yes.empty() ? Verdict::yes : Verdict::open;
  out.verdict = word(*out.passes);
  const std::string name = lines.words.words;
  const bool plural = is_plural(name);
  const auto margin = [&](const Line* line) {
    const double v = line->estimate().value;
    return bounds.below ? *bounds.below - v : v - *bounds.above;
  };
  const auto nearest = [&](const std::vector<const Line*>& list) {
    return **std::min_element(list.begin(), list.end(),
                              [&](const Line* a, const Line* b) { return margin(a) < margin(b); });
  };
  if (*out.passes == Verdict::yes) {
    const Line worst = nearest(yes);
    const char* at_most = lines.all.size() == 1 ? "" : bounds.below ? "at most " : "at least ";
    out.sentence = in_thirty_words(fmt::format("Yes: {} {} {}; {} {}{}", name, plural ? "stay" : "stays", range,
                                               plural ? "they are" : "it is", at_most, lines.text(worst.estimate())),
                                   {{worst.place()}});
  } else if (*out.passes == Verdict::no) {
    const Line worst = nearest(no);
    const std::string where = set_name(lines, no);
    const bool some = no.size() < lines.all.size();
    const std::string in_these = !some           ? ""
                                 : where.empty() ? fmt::format(" in {} of {}", no.size(), lines.all.size())
                                                 : " " + where;
    out.sentence = in_thirty_words(fmt::format("No: {} {} not {}{}; {} {}", name, plural ? "are" : "is", range,
                                               in_these, plural ? "they are" : "it is", lines.text(worst.estimate())),
                                   {{no.size() == 1 ? "" : worst.place()}});
  } else if (auto without = open_without_values(lines, out)) {
    return *without;
  } else {
    std::vector<const Line*> known;
    for (const Line* line : open)
      if (line->known()) known.push_back(line);
    const Line* first = known.empty() ? open.front() : known.front();
    out.reason = first->known() ? (first->estimate().unknown().empty() ? "the limit lies within its interval"
                                                                       : first->estimate().unknown())
                                : first->point.none;
    const std::string which =
        open.size() < lines.all.size() ? fmt::format(" in {} of {}", open.size(), lines.all.size()) : "";
    const std::string found =
        first->known() ? (plural ? "they are " : "it is ") + lines.text(first->estimate()) : "no value";
    out.sentence = in_thirty_words(
        fmt::format("Open{}: whether {} {} {} is not told", which, name, plural ? "stay" : "stays", range),
        {{"; " + found + first->place(), "; " + found}, {": " + out.reason, ": " + short_reason(out.reason)}});
  }
  return out;
}

void check_limit(const Ask& ask, const Study& study) {
  check_subject(ask, study);
  const auto below = ask.real("below"), above = ask.real("above");
  if (!below && !above) throw InputError(ask.pointer(), "a limit needs \"below\" or \"above\"");
  if (below && above && *above >= *below)
    throw InputError(ask.pointer("above"), fmt::format("nothing is above {:g} and below {:g}", *above, *below));
}

}  // namespace

const Verb& limit_verb() {
  static const Verb verb{
      "limit",
      "Whether a measure stays below a value, or above one.",
      {keys::of_form(Field::Form::text, "limit", std::nullopt, "The measure."),
       keys::quiet(keys::optional(keys::real("below", "", keys::any, std::nullopt, "In the measure's unit."))),
       keys::quiet(keys::optional(keys::real("above", "", keys::any, std::nullopt, "In the measure's unit.")))},
      "",
      check_limit,
      doubt_of_one_step,
      answer_limit};
  return verb;
}

}  // namespace ricochet::asks
