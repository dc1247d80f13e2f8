#pragma once
#include <ricochet/measure/energy/energy_audit.hpp>
#include <ricochet/measure/statistics/running_moments.hpp>
#include <vector>

namespace ricochet {

/// What friction did at a stop in an interval of time. A stage gives ω s of momentum per N; V⁻ and V⁺ are how fast the
/// surface slides before and after it, 0 while it sticks.
struct FrictionTotals {
  double time = 0;     ///< Σ ω while something presses, s
  double held = 0;     ///< the same while it sticks, s
  double changes = 0;  ///< how often it begins or ends to stick while something presses; a stick has two steps at least
  double impulse = 0;  ///< Σ ω |p_t|, N s
  double squares = 0;  ///< Σ ω p_t², N² s
  double peak = 0;     ///< largest |p_t|, N
  double heat = 0;     ///< −Σ p̄_tᵀ(T s + Δφ_t − ∫V dt), J
  double slipped = 0;  ///< Σ ω ½(V⁻ + V⁺), m
  double wear = 0;     ///< Σ ω |N| ½(V⁻ + V⁺), J
  double drifted = 0;  ///< Σ |T s + …| while it sticks, m

  void add(const FrictionTotals& other);
};

/// Adds them up by stop over the parts of a window. It looks at a stage after the audit. Where a point has just closed,
/// V⁻ is the velocity of the scheme before.
class FrictionWatch final : public StepObserver {
 public:
  FrictionWatch(const Marcher& marcher, const EnergyAudit& audit, const WindowParts& window);

  bool any() const { return !points_.empty(); }
  void stage_solved(const Marcher& marcher, const StageView& view) override;
  void step_done(Marcher&) override {}

  bool has(int stop) const { return number_of(stop) >= 0; }
  FrictionTotals totals(int stop) const;
  const FrictionTotals& part(int stop, int part) const;
  const WindowParts& window() const { return window_; }
  /// Whether heat and drift are known: of schemes with a work form.
  bool knows_work() const { return audit_.balances(); }
  /// Largest residual of friction over the run, and the turns that the slowest stage took.
  double residual() const { return residual_; }
  int most_turns() const { return most_turns_; }

 private:
  struct Point {
    int stop = 0;
    double slid = 0;  // V⁻
    bool pressed = false, held = false;
    bool sticks = false;       // what changes are counted of: held in two steps
    long long held_since = 0;  // step
  };
  int number_of(int stop) const;

  const EnergyAudit& audit_;
  WindowParts window_;
  double h_;
  std::vector<Point> points_;
  std::vector<FrictionTotals> totals_;  // points × parts
  double residual_ = 0;
  int most_turns_ = 0;
};

}  // namespace ricochet
