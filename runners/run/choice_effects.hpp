#pragma once
#include <ricochet/measure/statistics/effects.hpp>
#include <string>
#include <vector>

#include "runners/store/record.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {

/// What differences of a measure are shares of, as MeasureInfo::scale declares it.
class MeasureScale {
 public:
  explicit MeasureScale(const std::string& measure);
  /// The measure has no scale but its own largest value.
  bool own() const { return scale_.empty(); }
  /// The measure is a share itself.
  bool share() const { return scale_ == "1"; }
  /// The measure that is the scale; "" where own() or share().
  std::string name() const { return share() ? "" : scale_; }
  /// Its size in a case: 1 of a share, |value| where own(); nothing where the case lacks it.
  std::optional<double> of(const CaseRecord& record) const;

 private:
  std::string measure_, scale_;
};

/// How far the finished cases of a study spread in a measure.
struct MeasureSpread {
  double width = 0;  ///< largest less smallest value
  double scale = 0;  ///< largest of what differences are shares of
  double floor = 0;  ///< what round-off of the longest runs may make of it
};
MeasureSpread spread_of(const StudyResults& results, const std::string& measure);

/// What round-off of a run may make of a value, over its scale: 2⁻⁵² × steps.
double round_off(const CaseRecord& record);

/// effects: per measure of the motion, the share of its spread that each choice explains; no rows where fewer than two
/// choices vary.
Table effects_table(const StudyResults& results);

}  // namespace ricochet
