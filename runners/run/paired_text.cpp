// Two results beside each other, as a terminal, a table and a program read them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/report/html.hpp"
#include "runners/run/asked_text.hpp"
#include "runners/run/pair_results.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

using asks::VerdictRow;

constexpr std::size_t most_values = 12, most_asks = 4;

/// Only-in-one rows last, then what changed most over u.
std::vector<const PairedValue*> by_change(const PairedResults& pairs) {
  std::vector<const PairedValue*> out;
  for (const PairedValue& one : pairs.values)
    if (one.change != PairChange::equal && one.has_values()) out.push_back(&one);
  const auto rank = [](const PairedValue& one) {
    return one.change == PairChange::beyond        ? 0
           : one.change == PairChange::no_interval ? 1
           : one.change == PairChange::within      ? 2
                                                   : 3;
  };
  const auto size = [](const PairedValue& one) {
    return one.difference && one.u && *one.u > 0 ? std::abs(*one.difference) / *one.u : 0;
  };
  std::stable_sort(out.begin(), out.end(), [&](const PairedValue* one, const PairedValue* other) {
    return std::pair(rank(*one), -size(*one)) < std::pair(rank(*other), -size(*other));
  });
  return out;
}

std::string said(const PairedValue& value, const std::optional<VerdictRow>& row) {
  return !row ? "" : value.in_words ? row->verdict : value_cell(*row);
}

std::string asks_text(const PairedResults& pairs) {
  std::string out;
  std::size_t same = 0, told = 0;
  for (const PairedAsk& one : pairs.asks) {
    const bool equal = one.a && one.b && one.a->sentence == one.b->sentence;
    same += equal;
    if (equal || ++told > most_asks) continue;
    if (one.a) out += "  A: " + one.a->sentence + "\n";
    if (one.b) out += "  B: " + one.b->sentence + "\n";
  }
  if (told > most_asks) out += fmt::format("  {} more on the page\n", told - most_asks);
  return fmt::format("asks: {} of {} with the same answer\n", same, pairs.asks.size()) + out;
}

std::string values_text(const PairedResults& pairs) {
  std::string out = "values: " + counts_line(pairs) + "\n";
  const std::vector<const PairedValue*> rows = by_change(pairs);
  TextTable table({"of", "stop", "level", "unit", "A", "B", ""});
  std::set<std::vector<std::string>> met;  // asks tell the same value more than once
  std::size_t told = 0;
  for (const PairedValue* one : rows) {
    const VerdictRow& any = one->any();
    std::vector<std::string> line{answers::measure_words(any.measure).words,
                                  any.stop,
                                  any.level,
                                  any.unit == "1" ? "" : any.unit,
                                  said(*one, one->a),
                                  said(*one, one->b),
                                  word(one->change)};
    if (met.insert(line).second && ++told <= most_values) table.add(std::move(line));
  }
  if (told > 0) out += table.text(2);
  if (told > most_values) out += fmt::format("  {} more on the page\n", told - most_values);
  return out;
}

nlohmann::ordered_json about(const StudyResults& results) {
  nlohmann::ordered_json out{{"name", results.name}, {"kind", results.kind}, {"cases", results.cases.size()}};
  for (const auto& [name, value] : results.environment.entries) out["environment"][name] = value;
  return out;
}

}  // namespace

std::string counts_line(const PairedResults& pairs) {
  std::string out;
  for (const PairChange one : {PairChange::beyond, PairChange::within, PairChange::no_interval, PairChange::equal,
                               PairChange::only_a, PairChange::only_b}) {
    const std::size_t count = pairs.count(one);
    if (count > 0) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", count, word(one));
  }
  return out.empty() ? "none" : out;
}

