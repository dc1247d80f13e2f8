#include "runners/run/pair_results.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "runners/answers/uncertainty.hpp"
#include "runners/asks/evidence.hpp"
#include "runners/report/choices.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {
namespace {

using asks::VerdictRow;
using asks::WordAtPlace;

/// A value with what tells it from the others of its result.
struct KeyedValue {
  std::string table, of;
  Row key;
  VerdictRow row;
  bool in_words = false;
};

std::string json_text(const asks::Ask& ask) {
  return ask.keys.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

using Records = std::map<std::string, const CaseRecord*>;

Records by_id(const StudyResults& results) {
  Records out;
  for (const CaseRecord& record : results.cases) out[record.id] = &record;
  return out;
}

/// By the axes of a case where a row is one's: another study may call the same levels otherwise.
void add_verdicts(const AnalysedResults& results, const std::vector<std::string>& chosen,
                  std::vector<KeyedValue>& out) {
  const Records records = by_id(results);
  const auto add_levels = [&](Row& key, const std::string& of_case, const std::string& level) {
    if (const auto record = records.find(of_case); record == records.end())
      key.emplace_back(level);
    else
      for (Cell& cell : axes_of(*record->second, chosen)) key.push_back(std::move(cell));
  };
  for (const auto& [ask, answered] : results.asked.all) {
    for (const WordAtPlace& one : answered.words) {
      Row key{one.place};
      add_levels(key, one.of_case, one.level);
      VerdictRow row;
      row.level = one.level + (one.level.empty() ? "" : ", ") + one.place;
      row.verdict = one.word;
      row.reason = one.known ? "" : one.word;
      out.push_back({"verdicts", json_text(ask), std::move(key), std::move(row), true});
    }
    if (!answered.words.empty()) continue;
    for (const VerdictRow& row : answered.rows) {
      if (row.given) continue;  // the study's own number
      Row key{row.measure, row.stop, row.unit};
      add_levels(key, row.of_case, row.level);
      out.push_back({"verdicts", json_text(ask), std::move(key), row});
    }
  }
}

/// Columns of both but those that are refined.
std::vector<std::string> chosen_columns(const StudyResults& a, const StudyResults& b) {
  std::vector<std::string> out;
  for (const StudyResults* one : {&a, &b})
    for (const std::string& column : one->columns)
      if (!is_refinement(column) && std::find(out.begin(), out.end(), column) == out.end()) out.push_back(column);
  return out;
}

/// The rows of a table of values with low and high, if the result has it. `level`: the column that says the level of
/// all choices in words.
void add_rows_of(const StudyResults& results, const char* name, const char* level,
                 const std::vector<std::string>& chosen, std::vector<KeyedValue>& out) {
  const Table* table = find_table(results.derived, name);
  if (!table) return;
  const Records records = by_id(results);
  const TableReader rows(*table);
  const std::size_t words = rows.column_if_any(level), stop = rows.column_if_any("stop"),
                    id = rows.column_if_any("case");
  for (std::size_t r = 0; r < rows.size(); ++r) {
    VerdictRow row;
    std::tie(row.measure, row.stop) = asks::split_measure(rows.text(r, "measure"));
    if (stop != TableReader::absent) row.stop = rows.text(r, stop);
    row.level = rows.text(r, words);
    row.value = rows.number(r, "value");
    row.low = rows.number(r, "low");
    row.high = rows.number(r, "high");
    row.unit = rows.text(r, "unit");
    Row key{row.measure, row.stop, row.unit};
    const auto record = records.find(rows.text(r, id));
    if (record != records.end())
      for (Cell& cell : axes_of(*record->second, chosen)) key.push_back(std::move(cell));
    out.push_back({name, "", std::move(key), std::move(row)});
  }
}

using MeasuresOfStops = std::set<std::pair<std::string, std::string>>;

/// What asks of both tell a value of, by measure and stop: the table of limits would tell that once more.
MeasuresOfStops told_by_asks(const AnalysedResults& a, const AnalysedResults& b) {
  const auto told = [](const AnalysedResults& results) {
    MeasuresOfStops out;
    for (const auto& [ask, answered] : results.asked.all)
      if (ask.verb->name == std::string("value"))
        for (const VerdictRow& row : answered.rows) out.emplace(row.measure, row.stop);
    return out;
  };
  MeasuresOfStops out;
  const MeasuresOfStops of_a = told(a), of_b = told(b);
  std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), std::inserter(out, out.end()));
  return out;
}

