#include "runners/run/compare_studies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "runners/json/json_text.hpp"
#include "runners/report/case_view.hpp"
#include "runners/report/html.hpp"
#include "runners/report/summary_page.hpp"
#include "runners/run/choice_effects.hpp"
#include "runners/store/environments.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

using Json = nlohmann::ordered_json;

std::string json_said(const Json* value) {
  return value ? value->dump(-1, ' ', false, Json::error_handler_t::replace) : "";
}

/// Objects member by member, lists of equal length entry by entry; a list that grew or shrank is one value.
void add_changes(const Json* a, const Json* b, const std::string& pointer, std::vector<ChangedText>& out) {
  if (a && b && *a == *b) return;
  if (a && b && a->is_object() && b->is_object()) {
    for (const auto& [key, value] : a->items())
      add_changes(&value, b->contains(key) ? &(*b)[key] : nullptr, pointer_to(pointer, key), out);
    for (const auto& [key, value] : b->items())
      if (!a->contains(key)) add_changes(nullptr, &value, pointer_to(pointer, key), out);
    return;
  }
  if (a && b && a->is_array() && b->is_array() && a->size() == b->size()) {
    for (std::size_t k = 0; k < a->size(); ++k) add_changes(&(*a)[k], &(*b)[k], pointer_to(pointer, k), out);
    return;
  }
  out.push_back({pointer, json_said(a), json_said(b)});
}

std::vector<ChangedText> environment_changes(const Environment& a, const Environment& b) {
  std::vector<ChangedText> out;
  const auto find = [](const Environment& in, const std::string& name) {
    return without_place(name, environment_entry(in, name));
  };
  std::vector<std::string> names;
  for (const Environment* one : {&a, &b})
    for (const auto& [name, value] : one->entries)
      if (name != kStarted && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  for (const std::string& name : names)
    if (find(a, name) != find(b, name)) out.push_back({name, find(a, name), find(b, name)});
  return out;
}

/// The cases of both by a key that no two of either share; what is left over stays in the lists.
template <class KeyOf>
void pair_by(KeyOf key_of_case, StudyComparison& into) {
  std::map<std::string, std::vector<const CaseRecord*>> there;
  for (const CaseRecord* record : into.only_b) there[key_of_case(*record)].push_back(record);
  std::map<std::string, int> here;
  for (const CaseRecord* record : into.only_a) ++here[key_of_case(*record)];
  std::set<const CaseRecord*> matched;
  for (const CaseRecord* record : into.only_a) {
    const std::string key = key_of_case(*record);
    const auto found = there.find(key);
    if (found == there.end() || found->second.size() != 1 || here[key] != 1) continue;
    into.pairs.push_back({record, found->second.front()});
    matched.insert({record, found->second.front()});
  }
  for (auto* list : {&into.only_a, &into.only_b})
    std::erase_if(*list, [&](const CaseRecord* record) { return matched.count(record) != 0; });
}

void pair_cases(const StudyResults& a, const StudyResults& b, StudyComparison& into) {
  into.only_a = all_cases(a);
  into.only_b = all_cases(b);
  pair_by([](const CaseRecord& record) { return record.id; }, into);
  const std::size_t by_id = into.pairs.size();
  std::vector<std::string> both = a.columns;
  for (const std::string& column : b.columns)
    if (std::find(both.begin(), both.end(), column) == both.end()) both.push_back(column);
  pair_by([&](const CaseRecord& record) { return key_of(axes_of(record, both)); }, into);
  into.by_id = into.pairs.size() == by_id;
}

MeasureChange measure_change(const std::string& name, const CasePair& pair) {
  MeasureChange out{name, pair, measure(*pair.a, name), measure(*pair.b, name), 0, NumberChange::none};
  if (!out.a && !out.b) return out;
  if (!out.a || !out.b) {
    out.change = NumberChange::missing;
    return out;
  }
  if (*out.a == *out.b) return out;
  const MeasureScale scale(name);
  const double size = std::max(scale.of(*pair.a).value_or(0), scale.of(*pair.b).value_or(0));
  const double move = std::abs(*out.b - *out.a), floor = std::max(round_off(*pair.a), round_off(*pair.b)) * size;
  out.relative = size > 0 ? move / size : move;
  out.change = move <= floor ? NumberChange::round_off : NumberChange::beyond;
  return out;
}

std::vector<MeasureChange> measure_changes(const std::vector<CasePair>& pairs) {
  std::vector<std::string> names;
  std::set<std::string> seen;
  for (const CasePair& pair : pairs)
    for (const CaseRecord* record : {pair.a, pair.b})
      for (const auto& [name, value] : record->measures)
        if (seen.insert(name).second) names.push_back(name);
  std::vector<MeasureChange> out;
  for (const std::string& name : names) {
    const MeasureInfo* info = measure_info(name);
    if (info && info->of == MeasureInfo::Of::computation) continue;
    for (const CasePair& pair : pairs)
      if (pair.a->status == "done" && pair.b->status == "done") {
        const MeasureChange change = measure_change(name, pair);
        if (change.a || change.b) out.push_back(change);
      }
  }
  return out;
}

std::vector<std::string> lines_without(const std::vector<std::string>& lines, const std::vector<std::string>& others) {
  std::vector<std::string> out;
  for (const std::string& line : lines)
    if (std::find(others.begin(), others.end(), line) == others.end()) out.push_back(line);
  return out;
}

}  // namespace

