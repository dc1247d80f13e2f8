#include "runners/kinds/trajectory/stop_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <ricochet/measure/statistics/block_bootstrap.hpp>

#include "runners/kinds/trajectory/outputs.hpp"
#include "runners/kinds/trajectory/stop_measures.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

const Column stop_or_point{"stop", "", "Name of the stop, or number of the contact point."};
const Column side_of_stop{"side", "", "Its side: lower or upper."};

Table histogram_head() {
  return {"histogram",
          "One class of the peak forces of the shocks at one stop of one case. Of more than 100000 different peaks "
          "neighbours are counted as one.",
          {stop_or_point,
           {"from", "N", "The class begins above it; the first one at 0."},
           {"to", "N", "Its end."},
           {"shocks", "1", "Shocks whose peak force is in it, both sides."},
           {"share", "1", "Their share of the shocks at this stop."}},
          {}};
}

Table parts_head(const StopReading& known) {
  Table table{"stop_parts",
              "One part of the window of one case at one stop, both sides.",
              {stop_or_point,
               {"part", "1", "Number of the part, from 0."},
               {"from", "s", "Begin of the part."},
               {"to", "s", "Its end."}},
              {}};
  for (const Column& column : stop_reading_columns(known)) table.columns.push_back(column);
  return table;
}

std::vector<std::string> stop_names(const SemiDiscrete& problem) {
  std::vector<std::string> names = stop_list(problem).names;
  if (problem.stops.empty())
    for (std::size_t point = 0; point < names.size(); ++point) names[point] = std::to_string(point);
  return names;
}

void add_shocks(CaseRecord& record, const ShockRecorder& recorder, const std::vector<std::string>& names) {
  NumberTable table = shocks_type().head();
  table.words = {{"stop", names}, {"side", {"lower", "upper"}}, {"open_end", {"false", "true"}}};
  for (const Shock& shock : shocks_in_order(recorder))
    table.add({static_cast<double>(shock.point), static_cast<double>(shock.side), shock.begin, shock.peak_at,
               shock.peak, shock.impulse, shock.duration, shock.speed_in, static_cast<double>(shock.rebounds),
               shock.open_end ? 1.0 : 0.0});
  if (recorder.count() > static_cast<long long>(table.rows()))
    record.notes.push_back(fmt::format("shocks.csv has {} of {} shocks; histogram.csv and measures have all of them",
                                       table.rows(), recorder.count()));
  record.numbers.push_back(std::move(table));
}

// Equal classes from 0 to the largest peak of each stop, of the shocks of the window.
void add_histogram(CaseRecord& record, const OutputWatch& outputs, const std::vector<std::string>& names) {
  Table table = histogram_head();
  const int classes = outputs.asked().classes;
  for (std::size_t point = 0; point < names.size(); ++point) {
    const CountedValues& peaks = outputs.shocks()->peaks(static_cast<int>(point));
    if (peaks.count() == 0) continue;
    double largest = 0;
    for (const auto& [peak, times] : peaks.counted()) largest = std::max(largest, peak);
    std::vector<long long> counts(static_cast<std::size_t>(classes), 0);
    for (const auto& [peak, times] : peaks.counted())
      counts[static_cast<std::size_t>(std::clamp(static_cast<int>(std::ceil(peak / largest * classes)), 1, classes) -
                                      1)] += times;
    for (int i = 0; i < classes; ++i) {
      const long long count = counts[static_cast<std::size_t>(i)];
      table.rows.push_back({names[point], largest * i / classes, largest * (i + 1) / classes, count,
                            static_cast<double>(count) / static_cast<double>(peaks.count())});
    }
  }
  record.tables.push_back(std::move(table));
}

// What a point is in one part of the window.
StopReading part_reading(const StopWatches& watches, int point, int part) {
  const StopStatistics& statistics = *watches.outputs->statistics();
  StopReading reading;
  reading.window = statistics.window().length();
  reading.displacement = statistics.displacement(point, part);
  reading.pushed = statistics.pushed(point, StopSide::lower, part);
  reading.pushed->add(statistics.pushed(point, StopSide::upper, part));
  if (const ShockRecorder* shocks = watches.outputs->shocks()) {
    reading.shocks = shocks->totals(point, StopSide::lower, part);
    reading.shocks->add(shocks->totals(point, StopSide::upper, part));
  }
  if (watches.tangents && watches.tangents->has(point))
    reading.wear_power = watches.tangents->work(point, part) / reading.window;
  if (watches.friction && watches.friction->has(point)) {
    reading.rubbed_over = reading.window;
    reading.friction = watches.friction->part(point, part);
    reading.friction_works = watches.friction->knows_work();
    reading.wear_power = reading.friction->wear / reading.window;
  }
  return reading;
}

