#pragma once
#include <functional>
#include <memory>
#include <ricochet/contract/registry.hpp>
#include <string>

#include "runners/check/scheme_checks.hpp"

/// \file
/// Schemes that declare of themselves what is true, built here, and ways to make one thing wrong in each.
namespace ricochet::testing {

using Change = std::function<void(StepPlan& plan, double h)>;

/// Newmark (β, γ) in acceleration form.
inline StepPlan newmark_plan(double h, double beta, double gamma, bool singular = false) {
  const double lag = (1 - gamma) * h, curve = (0.5 - beta) * h * h;
  const Combination end{.slots = {1, h, curve}, .z = beta * h * h}, end_rate{.slots = {0, 1, lag}, .z = gamma * h};
  StepPlan plan;
  plan.slots = {"q", "v", "a"};
  plan.initial = {{1, 0}, {0, 1}, {0, 0}};
  plan.velocity = {.slots = {0, 1}};
  Stage start;
  start.matrix = {1, 0, singular ? beta * h * h : 0};
  start.history = {{0, 0, -1}, {0, -1, 0}};
  start.load = {{0, 1}};
  start.at(Evaluation::implicit_end) = {{.slots = {1}}, {}, {.slots = {0, 1}}, {}, {1}};
  start.update = {{.slots = {1}}, {.slots = {0, 1}}, {.slots = {}, .z = 1}};
  plan.start = {start};
  Stage stage;
  stage.matrix = {1, gamma * h, beta * h * h};
  stage.history = {{0, 0, -1}, {0, -1, -h}, {0, -lag, -curve}};
  stage.load = {{1, 1}};
  if (beta > 0) stage.impact = ImpactMeasure{.value = end};
  stage.at(Evaluation::implicit_end) = {end, {}, end_rate, {}, {1}};
  stage.update = {end, end_rate, {.slots = {}, .z = 1}};
  const Combination increment{.slots = {0, h, curve}, .z = beta * h * h};
  stage.work = {increment,
                {.slots = {0, 1, gamma * lag}, .z = gamma * gamma * h},
                {{0, 1 - gamma}, {1, gamma}},
                {gamma, 1 - gamma},
                {}};
  if (gamma != 0.5)
    stage.loss = {{EnergyMatrix::K, gamma - 0.5, increment},
                  {EnergyMatrix::M, (gamma - 0.5) * (beta - gamma / 2) * h * h, {.slots = {0, 0, -1}, .z = 1}}};
  plan.stages = {stage};
  plan.energy = {{EnergyMatrix::M, 0.5, {0, 1}},
                 {EnergyMatrix::K, 0.5, {1}},
                 {EnergyMatrix::M, 0.5 * (beta - gamma / 2) * h * h, {0, 0, 1}}};
  plan.facts.order = gamma == 0.5 ? 2 : 1;
  plan.facts.needs_regular_mass = 2 * beta < gamma;
  if (2 * beta < gamma) plan.facts.stability_limit = 1 / std::sqrt(gamma / 2 - beta);
  return plan;
}

/// Three levels in increments, β = ½, the stop on (q_{n+1} + e q_{n−1})/(1+e).
inline StepPlan three_level_plan(double h, double e) {
  constexpr double beta = 0.5;
  const Combination central_rate{.slots = {0, 1 / h}, .z = 0.5 / h}, end{.slots = {1, 1}, .z = 1};
  StepPlan plan;
  plan.slots = {"q", "d"};
  plan.initial = {{1, 0}, {0, h}};
  plan.velocity = {.slots = {0, 1 / h}};
  Stage stage;
  stage.matrix = {1 / (h * h), 0.5 / h, beta};
  stage.history = {{0, 0, -1}, {0, -1 / h, 0}};
  stage.load = {{1, beta}, {-1, beta}};
  stage.impact = ImpactMeasure{.value = {.slots = {1, (1 - e) / (1 + e)}, .z = 1 / (1 + e)}};
  stage.at(Evaluation::averaged) = {end, {}, central_rate, {}, {beta, 1 - 2 * beta, beta}};
  stage.update = {end, {.slots = {0, 1}, .z = 1}};
  stage.work = {{.slots = {0, 1}, .z = 0.5}, central_rate, stage.load, {1}, {}};
  plan.stages = {stage};
  Stage start;
  start.matrix = {1 / (h * h), 0, beta};
  start.history = {{0, 0, -1}, {0, -1 / h, 0}};
  start.load = stage.load;
  const Combination first{.slots = {1, 1}, .z = 0.5}, begins{.slots = {0, 1 / h}};
  // There is no position before the first that contact could lean on.
  start.impact = ImpactMeasure{.value = first};
  if (e > 0) {
    start.impact->value = {.slots = {0, 1 / h}, .z = 0.5 / h};
    start.impact->gate = VelocityGate{first, {}, begins, {}, e};
  }
  start.at(Evaluation::averaged) = {first, {}, begins, {}, {1}};
  start.update = {first, {.slots = {0, 1}, .z = 0.5}};
  plan.start = {start};
  plan.start_advances = true;
  plan.energy = {{EnergyMatrix::M, 0.5 / (h * h), {0, 1}},
                 {EnergyMatrix::K, 0.5, {1, -0.5}},
                 {EnergyMatrix::K, 0.5 * (beta - 0.25), {0, 1}}};
  plan.facts.order = 2;
  plan.facts.restitution = Restitution::asymptotic;
  plan.facts.contact_never_gains = e == 0;
  return plan;
}

/// The mid-point rule, positions between the stops, and a change of velocities that gives the work of contact back.
inline StepPlan restoring_plan(double h) {
  const Combination end{.slots = {1, h}, .z = h / 2}, way{.slots = {0, h}, .z = h / 2};
  StepPlan plan;
  plan.slots = {"q", "v"};
  plan.initial = {{1, 0}, {0, 1}};
  plan.velocity = {.slots = {0, 1}};
  Stage stage;
  stage.matrix = {1 / h, 0.5, h / 4};
  stage.history = {{0, 0, -1}, {0, -1, -h / 2}};
  stage.load = {{0.5, 1}};
  stage.impact = ImpactMeasure{.value = end};
  stage.update = {end, {.slots = {0, 1}, .z = 1}};
  stage.work = WorkForm{.displacement = way, .rate = {.slots = {0, 1}, .z = 0.5}, .load = {{0.5, 1}}};
  Stage back;
  back.matrix = {1 / h, 0, 0};
  back.impact = ImpactMeasure{.value = way, .restores = 1};
  back.update = {{.slots = {1}}, {.slots = {0, 1}, .z = 1}};
  back.work = WorkForm{.displacement = way, .rate = {}, .load = {}};
  plan.stages = {stage, back};
  plan.energy = {{EnergyMatrix::M, 0.5, {0, 1}}, {EnergyMatrix::K, 0.5, {1}}};
  plan.facts.order = 2;
  plan.facts.needs_regular_mass = plan.facts.contact_never_gains = true;
  return plan;
}

using PlanMaker = std::function<PlanOrRefusal(double h, const ProblemFacts& facts)>;

class GivenScheme final : public TimeScheme {
 public:
  explicit GivenScheme(PlanMaker maker) : maker_(std::move(maker)) {}
  PlanOrRefusal plan(double h, const ProblemFacts& facts) const override { return maker_(h, facts); }

