#include "runners/asks/answer_asks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <sstream>

namespace ricochet::asks {

Verdict all_of(const std::vector<Verdict>& verdicts) {
  const auto has = [&](Verdict one) { return std::find(verdicts.begin(), verdicts.end(), one) != verdicts.end(); };
  if (has(Verdict::no)) return Verdict::no;
  return has(Verdict::open) || verdicts.empty() ? Verdict::open : Verdict::yes;
}

const TableType<VerdictRow>& verdicts_type() {
  static const TableType<VerdictRow> all = [] {
    RowType<VerdictRow> rows;
    rows.add({"ask", "1", "The ask, by its place in the study's list, from 1."}, &VerdictRow::ask)
        .add({"verb", "", "Its verb."}, &VerdictRow::verb)
        .add({"measure", "", "What the row speaks of: a measure, an axis."}, &VerdictRow::measure)
        .add({"level", "", "The levels of all choices in words; empty in the row of the whole answer."},
             &VerdictRow::level)
        .add({"stop", "", "The stop; empty where there is one, or none."}, &VerdictRow::stop)
        .add({"value", "", "The value, in `unit`."}, &VerdictRow::value)
        .add({"low", "", "Where it may be: from; empty where no interval is known."}, &VerdictRow::low)
        .add({"high", "", "Where it may be: to."}, &VerdictRow::high)
        .add({"unit", "", "Unit of these three."}, &VerdictRow::unit)
        .add({"verdict", "", "yes, no or open; of what has neither, what is found."}, &VerdictRow::verdict)
        .add({"reason", "", "Why it is open, or has no value."}, &VerdictRow::reason)
        .add({"cases", "1", "Cases behind it."}, &VerdictRow::cases)
        .add({"left_out", "1", "Cases that are not, with no value."}, &VerdictRow::left_out)
        .add({"sentence", "", "Of the whole answer: the sentence."}, &VerdictRow::sentence);
    return TableType<VerdictRow>{
        "verdicts", "What the study asks: one row for each answer, then one for each of its levels.", rows};
  }();
  return all;
}

std::vector<const Ask*> Asked::unmet() const {
  std::vector<const Ask*> out;
  for (const auto& [ask, answered] : all)
    if (ask.required() && answered.passes != Verdict::yes) out.push_back(&ask);
  return out;
}

Asked answer_asks(const std::vector<Ask>& asks, const Evidence& evidence, const OwnAnswers& own) {
  Asked out;
  if (asks.empty()) return out;
  out.first = evidence.warnings();
  for (const Ask& ask : asks) {
    const auto found = own.find(verb_of_kind(ask));
    Answered answered = found != own.end() ? found->second(ask, evidence)
                        : ask.verb->answer ? ask.verb->answer(ask, evidence)
                                           : Answered{};
    out.all.emplace_back(ask, std::move(answered));
  }
  return out;
}

Table verdicts_table(const Asked& asked) {
  std::vector<VerdictRow> rows;
  for (const auto& [ask, answered] : asked.all) {
    VerdictRow whole;
    whole.ask = ask.number;
    whole.verb = ask.verb->name;
    whole.measure = ask.verb->name == std::string("effect") ? ask.text("on") : ask.subject();
    whole.verdict = answered.verdict;
    whole.reason = answered.reason;
    whole.cases = answered.cases;
    whole.left_out = answered.left_out;
    whole.sentence = answered.sentence;
    rows.push_back(std::move(whole));
    for (VerdictRow row : answered.rows) {
      row.ask = ask.number;
      row.verb = ask.verb->name;
      rows.push_back(std::move(row));
    }
  }
  return verdicts_type().with(rows);
}

}  // namespace ricochet::asks
