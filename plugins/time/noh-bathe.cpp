#include "shared_steps.hpp"

namespace {

using namespace ricochet;
using namespace plan_algebra;

/// Noh and Bathe's explicit scheme of two sub-steps, to t + ph and to t + h. With c = ph, d = (1−p)h,
/// q₁ = (1−2p)/(2p(1−p)), q₂ = ½ − p q₁, q₀ = ½ − q₁ − q₂:
///
///     stage 1, z = a_p:   M z = F(t+c) − C(v + c a) − K(q + c v + c²/2 a) + Hᵀp
///                         q ← q + c v + c²/2 a,   v ← v + c/2 (a + z),   b ← a,   a ← z
///     stage 2, z = a₁:    M z = F(t+h) − C(v + d a) − K(q + d v + d²/2 a) + Hᵀp
///                         q ← q + d v + d²/2 a,   v ← v + d((½ + q₁) a + q₀ b + q₂ z),   b ← a,   a ← z
///
/// An effort moves the next known position: t + h for stage 1, t + h + c for stage 2. That one is kept between the
/// stops.
PlanOrRefusal noh_bathe(const Parameters& parameters, double h, const ProblemFacts& facts) {
  if (facts.mass_kernel_dimension > 0) return needs_mass("an acceleration");
  const double p = parameters.real("split"), c = p * h, d = (1 - p) * h;
  const double q1 = (1 - 2 * p) / (2 * p * (1 - p)), q2 = 0.5 - p * q1, q0 = 0.5 - q1 - q2;
  const auto state = slots<4>();
  const Combination &q = state[0], &v = state[1], &a = state[2], &b = state[3];
  // To the instant `now`, `step` later; an effort moves the position of the instant `next`, `ahead` later still.
  const auto substep = [&](double step, double ahead, double now, double next, const auto& rate) {
    const Combination position = q + step * v + step * step / 2 * a;
    Stage stage = motion_at(now, position, v + step * a);
    stage.impact = {.value = position + ahead * rate + ahead * ahead / 2 * z, .bound = at(next)};
    // A damper may wait for the rate that the solve gives.
    stage.at(Evaluation::implicit_end)->rate = stage.at(Evaluation::averaged)->rate = rate;
    stage.update = {position, rate, z, a};
    return stage;
  };
  StepPlan plan = plan_with({"q", "v", "a", "b"});
  plan.start = {initial_acceleration(c, p, 0)};
  plan.start[0].update.push_back(b);
  plan.stages = {substep(c, d, p, 1, v + c / 2 * (a + z)),
                 substep(d, c, 1, 1 + p, v + d * (0.5 + q1) * a + d * q0 * b + d * q2 * z)};
  const auto oscillator = [=](double W, double q_n, double v_n) -> std::array<double, 2> {
    const double cp = p, dp = 1 - p, a_n = -W * q_n, q_p = q_n + cp * v_n + cp * cp / 2 * a_n, a_p = -W * q_p;
    const double v_p = v_n + cp / 2 * (a_n + a_p), q_end = q_p + dp * v_p + dp * dp / 2 * a_p;
    return {q_end, v_p + dp * ((0.5 + q1) * a_p + q0 * a_n - q2 * W * q_end)};
  };
  plan.facts = {.order = 2, .needs_regular_mass = true, .stability_limit = stability_limit(oscillator)};
  return plan;
}

void register_noh_bathe(Registry& registry) {
  registry.add_time(
      {.name = "noh-bathe",
       .summary = "explicit, two sub-steps: second order, stable to about hω = 3.7, damps what is near the limit",
       .text = R"(Two explicit sub-steps, each one solve with the mass matrix alone, so that a lumped mass makes it
          explicit. Frequencies near the limit are damped, low ones hardly. The limit of a step is nearly twice that
          of central differences, at two solves. Each effort keeps the next position that is known without another
          solve between the stops: a massed point keeps a few hundredths of its speed. That contact rule is this
          program's; the authors give none.)",
       .source = "Noh and Bathe (2013), An explicit time integration scheme for the analysis of wave propagations",
       .parameters = {real_parameter("split", "1", 0.54, {.low = 0.5, .high = 1, .low_open = true, .high_open = true},
                                     "p, where the first sub-step ends, in steps")},
       .words = "Noh–Bathe"},
      noh_bathe);
}

}  // namespace

RICOCHET_PLUGIN(time, noh_bathe, register_noh_bathe)
