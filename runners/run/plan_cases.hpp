#pragma once
#include <functional>
#include <map>
#include <ricochet/loader/catalogue.hpp>
#include <string>
#include <vector>

#include "runners/march/prepare_case.hpp"
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

/// Plans the cases of a study, as `ricochet plan` shows them. A case that uses a foreign plugin is planned in a child
/// process: whatever the plugin does there, the other cases have their plan. One that does not come to an end is waited
/// for once, not once per case. Throws InputError as plan_for does.
class CasePlanner {
 public:
  CasePlanner(const Study& study, const Catalogue& catalogue, const Registry& registry)
      : study_(study), catalogue_(catalogue), registry_(registry) {}
  PlanOutcome plan(const StudyCase& study_case);
  /// The same of all, in their order, on so many threads where no child process is needed. Nothing of excluded cases.
  /// `done` hears how many there are so far, from any thread. Of several InputErrors that of the first case is thrown.
  std::vector<PlanOutcome> plan_all(const std::vector<StudyCase>& cases, int at_once,
                                    const std::function<void(std::size_t)>& done);
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

/// A step with its unit, as tables of results write it, unless that has more digits than a person reads.
std::string step_text(double h);

/// What a step makes of the contacts of compliant laws, a line for each law, scheme and step among these cases. A
/// contact lasts half a period, π√(m/κ), of the law's spring κ on the mass m that moves in it. The line tells how many
/// steps that is. It tells what share of its energy a bounce of m loses, over the instants of a step at which it may
/// begin. m = κ/ω². ω is that of the mode with most energy in a spring at the last contact point. A stop with its own κ
/// has a line for its own point. Of an oscillator ω² = (k + κ)/M, M its mass. Laws without a constant stiffness have no
/// line. "" where there is none.
std::string contacts_text(const std::vector<PlannedCase>& cases, const CasePlanner& planner, const Registry& registry);

/// What a study will take, in processor seconds of this machine.
struct Forecast {
  double seconds = 0;  ///< of the whole study
  double chain = 0;    ///< s: the longest part that no more processors shorten
  double fixed = 0;    ///< s of the run itself, however many share the cases
  double beside = 0;   ///< s of what is done before or after the cases (references, repeats)
  double bytes = 0;    ///< of all results in the store, roughly

  /// s of the cases alone.
  double work() const { return seconds - beside - fixed; }
  /// s where so many share the cases.
  double on(int processors) const;
};

/// Sums what the cost model says of each case, adds what the kind does beside (references, repeats), and setting up,
/// storing and describing cases. Fills predicted_seconds of each plan. Within a factor of 3: contact, divergence and
/// transients are not foreseen.
Forecast forecast(const Study& study, std::vector<PlannedCase>& cases, const Registry& registry);

/// Cases of the same key cost about the same: the same methods, mesh, steps and settings, in scenes whose numbers
/// differ in size alone. One that is 0 here and not there sets cases apart, as what it feeds is left out.
std::string cost_key(const StudyCase& study_case);

}  // namespace ricochet
