#include "runners/kinds/trajectory/page/summary_measures.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/answers/uncertainty.hpp"
#include "runners/report/html.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet::report {
namespace {

constexpr std::size_t most_summary_measures = 8;

// Of the measures of a stop, those that a file asks for beside what is observed.
const std::vector<std::string> summary_order = {
    "peak_force",      "impulse",    "wear_power",         "window_displacement_max",
    "shock_force_max", "shock_rate", "window_impact_rate", "impacts"};

/// One measure over all methods, in the unit of its table.
struct SummaryMeasure {
  std::string unit = {};
  double least = 0, largest = 0;
  std::optional<double> low = {}, high = {}, step = {}, mesh = {}, sampling = {};
};
using SummaryMeasures = std::vector<std::pair<std::string, SummaryMeasure>>;

std::optional<double> number_at(const Table& table, const Row& row, const char* column) {
  return row[find_column(table.columns, column).value()].number();
}

std::string text_at(const Table& table, const Row& row, const char* column) {
  return row[find_column(table.columns, column).value()].text();
}

// Measures of stops that have names.
SummaryMeasures of_stops(const Table& table) {
  SummaryMeasures out;
  for (const Row& row : table.rows)
    out.emplace_back(text_at(table, row, "measure") + "[" + text_at(table, row, "stop") + "]",
                     SummaryMeasure{text_at(table, row, "unit"), number_at(table, row, "least").value_or(0),
                                    number_at(table, row, "largest").value_or(0), number_at(table, row, "low"),
                                    number_at(table, row, "high"), number_at(table, row, "step_gap"),
                                    number_at(table, row, "mesh_gap"), number_at(table, row, "sampling")});
  return out;
}

// Measures of whole cases: the range over the methods, each with where its limit may be.
SummaryMeasures of_cases(const Table& limits) {
  SummaryMeasures out;
  for (const Row& row : limits.rows) {
    const std::string name = text_at(limits, row, "measure");
    auto found = std::find_if(out.begin(), out.end(), [&](const auto& one) { return one.first == name; });
    const double value = number_at(limits, row, "value").value_or(0);
    const auto low = number_at(limits, row, "low"), high = number_at(limits, row, "high");
    const bool known = number_at(limits, row, "u").has_value();
    if (found == out.end()) {
      SummaryMeasure first{.unit = text_at(limits, row, "unit"), .least = value, .largest = value};
      first.low = low;
      first.high = high;
      out.emplace_back(name, std::move(first));
      found = out.end() - 1;
      if (!known) found->second.low.reset();
    }
    SummaryMeasure& one = found->second;
    one.least = std::min(one.least, value);
    one.largest = std::max(one.largest, value);
    if (!known || !low || !high) one.low.reset();
    if (one.low) one.low = std::min(*one.low, *low);
    if (one.low) one.high = std::max(one.high.value_or(*high), *high);
    for (const auto& [column, gap] :
         {std::pair("step_moves", &SummaryMeasure::step), {"mesh_moves", &SummaryMeasure::mesh}})
      if (const auto moves = number_at(limits, row, column)) one.*gap = std::max((one.*gap).value_or(0), *moves);
  }
  return out;
}

void add_row(HtmlTable& table, const std::string& name, const SummaryMeasure& one) {
  answers::MeasureWords words = answers::measure_words(name);
  words.factor = 1;
  words.unit = one.unit;
  const double size = std::max(std::abs(one.least), std::abs(one.largest));
  words = answers::prefixed(std::move(words), size);
  const bool known = one.low && one.high;
  table.row(words.words);
  // Shares of energy that no method has below 0 are none below it.
  const bool share_of_energy = one.unit == "%" && one.least >= 0;
  const double low = !known ? one.least : share_of_energy ? std::max(0.0, *one.low) : *one.low;
  table.number(answers::range_text(words, low, known ? *one.high : one.largest) + (known ? "" : " ?"));
  const auto share = [&](const std::optional<double>& value) {
    if (!value || !std::isfinite(*value) || size == 0)
      table.absent();
    else
      table.number(answers::percent(*value / size));
  };
  share(one.largest - one.least);
  share(one.step);
  share(one.mesh);
  share(one.sampling);
}

}  // namespace

std::string summary_measures_html(const CaseView& view) {
  const StudyResults& results = view.results();
  const auto& scene = results.study.contains("scene") ? results.study.at("scene") : nlohmann::ordered_json();
  if (!scene.contains("stops") || scene.at("stops").is_null()) return "";
  SummaryMeasures all;
  if (const Table* stops = find_table(results.derived, "uncertainty")) all = of_stops(*stops);
  if (const Table* limits = find_table(results.derived, "limits"))
    for (auto& one : of_cases(*limits))
      if (std::none_of(all.begin(), all.end(), [&](const auto& other) { return other.first == one.first; }))
        all.push_back(std::move(one));
  std::vector<std::string> order;
  if (const auto observed = results.study.find("observe"); observed != results.study.end() && observed->is_array())
    for (const auto& name : *observed) order.push_back(name.get<std::string>());
  for (const std::string& measure : summary_order)
    for (const auto& [name, ignored] : all)
      if (name.starts_with(measure + "[") || name == measure) order.push_back(name);
  for (const auto& [name, ignored] : all)
    if (name.find('[') == std::string::npos) order.push_back(name);
  HtmlTable table(
      "Between which values each measure is, over all methods at their finest step and mesh. Beside it: what "
      "these move it by, as shares of the largest value. ?: a single step, which leaves that open.",
      {{"measure"}, {"between", true}, {"methods", true}, {"step", true}, {"mesh", true}, {"sampling", true}});
  std::vector<std::string> told;
  for (const std::string& name : order) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.first == name; });
    if (found == all.end() || table.size() == most_summary_measures) continue;
    if (std::find(told.begin(), told.end(), name) != told.end()) continue;
    told.push_back(name);
    add_row(table, name, found->second);
  }
  return table.html();
}

}  // namespace ricochet::report