namespace {

/// How many numbers changed beyond u; "" where none is in both.
std::string numbers_changed(const PairedResults& pairs) {
  const auto count = [&](PairChange change) { return pairs.count(change, false); };
  const std::size_t beyond = count(PairChange::beyond), bare = count(PairChange::no_interval),
                    both = beyond + bare + count(PairChange::within) + count(PairChange::equal);
  if (both == 0) return "";
  std::string out = beyond > 0 ? fmt::format("{} of {} changed by more than the two uncertainties together", beyond,
                                             report::count_text(both, "value", "values"))
                               : fmt::format("No value is known to have changed, of {} in both", both);
  if (bare > 0)
    out += fmt::format("; of {} that differ{} this cannot be told, without an interval", bare, bare == 1 ? "s" : "");
  return out + ".";
}

/// In how many places the motion is another one; "" where none is in both.
std::string words_changed(const PairedResults& pairs) {
  const auto count = [&](PairChange change) { return pairs.count(change, true); };
  const std::size_t beyond = count(PairChange::beyond), open = count(PairChange::no_interval),
                    both = beyond + open + count(PairChange::equal);
  if (both == 0) return "";
  std::string out =
      fmt::format("The motion of {} of {} is another one", beyond, report::count_text(both, "orbit", "orbits"));
  if (open > 0) out += fmt::format("; {} {} undecided in one of the two", open, open == 1 ? "is" : "are");
  return out + ".";
}

}  // namespace

std::string paired_verdict(const PairedResults& pairs) {
  const std::size_t only = pairs.count(PairChange::only_a) + pairs.count(PairChange::only_b),
                    both = pairs.values.size() - only;
  if (both == 0) return "No value is in both.";
  if (pairs.count(PairChange::equal) == both && only == 0) return "Nothing changed: every value is equal.";
  const std::string words = words_changed(pairs), numbers = numbers_changed(pairs);
  return words + (words.empty() || numbers.empty() ? "" : " ") + numbers;
}

std::string paired_text(const PairedResults& pairs, const AnalysedResults& a, const AnalysedResults& b) {
  return facts_text(pairs.facts, a, b) + asks_text(pairs) + values_text(pairs) + paired_verdict(pairs) + "\n";
}

Table paired_table(const PairedResults& pairs) {
  Table table{"pair",
              "Two results beside each other. A row is a fact that differs, or a value of one or both.",
              {{"table", "", "study, environment, or the table that the value is of: verdicts, limits, uncertainty."},
               {"of", "", "JSON pointer, entry of the environment, or the ask; empty of other values."},
               {"measure", "", "The measure."},
               {"level", "", "The levels of all choices in words."},
               {"stop", "", "The stop."},
               {"unit", "", "Unit of the numbers."},
               {"a", "", "In A."},
               {"a_low", "", "Where that may be: from."},
               {"a_high", "", "To."},
               {"b", "", "In B."},
               {"b_low", "", "Where that may be: from."},
               {"b_high", "", "To."},
               {"difference", "", "b − a."},
               {"u", "", "Sum of the half intervals that face each other."},
               {"a_verdict", "", "The verdict in A."},
               {"b_verdict", "", "The verdict in B."},
               {"change", "",
                "equal; within u; changed: |b − a| > u; no interval: they differ and one has none; only in A; only in "
                "B; differs: of a fact."}},
              {}};
  for (const auto& [part, changes] :
       {std::pair("study", &pairs.facts.inputs), {"environment", &pairs.facts.environment}})
    for (const ChangedText& one : *changes) {
      Row row(table.columns.size());
      row[0] = part;
      row[1] = one.where;
      row[6] = one.a;
      row[9] = one.b;
      row.back() = "differs";
      table.rows.push_back(std::move(row));
    }
  for (const PairedValue& one : pairs.values) {
    const VerdictRow &any = one.any(), none, &a = one.a ? *one.a : none, &b = one.b ? *one.b : none;
    const auto text = [](const std::string& words) { return words.empty() ? Cell() : Cell(words); };
    table.rows.push_back({one.table, text(one.of), any.measure, text(any.level), text(any.stop), text(any.unit),
                          a.value, a.low, a.high, b.value, b.low, b.high, one.difference, one.u, text(a.verdict),
                          text(b.verdict), word(one.change)});
  }
  return table;
}

nlohmann::ordered_json paired_json(const PairedResults& pairs, const AnalysedResults& a, const AnalysedResults& b) {
  nlohmann::ordered_json counts;
  for (const PairChange one : {PairChange::equal, PairChange::within, PairChange::beyond, PairChange::no_interval,
                               PairChange::only_a, PairChange::only_b})
    counts[word(one)] = pairs.count(one);
  return {{"a", about(a)}, {"b", about(b)}, {"counts", counts}, {"rows", rows_as_json(paired_table(pairs))}};
}

}  // namespace ricochet
