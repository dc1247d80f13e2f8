#include <ricochet/contract/plugin.hpp>

#include "shared_steps.hpp"

namespace {

using namespace ricochet;

/// Central differences in velocity form, z = a_{n+1}:
///
///     (M + h/2 C) z = F(t+h) − C(v + h/2 a) − K(q + h v + h²/2 a) + Hᵀp
///     q ← q + h v + h²/2 a,   v ← v + h/2 (a + z),   a ← z
///
/// Newmark (0, ½). No effort moves the position of its own instant, so that there is no measure of impact. Energy
/// (undamped, free): ½|v|²_M + ½|q|²_K − ⅛h²|a|²_M; test displacement h v + h²/2 a with the equations of both ends.
class CentralDifference final : public TimeScheme {
 public:
  PlanOrRefusal plan(double h, const ProblemFacts& facts) const override {
    if (facts.mass_kernel_dimension > 0)
      return Refusal{
          "an acceleration needs the inverse of the mass, which is singular here: use a lumped mass, or an "
          "implicit scheme"};
    using namespace plan_algebra;
    const auto [q, v, a] = slots<3>();
    StepPlan plan = plan_with({"q", "v", "a"});
    const Combination end = q + h * v + h * h / 2 * a, end_rate = v + h / 2 * (a + z);
    Stage start = initial_acceleration(h, 1, 0);
    start.impact.reset();
    Stage step;
    step.matrix = M + h / 2 * C;
    step.history = -(C * known(end_rate)) - K * end;
    step.load = at(1);
    step.at(Evaluation::implicit_end) = step.at(Evaluation::averaged) = {end, at(1), end_rate, at(1), {1}};
    step.at(Evaluation::explicit_start) = {end, at(1), known(end_rate), at(1), {1}};
    step.update = {end, end_rate, z};
    step.work = {
        .displacement = end - q, .rate = v + h / 4 * (a + z), .load = 0.5 * at(0) + 0.5 * at(1), .effort = {0.5, 0.5}};
    plan.start = {start};
    plan.stages = {step};
    plan.energy = {square(EnergyMatrix::M, 0.5, v), square(EnergyMatrix::K, 0.5, q),
                   square(EnergyMatrix::M, -0.125 * h * h, a)};
    plan.facts.order = 2;
    plan.facts.needs_regular_mass = true;
    plan.facts.stability_limit = 2;
    return plan;
  }
};

void register_central_difference(Registry& registry) {
  registry.add_time(
      {.name = "central-difference",
       .summary = "explicit central differences, for springs and free motion",
       .text = R"(Newmark with β = 0, γ = ½: one solve with M + h/2 C per step, with the mass alone where nothing is
          damped. Stable up to hω = 2, the springs behind the stops included. An effort does not move the position
          of its own instant: with a rigid law use carpenter-taylor-katona (position) or cd-lagrange (velocity),
          which are the same scheme with a multiplier.)",
       .source = R"(Belytschko, Liu and Moran (2000), Nonlinear Finite Elements for Continua and Structures, ch. 6;
          Hughes (1987), The Finite Element Method, section 9.1)",
       .parameters = {},
       .words = "central difference"},
      [](const Parameters&) { return std::make_unique<CentralDifference>(); });
}

}  // namespace

RICOCHET_PLUGIN(time, central_difference, register_central_difference)
