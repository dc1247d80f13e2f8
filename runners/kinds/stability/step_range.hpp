#pragma once
#include <optional>
#include <string>
#include <vector>

#include "runners/store/record.hpp"

/// \file
/// The cells that a case of kind `stability` left, as a range of steps.
namespace ricochet {

/// One step of a range.
struct StepCell {
  double step = 0;               ///< s
  std::optional<double> radius;  ///< of the contact state itself
  std::optional<double> worst;   ///< the larger of the radii that the marched cell meets: a scene is open as well
  std::string marginal, status, reason;
  std::string behaviour;  ///< "" where not observed; stable, marginal, unstable, diverged, failed
  /// By the tolerance of the spectrum itself (growth_tolerance).
  bool predicted_unstable() const;
  bool observed_unstable() const { return behaviour == "unstable" || behaviour == "diverged" || behaviour == "failed"; }
  bool disagrees() const { return worst && !behaviour.empty() && predicted_unstable() != observed_unstable(); }
};

/// One contact state of one case, along the step.
struct StepRange {
  std::vector<StepCell> cells;                ///< steps increase
  std::optional<double> predicted, observed;  ///< step limits, s
  std::optional<double> expected;             ///< the smaller of the predicted limits that the marched cell meets
};

/// The open or closed range of a case; nothing where its tables have no such rows.
std::optional<StepRange> step_range(const CaseRecord& record, bool closed);

/// Neighbouring steps at which prediction and observation differ in the same way.
struct Disagreement {
  double from = 0, to = 0;  ///< s
  std::size_t steps = 0;
  bool predicted_unstable = false;
};

/// How the cells of a range disagree; empty where they agree.
std::vector<Disagreement> disagreements(const StepRange& range);

}  // namespace ricochet