// Half the interval of the mean of a series over the parts; `root`: of the root of it. Nothing of an empty one.
void put_half(CaseRecord& record, const std::string& measure, const std::vector<double>& series, bool root) {
  if (series.empty()) return;
  const Interval found = block_bootstrap_mean(series);
  const auto shown = [root](double x) { return root ? std::sqrt(std::max(x, 0.0)) : x; };
  put_measure(record, "confidence." + measure,
              std::max(shown(found.high) - shown(found.value), shown(found.value) - shown(found.low)));
}

// A series whose mean is R = Σa/Σb and whose scatter is that of R to first order: R + (a_i − R b_i)/b̄. Empty where b
// is 0.
std::vector<double> ratio_series(const std::vector<double>& a, const std::vector<double>& b) {
  const double over = std::accumulate(b.begin(), b.end(), 0.0);
  std::vector<double> out;
  if (!(over > 0)) return out;
  const double ratio = std::accumulate(a.begin(), a.end(), 0.0) / over, mean = over / static_cast<double>(b.size());
  for (std::size_t i = 0; i < a.size(); ++i) out.push_back(ratio + (a[i] - ratio * b[i]) / mean);
  return out;
}

void put_halves(CaseRecord& record, const StopWatches& watches, int point, const std::string& name) {
  const StopStatistics& statistics = *watches.outputs->statistics();
  std::vector<double> displacement, squares, force, force_squares, rate, share, wear, rubbed, held, heat;
  std::vector<double> shocks, shock_rate, rebounds, lasted, hit, peaks;
  const double length = statistics.window().length();
  for (int part = 0; part < statistics.window().count; ++part) {
    const StopReading reading = part_reading(watches, point, part);
    displacement.push_back(reading.displacement->mean);
    squares.push_back(std::pow(reading.displacement->rms(), 2));
    force.push_back(reading.pushed->mean(length));
    force_squares.push_back(reading.pushed->squares / length);
    rate.push_back(static_cast<double>(reading.pushed->impacts) / length);
    share.push_back(reading.pushed->contact_time / length);
    if (reading.wear_power) wear.push_back(*reading.wear_power);
    if (reading.friction) {
      rubbed.push_back(reading.friction->time);
      held.push_back(reading.friction->held);
      if (reading.friction_works) heat.push_back(reading.friction->heat / length);
    }
    if (!reading.shocks) continue;
    shocks.push_back(static_cast<double>(reading.shocks->shocks));
    shock_rate.push_back(shocks.back() / length);
    rebounds.push_back(static_cast<double>(reading.shocks->rebounds));
    lasted.push_back(reading.shocks->lasted);
    hit.push_back(reading.shocks->pushed);
    peaks.push_back(shocks.back() * reading.shocks->peaks.mean);
  }
  const std::string of = "[" + name + "]";
  put_half(record, "window_displacement_mean" + of, displacement, false);
  put_half(record, "window_displacement_rms" + of, squares, true);
  put_half(record, "window_force" + of, force, false);
  put_half(record, "window_rms_force" + of, force_squares, true);
  put_half(record, "window_impact_rate" + of, rate, false);
  put_half(record, "window_contact_share" + of, share, false);
  put_half(record, "window_contact_rms_force" + of, ratio_series(force_squares, share), true);
  put_half(record, "window_contact_force" + of, ratio_series(force, share), false);
  put_half(record, "shock_rate" + of, shock_rate, false);
  put_half(record, "shock_time" + of, ratio_series(lasted, shocks), false);
  put_half(record, "rebound_time" + of, ratio_series(hit, rebounds), false);
  put_half(record, "shock_force_mean" + of, ratio_series(peaks, shocks), false);
  put_half(record, "wear_power" + of, wear, false);
  put_half(record, "friction_power" + of, heat, false);
  put_half(record, "stick_share" + of, ratio_series(held, rubbed), false);
}

