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

/// Why the interval of a value that is settled may not hold; "" where nothing speaks against it.
std::string why_unsure(const Line& line) {
  const Estimate& one = line.estimate();
  if (!one.unknown().empty()) return one.unknown();
  return doubtful(line.point) ? "is of doubtful runs" : one.two || one.disproved ? one.few : "";
}

Answered answer_value(const Ask& ask, const Evidence& evidence) {
  const Lines lines = lines_of(ask, evidence, ask.subject());
  Answered out = begin_answer(lines);
  const std::string name = answers::capitalised(lines.words.words);
  const std::vector<const Line*> known = lines.known();
  std::size_t unsettled = 0, without = 0;
  for (const Line& line : lines.all) {
    VerdictRow row = lines.row(line);
    row.verdict = !line.known()                     ? "no value"
                  : !line.estimate().motion.empty() ? "not settled"
                  : !why_unsure(line).empty()       ? "open"
                                                    : "known";
    if (row.reason.empty() && line.known())
      row.reason = !line.estimate().motion.empty()                                  ? line.estimate().motion
                   : line.estimate().unknown().empty() && !why_unsure(line).empty() ? "it " + why_unsure(line)
                                                                                    : why_unsure(line);
    unsettled += row.verdict == "not settled";
    without += row.verdict == "open";
    out.rows.push_back(std::move(row));
  }
  out.figure = bars(lines);
  if (auto open = without_values(lines, out, false)) return *open;
  const bool all_known =
      std::all_of(lines.all.begin(), lines.all.end(), [](const Line& line) { return line.known() || !line.applies(); });
  out.passes = unsettled + without == 0 && all_known ? Verdict::yes : Verdict::open;
  out.verdict = unsettled > 0 ? "not settled" : without > 0 ? "open" : "known";
  constexpr std::size_t few = 3;
  // Of thirty some are left for what is not settled.
  const std::ptrdiff_t most_words_of_values = unsettled + without > 0 ? 20 : 28;
  std::vector<std::string> parts;
  for (const Line* line : known) parts.push_back(told(lines, line->estimate()) + line->place());
  std::string said = fmt::format("{}: {}", name, fmt::join(parts, ", "));
  std::vector<std::string> places;
  if (known.size() > few || (known.size() > 1 && words_in(said) > most_words_of_values)) {
    const auto by_value = [](const Line* a, const Line* b) { return a->estimate().value < b->estimate().value; };
    const Line &least = **std::min_element(known.begin(), known.end(), by_value),
               &most = **std::max_element(known.begin(), known.end(), by_value);
    const std::string low = told(lines, least.estimate()), high = told(lines, most.estimate());
    said = low == high ? fmt::format("{}: {} in {}", name, low, all_text(known.size()))
                       : fmt::format("{}: from {} to {}", name, low, high);
    if (low != high)
      places = {fmt::format(" (least{}, most{})", least.place(), most.place()), fmt::format(" (most{})", most.place())};
  }
  std::vector<std::vector<std::string>> rest = {places};
  if (unsettled > 0) {
    const Line* first =
        *std::find_if(known.begin(), known.end(), [](const Line* l) { return !l->estimate().motion.empty(); });
    out.reason = first->estimate().motion;
    const bool alike = std::all_of(known.begin(), known.end(), [&](const Line* l) {
      return l->estimate().motion.empty() || l->estimate().motion == out.reason;
    });
    said += unsettled < known.size() ? fmt::format("; {} of {} not settled", unsettled, known.size())
            : alike                  ? "; not settled: it " + out.reason
                                     : "; none is settled";
  } else if (without > 0) {
    const Line& first =
        **std::find_if(known.begin(), known.end(), [](const Line* l) { return !why_unsure(*l).empty(); });
    out.reason = why_unsure(first);
    const Estimate& one = first.estimate();
    const std::string doubt = one.has_step && !one.step ? "; what the step leaves open is not known"
                              : !one.unknown().empty()  ? "; " + one.unknown()
                              : known.size() == 1       ? "; it " + out.reason
                              : without == known.size()
                                  ? "; each " + out.reason
                                  : fmt::format("; in {} of {} it {}", without, known.size(), out.reason);
    // Where these are comes before it, and goes first.
    rest = {{}};
    for (const std::string& where : places) rest.front().push_back(where + doubt);
    rest.front().push_back(doubt);
  }
  out.sentence = in_thirty_words(said, rest);
  return out;
}

std::string doubt_value(const Ask&, const Study& study) {
  const Planned plan = planned(study);
  return plan.steps == 1 ? "one step only: its interval holds nothing of the step"
         : plan.one_draw ? "one seed of a random load: its interval holds nothing of other draws"
                         : "";
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
