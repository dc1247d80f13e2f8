#pragma once
#include <array>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/measure/contact/stop_contacts.hpp>
#include <ricochet/measure/energy/energy_audit.hpp>
#include <ricochet/measure/statistics/block_bootstrap.hpp>
#include <string>
#include <vector>

#include "runners/store/record.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// Means over the window of a trajectory, cut into equal parts as far as whole steps allow: what a chaotic motion has
/// in place of a path. Of each part: the energy lost at the stops and the momentum that they gave, both over its length
/// (W, N). Then how often points closed in a second (1/s), and the square of the tip's absolute displacement, of whose
/// mean the root is told (m). The mean over the parts has a 95 % interval by the stationary block bootstrap. That holds
/// where the motion is stationary over the window. Parts that drift show as an interval that is too narrow, never too
/// wide.
class WindowMeans final : public StepObserver {
 public:
  static constexpr int fewest_parts = fewest_resampled;

  /// `settings` are those of a trajectory, with or without a window in parts; without, it has nothing to look at. What
  /// stops of a compliant law store is asked for at every step. The audit looks at a step before it. Momentum and
  /// impacts of clearances are those of `contacts`. The window ends at the last of all `steps` at the latest.
  WindowMeans(const Json& settings, const Marcher& marcher, EnergyAudit& audit, long long steps,
              const StopContacts* contacts = nullptr);

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
  bool uneven() const;
  double mean_by_length(const std::vector<double>& series) const;
  Totals now(const Marcher& marcher) const;

  const EnergyAudit& audit_;
  const StopContacts* contacts_;
  double from_ = 0, to_ = 0;
  int parts_ = 0;
  Totals begin_;  // of the part under way
  double squares_ = 0;
  long long steps_ = 0;
  std::array<std::vector<double>, means> series_;
  std::vector<double> lengths_;  // of each part, s
  bool too_many_ = false;        // parts, for the steps of the window
};

/// Whether the settings of a trajectory ask for means over an interval.
inline bool has_window(const Json& settings) {
  return settings.is_object() && settings.contains("window");
}

/// The contact force over an interval of time, as one lane marches. The efforts of an instant of contact give a free
/// mass the momentum Σ ω p over its stages and points (N s). Over the largest ω of its stages (s) this is the force F.
/// The instant weighs as much as that ω, and is of the window where the middle of its step is:
///     F̄ = Σ ω F / Σ ω,   s² = Σ ω (F − F̄)² / Σ ω   (N),
/// so that F̄ times the interval is the impulse, whatever the stages of the scheme. An effort that gives no momentum,
/// of a projection, is no force. Allocates nothing.
class ForceWindow final : public StepObserver {
 public:
  /// [from, to], s; `settings` are those of a trajectory. Without a window it has nothing to look at, and shall not.
  ForceWindow(const Json& settings, const Marcher& marcher);

  void stage_solved(const Marcher& marcher, const StageView& view) override;
  void step_done(Marcher&) override {}
  void interval(Marcher& marcher, const StepInterval& steps) override;

  /// Whether any instant of contact fell into the window.
  bool told() const { return weight_ > 0; }
  double mean() const { return mean_; }
  double deviation() const;

 private:
  bool within(double middle) const { return from_ <= middle && middle < to_; }
  void add(double force, double lasts);

  double from_ = 0, to_ = -1;
  double given_ = 0, lasts_ = 0;  // by the instant under way
  std::vector<double> shares_;    // of each point's effort in the force: of a side of a clearance along its first axis
  double weight_ = 0, mean_ = 0, squares_ = 0;
};

}  // namespace ricochet
