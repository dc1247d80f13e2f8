#include "shared_steps.hpp"

namespace {

using namespace ricochet;
using namespace plan_algebra;

/// Moreau–Jean θ-scheme, impacts at velocity level. With z = v_{n+1} − v_n and p = impulse/h:
///
///     (M/h + θC + hθ²K) z = (1−θ)F(t) + θF(t+h) − C v − K(q + θh v) + Hᵀp
///     v ← v + z,   q ← q + h v + hθ z,   y = H v_{n+1} on the sides that the gap test finds closed
///
/// Gap test at q + (h/2)v. On a side that passes it, v⁺ may not fall below −e v⁻ (relative to the stop), or below −v⁻
/// where v⁻ leaves it. Energy (undamped, free): ½|v|²_M + ½|q|²_K, of which a step takes (θ−½)(|z|²_M + |Δq|²_K); test
/// displacement Δq = h(v + θz).
PlanOrRefusal moreau_jean(const Parameters& p, double h, const ProblemFacts& facts) {
  const double theta = p.real("theta"), e = p.real("restitution");
  const bool damps = theta != 0.5, massless_contact = facts.contact && facts.mass_kernel_dimension > 0;
  if (massless_contact && e > 0)
    return needs_mass(said("restitution = {:g}", e), "use restitution 0, or a regular mass");
  if (massless_contact && !damps)
    return Refusal{
        "theta = 0.5 leaves the root −1 on the kernel of a singular mass, with or without damping: use theta > 0.5, or "
        "a regular mass"};
  const auto [q, v] = slots<2>();
  const Combination next_v = v + z, next = q + h * v + h * theta * z, mean_v = v + theta * z;
  const Levels mean = (1 - theta) * at(0) + theta * at(1);
  Stage step = equation(M / h * z + C * mean_v + K * (q + theta * (next - q)), mean);
  step.impact = {next_v, at(1), VelocityGate{q + h / 2 * v, at(0.5), v, at(0), e}};
  step.at(Evaluation::implicit_end) = {next, at(1), next_v, at(1), {1}};
  step.at(Evaluation::averaged) = {next, at(1), next_v, at(1), {theta, 1 - theta}};
  step.at(Evaluation::explicit_start) = {q + theta * h * v, at(theta), v, at(0), {1}};
  step.update = {next, next_v};
  step.work = {next - q, mean_v, mean, {1}, at(1) - at(0)};
  if (damps) step.loss = {{EnergyMatrix::M, theta - 0.5, z}, {EnergyMatrix::K, theta - 0.5, next - q}};
  StepPlan plan = mean_step_plan();
  plan.stages = {step};
  // Above θ = ½ a step that rests on its stop keeps less: not known.
  plan.facts = {.order = damps ? 1.0 : 2.0,
                .contact_order = damps ? std::optional<double>() : 1,
                .restitution = Restitution::exact,
                .needs_regular_mass = e > 0 || !damps,
                .contact_never_gains = !damps};
  return plan;
}

void register_moreau_jean(Registry& registry) {
  registry.add_time(
      {.name = "moreau-jean",
       .summary = "θ-scheme with Newton's impact law at velocity level, gap test at mid-step",
       .text = R"(The time-stepping of nonsmooth contact dynamics: velocities jump, impulses act over the step, and
          Newton's restitution v⁺ = −e v⁻ holds exactly for each point that the gap test q + (h/2)v finds closed and
          that does not leave its stop; one that leaves is not thrown back faster than it went. So contact never
          gives energy (θ = ½, any e in [0, 1]). Positions may pass the stop by O(h). Contact points without mass
          have no velocity to restitute: refused for e > 0, and for θ = ½.)",
       .source = R"(Jean and Moreau (1992); Moreau (1999), Numerical aspects of the sweeping process; Acary and
          Brogliato (2008), ch. 10)",
       .parameters = {real_parameter("theta", "1", 0.5, {.low = 0.5, .high = 1}, "θ; above ½ it damps, at first order"),
                      restitution_parameter()},
       .words = "Moreau–Jean"},
      moreau_jean);
}

}  // namespace

RICOCHET_PLUGIN(time, moreau_jean, register_moreau_jean)