std::vector<KeyedValue> values_of(const AnalysedResults& results, const std::vector<std::string>& chosen,
                                  const MeasuresOfStops& told) {
  std::vector<KeyedValue> out, limits;
  add_verdicts(results, chosen, out);
  add_rows_of(results, "limits", "method", chosen, limits);
  for (KeyedValue& one : limits)
    if (!told.contains({one.row.measure, one.row.stop})) out.push_back(std::move(one));
  // A range over several scenes is none of either.
  if (!answers::scene_varies(results.choices)) add_rows_of(results, "uncertainty", "", {}, out);
  // Rows that nothing tells apart go together in their order.
  std::map<std::string, std::size_t> met;
  for (KeyedValue& one : out) {
    one.key.insert(one.key.begin(), {one.table, one.of});
    one.key.emplace_back(met[key_of(one.key)]++);
  }
  return out;
}

PairChange change_of(PairedValue& pair) {
  if (!pair.b) return PairChange::only_a;
  if (!pair.a) return PairChange::only_b;
  const VerdictRow &a = *pair.a, &b = *pair.b;
  if (pair.in_words)
    return a.verdict == b.verdict                 ? PairChange::equal
           : a.reason.empty() && b.reason.empty() ? PairChange::beyond
                                                  : PairChange::no_interval;
  const auto known = [](const VerdictRow& row) { return row.value || row.low; };
  if (known(a) != known(b)) return known(a) ? PairChange::only_a : PairChange::only_b;
  if (a.value && b.value) pair.difference = *b.value - *a.value;
  if (std::pair(a.value, a.verdict) == std::pair(b.value, b.verdict) &&
      std::pair(a.low, a.high) == std::pair(b.low, b.high))
    return PairChange::equal;
  if (!a.low || !a.high || !b.low || !b.high) return PairChange::no_interval;
  if (!pair.difference) return *a.low > *b.high || *b.low > *a.high ? PairChange::beyond : PairChange::within;
  pair.u =
      *pair.difference > 0 ? (*a.high - *a.value) + (*b.value - *b.low) : (*a.value - *a.low) + (*b.high - *b.value);
  return std::abs(*pair.difference) > *pair.u ? PairChange::beyond : PairChange::within;
}

}  // namespace

bool PairedValue::has_values() const {
  const auto has = [](const std::optional<VerdictRow>& row) { return row && (row->value || row->low); };
  return in_words || has(a) || has(b);
}

std::string PairedValue::level() const {
  const VerdictRow& row = any();
  const bool bare = row.value && !row.low && !row.verdict.empty() && (!a || !b || a->verdict == b->verdict);
  return row.level + (bare ? (row.level.empty() ? "" : ", ") + row.verdict : "");
}

std::size_t PairedResults::count(PairChange change) const {
  return static_cast<std::size_t>(
      std::count_if(values.begin(), values.end(), [&](const PairedValue& one) { return one.change == change; }));
}

std::size_t PairedResults::count(PairChange change, bool in_words) const {
  return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [&](const PairedValue& one) {
    return one.change == change && one.in_words == in_words;
  }));
}

PairedResults pair_results(const AnalysedResults& a, const AnalysedResults& b) {
  PairedResults out{compare_studies(a, b), {}, {}};
  const std::vector<std::string> chosen = chosen_columns(a, b);
  const MeasuresOfStops told = told_by_asks(a, b);
  std::map<std::string, std::size_t> places;
  for (KeyedValue& one : values_of(a, chosen, told)) {
    places[key_of(one.key)] = out.values.size();
    out.values.push_back({.table = one.table, .of = one.of, .a = std::move(one.row), .in_words = one.in_words});
  }
  for (KeyedValue& one : values_of(b, chosen, told)) {
    const auto place = places.find(key_of(one.key));
    if (place == places.end())
      out.values.push_back({.table = one.table, .of = one.of, .b = std::move(one.row), .in_words = one.in_words});
    else
      out.values[place->second].b = std::move(one.row);
  }
  for (PairedValue& one : out.values) one.change = change_of(one);
  for (const auto& [ask, answered] : a.asked.all) out.asks.push_back({json_text(ask), &answered, nullptr});
  for (const auto& [ask, answered] : b.asked.all) {
    const std::string text = json_text(ask);
    const auto same =
        std::find_if(out.asks.begin(), out.asks.end(), [&](const PairedAsk& one) { return one.ask == text && !one.b; });
    if (same == out.asks.end())
      out.asks.push_back({text, nullptr, &answered});
    else
      same->b = &answered;
  }
  return out;
}

}  // namespace ricochet
