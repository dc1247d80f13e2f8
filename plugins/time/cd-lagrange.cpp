#include "shared_steps.hpp"

namespace {

using namespace ricochet;
using namespace plan_algebra;

/// CD-Lagrange: central differences in leap-frog form, Newton's law at velocity level. The slot w is the velocity half
/// a step ahead of q, z = w_{n+3/2} − w_{n+1/2}:
///
///     M/h z = F(t+h) − C w − K(q + h w) + Hᵀp,   q ← q + h w,   w ← w + z,   y = H w_{n+3/2}
///
/// on the points that the position q + h w, known before the solve, finds at or beyond their stop. Energy (undamped,
/// free): ½|w|²_M + ½|q + h w/2|²_K − ⅛h²|w|²_K; test displacement h(w + z/2). Start: w = v₀ + h/2 a₀.
PlanOrRefusal cd_lagrange(const Parameters& p, double h, const ProblemFacts& facts) {
  if (facts.mass_kernel_dimension > 0) return needs_mass("the velocity of the next half step");
  const double e = p.real("restitution");
  const auto [q, v] = slots<2>();
  const Combination ahead = q + h * v, next = v + z, mean = v + 0.5 * z;
  Stage step = equation(M / h * z + C * v + K * ahead, at(1));
  step.impact = {next, at(1.5), VelocityGate{ahead, at(1), v, at(0.5), e}};
  // The position that the force is asked at is known before the solve; the rate it may wait for.
  step.at(Evaluation::implicit_end) = step.at(Evaluation::averaged) = {ahead, at(1), mean, at(1), {1}};
  step.at(Evaluation::explicit_start) = {ahead, at(1), v, at(0.5), {1}};
  step.at(Evaluation::conserving) = {ahead + h / 2 * next, 0.5 * at(1) + 0.5 * at(2), mean, at(1), {1},
                                     q + 0.5 * h * v,      0.5 * at(0) + 0.5 * at(1)};
  step.update = {ahead, next};
  step.work = {.displacement = h * v + h / 2 * z, .rate = v, .load = at(1), .support = 0.5 * at(2) - 0.5 * at(0)};
  // 2/h M z = F(0) − C v₀ − K q₀ (+ Hᵀp where the state rests on a stop): w = v₀ + z.
  Stage start = equation(2 / h * M * z + C * v + K * q, at(0));
  start.impact = {next, at(0.5), VelocityGate{q, at(0), v, at(0), e}};
  for (auto& compliance : start.compliance) compliance = {q, at(0), v, at(0), {1}};
  start.at(Evaluation::conserving) = {q, at(0), v, at(0), {1}, q, at(0)};
  start.update = {q, next};
  StepPlan plan = plan_with({"q", "w"});
  plan.start = {start};
  plan.stages = {step};
  plan.energy = {square(EnergyMatrix::M, 0.5, v), square(EnergyMatrix::K, 0.5, q + h / 2 * v),
                 square(EnergyMatrix::K, -0.125 * h * h, v)};
  plan.facts = {.order = facts.damped ? 1.0 : 2.0,
                .contact_order = 1,
                .restitution = Restitution::exact,
                .needs_regular_mass = true,
                .stability_limit = 2,
                .contact_never_gains = true};
  return plan;
}

void register_cd_lagrange(Registry& registry) {
  registry.add_time(
      {.name = "cd-lagrange",
       .summary = "explicit central differences with Newton's impact law on the mid-step velocities",
       .text = R"(Leap-frog: positions at the steps, velocities between them, one solve with the mass matrix alone,
          so that a lumped mass makes it explicit. Points whose known next position has reached a stop get v⁺ = −e
          v⁻ on the mid-step velocities: contact never gives energy. Stable up to hω = 2. A damping force is taken
          half a step late: of first order where the structure is damped, of second where it is not.)",
       .source = R"(Fekak, Brun, Gravouil and Depale (2017), A new heterogeneous asynchronous explicit–implicit time
          integrator for nonsmooth dynamics)",
       .parameters = {restitution_parameter()},
       .words = "CD-Lagrange"},
      cd_lagrange);
}

}  // namespace

RICOCHET_PLUGIN(time, cd_lagrange, register_cd_lagrange)