void add_parts(CaseRecord& record, const StopWatches& watches, const SemiDiscrete& problem,
               const std::vector<std::string>& names) {
  const StopStatistics& statistics = *watches.outputs->statistics();
  const WindowParts& window = statistics.window();
  // Columns that one stop has, all have.
  StopReading known;
  known.pushed.emplace();
  if (watches.outputs->shocks()) known.shocks.emplace();
  const int stops = static_cast<int>(names.size());
  for (int point = 0; watches.tangents && point < stops; ++point)
    if (watches.tangents->has(point)) known.wear_power = 0;
  for (int point = 0; watches.friction && point < stops; ++point)
    if (watches.friction->has(point)) known.friction.emplace();
  Table table = parts_head(known);
  const std::vector<Column> columns = stop_reading_columns(known);
  for (int point = 0; point < stops; ++point) {
    for (int part = 0; part < window.count && statistics.complete(part); ++part) {
      Row row = {names[static_cast<std::size_t>(point)], part, window.begin(part), window.begin(part + 1)};
      const StopReading reading = part_reading(watches, point, part);
      const Row cells = stop_reading_cells(reading);
      row.insert(row.end(), cells.begin(), cells.end());
      row.resize(table.columns.size());
      table.rows.push_back(std::move(row));
    }
    if (window.count >= fewest_resampled && statistics.complete(window.count - 1) && !problem.stops.empty())
      put_halves(record, watches, point, names[static_cast<std::size_t>(point)]);
  }
  record.tables.push_back(std::move(table));
}

void add_spectra(CaseRecord& record, const OutputWatch& outputs) {
  NumberTable table = spectra_type().head();
  Table octaves = third_octaves_head();
  std::vector<std::string> names;
  for (const SpectrumTaker& one : outputs.spectra()) {
    const auto name = static_cast<double>(names.size());
    names.push_back(one.of().of);
    const std::vector<double> density = one.spectrum().density();
    for (std::size_t k = 0; k < density.size(); ++k)
      table.add({name, one.of().force ? 1.0 : 0.0, one.spectrum().frequency(static_cast<int>(k)), density[k]});
    put_third_octaves(record, octaves, one.of().of, one.of().force, density, one.spectrum().frequency(1));
    if (density.empty())
      record.notes.push_back(fmt::format("no spectrum of {}: the run ended within the first segment", one.of().of));
  }
  table.words = {{"of", names}, {"quantity", {"displacement", "force"}}};
  record.numbers.push_back(std::move(table));
  record.tables.push_back(std::move(octaves));
}

}  // namespace

const NumberType<ShockColumns>& shocks_type() {
  static const NumberType<ShockColumns> all = [] {
    NumberType<ShockColumns> type("shocks",
                                  "One shock of one case: force above force_above, joined while apart by less than "
                                  "rest.");
    type.add(stop_or_point, &ShockColumns::stop)
        .add(side_of_stop)
        .add({"t_begin", "s", "Time of the first instant whose force is above force_above."})
        .add({"t_peak", "s", "Time of the largest force."}, &ShockColumns::t_peak)
        .add({"peak_force", "N", "Largest force."}, &ShockColumns::peak_force)
        .add({"impulse", "N s", "Momentum that the stop gives from the first to the last such instant, by magnitude."})
        .add({"duration", "s", "From the first to the end of the last such instant, whole sub-steps."},
             &ShockColumns::duration)
        .add({"speed_in", "m/s", "Velocity towards the stop when the point last closed before it."})
        .add({"rebounds", "1", "How often the force rose above force_above."}, &ShockColumns::rebounds)
        .add({"open_end", "", "Whether the force was above it when the integration ended."});
    return type;
  }();
  return all;
}

