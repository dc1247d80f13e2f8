// What two results folders have differently, as a person reads it and as a table.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "runners/report/choices.hpp"
#include "runners/report/html.hpp"
#include "runners/run/compare_studies.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

using report::count_text;

// Together they fill a screen and no more.
constexpr std::size_t most_inputs = 6, most_environment = 3, most_cases = 3, most_measures = 8, most_lines = 2;
constexpr std::size_t longest_words = 60;

/// Cut where it is long; the table has all of it.
std::string brief_text(const std::string& text) {
  if (text.empty()) return "(none)";
  if (text.size() <= longest_words) return text;
  std::size_t end = longest_words - 3;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end) + "…";
}

template <class List, class Line>
std::string lines_of(const List& list, std::size_t most, Line line) {
  std::string out;
  for (std::size_t k = 0; k < std::min(most, list.size()); ++k) out += "  " + line(list[k]) + "\n";
  if (list.size() > most) out += fmt::format("  {} more: --table\n", list.size() - most);
  return out;
}

std::string changed_text(const std::vector<ChangedText>& changes, std::size_t most) {
  return lines_of(changes, most, [](const ChangedText& one) {
    return fmt::format("{}: {} → {}", one.where, brief_text(one.a), brief_text(one.b));
  });
}

std::string shown_status(const CaseRecord& record) {
  return record.partial ? "under way" : word(record.status);
}

std::string cases_text(const StudyComparison& found, const StudyResults& a, const StudyResults& b) {
  const std::vector<CasePair> changed = found.status_changes();
  std::string out = fmt::format("cases: {} in both{}, {} only in A, {} only in B, {} with another status\n",
                                found.pairs.size(), found.by_id ? "" : " (by their parameters: the ids differ)",
                                found.only_a.size(), found.only_b.size(), changed.size());
  const auto named = [](const Choices& choices, const char* which) {
    return [&choices, which](const CaseRecord* record) {
      return fmt::format("only in {}: {} ({})", which, record->id, brief_text(choices.short_name(*record)));
    };
  };
  const Choices view_a(a), view_b(b);
  out += lines_of(found.only_a, most_cases, named(view_a, "A"));
  out += lines_of(found.only_b, most_cases, named(view_b, "B"));
  return out + lines_of(changed, most_cases, [&](const CasePair& pair) {
           const std::string reason = (pair.b->reasons.empty() ? pair.a : pair.b)->reason();
           return fmt::format("{} ({}): {} → {}{}", pair.a->id, brief_text(view_a.short_name(*pair.a)),
                              shown_status(*pair.a), shown_status(*pair.b),
                              reason.empty() ? "" : ", " + brief_text(reason));
         });
}

/// What became of one measure over all cases.
struct MeasureLine {
  std::string measure;
  std::size_t cases = 0, equal = 0, round_off = 0, beyond = 0, missing = 0;
  const MeasureChange* largest = nullptr;
};

std::vector<MeasureLine> by_measure(const StudyComparison& found) {
  std::vector<MeasureLine> out;
  for (const MeasureChange& one : found.measures) {
    if (out.empty() || out.back().measure != one.measure) out.push_back({one.measure});
    MeasureLine& line = out.back();
    ++line.cases;
    line.equal += one.change == NumberChange::none;
    line.round_off += one.change == NumberChange::round_off;
    line.beyond += one.change == NumberChange::beyond;
    line.missing += one.change == NumberChange::missing;
    if (one.change != NumberChange::none && (!line.largest || one.relative > line.largest->relative))
      line.largest = &one;
  }
  // What moved beyond round-off first, by how much.
  std::stable_sort(out.begin(), out.end(), [](const MeasureLine& one, const MeasureLine& other) {
    const auto size = [](const MeasureLine& line) { return line.largest ? line.largest->relative : 0; };
    return size(one) > size(other);
  });
  return out;
}

std::string six_digits(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g}", *value) : "";
}

std::string measures_text(const StudyComparison& found) {
  if (found.measures.empty()) return found.tables.empty() ? "results: no case is done in both\n" : "";
  std::string out = fmt::format(
      "results: {} compared: {} equal to the last bit, {} within round-off, {} beyond it{}\n",
      count_text(found.measures.size(), "number", "numbers"), found.count(NumberChange::none),
      found.count(NumberChange::round_off), found.count(NumberChange::beyond),
      found.count(NumberChange::missing) ? fmt::format(", {} only in one", found.count(NumberChange::missing)) : "");
  TextTable table({"measure", "beyond", "of", "largest change", "in case", "A", "B"});
  std::size_t shown = 0, left = 0;
  for (const MeasureLine& line : by_measure(found)) {
    if (line.beyond + line.missing == 0) continue;
    if (++shown > most_measures) {
      ++left;
      continue;
    }
    const MeasureChange& most = *line.largest;
    table.add({line.measure, std::to_string(line.beyond + line.missing), std::to_string(line.cases),
               most.relative > 0 ? fmt::format("{:.2g} %", 100 * most.relative) : "", most.pair.a->id,
               six_digits(most.a), six_digits(most.b)});
  }
  if (shown > 0) out += table.text(2);
  if (left > 0) out += fmt::format("  {}: --table\n", count_text(left, "more measure", "more measures"));
  return out;
}

/// "branches of 3 cases, turns of 1": tables that differ, with the number of cases.
std::string tables_that_differ(const StudyComparison& found) {
  std::map<std::string, std::size_t> counts;
  for (const TableChange& one : found.tables)
    if (!one.equal) ++counts[one.table];
  std::string out;
  for (const auto& [name, count] : counts)
    out += fmt::format("{}{} of {}", out.empty() ? "" : ", ", name, count_text(count, "case", "cases"));
  return out;
}

