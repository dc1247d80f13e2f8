#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "runners/answers/limits.hpp"
#include "runners/answers/uncertainty.hpp"
#include "runners/kinds/trajectory/page/page.hpp"
#include "runners/kinds/trajectory/stop_tables.hpp"
#include "runners/report/choices.hpp"
#include "runners/report/html.hpp"
#include "runners/table/in_order_met.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet::report {
namespace {

// Of the many measures of a stop, those that a first look is for, in this order.
const std::vector<std::string> first_measures = {"impacts",
                                                 "window_impact_rate",
                                                 "shock_rate",
                                                 "impulse",
                                                 "peak_force",
                                                 "rms_force",
                                                 "window_force",
                                                 "shock_force_mean",
                                                 "shock_time",
                                                 "window_contact_share",
                                                 "window_displacement_rms",
                                                 "window_displacement_max",
                                                 "wear_power"};

constexpr std::size_t most_shocks_drawn = 3000, most_lines_drawn = 400;

/// Densities of one record by series: "bar-a\nforce".
std::map<std::string, std::vector<double>> densities(const CaseRecord& record, std::vector<double>* frequencies) {
  std::map<std::string, std::vector<double>> out;
  const NumberTable* table = spectra_type().find(record.numbers);
  if (!table) return out;
  const auto& [of, quantity, f, density] = spectra_type().read(*table);
  const auto *names = table->words_of("of"), *quantities = table->words_of("quantity");
  if (!of || !quantity || !f || !density || !names || !quantities) return out;
  for (std::size_t i = 0; i < table->rows(); ++i) {
    const std::string key =
        names->at(static_cast<std::size_t>((*of)[i])) + "\n" + quantities->at(static_cast<std::size_t>((*quantity)[i]));
    out[key].push_back((*density)[i]);
    if (frequencies && out.size() == 1) frequencies->push_back((*f)[i]);
  }
  return out;
}

struct Band {
  std::vector<double> least, largest, gap;
};

void widen_band(Band& band, const std::vector<double>& finest, const std::vector<double>* coarser) {
  if (band.least.empty()) band = {finest, finest, std::vector<double>(finest.size(), 0.0)};
  for (std::size_t k = 0; k < std::min(finest.size(), band.least.size()); ++k) {
    band.least[k] = std::min(band.least[k], finest[k]);
    band.largest[k] = std::max(band.largest[k], finest[k]);
    if (coarser && k < coarser->size()) band.gap[k] = std::max(band.gap[k], std::abs((*coarser)[k] - finest[k]));
  }
}

}  // namespace

std::vector<Cases> methods_from_finest(const Choices& study) {
  InOrderMet<std::string, Cases> groups;
  for (const CaseRecord* record : with_status(all_cases(study.results()), Status::done))
    groups[study.key(*record)].push_back(record);
  std::vector<Cases> out;
  for (auto& [key, cases] : std::move(groups).list()) {
    std::stable_sort(cases.begin(), cases.end(),
                     [&](const CaseRecord* a, const CaseRecord* b) { return study.finer(*a, *b); });
    out.push_back(std::move(cases));
  }
  return out;
}

std::string stops_html(const Choices& choices) {
  const std::vector<answers::StopRange> all = answers::uncertainty_type().read(choices.results().derived);
  if (all.empty()) return "";
  std::vector<std::string> stops;
  std::map<std::pair<std::string, std::string>, const answers::StopRange*> rows;
  for (const answers::StopRange& row : all) {
    // Levels of spectra may be those of points.
    if (std::find(first_measures.begin(), first_measures.end(), row.measure) == first_measures.end()) continue;
    if (std::find(stops.begin(), stops.end(), row.stop) == stops.end()) stops.push_back(row.stop);
    rows[{row.measure, row.stop}] = &row;
  }
  HtmlTable html(
      "What each stop gives: the range over all methods at their finest step and mesh, widened by what these leave "
      "open. All measures: uncertainty.csv.",
      {{"measure"}, {"unit"}});
  for (const std::string& stop : stops) html.add({stop, true});
  for (const std::string& name : first_measures) {
    if (std::none_of(stops.begin(), stops.end(), [&](const std::string& stop) { return rows.contains({name, stop}); }))
      continue;
    html.row(in_words(name));
    answers::MeasureWords words;
    double size = 0;
    const auto ends = [](const answers::StopRange& row) {
      return std::pair(row.low.value_or(row.least), row.low ? row.high.value_or(0) : row.largest);
    };
    for (const std::string& stop : stops)
      if (const auto found = rows.find({name, stop}); found != rows.end()) {
        words.unit = found->second->unit;
        const auto [low, high] = ends(*found->second);
        size = std::max({size, std::abs(low), std::abs(high)});
      }
    words = answers::prefixed(std::move(words), size);
    html.text(words.unit);
    for (const std::string& stop : stops) {
      const auto found = rows.find({name, stop});
      if (found == rows.end()) {
        html.absent();
        continue;
      }
      const auto [least, largest] = ends(*found->second);
      const std::string low = short_number(words.factor * least, 3), high = short_number(words.factor * largest, 3),
                        text = low == high ? low : low + " to " + high;
      html.number(found->second->low ? text : text + " ?", found->second->sentence);
    }
  }
  return html.html();
}

