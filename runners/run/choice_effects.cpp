#include "runners/run/choice_effects.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/measure/statistics/effects.hpp>

#include "runners/report/html.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/study_tables.hpp"
#include "runners/study/axis_meaning.hpp"

namespace ricochet {

MeasureScale::MeasureScale(const std::string& measure) : measure_(measure) {
  if (const MeasureInfo* info = measure_info(measure)) scale_ = info->scale;
}

std::optional<double> MeasureScale::of(const CaseRecord& record) const {
  if (share()) return 1.0;
  if (!own()) return measure(record, scale_);
  const auto value = measure(record, measure_);
  return value ? std::optional(std::abs(*value)) : std::nullopt;
}

MeasureSpread spread_of(const StudyResults& results, const std::string& name) {
  const MeasureScale scale(name);
  MeasureSpread spread;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const CaseRecord& record : results.cases) {
    const auto value = record.status == Status::done ? measure(record, name) : std::nullopt;
    if (!value) continue;
    low = std::min(low, *value);
    high = std::max(high, *value);
    const double own = scale.of(record).value_or(0);
    spread.scale = std::max(spread.scale, own);
    spread.floor = std::max(spread.floor, round_off(record) * own);
  }
  spread.width = high - low;
  return spread;
}

double round_off(const CaseRecord& record) {
  return 0x1p-52 * static_cast<double>(record.steps);
}

namespace {

// A measure that no kind declares is taken for one of the motion.
bool of_the_motion(const std::string& measure) {
  const MeasureInfo* info = measure_info(measure);
  return !info || info->of == MeasureInfo::Of::motion;
}

// Whether the finished cases of some level never have this measure while those of another do. That level then has none:
// what is absent may neither be filled in nor taken for zero.
bool absent_by_level(const StudyResults& results, const std::vector<Factor>& factors,
                     const std::vector<std::optional<double>>& values) {
  for (const Factor& factor : factors) {
    std::vector<int> done(factor.levels.size(), 0), present(factor.levels.size(), 0);
    for (std::size_t c = 0; c < values.size(); ++c) {
      done[factor.level[c]] += results.cases[c].status == Status::done ? 1 : 0;
      present[factor.level[c]] += values[c] ? 1 : 0;
    }
    for (std::size_t l = 0; l < done.size(); ++l)
      if (done[l] > 0 && present[l] == 0) return true;
  }
  return false;
}

/// Whether what the finished cases differ by is more than round-off makes of the measure: 2⁻⁵² × steps of its scale.
bool beyond_round_off(const StudyResults& results, const std::string& name) {
  const MeasureSpread spread = spread_of(results, name);
  return spread.width > spread.floor;
}

/// Two levels have a difference, and no share that another choice of levels would not change: a factor needs three.
bool has_share(const EffectShare& share, const std::vector<Factor>& factors) {
  static const std::string times = " × ";
  constexpr std::size_t fewest = 3;
  const std::string padded = times + share.factor + times;
  return std::none_of(factors.begin(), factors.end(), [&](const Factor& factor) {
    return factor.levels.size() < fewest && padded.find(times + factor.name + times) != std::string::npos;
  });
}

}  // namespace

Table effects_table(const StudyResults& results) {
  std::vector<EffectRow> rows;
  std::vector<std::vector<std::string>> cells;
  std::vector<std::string> measures;
  for (const CaseRecord& record : results.cases) {
    std::vector<std::string> row;
    for (const Cell& value : axes_of(record, results.columns)) row.push_back(value.text());
    cells.push_back(std::move(row));
    for (const auto& [name, value] : record.measures)
      if (of_the_motion(name) && std::find(measures.begin(), measures.end(), name) == measures.end())
        measures.push_back(name);
  }
  std::vector<Factor> factors = factors_of(results.columns, cells).factors;
  std::erase_if(factors, [](const Factor& factor) { return factor.levels.size() < 2; });
  const auto told = [](const Factor& factor) { return factor.levels.size() > 2; };
  if (factors.size() < 2 || std::none_of(factors.begin(), factors.end(), told)) return effects_type().head();
  for (const std::string& name : measures) {
    std::vector<std::optional<double>> values;
    for (const CaseRecord& record : results.cases)
      values.push_back(record.status == Status::done ? measure(record, name) : std::nullopt);
    if (absent_by_level(results, factors, values) || !beyond_round_off(results, name)) continue;
    const Effects effects = effects_of(factors, values);
    for (const EffectShare& share : effects.shares)
      if (has_share(share, factors))
        rows.push_back({name, share.factor, share.share, share.low, share.high, effects.log});
  }
  return effects_type().with(rows);
}

}  // namespace ricochet
