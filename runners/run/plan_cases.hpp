#pragma once
#include <functional>
#include <map>
#include <ricochet/loader/catalogue.hpp>
#include <string>

#include "runners/march/case_plan.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// A case that would run, and how.
struct PlannedCase {
  const StudyCase* study_case;
  CasePlan plan;
  double plan_seconds = 0;  ///< processor time of planning it
};

/// What planning a case gave.
struct PlanOutcome {
  CasePlan plan;
  std::string failure;  ///< "" when there is a plan; else what went wrong, and whose fault it is
  double seconds = 0;   ///< processor time of planning it
};

/// Plans the cases of a study one by one, as `ricochet plan` shows them. A case that uses a foreign plugin is planned
/// in a child process: whatever the plugin does there, the other cases have their plan. One that does not come to an
/// end is waited for once, not once per case. Throws InputError as plan_for does.
class CasePlanner {
 public:
  CasePlanner(const Study& study, const Catalogue& catalogue, const Registry& registry)
      : study_(study), catalogue_(catalogue), registry_(registry) {}
  PlanOutcome plan(const StudyCase& study_case);
  /// What `question` answers, which calls the methods of this case: in a child process where one of them is foreign. ""
  /// where they go wrong.
  std::string ask(const StudyCase& study_case, const std::function<std::string()>& question) const;

 private:
  PlanOutcome planned(const StudyCase& study_case);
  PlanOutcome plan_in_child(const StudyCase& study_case);
  bool uses_foreign(const StudyCase& study_case) const;
  const Study& study_;
  const Catalogue& catalogue_;
  const Registry& registry_;
  std::map<std::pair<std::string, std::string>, std::string> endless_;  ///< role and name → what was found
};

}  // namespace ricochet
