#pragma once
#include <optional>
#include <string>
#include <vector>

#include "runners/report/case_view.hpp"

namespace ricochet::report {

/// One row of a case's `stability` table, with what `stability_observed` says of the same cell.
struct StabilityCell {
  double step = 0;
  std::optional<double> radius;  ///< of the contact state itself
  std::optional<double> worst;   ///< the larger of the radii that the marched cell meets: a scene is open as well
  std::string marginal, status, reason;
  std::string behaviour;  ///< "" where not observed; stable, marginal, unstable, diverged, failed
  bool predicted_unstable() const { return worst && *worst > 1 + 1e-6; }
  bool observed_unstable() const { return behaviour == "unstable" || behaviour == "diverged" || behaviour == "failed"; }
  bool disagrees() const { return worst && !behaviour.empty() && predicted_unstable() != observed_unstable(); }
};

/// One contact state of one case, along the step.
struct StabilityRange {
  const CaseRecord* record = nullptr;
  bool closed = false;
  std::vector<StabilityCell> cells;
  std::optional<double> predicted, observed;  ///< step limits, s
  std::optional<double> expected;             ///< the smaller of the predicted limits that the marched cell meets
};

/// Open or closed range of a case; nothing where its tables have no such rows.
std::optional<StabilityRange> stability_range(const CaseRecord& record, bool closed);

/// Cases with such a range. Open ranges do not depend on the contact law: of cases that differ in it alone the first
/// stands for all (one that was refused only where all were).
Cases stability_cases(const CaseView& view, bool closed);

/// Columns of the contact law.
std::vector<std::string> contact_columns(const CaseView& view);

/// Neighbouring steps at which prediction and observation differ in the same way.
struct Disagreement {
  double from = 0, to = 0;  ///< s
  size_t steps = 0;
  bool predicted_unstable = false;
};

/// How the cells of a range disagree; empty where they agree.
std::vector<Disagreement> disagreements(const StabilityRange& range);

}  // namespace ricochet::report
