#include <fmt/format.h>

#include <ricochet/contract/plugin.hpp>

#include "shared_steps.hpp"

namespace {

using namespace ricochet;

/// Moreau–Jean θ-scheme, impacts at velocity level. With z = v_{n+1} − v_n and p = impulse/h:
///
///     (M/h + θC + hθ²K) z = (1−θ)F(t) + θF(t+h) − C v − K(q + θh v) + Hᵀp
///     v ← v + z,   q ← q + h v + hθ z,   y = H v_{n+1} on the sides that the gap test finds closed
///
/// Gap test at q + (h/2)v. On a side that passes it, v⁺ may not fall below −e v⁻ (relative to the stop), or below −v⁻
/// where v⁻ leaves it. Energy (undamped, free): ½|v|²_M + ½|q|²_K, of which a step takes (θ−½)(|z|²_M + |Δq|²_K); test
/// displacement Δq = h(v + θz).
class MoreauJean final : public TimeScheme {
 public:
  MoreauJean(double theta, double restitution) : theta_(theta), e_(restitution) {}

  PlanOrRefusal plan(double h, const ProblemFacts& facts) const override {
    const bool massless_contact = facts.contact && facts.mass_kernel_dimension > 0;
    if (massless_contact && e_ > 0)
      return Refusal{
          fmt::format("restitution = {:g} has nothing to act on at a contact point without mass (singular mass): its "
                      "velocity is not a state; use restitution 0, or a regular mass",
                      e_)};
    if (massless_contact && theta_ == 0.5)
      return Refusal{
          "theta = 0.5 leaves the root −1 on the kernel of a singular mass, with or without damping: the velocity of a "
          "contact point changes sign at every step and the approach test never holds; use theta > 0.5 or a regular "
          "mass"};
    using namespace plan_algebra;
    const auto [q, v] = slots<2>();
    const Combination next_v = v + z, next = q + h * v + h * theta_ * z;
    const Levels mean = (1 - theta_) * at(0) + theta_ * at(1);
    StepPlan plan = mean_step_plan();
    Stage stage;
    stage.matrix = M / h + theta_ * C + h * theta_ * theta_ * K;
    stage.history = -(C * v) - K * (q + theta_ * h * v);
    stage.load = mean;
    stage.impact = {next_v, at(1), VelocityGate{q + h / 2 * v, at(0.5), v, at(0), e_}};
    stage.at(Evaluation::implicit_end) = {next, at(1), next_v, at(1), {1}};
    stage.at(Evaluation::averaged) = {next, at(1), next_v, at(1), {theta_, 1 - theta_}};
    stage.at(Evaluation::explicit_start) = {q + theta_ * h * v, at(theta_), v, at(0), {1}};
    stage.update = {next, next_v};
    stage.work = {next - q, v + theta_ * z, mean, {1}, at(1) - at(0)};
    if (theta_ != 0.5) stage.loss = {{EnergyMatrix::M, theta_ - 0.5, z}, {EnergyMatrix::K, theta_ - 0.5, next - q}};
    plan.stages = {stage};
    if (theta_ != 0.5) plan.facts.order = 1;
    // Above θ = ½ a step that rests on its stop keeps less: not known.
    if (theta_ == 0.5) plan.facts.contact_order = 1;
    plan.facts.restitution = Restitution::exact;
    plan.facts.needs_regular_mass = e_ > 0 || theta_ == 0.5;
    plan.facts.contact_never_gains = theta_ == 0.5;
    return plan;
  }

 private:
  double theta_, e_;
};

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
                      with_role(real_parameter("restitution", "1", 0.0, {.low = 0, .high = 1},
                                               "e, Newton's restitution coefficient"),
                                ParameterRole::restitution)},
       .words = "Moreau–Jean"},
      [](const Parameters& p) { return std::make_unique<MoreauJean>(p.real("theta"), p.real("restitution")); });
}

}  // namespace

RICOCHET_PLUGIN(time, moreau_jean, register_moreau_jean)
