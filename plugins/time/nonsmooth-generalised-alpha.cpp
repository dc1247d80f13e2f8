#include <ricochet/contract/plugin.hpp>

#include "alpha_method.hpp"
#include "shared_steps.hpp"

namespace {

using namespace ricochet;

/// The generalised-α scheme whose velocities jump, coupled: the α-method (alpha_method.hpp, with Chung and Hulbert's
/// α_m, α_f, β, γ) carries the smooth motion, a jump w = h M⁻¹Hᵀp the contact, p the mean force of the step. With
/// k = (1−γ)h, c = (½−β)h², f = 1−α_f, z = a_{n+1} the smooth acceleration, position `half` is
///
///     v ← v + k a + γh z + w,   q ← q + h v + c a + βh² z + (h/2)w,   a ← z,   y = H v_{n+1}
///     (1−α_m) M z + f(C v_{n+1} + K q_{n+1}) = f F(t+h) + α_f(F(t) − C v − K q) − α_m M a
///
/// `beta` moves positions by (β/γ)h w, with one unknown at a time: the true acceleration in b, its filter in a, what is
/// known of v and q in v*, q*, κ = f/(1−α_m), μ = κγ, r = βh/γ,
///
///     stage 1, z = v_{n+1} − v*:   (M/h + μC + μrK) z = μ(F(t+h) − C v* − K q*) + Hᵀp,   v ← v* + z,   q ← q* + r z
///     stage 2, z = b_{n+1}:        M z = F(t+h) − C v − K q,   a ← (α_f b + f z − α_m a)/(1−α_m),   b ← z
///
/// `projected` puts the positions of `beta` between the stops, M z = h²Hᵀp′, before its last stage. A side is closed
/// where q + h v + ½h² a passes it, and rebounds by e. With `half` a jump leaves Δq = h(v_n + v_{n+1})/2 + ¼ε²h²Δa as
/// it is in free motion: the energy of the α-method falls as there, and contact gives (h/2) p·H(v_n + v_{n+1}) ≤ 0,
/// whatever ρ∞. At ρ∞ = 1 `half` and `beta` are the same, and their balance (½|v|²_M + ½|q|²_K, test displacement Δq)
/// is whole; below, what a load does to the filter is left out.
class NonsmoothGeneralisedAlpha final : public TimeScheme {
 public:
  NonsmoothGeneralisedAlpha(double rho, double restitution, const std::string& position)
      : method_(AlphaMethod::chung_hulbert(rho)),
        e_(restitution),
        half_(position == "half"),
        projected_(position == "projected") {}

  PlanOrRefusal plan(double h, const ProblemFacts& facts) const override {
    if (facts.mass_kernel_dimension > 0)
      return Refusal{
          "a velocity that jumps needs the inverse of the mass, which is singular here: use generalised-alpha, whose "
          "stops are at position level, or a regular mass"};
    StepPlan plan = method_.plan(h, facts);
    plan.start[0].impact.reset();
    if (half_)
      jump_by_impulse(plan, h);
    else
      jump_coupled(plan, h);
    method_.add_filtered_energy(plan, h);
    const bool trapezium = method_.gamma == 0.5 && !projected_;
    if (trapezium) balance(plan);
    plan.facts.restitution = Restitution::exact;
    plan.facts.needs_regular_mass = true;
    plan.facts.contact_never_gains = half_ || trapezium;
    return plan;
  }

 private:
  ImpactMeasure impact(const Combination& next_v, double h, double effort) const {
    using namespace plan_algebra;
    const auto [q, v, a, b] = slots<4>();
    const Combination ahead = q + h * v + 0.5 * h * h * (half_ ? a : b);
    return {next_v, at(1), VelocityGate{ahead, at(1), v, at(0), e_}, {effort}};
  }

  void jump_by_impulse(StepPlan& plan, double h) const {
    using namespace plan_algebra;
    const auto [q, v] = slots<2>();
    Stage step = method_.jumping_step(h, M / h);
    step.impact = impact(step.update[1], h, 0);
    // A spring is one of the forces, as in generalised-alpha: no w.
    step.at(Evaluation::explicit_start) = {q + method_.now() * h * v, at(method_.now()), v, at(0), {1}};
    for (auto& compliance : step.compliance)
      if (compliance) compliance->impulse = 0;
    plan.stages = {step};
  }