 private:
  PlanMaker maker_;
};

inline PluginManual full_manual(const std::string& name) {
  return {.name = name,
          .summary = "a method of the tests",
          .text = "Made here.",
          .source = "these tests",
          .parameters = {}};
}

inline Entry<TimeScheme> scheme_entry(PlanMaker maker, std::vector<ParameterSpec> parameters = {}) {
  Entry<TimeScheme> entry{full_manual("made-here"), {}, ""};
  entry.manual.parameters = std::move(parameters);
  entry.make = [maker](const Parameters&) { return std::make_unique<GivenScheme>(maker); };
  return entry;
}

inline Entry<TimeScheme> newmark_entry(double beta, double gamma, const Change& change = {}) {
  return scheme_entry([=](double h, const ProblemFacts& facts) -> PlanOrRefusal {
    if (facts.mass_kernel_dimension > 0 && 2 * beta < gamma)
      return Refusal{"beta below gamma/2 makes the kernel of a singular mass diverge: use a regular mass"};
    StepPlan plan = newmark_plan(h, beta, gamma, facts.mass_kernel_dimension > 0);
    if (change) change(plan, h);
    return plan;
  });
}

inline Entry<TimeScheme> three_level_entry(double e, const Change& change = {}) {
  return scheme_entry(
      [=](double h, const ProblemFacts&) -> PlanOrRefusal {
        StepPlan plan = three_level_plan(h, e);
        if (change) change(plan, h);
        return plan;
      },
      {with_role(real_parameter("restitution", "1", e, {.low = e, .high = e}, "e"), ParameterRole::restitution)});
}

inline Entry<TimeScheme> restoring_entry(const Change& change = {}) {
  return scheme_entry([=](double h, const ProblemFacts& facts) -> PlanOrRefusal {
    if (facts.mass_kernel_dimension > 0)
      return Refusal{"velocities are changed in the metric of the mass, which is singular: use a regular mass"};
    StepPlan plan = restoring_plan(h);
    if (change) change(plan, h);
    return plan;
  });
}

/// What one check says of a method, in this process.
template <class Interface>
checking::CheckResult one_check(const std::vector<checking::Check<Interface>>& checks, const Entry<Interface>& entry,
                                const std::string& name) {
  std::vector<checking::Check<Interface>> chosen;
  for (const auto& check : checks)
    if (check.name == name) chosen.push_back(check);
  if (chosen.empty()) return {"there is no check " + name, checking::Finding::not_applicable, {}};
  return checking::run_checks(chosen, entry, {.child = false}).front();
}

inline std::string text_of(const std::vector<checking::CheckResult>& results) {
  std::string text;
  for (const auto& result : results) {
    text += std::string(word(result.finding)) + "  " + result.check;
    for (const std::string& sentence : result.sentences) text += "  " + sentence;
    text += "\n";
  }
  return text;
}

}  // namespace ricochet::testing