const NumberType<SpectrumColumns>& spectra_type() {
  static const NumberType<SpectrumColumns> all = [] {
    NumberType<SpectrumColumns> type(
        "spectra", "One frequency of one power spectral density of one case, by Welch's method over the window.");
    type.add({"of", "", "Name of the stop or the point."}, &SpectrumColumns::of)
        .add({"quantity", "", "Displacement, or force, positive upwards."}, &SpectrumColumns::quantity)
        .add({"frequency", "Hz", "Frequency f."}, &SpectrumColumns::frequency)
        .add({"density", "m²/Hz or N²/Hz",
              "One-sided power spectral density: its sum times the spacing of f is the variance."},
             &SpectrumColumns::density);
    return type;
  }();
  return all;
}

StopReading stop_reading(const StopContacts& contacts, const StopWatches& watches, int stop,
                         std::optional<StopSide> side) {
  StopReading reading;
  const StopTotals &lower = contacts.totals(stop, StopSide::lower), &upper = contacts.totals(stop, StopSide::upper);
  reading.run = side == StopSide::lower ? lower : side == StopSide::upper ? upper : lower;
  if (!side) {
    reading.run.impacts += upper.impacts;
    reading.run.peak_force = std::max(lower.peak_force, upper.peak_force);
    reading.run.impulse = lower.impulse + upper.impulse;
    reading.run.contact_time = lower.contact_time + upper.contact_time;
    reading.run.squares = lower.squares + upper.squares;
  }
  if (watches.tangents && watches.tangents->has(stop)) reading.wear_power = watches.tangents->power(stop);
  if (watches.friction && watches.friction->has(stop)) {
    const WindowParts& window = watches.friction->window();
    reading.rubbed_over = window.to - window.from;
    reading.friction = watches.friction->totals(stop);
    reading.friction_works = watches.friction->knows_work();
    reading.wear_power = reading.friction->wear / reading.rubbed_over;
  }
  if (!watches.outputs) return reading;
  const OutputWatch& outputs = *watches.outputs;
  reading.window = outputs.asked().window.to - outputs.asked().window.from;
  if (const StopStatistics* statistics = outputs.statistics();
      statistics && statistics->complete(statistics->window().count - 1)) {
    reading.displacement = statistics->displacement(stop);
    reading.pushed = statistics->pushed(stop, side.value_or(StopSide::lower));
    if (!side) reading.pushed->add(statistics->pushed(stop, StopSide::upper));
  }
  if (const ShockRecorder* shocks = outputs.shocks()) {
    reading.shocks = shocks->totals(stop, side.value_or(StopSide::lower));
    if (!side) reading.shocks->add(shocks->totals(stop, StopSide::upper));
  }
  return reading;
}

std::vector<Shock> shocks_in_order(const ShockRecorder& recorder) {
  std::vector<Shock> shocks = recorder.shocks();
  std::sort(shocks.begin(), shocks.end(), [](const Shock& a, const Shock& b) {
    return a.begin != b.begin ? a.begin < b.begin : a.point != b.point ? a.point < b.point : a.side < b.side;
  });
  return shocks;
}

double shock_of(const Impact& impact, const std::vector<Shock>& in_order) {
  // An impact begins no later than its first force above that of the rule, and ends after it.
  const double rounding = 1e-9 * (impact.duration + impact.time);
  for (auto at = std::lower_bound(in_order.begin(), in_order.end(), impact.time + impact.duration + rounding,
                                  [](const Shock&shock, double t) { return shock.begin < t; });
       at != in_order.begin();) {
    --at;
    if (at->point != impact.point || at->side != impact.side) continue;
    return at->begin + at->duration >= impact.time - rounding ? static_cast<double>(at - in_order.begin())
                                                              : std::nan("");
  }
  return std::nan("");
}

void add_stop_tables(CaseRecord& record, const SemiDiscrete& problem, const StopWatches& watches) {
  if (!watches.outputs) return;
  const OutputWatch& outputs = *watches.outputs;
  const std::vector<std::string> names = stop_names(problem);
  if (outputs.shocks()) {
    add_shocks(record, *outputs.shocks(), names);
    add_histogram(record, outputs, names);
  }
  if (outputs.statistics()) add_parts(record, watches, problem, names);
  if (!outputs.spectra().empty()) add_spectra(record, outputs);
}

std::vector<Table> stop_table_heads() {
  Table parts = parts_head({});
  parts.columns = joined(parts.columns, all_stop_reading_columns());
  return {histogram_head(), parts, third_octaves_head()};
}

}  // namespace ricochet
