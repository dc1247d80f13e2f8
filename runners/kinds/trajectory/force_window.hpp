#pragma once
#include <ricochet/engine/marcher.hpp>

#include "runners/study/study.hpp"

namespace ricochet {

/// Whether the settings of a trajectory ask for means over an interval.
inline bool has_window(const Json& settings) {
  return settings.is_object() && settings.contains("window");
}

/// The contact force over an interval of time, as one lane marches. What the efforts of an instant of contact give a
/// free mass, Σ ω p over its stages and points (N s), is a force F over the largest ω of its stages (s), which is also
/// what the instant weighs:
///     F̄ = Σ ω F / Σ ω,   s² = Σ ω (F − F̄)² / Σ ω   (N),
/// so that F̄ times the interval is the impulse, whatever the stages of the scheme. An effort that gives no momentum, of
/// a projection, is no force. Allocates nothing.
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
  void add(double force, double lasts);

  double from_ = 0, to_ = -1;
  double given_ = 0, lasts_ = 0;  // by the instant under way
  double weight_ = 0, mean_ = 0, squares_ = 0;
};

}  // namespace ricochet
