#pragma once
#include <array>
#include <ricochet/measure/energy/energy_audit.hpp>
#include <ricochet/measure/statistics/block_bootstrap.hpp>
#include <string>
#include <vector>

#include "runners/store/record.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// Means over the window of a trajectory, cut into equal parts: what a chaotic motion has in place of a path. Of each
/// part: the energy lost at the stops and the momentum that they gave, both over its length (W, N); how often points
/// closed in a second (1/s); the root mean square of the tip's absolute displacement (m). The mean over the parts
/// comes with its 95 % interval by the stationary block bootstrap, which holds where the motion is stationary over the
/// window: parts that drift show as an interval that is too narrow, never too wide.
class WindowMeans final : public StepObserver {
 public:
  static constexpr int fewest_parts = fewest_resampled;

  /// `settings` are those of a trajectory, with or without a window in parts; without, it has nothing to look at. What
  /// stops of a compliant law store is asked for at every step. The audit looks at a step before it.
  WindowMeans(const Json& settings, const Marcher& marcher, EnergyAudit& audit);

  bool asked() const { return parts_ > 0; }
  void stage_solved(const Marcher&, const StageView&) override {}
  void step_done(Marcher& marcher) override;
  void interval(Marcher& marcher, const StepInterval& steps) override;

  /// Puts each mean, and half the width of its interval as confidence.NAME; a note where the run ended before the
  /// window did. Nothing without parts.
  void put(CaseRecord& record) const;

 private:
  enum Mean { power, force, rate, tip, means };
  struct Totals {
    double t = 0, lost = 0, impulse = 0, impacts = 0;
  };
  bool before_window(const Marcher& marcher) const;
  bool over() const { return series_[tip].size() >= static_cast<std::size_t>(parts_); }
  void see_step(const Marcher& marcher);
  long long next_shown(const Marcher& marcher) const;
  double part_end() const;
  Totals now(const Marcher& marcher) const;

  const EnergyAudit& audit_;
  double from_ = 0, to_ = 0;
  int parts_ = 0;
  Totals begin_;  // of the part under way
  double squares_ = 0;
  long long steps_ = 0;
  std::array<std::vector<double>, means> series_;
};

}  // namespace ricochet
