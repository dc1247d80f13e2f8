#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/asks/bounds.hpp"
#include "runners/asks/lines.hpp"
#include "runners/asks/verbs.hpp"
#include "runners/json/json_text.hpp"

namespace ricochet::asks {
namespace {

using Marked = std::vector<const Line*>;

/// "below 3 mm and above 1 mm", and both as the figure draws them.
std::pair<std::string, std::vector<double>> range_of(const Lines& lines, const Bounds& bounds) {
  std::vector<double> at;
  std::string text;
  if (bounds.below) {
    at.push_back(*bounds.below * lines.words.factor);
    text = "below " + lines.given(*bounds.below);
  }
  if (bounds.above) {
    at.push_back(*bounds.above * lines.words.factor);
    text += (text.empty() ? "" : " and ") + ("above " + lines.given(*bounds.above));
  }
  return {text, at};
}

/// The one with the least room to a bound, or the farthest beyond.
const Line& nearest(const Marked& list, const Bounds& bounds) {
  const auto margin = [&](const Line* line) {
    const double v = line->estimate().value;
    return bounds.below ? *bounds.below - v : v - *bounds.above;
  };
  return **std::min_element(list.begin(), list.end(),
                            [&](const Line* a, const Line* b) { return margin(a) < margin(b); });
}

std::string kept_sentence(const Lines& lines, const Line& worst, const Bounds& bounds, const std::string& range) {
  const bool plural = is_plural(lines.words.words);
  const char* at_most = lines.all.size() == 1 ? "" : bounds.below ? "at most " : "at least ";
  return in_thirty_words(fmt::format("Yes: {} {} {}; {} {}{}", lines.words.words, plural ? "stay" : "stays", range,
                                     plural ? "they are" : "it is", at_most, lines.text(worst.estimate())),
                         {{worst.place()}});
}

std::string broken_sentence(const Lines& lines, const Marked& no, std::size_t judged, const Line& worst,
                            const std::string& range, const std::string& seeds) {
  const bool plural = is_plural(lines.words.words), some = no.size() < judged;
  const std::string where = set_name(lines, no);
  const std::string in_these = !some           ? ""
                               : where.empty() ? fmt::format(" in {} of {}", no.size(), judged)
                                               : " " + where;
  return in_thirty_words(fmt::format("No: {} {} not {}{}; {} {}", lines.words.words, plural ? "are" : "is", range,
                                     in_these, plural ? "they are" : "it is", lines.text(worst.estimate())),
                         {{no.size() == 1 ? "" : worst.place()}, {seeds.empty() ? "" : ", and " + seeds}});
}

/// Reason and sentence.
void say_open(Answered& out, const Lines& lines, const Marked& open, std::size_t judged, const Bounds& bounds,
              const std::string& range) {
  const bool plural = is_plural(lines.words.words);
  const auto known = std::find_if(open.begin(), open.end(), [](const Line* line) { return line->known(); });
  const Line& first = known == open.end() ? *open.front() : **known;
  out.reason = why_open(first, bounds);
  const std::string which = open.size() < judged ? fmt::format(" in {} of {}", open.size(), judged) : "";
  const std::string found =
      first.known() ? (plural ? "they are " : "it is ") + lines.text(first.estimate()) : "no value";
  out.sentence = in_thirty_words(
      fmt::format("Open{}: whether {} {} {} is not told", which, lines.words.words, plural ? "stay" : "stays", range),
      {{"; " + found + first.place(), "; " + found}, {": " + out.reason, ": " + short_reason(out.reason)}});
}

Answered answer_limit(const Ask& ask, const Evidence& evidence) {
  const Lines lines = lines_of(ask, evidence, ask.subject(), true);
  Answered out = begin_answer(lines);
  const Bounds bounds{ask.real("below"), ask.real("above")};
  Marked yes, no, open;
  const bool any_applies = lines.any_applies();
  for (const Line& line : lines.all) {
    VerdictRow row = lines.row(line);
    const Kept found = kept(line, bounds);
    const Verdict verdict = found.verdict;
    row.verdict = word(verdict);
    if (verdict == Verdict::no && row.reason.empty()) row.reason = beyond_text(found);
    if (verdict == Verdict::open && row.reason.empty()) row.reason = why_open(line, bounds);
    out.rows.push_back(std::move(row));
    // What is refused is left out by name, and of what is never touched there is nothing to tell.
    if (verdict == Verdict::yes ? line.known() : line.applies() || !any_applies)
      (verdict == Verdict::yes ? yes : verdict == Verdict::no ? no : open).push_back(&line);
  }
  const auto [range, at] = range_of(lines, bounds);
  out.figure = bars(lines, at);
  VerdictRow limit;
  limit.level = "the limit";
  limit.unit = lines.words.unit;
  limit.given = true;
  for (const double one : at) {
    limit.value = one;
    out.rows.push_back(limit);
  }
  const std::size_t judged = yes.size() + no.size() + open.size();
  // A limit that is broken anywhere is broken.
  out.passes = !no.empty() ? Verdict::no : open.empty() && !yes.empty() ? Verdict::yes : Verdict::open;
  out.verdict = word(*out.passes);
  if (*out.passes == Verdict::yes)
    out.sentence = kept_sentence(lines, nearest(yes, bounds), bounds, range);
  else if (*out.passes == Verdict::no)
    out.sentence =
        broken_sentence(lines, no, judged, nearest(no, bounds), range, beyond_text(kept(nearest(no, bounds), bounds)));
  else if (auto without = without_values(lines, out))
    return *without;
  else
    say_open(out, lines, open, judged, bounds, range);
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
      doubt_of_values,
      answer_limit};
  return verb;
}

}  // namespace ricochet::asks
