#include "runners/kinds/sweep/rehearsal.hpp"

#include <algorithm>
#include <atomic>

namespace ricochet {
namespace {

// Seconds that a part is meant to take, and those after which it is given up.
constexpr double part_wanted = 0.4, part_longest = 2;
// With fewer an orbit is no longer what it is with more.
constexpr int least_steps = 250;

}  // namespace

double rehearsed(StudyCase part, const Registry& registry, CasePlan (*plan)(const StudyCase&, const Registry&),
                 const RunSweep& run) {
  const CasePlan whole = plan(part, registry);
  if (!whole.refusal.empty() || whole.predicted_seconds <= 0) return 0;
  const double share = std::min(1.0, part_wanted / whole.predicted_seconds);
  part.steps_per_period =
      std::min(part.steps_per_period, std::max(least_steps, static_cast<int>(share * part.steps_per_period)));
  part.settings["budget"] = part_longest;
  const double predicted = plan(part, registry).predicted_seconds;
  const std::atomic<bool> stop = false;
  const CaseRecord record = run(part, registry, {}, stop);
  return predicted > 0 && record.status == "done" ? record.run_seconds / predicted : 0;
}

}  // namespace ricochet
