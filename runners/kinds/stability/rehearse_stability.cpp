#include <algorithm>
#include <atomic>

#include "runners/kinds/stability/run_stability.hpp"
#include "runners/march/prepare_case.hpp"

namespace ricochet {
namespace {

constexpr int few_steps_of_range = 4;
constexpr double longest_part = 1;  // s

}  // namespace

double rehearse_stability(const StudyCase& study_case, const Registry& registry) {
  StudyCase part = study_case;
  Json& count = part.settings["steps"]["count"];
  count = std::min(count.get<int>(), few_steps_of_range);
  part.settings["budget"] = longest_part;
  const double predicted = plan_stability(part, registry).predicted_seconds;
  const std::atomic<bool> stop = false;
  const CaseRecord record = run_stability(part, registry, stop);
  return predicted > 0 && record.status == "done" ? (record.setup_seconds + record.run_seconds) / predicted : 0;
}

}  // namespace ricochet
