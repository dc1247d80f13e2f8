#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <ricochet/contract/registry.hpp>
#include <ricochet/contract/step_plan.hpp>
#include <ricochet/engine/indefinite_step.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "runners/store/record.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// What would run for a case, decided without running it.
struct CasePlan {
  std::string refusal;        ///< "" when the case applies
  std::string operator_name;  ///< diagonal, modal, band, sparse
  long long steps = 0;
  double predicted_seconds = 0;
  double trial_seconds = 0;  ///< processor time of planning that the case itself does not take
  /// Of predicted_seconds, what no more processors shorten: orbits that begin where others end, the last block of a
  /// grid. 0: all.
  double chain_seconds = 0;
  double bytes = 0;                           ///< of its results in the store, roughly
  double coarsest_step = 0, finest_step = 0;  ///< s, of those that the case takes; 0 where it is refused
  std::vector<std::pair<std::string, std::string>> left_out;  ///< item, reason
  std::vector<std::string> notes;
};

/// Thrown out of a case when `stop` became true while it marched; the case leaves nothing behind.
struct Interrupted {};

/// What is no case's fault ends the run, and no case is stored for it: memory, processes or threads are at an end (exit
/// code 5), or a plugin lets no worker begin (4).
class RunError : public std::runtime_error {
 public:
  explicit RunError(const std::string& message, bool of_plugin = false)
      : std::runtime_error(message), of_plugin_(of_plugin) {}
  bool of_plugin() const { return of_plugin_; }

 private:
  bool of_plugin_;
};

/// Whether a scheme is explicit: no stage of its plan solves with K.
bool explicit_step(const StepPlan& plan);

/// The sentence with which the step h (s) of an explicit scheme is refused where the free structure grows in it. The
/// spectral radius of the step, contact open, is then beyond 1. It names the largest stable step, found by bisection of
/// the spectrum over plans that `plan_at` makes. "" where the step is stable, the scheme is implicit, or the structure
/// has more dofs than modes are found of.
Said beyond_explicit_limit(const std::shared_ptr<const SemiDiscrete>& problem, const StepPlan& plan, double h,
                           const std::function<PlanOrRefusal(double)>& plan_at);

/// A case made ready: its semi-discrete problem and its program, or the sentence that says why it does not apply.
struct Prepared {
  std::shared_ptr<const SemiDiscrete> problem;
  std::optional<Program> program;
  Said refusal;
  long long steps = 0;  ///< whole steps within the duration
  std::vector<std::string> notes;
  double aside_seconds = 0;  ///< processor time of looking for the limit of an explicit step: no part of the method
};

/// Discretises, plans and compiles a case. `step` and `elements` may differ from the case's own (references).
/// `audited`: an EnergyAudit reads the march.
Prepared prepare_case(const StudyCase& study_case, const Registry& registry, bool audited = false);

/// The record of a case as far as its preparation tells: id, axes, notes, operator, what is left out. Where there is no
/// program it is `refused`, with the sentence.
CaseRecord begin_record(const StudyCase& study_case, const Prepared& prepared);

/// Records an integration that stopped before its end: diverged or failed, with the step, the time and the cause. A
/// lane that still runs ran out of its budget, and failed.
void record_early_end(CaseRecord& record, const Marcher& marcher, long long steps, double budget);

/// What makes the figures of a finished case doubtful, a sentence each ("" is none): its reason where it is done, else
/// notes.
void add_doubts(CaseRecord& record, const std::vector<Said>& doubts);

/// The case's "march".
MarchWay march_way(const StudyCase& study_case);

/// The methods of a case, made.
std::unique_ptr<MassStrategy> make_mass(const StudyCase& study_case, const Registry& registry);
std::unique_ptr<ContactLaw> make_law(const StudyCase& study_case, const Registry& registry);
std::function<std::unique_ptr<FrictionLaw>()> friction_maker(const StudyCase& study_case, const Registry& registry);
std::unique_ptr<TimeScheme> make_scheme(const StudyCase& study_case, const Registry& registry);

/// Throws the fault of the plugin of a case whose numbers make a step indefinite; the error itself where it is the
/// structure's.
[[noreturn]] void name_indefinite(const IndefiniteStep& wrong, const StudyCase& study_case, const Registry& registry);

/// The restitution coefficient that the study gives the scheme, or nothing where it takes none.
std::optional<double> scheme_restitution(const StudyCase& study_case, const Registry& registry);
/// The largest of its stops then, those with a restitution of their own among them.
std::optional<double> largest_restitution(const StudyCase& study_case, const SemiDiscrete& problem,
                                          const Registry& registry);

/// Item and reason of everything that a program does without.
std::vector<std::pair<std::string, std::string>> left_out_pairs(const std::vector<LeftOut>& items);

/// The processor time that a case may take, s; infinite without a budget.
double budget_of(const StudyCase& study_case);

}  // namespace ricochet
