#pragma once
#include <ricochet/measure/contact/impact_recorder.hpp>
#include <string>
#include <vector>

#include "runners/march/prepare_case.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// Looks at how far the points of one lane get beyond stops that are on both sides of them, beside the gap between
/// them. Points with a stop on one side, or without room between two, have no gap.
class GapWatch {
 public:
  explicit GapWatch(const Marcher& marcher);

  /// After a step at whose end some point is `penetration` (m) beyond its stop. Costs a comparison where that is within
  /// the smallest gap; no allocation.
  void see(const Marcher& marcher, double penetration) {
    if (penetration > known_) update(marcher, penetration);
  }

  /// What the integration did in steps too long for its gaps, a sentence each. `crossed`: a point comes to its stop
  /// with a speed that crosses the gap in a step. `passed`: a point passes its stop by more than the gap; of contacts
  /// that the steps resolve, which a soft stop explains, by more than ten. `recorder`: of the whole integration.
  static Said crossed(const Marcher& marcher, const ImpactRecorder& recorder);
  Said passed(bool resolved) const;

 private:
  void update(const Marcher& marcher, double penetration);
  double known_;  // m: no less is news; at first the smallest gap
  double times_ = 0, first_ = 0;
};

/// What steps of `step` (s) from t = 0 on do not resolve of a load that is a formula in t, or a table, and of motions
/// in tables, a sentence each. It comes and goes within a step (no step sees it, or one instant alone), or it jumps. L
/// being the largest load, or what a table gives of a motion at most:
///
///     comes and goes    inside of a step it is beyond both of its ends by more than L/10, or at one end it is beyond
///                       the ends before and behind by more than L/2 (both are met by a wave of six steps and less);
///     jumps             by more than L/4 in a step, half of it or more in an eighth of that step.
///
/// Looks at a quarter of the steps, 500 to 2500 of them, spread evenly. It looks closely around the numbers that stand
/// in the formulas, 64 of each at most, and at the entries of tables, 10⁵ of each. What it does not find of a formula
/// may be there. Costs half a millisecond at most where a formula takes 100 ns, and some 100 ns an entry.
std::vector<Said> load_changes(const SceneSpec& scene, double step, long long steps);

/// What a run of `duration` (s) shows of a structure whose slowest period is more than a hundred times as long: nothing
/// of that motion. Nothing where no such period is known.
Said short_run(const SemiDiscrete& problem, double duration);

/// Whether a point passed its stop by more (m) than a table of its law, against a depth, knows: its last slope goes on.
Said beyond_table(const MethodChoice& law, const PluginManual& manual, double deepest);

/// What the steps of a case do not resolve, and what its duration does not show: load_changes() and short_run().
std::vector<Said> run_doubts(const StudyCase& study_case, const Prepared& prepared);

/// What the step of a case makes of its tables and spectra, a sentence each. Told are tables with many steps between
/// entries, and spectra whose highest line has fewer than five steps in its period.
std::vector<std::string> table_notes(const StudyCase& study_case);

/// Tables of a scene whose entries, Δ apart, resolve nothing above 1/2Δ, a sentence each. Told where the structure has
/// a mode of one of these pulsations (rad/s, in order) above.
std::vector<std::string> coarse_tables(const SceneSpec& scene, const std::vector<double>& pulsations);

}  // namespace ricochet
