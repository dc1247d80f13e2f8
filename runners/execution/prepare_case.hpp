#pragma once
#include <memory>
#include <optional>
#include <ricochet/contract/registry.hpp>
#include <ricochet/engine/compile.hpp>
#include <string>
#include <vector>

#include "runners/study/study.hpp"

namespace ricochet {

/// A case made ready: its semi-discrete problem and its program, or the sentence that says why it does not apply.
struct Prepared {
  std::shared_ptr<const SemiDiscrete> problem;
  std::optional<Program> program;
  std::string refusal;
  long long steps = 0;  ///< whole steps within the duration
  std::vector<std::string> notes;
};

/// Discretises, plans and compiles a case. `step` and `elements` may differ from the case's own (references).
Prepared prepare_case(const StudyCase& study_case, const Registry& registry);

/// The methods of a case, made.
std::unique_ptr<MassStrategy> make_mass(const StudyCase& study_case, const Registry& registry);
std::unique_ptr<ContactLaw> make_law(const StudyCase& study_case, const Registry& registry);
std::unique_ptr<TimeScheme> make_scheme(const StudyCase& study_case, const Registry& registry);

/// Item and reason of everything that the program does without.
std::vector<std::pair<std::string, std::string>> left_out_pairs(const Program& program);

/// Processor time of this thread: what a case costs, whatever else the machine does. A case runs on one thread from
/// start to end.
double thread_seconds();

/// The processor time that a case may take, s; infinite without a budget.
double budget_of(const StudyCase& study_case);

}  // namespace ricochet