  // Slots q, v, b the true acceleration, a its filter.
  void jump_coupled(StepPlan& plan, double h) const {
    using namespace plan_algebra;
    const auto [q, v, b, a] = slots<4>();
    const double m = 1 - method_.mass, f = method_.now(), beta = method_.beta, gamma = method_.gamma;
    const double kept = method_.mass / m, past = method_.force / m, mu = gamma * f / m, r = beta * h / gamma;
    const Combination ahead_v = v + h * gamma * past * b + h * (1 - gamma - gamma * kept) * a;
    const Combination ahead = q + h * v + h * h * beta * past * b + h * h * (0.5 - beta - beta * kept) * a;
    const Combination next_v = ahead_v + z, next = ahead + r * z;
    plan.slots = {"q", "v", "b", "a"};
    plan.initial = {{1, 0}, {0, 1}, {0, 0}, {0, 0}};
    plan.start = {structure_acceleration<4>(0)};
    plan.start[0].update[3] = z;
    Stage stage;
    stage.matrix = M / h + mu * C + mu * r * K;
    stage.history = -(mu * C * ahead_v) - mu * K * ahead;
    stage.load = mu * at(1);
    stage.update = {next, next_v, b, a};
    stage.impact = impact(next_v, h, 1);
    // A spring too is a mean force of the step.
    read_mean_force(stage, next, next_v, halfway(v, next_v), q + h / 2 * v);
    plan.stages = {stage};
    if (projected_) {
      Stage projection;
      projection.matrix = M / (h * h);
      projection.impact = {.value = q + z, .bound = at(1)};
      projection.update = {q + z, v, b, a};
      plan.stages.push_back(projection);
    }
    plan.stages.push_back(structure_acceleration<4>(1));
    plan.stages.back().update[3] = past * b - kept * a + f / m * z;
  }

  void balance(StepPlan& plan) const {
    using namespace plan_algebra;
    const auto [q, v] = slots<2>();
    Stage& step = plan.stages.front();
    const Combination rate = halfway(v, step.update[1]);
    conserve_mean_force(step, step.update[0], rate);
    balance_mean_force(step, step.update[0], rate);
    step.at(Evaluation::conserving)->effort = {half_ ? 0.0 : 1.0};
    step.work->impulse = half_ ? 1 : 0;
    if (!half_) plan.stages.back().work = {{}, v, at(1)};  // moves nothing
  }

  AlphaMethod method_;
  double e_;
  bool half_, projected_;
};

void register_nonsmooth_generalised_alpha(Registry& registry) {
  registry.add_time(
      {.name = "nonsmooth-generalised-alpha",
       .summary = "generalised α whose velocities jump by Newton's impact law",
       .text = R"(The smooth motion is that of generalised-alpha, of second order with ρ∞ at the highest
          frequencies; contact is an impulse of the step that jumps velocities, on which that damping does not act,
          and the restitution holds exactly for each point that the gap test q + h v + ½h² a finds closed and that
          does not leave. With `half` positions move by half of the jump, as the authors have it; with `beta` by β/γ
          of it, the same at ρ∞ = 1; `projected` adds a projection of positions, so that no step ends beyond a stop.
          Contact never gives energy with `half`, in the energy of the scheme, nor with `beta` at ρ∞ = 1; elsewhere
          it may.)",
       .source = R"(Chen, Acary, Virlez and Brüls (2013), A nonsmooth generalized-α scheme for flexible multibody
          systems with unilateral constraints; projected: after Brüls, Acary and Cardona (2014))",
       .parameters = {real_parameter("rho_inf", "1", 0.8, {.low = 0, .high = 1},
                                     "ρ∞, what a step leaves of the highest frequencies; 1 does not damp"),
                      with_role(real_parameter("restitution", "1", 0.0, {.low = 0, .high = 1},
                                               "e, Newton's restitution coefficient"),
                                ParameterRole::restitution),
                      word_parameter(
                          "position", {"half", "beta", "projected"}, "half",
                          R"(what a jump w moves positions by: half, (h/2)w; beta, (β/γ)h w; projected, that and onto
          the stops)")},
       .words = "nonsmooth generalised α"},
      [](const Parameters& p) {
        return std::make_unique<NonsmoothGeneralisedAlpha>(p.real("rho_inf"), p.real("restitution"),
                                                           p.word("position"));
      });
}

}  // namespace

RICOCHET_PLUGIN(time, nonsmooth_generalised_alpha, register_nonsmooth_generalised_alpha)
