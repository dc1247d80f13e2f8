#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/kinds/stability/run_stability.hpp"
#include "runners/kinds/stability/stability_steps.hpp"
#include "runners/march/prepare_case.hpp"

namespace ricochet {

std::vector<double> steps_of(const StudyCase& study_case) {
  const Json& range = study_case.settings.at("steps");
  const double from = range.at("from").get<double>(), to = range.at("to").get<double>();
  const int count = range.at("count").get<int>();
  if (!std::isfinite(to / from) || !std::isnormal(from))
    throw InputError("/steps/from", fmt::format("steps from {:g} to {:g} s span more than numbers can hold", from, to));
  std::vector<double> steps;
  // Twelve digits: 1e-05 rather than 9.999999999999999e-06.
  for (int i = 0; i < count; ++i)
    steps.push_back(
        std::stod(fmt::format("{:.12g}", count == 1 ? from : from * std::pow(to / from, i / (count - 1.0)))));
  return steps;
}

CasePlan plan_stability(const StudyCase& study_case, const Registry& registry) {
  CasePlan out;
  const auto law = make_law(study_case, registry);
  const auto discretised = discretise(study_case.scene, study_case.elements, *make_mass(study_case, registry),
                                      law.get(), &study_case.contact.parameters);
  if (const auto* refusal = std::get_if<Refusal>(&discretised)) {
    out.refusal = refusal->sentence;
    return out;
  }
  const SemiDiscrete& problem = std::get<SemiDiscrete>(discretised);
  out.notes = problem.notes;
  const auto scheme = make_scheme(study_case, registry);
  const std::vector<double> steps = steps_of(study_case);
  const auto made = scheme->plan(steps.front(), problem_facts(problem, *law));
  if (const auto* refusal = std::get_if<Refusal>(&made)) {
    out.refusal = refusal->sentence;
    return out;
  }
  out.coarsest_step = std::max(steps.front(), steps.back());
  out.finest_step = std::min(steps.front(), steps.back());
  const auto n = static_cast<double>(problem.dofs());
  // Eigenvalues of a step with the contact closed, per step of the range and for the bisection.
  out.predicted_seconds = 1e-8 * n * n * n * static_cast<double>(std::min<std::size_t>(steps.size(), 40) + 20);
  if (!study_case.settings.value("observe", true)) return out;
  const bool touches = problem.points() > 0 && !law->absent();
  for (const double h : steps) {
    out.steps += free_steps;
    if (touches && study_case.duration > 0)
      out.steps += std::clamp(static_cast<long long>(std::min(study_case.duration / h, 1e9)), least_scene_steps,
                              most_scene_steps);
    else if (touches)
      out.steps += 10 * free_steps;
  }
  out.predicted_seconds += static_cast<double>(out.steps) * (6e-7 + 2e-8 * n);
  return out;
}

}  // namespace ricochet
