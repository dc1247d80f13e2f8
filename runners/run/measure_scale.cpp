#include "runners/run/measure_scale.hpp"

#include <cmath>

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

double round_off(const CaseRecord& record) {
  return 0x1p-52 * static_cast<double>(record.steps);
}

}  // namespace ricochet
