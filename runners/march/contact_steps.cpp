#include "runners/march/contact_steps.hpp"

#include <numbers>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/measure/stability/linear_response.hpp>

#include "runners/store/record_values.hpp"
#include "runners/table/text.hpp"

namespace ricochet {

std::optional<ContactSteps> contact_steps(const StudyCase& study_case, const Marcher& marcher,
                                          const ImpactRecorder& recorder, double depth, const Registry& registry) {
  const Program& program = marcher.program();
  if (!program.contact || !program.law->reads() || program.law->changes_problem()) return std::nullopt;
  const SemiDiscrete& problem = *program.problem;
  int hardest = -1;
  double peak = 0;
  for (int j = 0; j < problem.points(); ++j)
    for (const StopSide side : {StopSide::lower, StopSide::upper})
      // What rests on its stop is not turned back.
      if (const StopTotals& one = recorder.totals(0, j, side); one.impacts > 0 && one.peak_force > peak)
        hardest = j, peak = one.peak_force;
  if (hardest < 0) return std::nullopt;
  const auto law = make_law(study_case, registry);
  Parameters parameters = study_case.contact.parameters;
  const std::string key = law->parameter_of(ParameterRole::stiffness);
  if (!problem.own.empty() && !key.empty())
    if (const auto own = problem.own[static_cast<std::size_t>(hardest)].stiffness) parameters.set(key, *own);
  const auto gives_way = contact_compliance(*law, parameters, depth);
  if (!gives_way || !(*gives_way > 0)) return std::nullopt;
  const auto spring = contact_spring(problem, 1 / *gives_way, hardest);
  if (!spring || !(spring->pulsation > 0)) return std::nullopt;
  const double half = std::numbers::pi / spring->pulsation;
  return ContactSteps{spring->stiffness, half, half / program.h};
}

Said unresolved(const std::optional<ContactSteps>& found) {
  if (!found || found->steps >= fewest_contact_steps) return {};
  return said("contact is not resolved: a spring of {:.4g} N/m turns a point back in {}, {:.2g} steps",
              found->stiffness, as_number(duration_text(found->half)), found->steps);
}

}  // namespace ricochet
