#include "runners/kinds/trajectory/page/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "runners/answers/answer.hpp"
#include "runners/answers/limits.hpp"
#include "runners/answers/numbers_in_words.hpp"
#include "runners/answers/uncertainty.hpp"
#include "runners/asks/ask.hpp"
#include "runners/kinds/trajectory/outputs.hpp"
#include "runners/report/html.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet::report {

KindPage trajectory_page() {
  KindPage page;
  page.scripts = scripts({"along_axis", "over_time", "final_energy", "energy", "tip", "force", "penetration", "impacts",
                          "shocks", "clearances", "spectra"});
  page.tables = {"energy_changes", "shock_points", "orbit_points", "spectrum_bands"};
  page.curves = {"energy", "tip_displacement", "contact_force_peak"};
  page.derived = {energy_changes, shock_points, orbit_points, spectrum_bands};
  page.answer = stops_html;
  page.summary = summary_measures_html;
  return page;
}

Table energy_changes(const Choices& choices) {
  Table out{"energy_changes",
            "One row per case: where its energy ends, told from its start.",
            {{"case", "", "Identity of the case: its row in cases.csv."},
             {"change", "1", "Distance of the energy left from 1."},
             {"gained", "", "Whether the energy grew."},
             {"conservative", "", "Whether nothing but contact and the method changes energies in this study."}},
            {}};
  const bool kept = answers::keeps_energy(choices.results());
  for (const CaseRecord* record : all_cases(choices.results()))
    if (const auto ratio = ricochet::measure(*record, "energy_left"))
      out.rows.push_back({record->id, std::abs(*ratio - 1), *ratio > 1, kept});
  return out;
}

Table orbit_points(const Choices& choices) {
  Table out{"orbit_points",
            "One sample of a place within its clearance, of the finest case of a method.",
            {{"case", "", "Identity of the case: its row in cases.csv."},
             {"stop", "", "Name of the clearance."},
             {"t", "s", "Time of the sample."},
             {"first", "m", "Displacement along the first component."},
             {"second", "m", "Displacement along the second."},
             {"radius", "m", "Radius of the clearance."}},
            {}};
  constexpr std::size_t most_methods = 6, most_dots = 4000;
  std::vector<std::pair<const CaseRecord*, const NumberTable*>> tables;
  std::size_t rows = 0;
  for (const Cases& cases : methods_from_finest(Choices(choices.results()))) {
    const NumberTable* table = orbits_type().find(cases.front()->numbers);
    if (!table || table->rows() == 0 || tables.size() == most_methods) continue;
    tables.emplace_back(cases.front(), table);
    rows += table->rows();
  }
  const std::size_t every = std::max<std::size_t>(1, (rows + most_dots - 1) / most_dots);
  for (const auto& [record, orbits] : tables) {
    const OrbitColumns at = orbits_type().read(*orbits);
    const std::vector<std::string>& names = orbits->words.front().second;
    for (std::size_t i = 0; i < orbits->rows(); i += every)
      out.rows.push_back({record->id, names.at(static_cast<std::size_t>((*at.stop)[i])), (*at.t)[i], (*at.first)[i],
                          (*at.second)[i], (*at.radius)[i]});
  }
  return out;
}

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

// Measures of stops that have names.
SummaryMeasures of_stops(const std::vector<answers::StopRange>& rows) {
  SummaryMeasures out;
  for (const answers::StopRange& row : rows)
    out.emplace_back(row.measure + "[" + row.stop + "]", SummaryMeasure{row.unit, row.least, row.largest, row.low,
                                                                        row.high, row.step, row.mesh, row.sampling});
  return out;
}

// Measures of whole cases: the range over the methods, each with where its limit may be.
SummaryMeasures of_cases(const std::vector<answers::MeasureLimit>& limits) {
  SummaryMeasures out;
  for (const answers::MeasureLimit& row : limits) {
    auto found = std::find_if(out.begin(), out.end(), [&](const auto& one) { return one.first == row.measure; });
    const double value = row.value.value_or(0);
    if (found == out.end()) {
      out.emplace_back(row.measure, SummaryMeasure{row.unit, value, value, row.low, row.high});
      found = out.end() - 1;
    }
    SummaryMeasure& one = found->second;
    one.least = std::min(one.least, value);
    one.largest = std::max(one.largest, value);
    if (!row.low || !row.high) one.low.reset();
    if (one.low) one.low = std::min(*one.low, *row.low);
    if (one.low) one.high = std::max(one.high.value_or(*row.high), *row.high);
    if (row.step_moves) one.step = std::max(one.step.value_or(0), *row.step_moves);
    if (row.mesh_moves) one.mesh = std::max(one.mesh.value_or(0), *row.mesh_moves);
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

std::string summary_measures_html(const Choices& choices) {
  const StudyResults& results = choices.results();
  const auto& scene = results.study.contains("scene") ? results.study.at("scene") : nlohmann::ordered_json();
  if (!scene.contains("stops") || scene.at("stops").is_null()) return "";
  SummaryMeasures all = of_stops(answers::uncertainty_type().read(results.derived));
  for (auto& one : of_cases(answers::limits_type().read(results.derived)))
    if (std::none_of(all.begin(), all.end(), [&](const auto& other) { return other.first == one.first; }))
      all.push_back(std::move(one));
  std::vector<const SummaryMeasures::value_type*> order;
  const auto add = [&](const std::string& measure) {
    for (const auto& one : all)
      if ((one.first == measure || one.first.starts_with(measure + "[")) &&
          std::find(order.begin(), order.end(), &one) == order.end())
        order.push_back(&one);
  };
  for (const asks::Ask& ask : asks::asks_of(results.study)) add(ask.has("on") ? ask.text("on") : ask.subject());
  if (const auto observed = results.study.find("observe"); observed != results.study.end() && observed->is_array())
    for (const auto& name : *observed) add(name.get<std::string>());
  for (const std::string& measure : summary_order) add(measure);
  for (const auto& [name, ignored] : all)
    if (name.find('[') == std::string::npos) add(name);
  const std::size_t shown = std::min(order.size(), most_summary_measures);
  HtmlTable table(
      "Between which values each measure is, over all methods at their finest step and mesh. Beside it: what "
      "these move it by, as shares of the largest value. ?: what the step leaves is not known, as of a single step." +
          (shown < order.size() ? fmt::format(" {} more are in uncertainty.csv and limits.csv.", order.size() - shown)
                                : std::string()),
      {{"measure"}, {"between", true}, {"methods", true}, {"step", true}, {"mesh", true}, {"sampling", true}});
  for (std::size_t k = 0; k < shown; ++k) add_row(table, order[k]->first, order[k]->second);
  return table.html();
}

}  // namespace ricochet::report