const char* change_word(NumberChange change) {
  switch (change) {
    case NumberChange::none:
      return "equal";
    case NumberChange::round_off:
      return "within round-off";
    case NumberChange::beyond:
      return "beyond round-off";
    case NumberChange::missing:
      return "only in one";
  }
  return "";
}

std::vector<CasePair> StudyComparison::status_changes() const {
  std::vector<CasePair> out;
  std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(out), [](const CasePair& pair) {
    return pair.a->status != pair.b->status || pair.a->partial != pair.b->partial;
  });
  return out;
}

std::size_t StudyComparison::count(NumberChange change) const {
  return static_cast<std::size_t>(
      std::count_if(measures.begin(), measures.end(), [&](const MeasureChange& one) { return one.change == change; }));
}

StudyComparison compare_studies(const StudyResults& a, const StudyResults& b) {
  StudyComparison out;
  add_changes(&a.study, &b.study, "", out.inputs);
  // How a structure is drawn follows from its files, whose digests are compared.
  std::erase_if(out.inputs, [](const ChangedText& one) { return one.where.starts_with("/files/layout"); });
  out.environment = environment_changes(a.environment, b.environment);
  pair_cases(a, b, out);
  out.measures = measure_changes(out.pairs);
  const std::vector<std::string> lines_a = report::answer_lines(a), lines_b = report::answer_lines(b);
  out.lines_only_a = lines_without(lines_a, lines_b);
  out.lines_only_b = lines_without(lines_b, lines_a);
  return out;
}

// What two results folders have differently, as a person reads it and as a table.

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
  return record.partial ? "under way" : record.status;
}

std::string cases_text(const StudyComparison& found, const StudyResults& a, const StudyResults& b) {
  const std::vector<CasePair> changed = found.status_changes();
  std::string out = fmt::format("cases: {} in both{}, {} only in A, {} only in B, {} with another status\n",
                                found.pairs.size(), found.by_id ? "" : " (by their parameters: the ids differ)",
                                found.only_a.size(), found.only_b.size(), changed.size());
  const auto named = [](const report::CaseView& view, const char* which) {
    return [&view, which](const CaseRecord* record) {
      return fmt::format("only in {}: {} ({})", which, record->id, brief_text(view.name(*record)));
    };
  };
  const report::CaseView view_a(a), view_b(b);
  out += lines_of(found.only_a, most_cases, named(view_a, "A"));
  out += lines_of(found.only_b, most_cases, named(view_b, "B"));
  return out + lines_of(changed, most_cases, [&](const CasePair& pair) {
           const std::string& reason = pair.b->reason.empty() ? pair.a->reason : pair.b->reason;
           return fmt::format("{} ({}): {} → {}{}", pair.a->id, brief_text(view_a.name(*pair.a)), shown_status(*pair.a),
                              shown_status(*pair.b), reason.empty() ? "" : ", " + brief_text(reason));
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
  if (found.measures.empty()) return "results: no case is done in both\n";
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
                                                               : "are equal to the last bit";
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

std::string comparison_text(const StudyComparison& found, const StudyResults& a, const StudyResults& b) {
  std::string out = folder_line("A", a) + folder_line("B", b);
  out += fmt::format("inputs: {}\n", found.inputs.empty()
                                         ? "the same"
                                         : count_text(found.inputs.size(), "value differs", "values differ"));
  out += changed_text(found.inputs, most_inputs);
  out += fmt::format(
      "environment: {}\n",
      found.environment.empty() ? "the same" : count_text(found.environment.size(), "entry differs", "entries differ"));
  out += changed_text(found.environment, most_environment);
  return out + cases_text(found, a, b) + measures_text(found) + answers_text(found) + comparison_verdict(found);
}

Table comparison_table(const StudyComparison& found) {
  Table table{
      "differences",
      "What two results folders have: an input, an entry of the environment, a case, a measure of a case, a line "
      "of the answer.",
      {{"part", "", "input, environment, case, measure or answer."},
       {"case", "", "The case in A; in B where A has none."},
       {"case_b", "", "The same case in B, where its id differs."},
       {"name", "", "JSON pointer, entry of the environment, or measure."},
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
         one.a && one.b ? Cell(one.relative) : Cell(), change_word(one.change)});
  for (const std::string& line : found.lines_only_a)
    add({"answer", nullptr, nullptr, nullptr, line, nullptr, nullptr, "only in one"});
  for (const std::string& line : found.lines_only_b)
    add({"answer", nullptr, nullptr, nullptr, nullptr, line, nullptr, "only in one"});
  return table;
}

}  // namespace ricochet
