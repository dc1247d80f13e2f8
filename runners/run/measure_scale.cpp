#include "runners/run/measure_scale.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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
    const auto value = record.status == "done" ? measure(record, name) : std::nullopt;
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

}  // namespace ricochet
