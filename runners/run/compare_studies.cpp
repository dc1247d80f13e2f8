#include "runners/run/compare_studies.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "runners/json/json_text.hpp"
#include "runners/report/summary_page.hpp"
#include "runners/run/choice_effects.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {
namespace {

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
      if (pair.a->status == Status::done && pair.b->status == Status::done) {
        const MeasureChange change = measure_change(name, pair);
        if (change.a || change.b) out.push_back(change);
      }
  }
  return out;
}

bool equal_tables(const Table& a, const Table& b) {
  return a.rows == b.rows;
}

bool equal_tables(const NumberTable& a, const NumberTable& b) {
  if (a.values.size() != b.values.size()) return false;
  for (std::size_t c = 0; c < a.values.size(); ++c)
    if (!std::equal(a.values[c].begin(), a.values[c].end(), b.values[c].begin(), b.values[c].end(), same_bits))
      return false;
  return true;
}

template <class AnyTable>
void add_table_changes(const CasePair& pair, const std::vector<AnyTable>& a, const std::vector<AnyTable>& b,
                       std::vector<TableChange>& out) {
  for (const AnyTable& one : a) {
    const AnyTable* other = find_table(b, one.name);
    out.push_back({one.name, pair, other && equal_tables(one, *other)});
  }
  for (const AnyTable& one : b)
    if (!find_table(a, one.name)) out.push_back({one.name, pair, false});
}

std::vector<TableChange> table_changes(const std::vector<CasePair>& pairs) {
  std::vector<TableChange> out;
  for (const CasePair& pair : pairs) {
    if (pair.a->status != Status::done || pair.b->status != Status::done) continue;
    add_table_changes(pair, pair.a->tables, pair.b->tables, out);
    add_table_changes(pair, pair.a->numbers, pair.b->numbers, out);
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
  out.tables = table_changes(out.pairs);
  const std::vector<std::string> lines_a = report::answer_lines(a), lines_b = report::answer_lines(b);
  out.lines_only_a = lines_without(lines_a, lines_b);
  out.lines_only_b = lines_without(lines_b, lines_a);
  return out;
}

}  // namespace ricochet