Table shock_points(const Choices& choices) {
  Table out{"shock_points",
            "One of the largest shocks of the finest case of a method.",
            {{"case", "", "Identity of the case: its row in cases.csv."},
             {"stop", "", "Name of the stop, or number of the contact point."},
             {"t", "s", "Time of the largest force."},
             {"peak", "N", "Largest force."},
             {"duration", "s", "Duration."},
             {"rebounds", "1", "Rebounds."}},
            {}};
  struct Point {
    double peak;
    Row row;
  };
  std::vector<Point> points;
  for (const Cases& cases : methods_from_finest(Choices(choices.results()))) {
    const CaseRecord& record = *cases.front();
    const NumberTable* table = shocks_type().find(record.numbers);
    if (!table || table->rows() == 0) continue;
    const ShockColumns at = shocks_type().read(*table);
    const std::vector<std::string>& stops = table->words.front().second;
    for (std::size_t i = 0; i < table->rows(); ++i)
      points.push_back({(*at.peak_force)[i],
                        {record.id, stops.at(static_cast<std::size_t>((*at.stop)[i])), (*at.t_peak)[i],
                         (*at.peak_force)[i], (*at.duration)[i], (*at.rebounds)[i]}});
  }
  std::stable_sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.peak > b.peak; });
  for (Point& point : points) {
    if (out.rows.size() == most_shocks_drawn) break;
    out.rows.push_back(std::move(point.row));
  }
  return out;
}

Table spectrum_bands(const Choices& choices) {
  Table out{"spectrum_bands",
            "One frequency of one spectrum: between which densities all methods are.",
            {{"of", "", "Name of the stop or the point."},
             {"quantity", "", "Displacement or force."},
             {"frequency", "Hz", "Frequency."},
             {"least", "m²/Hz or N²/Hz", "Least density over the methods, each at its finest step and mesh."},
             {"largest", "m²/Hz or N²/Hz", "Largest of them."},
             {"low", "m²/Hz or N²/Hz", "The least less what the last refinement moves a method by."},
             {"high", "m²/Hz or N²/Hz", "The largest and that."}},
            {}};
  std::map<std::string, Band> bands;
  std::vector<double> frequencies;
  for (const Cases& cases : methods_from_finest(Choices(choices.results()))) {
    std::vector<double> own;
    const auto finest = densities(*cases.front(), &own);
    if (own.size() > frequencies.size()) frequencies = own;
    std::map<std::string, std::vector<double>> coarser;
    if (cases.size() > 1) coarser = densities(*cases[1], nullptr);
    for (const auto& [key, density] : finest) {
      const auto other = coarser.find(key);
      widen_band(bands[key], density, other == coarser.end() ? nullptr : &other->second);
    }
  }
  for (const auto& [key, band] : bands) {
    const std::size_t count = std::min(band.least.size(), frequencies.size());
    const std::size_t together = (count + most_lines_drawn - 1) / most_lines_drawn;
    for (std::size_t k = 1; k < count; k += std::max<std::size_t>(together, 1)) {
      double least = band.least[k], largest = band.largest[k], low = least, high = largest;
      for (std::size_t i = k; i < std::min(k + together, count); ++i) {
        least = std::min(least, band.least[i]);
        largest = std::max(largest, band.largest[i]);
        low = std::min(low, band.least[i] - band.gap[i]);
        high = std::max(high, band.largest[i] + band.gap[i]);
      }
      const std::size_t cut = key.find('\n');
      out.rows.push_back(
          {key.substr(0, cut), key.substr(cut + 1), frequencies[k], least, largest, std::max(low, 0.0), high});
    }
  }
  return out;
}

}  // namespace ricochet::report
