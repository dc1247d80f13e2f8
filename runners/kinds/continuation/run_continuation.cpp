#include "runners/kinds/continuation/run_continuation.hpp"

#include <fmt/format.h>

#include "runners/kinds/continuation/continuation_study.hpp"
#include "runners/kinds/continuation/continuation_tables.hpp"
#include "runners/kinds/sweep/forced_scenes.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"

namespace ricochet {

CasePlan plan_continuation(const StudyCase& study_case, const Registry& registry) {
  CasePlan out;
  const ContinuationPlan plan = continuation_plan(study_case.settings);
  ForcedScenes scenes(study_case, registry);
  for (const WantedOrbit& orbit : plan.orbits) {
    const int scene = scenes.add(plan.pointer, orbit.at, orbit.from == OrbitSource::state);
    if (scenes[scene].refusal.empty()) break;
    if (out.refusal.empty()) out.refusal = fmt::format("at {:g}: {}", orbit.at, scenes[scene].refusal);
  }
  if (scenes.groups() == 0) return out;
  out.refusal.clear();
  describe_march(out, scenes, study_case);
  return out;
}

CaseRecord run_continuation(const StudyCase& study_case, const Registry& registry, const CaseContext&,
                            const std::atomic<bool>&) {
  CaseRecord record;
  record.id = study_case.id;
  record.axes = study_case.axes;
  const CasePlan plan = plan_continuation(study_case, registry);
  if (!plan.refusal.empty()) {
    record.status = "refused";
    record.reason = plan.refusal;
    return record;
  }
  const ContinuationPlan settings = continuation_plan(study_case.settings);
  record.tables.push_back(branches_table(settings.multipliers, {}));
  record.tables.push_back(special_points_type().with({}));
  record.tables.push_back(turns_type().with({}));
  record.status = "done";
  return record;
}

}  // namespace ricochet
