#include "runners/run/asked_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "runners/answers/answer.hpp"
#include "runners/answers/numbers_in_words.hpp"
#include "runners/json/json_text.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

using asks::VerdictRow;

std::string unit_of(const VerdictRow& row) {
  return row.unit == "1" ? "" : row.unit;
}

}  // namespace

std::string subject_words(const VerdictRow& row) {
  if (row.measure.empty()) return "";
  for (const std::string& name : {row.measure, row.measure + "[" + row.stop + "]"})
    if (measure_info(name)) return answers::measure_words(name).words;
  return spoken(row.measure);
}

std::string value_cell(const VerdictRow& row) {
  if (!row.value && row.low && row.high && *row.low == *row.high) return short_number(*row.low);
  if (!row.value) return row.low && row.high ? short_number(*row.low) + " to " + short_number(*row.high) : "";
  constexpr int in_full = 12;
  if (row.given) return short_number(*row.value, in_full);
  if (row.allowed && *row.value > 0) {
    constexpr int digits = 3;
    const auto down = [](double value) { return value > 0 ? short_number_down(value, digits) : short_number(value); };
    const std::string value = down(*row.value);
    if (!row.low || !row.high || *row.low == *row.high) return value;
    return fmt::format("{} ({} to {})", value, down(*row.low), down(*row.high));
  }
  answers::MeasureWords words;
  words.unit = unit_of(row);
  words.decades = words.unit != "%" && answers::measure_words(row.measure).decades;
  if (!row.low || !row.high) return answers::value_text(words, *row.value, {}, false);
  constexpr double lopsided = 0.05;
  const double half = 0.5 * (*row.high - *row.low), middle = 0.5 * (*row.high + *row.low);
  if (std::abs(*row.value - middle) > lopsided * half && half > 0) {
    // Two digits at least, however wide the interval.
    constexpr double two_digits = 0.05;
    const auto said = [&](double value) {
      return answers::value_text(words, value, value == 0 ? half : std::min(half, two_digits * std::abs(value)), false);
    };
    const std::string value = said(*row.value), low = said(*row.low), high = said(*row.high);
    return low == high ? value : fmt::format("{} ({} to {})", value, low, high);
  }
  std::string text = answers::with_uncertainty(words, *row.value, half);
  if (const std::string unit = " " + words.unit; !words.unit.empty() && text.ends_with(unit))
    text.resize(text.size() - unit.size());
  return text;
}

report::AskedTable asked_rows(const asks::Answered& answered) {
  std::set<std::string> units, measures, stops;
  for (const VerdictRow& row : answered.rows) {
    if (row.value || row.low) units.insert(unit_of(row));
    if (!row.measure.empty()) measures.insert(row.measure);
    if (!row.stop.empty()) stops.insert(row.stop);
  }
  const bool one_unit = units.size() == 1;
  report::AskedTable out;
  const auto value = [&](const VerdictRow& row) {
    const std::string text = value_cell(row), unit = one_unit ? "" : unit_of(row);
    return text + (text.empty() || unit.empty() ? "" : " " + unit);
  };
  out.heads = {"level", "stop", "of", one_unit && !units.begin()->empty() ? "value (" + *units.begin() + ")" : "value",
               "verdict"};
  constexpr std::size_t values = 3;
  for (const VerdictRow& row : answered.rows)
    out.rows.push_back({row.level, stops.size() > 1 ? row.stop : "", measures.size() > 1 ? subject_words(row) : "",
                        value(row),
                        row.verdict + (row.reason.empty() ? "" : (row.verdict.empty() ? "" : ": ") + row.reason)});
  out.values = values;
  for (std::size_t k = out.heads.size(); k-- > 0;) {
    if (std::any_of(out.rows.begin(), out.rows.end(), [&](const auto& row) { return !row[k].empty(); })) continue;
    const auto place = static_cast<std::ptrdiff_t>(k);
    out.heads.erase(out.heads.begin() + place);
    for (auto& row : out.rows) row.erase(row.begin() + place);
    if (k < out.values)
      --out.values;
    else if (k == out.values)
      out.values = out.heads.size() + values;  // no column of numbers
  }
  return out;
}

report::AskedAnswers asked_answers(const AnalysedResults& results) {
  report::AskedAnswers out;
  out.first = results.asked.first;
  for (const auto& [ask, answered] : results.asked.all) {
    std::vector<std::string> aside = answered.aside;
    if (ask.required() && answered.passes != asks::Verdict::yes)
      aside.push_back(fmt::format("Ask {} requires a yes and has none.", ask.number));
    out.parts.push_back({ask.number, answered.sentence, std::move(aside), asked_rows(answered), answered.figure});
  }
  for (const answers::Sentence& doubt : answers::doubted(results.choices)) out.first.push_back(doubt.text);
  return out;
}

report::KindPage page_of_study(const AnalysedResults& results) {
  report::KindPage page = results.analysis.page;
  page.asked = asked_answers(results);
  return page;
}

std::string asked_text(const AnalysedResults& results) {
  constexpr std::size_t most = 12, indent = 4;
  const report::AskedAnswers asked = asked_answers(results);
  std::string out = results.question.empty() ? "" : results.question + "\n";
  std::set<std::string> told;
  const auto line = [&](const std::string& text) {
    if (told.insert(text).second) out += "  " + text + "\n";
  };
  for (const std::string& one : asked.first) line(one);
  for (const report::AskedPart& part : asked.parts) {
    for (const std::string& one : part.aside) line(one);
    out += "  " + part.sentence + "\n";
    // One row alone says what the sentence says.
    if (part.table.rows.size() < 2) continue;
    TextTable table(part.table.heads);
    for (std::size_t k = 0; k < std::min(most, part.table.rows.size()); ++k) table.add(part.table.rows[k]);
    out += table.text(indent);
    if (part.table.rows.size() > most) out += fmt::format("    … {} rows in verdicts.csv\n", part.table.rows.size());
  }
  if (!results.asked.proposed.empty())
    out += fmt::format("  It could ask: {}\n", fmt::join(results.asked.proposed, "\n                "));
  return out;
}

nlohmann::ordered_json rows_as_json(const Table& table) {
  Json rows = Json::array();
  for (const Row& row : table.rows) {
    Json one = Json::object();
    for (std::size_t k = 0; k < table.columns.size(); ++k) one[table.columns[k].name] = json_of(row[k]);
    rows.push_back(std::move(one));
  }
  return rows;
}

nlohmann::ordered_json asked_json(const AnalysedResults& results) {
  const report::AskedAnswers asked = asked_answers(results);
  Json aside = Json::array();
  for (const report::AskedPart& part : asked.parts)
    for (const std::string& sentence : part.aside) aside.push_back({{"ask", part.number}, {"sentence", sentence}});
  return {{"question", results.question},
          {"first", asked.first},
          {"verdicts", rows_as_json(asks::verdicts_table(results.asked))},
          {"aside", std::move(aside)}};
}

}  // namespace ricochet
