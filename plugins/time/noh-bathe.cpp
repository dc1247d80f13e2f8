#include <array>
#include <cmath>
#include <ricochet/contract/plugin.hpp>

#include "shared_steps.hpp"

namespace {

using namespace ricochet;

/// Noh and Bathe's explicit scheme of two sub-steps, to t + ph and to t + h. With c = ph, d = (1−p)h,
/// q₁ = (1−2p)/(2p(1−p)), q₂ = ½ − p q₁, q₀ = ½ − q₁ − q₂:
///
///     stage 1, z = a_p:   M z = F(t+c) − C(v + c a) − K(q + c v + c²/2 a) + Hᵀp
///                         q ← q + c v + c²/2 a,   v ← v + c/2 (a + z),   b ← a,   a ← z
///     stage 2, z = a₁:    M z = F(t+h) − C(v + d a) − K(q + d v + d²/2 a) + Hᵀp
///                         q ← q + d v + d²/2 a,   v ← v + d((½ + q₁) a + q₀ b + q₂ z),   b ← a,   a ← z
///
/// An effort moves the next known position, t + h for stage 1 and t + h + c for stage 2: that one is kept between the
/// stops.
class NohBathe final : public TimeScheme {
 public:
  explicit NohBathe(double split) : p_(split) {
    q1_ = (1 - 2 * p_) / (2 * p_ * (1 - p_));
    q2_ = 0.5 - p_ * q1_;
    q0_ = 0.5 - q1_ - q2_;
  }

  PlanOrRefusal plan(double h, const ProblemFacts& facts) const override {
    if (facts.mass_kernel_dimension > 0)
      return Refusal{
          "an acceleration needs the inverse of the mass, which is singular here: use a lumped mass, or an "
          "implicit scheme"};
    using namespace plan_algebra;
    const auto [q, v, a, b] = slots<4>();
    const double c = p_ * h, d = (1 - p_) * h;
    StepPlan plan = plan_with({"q", "v", "a", "b"});
    plan.start = {initial_acceleration(c, p_, 0)};
    plan.start.front().update.push_back(b);
    plan.stages = {substep(c, d, p_, 1, v + c / 2 * (a + z)),
                   substep(d, c, 1, 1 + p_, v + d * (0.5 + q1_) * a + d * q0_ * b + d * q2_ * z)};
    plan.facts.order = 2;
    plan.facts.needs_regular_mass = true;
    plan.facts.stability_limit = limit();
    return plan;
  }

 private:
  // To the instant `at`, `step` later; what the effort moves is the position of the instant `next`, `ahead` later
  // still.
  static Stage substep(double step, double ahead, double now, double next, const Combination& rate) {
    using namespace plan_algebra;
    const auto [q, v, a] = slots<3>();
    const Combination position = q + step * v + step * step / 2 * a, known_rate = v + step * a;
    Stage stage;
    stage.matrix = M;
    stage.history = -(C * known_rate) - K * position;
    stage.load = at(now);
    stage.impact = {.value = position + ahead * rate + ahead * ahead / 2 * z, .bound = at(next)};
    // The position that a spring is asked at is known before the solve, as that of the elastic force.
    stage.at(Evaluation::implicit_end) = stage.at(Evaluation::averaged) = {position, at(now), rate, at(now), {1}};
    stage.at(Evaluation::explicit_start) = {position, at(now), known_rate, at(now), {1}};
    stage.update = {position, rate, z, a};
    return stage;
  }

  // Smallest hω at which a root of the undamped oscillator's step leaves the unit circle, through −1 or as a pair.
  double limit() const {
    const auto stable = [this](double pulsation) {
      const double w = pulsation * pulsation, c = p_, d = 1 - p_;
      std::array<std::array<double, 2>, 2> step{};
      for (std::size_t k = 0; k < 2; ++k) {
        const double q = k == 0, v = k == 1, a = -w * q;
        const double qp = q + c * v + c * c / 2 * a, ap = -w * qp, vp = v + c / 2 * (a + ap);
        step[0][k] = qp + d * vp + d * d / 2 * ap;
        step[1][k] = vp + d * ((0.5 + q1_) * ap + q0_ * a - q2_ * w * step[0][k]);
      }
      const double trace = step[0][0] + step[1][1];
      const double determinant = step[0][0] * step[1][1] - step[0][1] * step[1][0];
      constexpr double round_off = 1e-12;
      return determinant <= 1 + round_off && std::abs(trace) <= 1 + determinant + round_off;
    };
    constexpr double stride = 1e-2;
    double inside = stride;
    while (stable(inside + stride)) inside += stride;
    double outside = inside + stride;
    for (int k = 0; k < 60; ++k) (stable((inside + outside) / 2) ? inside : outside) = (inside + outside) / 2;
    return inside;
  }

  double p_, q0_ = 0, q1_ = 0, q2_ = 0;
};

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
      [](const Parameters& p) { return std::make_unique<NohBathe>(p.real("split")); });
}

}  // namespace

RICOCHET_PLUGIN(time, noh_bathe, register_noh_bathe)
