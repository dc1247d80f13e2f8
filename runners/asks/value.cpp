#include <fmt/format.h>

#include <algorithm>

#include "runners/asks/lines.hpp"
#include "runners/asks/verbs.hpp"

namespace ricochet::asks {
namespace {

/// "1.44 ± 0.13 mW", and what else must be said of it.
std::string told(const Lines& lines, const Estimate& one) {
  std::string out = lines.text(one);
  if (one.seeds > 1) out += fmt::format(" (mean of {} seeds)", one.seeds);
  return out;
}

Answered answer_value(const Ask& ask, const Evidence& evidence) {
  const Lines lines = lines_of(ask, evidence, ask.subject());
  Answered out = begin_answer(lines);
  const std::string name = answers::capitalised(lines.words.words);
  const std::vector<const Line*> known = lines.known();
  std::size_t unsettled = 0, without = 0;
  for (const Line& line : lines.all) {
    VerdictRow row = lines.row(line);
    row.verdict = !line.known()                        ? "no value"
                  : !line.estimate().motion.empty()    ? "not settled"
                  : !line.estimate().unknown().empty() ? "open"
                                                       : "known";
    if (row.reason.empty() && line.known()) row.reason = line.estimate().motion;
    unsettled += row.verdict == "not settled";
    without += row.verdict == "open";
    out.rows.push_back(std::move(row));
  }
  out.figure = bars(lines);
  if (known.empty()) {
    out.verdict = "no value";
    out.reason = nothing_known(lines);
    out.sentence = fmt::format("No case has a value of {}: {}.", lines.words.words, out.reason);
    return out;
  }
  out.passes = unsettled + without == 0 && known.size() == lines.all.size() ? Verdict::yes : Verdict::open;
  out.verdict = unsettled > 0 ? "not settled" : without > 0 ? "open" : "known";
  constexpr std::size_t few = 3;
  std::string said;
  std::vector<std::vector<std::string>> rest;
  if (known.size() <= few) {
    std::vector<std::string> parts;
    for (const Line* line : known) parts.push_back(told(lines, line->estimate()) + line->place());
    said = fmt::format("{}: {}", name, fmt::join(parts, ", "));
  } else {
    const auto by_value = [](const Line* a, const Line* b) { return a->estimate().value < b->estimate().value; };
    const Line &least = **std::min_element(known.begin(), known.end(), by_value),
               &most = **std::max_element(known.begin(), known.end(), by_value);
    const std::string low = told(lines, least.estimate()), high = told(lines, most.estimate());
    said = low == high ? fmt::format("{}: {} in {}", name, low, all_text(known.size()))
                       : fmt::format("{}: from {} to {}", name, low, high);
    if (low != high)
      rest = {{fmt::format(" (least{}, most{})", least.place(), most.place()), fmt::format(" (most{})", most.place())}};
  }
  if (unsettled > 0) {
    const Line* first =
        *std::find_if(known.begin(), known.end(), [](const Line* l) { return !l->estimate().motion.empty(); });
    out.reason = first->estimate().motion;
    said += unsettled == known.size() ? "; not settled: it " + out.reason
                                      : fmt::format("; {} of {} not settled", unsettled, known.size());
  } else if (without > 0) {
    out.reason = known.front()->estimate().unknown();
    said += "; what the step leaves open is not known";
  }
  out.sentence = in_thirty_words(said, rest);
  return out;
}

std::string doubt_value(const Ask&, const Study& study) {
  const Planned plan = planned(study);
  return plan.steps == 1 ? "one step only: its interval holds nothing of the step" : "";
}

}  // namespace

const Verb& value_verb() {
  static const Verb verb{"value",
                         "What a measure is, for each stop and level.",
                         {keys::of_form(Field::Form::text, "value", std::nullopt, "The measure.")},
                         "",
                         check_subject,
                         doubt_value,
                         answer_value};
  return verb;
}

}  // namespace ricochet::asks