std::string tables_text(const StudyComparison& found) {
  if (found.tables.empty()) return "";
  const auto equal =
      std::count_if(found.tables.begin(), found.tables.end(), [](const TableChange& one) { return one.equal; });
  const std::string differ = tables_that_differ(found);
  return fmt::format("tables: {} compared: {} equal{}\n", count_text(found.tables.size(), "table", "tables"), equal,
                     differ.empty() ? "" : "; others: " + differ);
}

std::string answers_text(const StudyComparison& found) {
  if (found.lines_only_a.empty() && found.lines_only_b.empty()) return "answer: the same lines\n";
  const auto line = [](const char* sign) { return [sign](const std::string& text) { return sign + text; }; };
  return fmt::format("answer: {} of A gone, {} of B new\n", count_text(found.lines_only_a.size(), "line", "lines"),
                     found.lines_only_b.size()) +
         lines_of(found.lines_only_a, most_lines, line("− ")) + lines_of(found.lines_only_b, most_lines, line("+ "));
}

std::string comparison_verdict(const StudyComparison& found) {
  const bool cases = !found.only_a.empty() || !found.only_b.empty() || !found.status_changes().empty();
  if (found.pairs.empty()) return "Nothing to compare: no case is in both.\n";
  const std::string among = cases ? " in the cases that both have; the cases themselves differ" : "";
  const std::size_t missing = found.count(NumberChange::missing);
  const char* how = found.count(NumberChange::beyond) > 0      ? "differ beyond round-off"
                    : found.count(NumberChange::round_off) > 0 ? "are equal within round-off"
                    : tables_that_differ(found).empty()        ? "are equal to the last bit"
                    : found.measures.empty()                   ? "differ in their tables"
                                                               : "have equal measures, but their tables differ";
  return fmt::format(
      "The results {}{}{}.\n", how, among,
      missing ? "; " + count_text(missing, "number is", "numbers are") + " in one of the two alone" : "");
}

std::string folder_line(const char* which, const StudyResults& results) {
  std::string line = fmt::format("{}: {}, {}", which, results.name, count_text(results.cases.size(), "case", "cases"));
  if (const std::string commit = environment_entry(results.environment, "commit"); !commit.empty())
    line += ", commit " + commit;
  if (const std::string started = environment_entry(results.environment, kStarted); !started.empty())
    line += ", " + started;
  return line + "\n";
}

}  // namespace

std::string facts_text(const StudyComparison& found, const StudyResults& a, const StudyResults& b) {
  std::string out = folder_line("A", a) + folder_line("B", b);
  out += fmt::format("inputs: {}\n", found.inputs.empty()
                                         ? "the same"
                                         : count_text(found.inputs.size(), "value differs", "values differ"));
  out += changed_text(found.inputs, most_inputs);
  out += fmt::format(
      "environment: {}\n",
      found.environment.empty() ? "the same" : count_text(found.environment.size(), "entry differs", "entries differ"));
  return out + changed_text(found.environment, most_environment);
}

std::string comparison_text(const StudyComparison& found, const StudyResults& a, const StudyResults& b) {
  return facts_text(found, a, b) + cases_text(found, a, b) + measures_text(found) + tables_text(found) +
         answers_text(found) + comparison_verdict(found);
}

Table comparison_table(const StudyComparison& found) {
  Table table{"differences",
              "What two results folders have differently. A row is an input, an entry of the environment, a case, its "
              "measure or table, or a line of the answer.",
              {{"part", "", "input, environment, case, measure, table or answer."},
               {"case", "", "The case in A; in B where A has none."},
               {"case_b", "", "The same case in B, where its id differs."},
               {"name", "", "JSON pointer, entry of the environment, measure, or table."},
               {"a", "", "In A."},
               {"b", "", "In B."},
               {"relative_change", "1", "|b − a| over what differences of the measure are shares of."},
               {"verdict", "", "equal, within round-off, beyond round-off, only in one, or changed."}},
              {}};
  const auto add = [&](Row row) { table.rows.push_back(std::move(row)); };
  for (const auto& [part, changes] : {std::pair("input", &found.inputs), {"environment", &found.environment}})
    for (const ChangedText& one : *changes) add({part, nullptr, nullptr, one.where, one.a, one.b, nullptr, "changed"});
  for (const CaseRecord* record : found.only_a)
    add({"case", record->id, nullptr, "status", shown_status(*record), nullptr, nullptr, "only in one"});
  for (const CaseRecord* record : found.only_b)
    add({"case", record->id, nullptr, "status", nullptr, shown_status(*record), nullptr, "only in one"});
  const auto other_id = [](const CasePair& pair) { return pair.a->id == pair.b->id ? Cell() : Cell(pair.b->id); };
  for (const CasePair& pair : found.pairs) {
    const std::string a = shown_status(*pair.a), b = shown_status(*pair.b);
    add({"case", pair.a->id, other_id(pair), "status", a, b, nullptr, a == b ? "equal" : "changed"});
  }
  for (const MeasureChange& one : found.measures)
    add({"measure", one.pair.a->id, other_id(one.pair), one.measure, one.a, one.b,
         one.a && one.b ? Cell(one.relative) : Cell(), word(one.change)});
  for (const TableChange& one : found.tables)
    add({"table", one.pair.a->id, other_id(one.pair), one.table, nullptr, nullptr, nullptr,
         one.equal ? "equal" : "changed"});
  for (const std::string& line : found.lines_only_a)
    add({"answer", nullptr, nullptr, nullptr, line, nullptr, nullptr, "only in one"});
  for (const std::string& line : found.lines_only_b)
    add({"answer", nullptr, nullptr, nullptr, nullptr, line, nullptr, "only in one"});
  return table;
}

}  // namespace ricochet
