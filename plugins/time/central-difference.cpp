#include "shared_steps.hpp"

namespace {

using namespace ricochet;
using namespace plan_algebra;

/// Central differences in velocity form, z = a_{n+1}:
///
///     (M + h/2 C) z = F(t+h) − C(v + h/2 a) − K(q + h v + h²/2 a) + Hᵀp
///     q ← q + h v + h²/2 a,   v ← v + h/2 (a + z),   a ← z
///
/// Newmark (0, ½). No effort moves the position of its own instant, so that there is no measure of impact. Energy
/// (undamped, free): ½|v|²_M + ½|q|²_K − ⅛h²|a|²_M; test displacement h v + h²/2 a with the equations of both ends.
PlanOrRefusal central_difference(const Parameters&, double h, const ProblemFacts& facts) {
  if (facts.mass_kernel_dimension > 0) return needs_mass("an acceleration");
  const auto [q, v, a] = slots<3>();
  const Combination end = q + h * v + h * h / 2 * a;
  Stage step = motion_at(1, end, v + h / 2 * (a + z));
  step.work = {.displacement = end - q, .rate = v + h / 4 * (a + z), .load = both_ends(), .effort = {0.5, 0.5}};
  StepPlan plan = plan_with({"q", "v", "a"});
  plan.start = {initial_acceleration(h, 1, 0)};
  plan.start[0].impact.reset();
  plan.stages = {step};
  plan.energy = {square(EnergyMatrix::M, 0.5, v), square(EnergyMatrix::K, 0.5, q),
                 square(EnergyMatrix::M, -0.125 * h * h, a)};
  plan.facts = {.order = 2, .needs_regular_mass = true, .stability_limit = 2};
  return plan;
}

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
      central_difference);
}

}  // namespace

RICOCHET_PLUGIN(time, central_difference, register_central_difference)
