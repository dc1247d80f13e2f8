#include <ricochet/contract/plugin.hpp>

#include "alpha_method.hpp"
#include "mean_force_step.hpp"

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
  ImpactMeasure impact(const Combination& velocity, double h, double effort) const {
    Combination ahead{.slots = {1, h, 0.5 * h * h}};
    if (!half_) ahead.slots = {1, h, 0, 0.5 * h * h};
    return {velocity, {{1, 1}}, VelocityGate{ahead, {{1, 1}}, {.slots = {0, 1}}, {{0, 1}}, e_}, {effort}};
  }

  void jump_by_impulse(StepPlan& plan, double h) const {
    Stage step = method_.jumping_step(h, {1 / h, 0, 0});
    step.impact = impact(step.update[1], h, 0);
    // A spring is one of the forces, as in generalised-alpha: no w.
    const Combination ahead{.slots = {1, method_.now() * h}};
    step.at(Evaluation::explicit_start) = {ahead, {{method_.now(), 1}}, {.slots = {0, 1}}, {{0, 1}}, {1}};
    for (auto& compliance : step.compliance)
      if (compliance) compliance->impulse = 0;
    plan.stages = {step};
  }

  void jump_coupled(StepPlan& plan, double h) const {
    const double m = 1 - method_.mass, f = method_.now(), beta = method_.beta, gamma = method_.gamma;
    const double kept = method_.mass / m, past = method_.force / m, mu = gamma * f / m, r = beta * h / gamma;
    const Combination v{.slots = {0, 1, h * gamma * past, h * (1 - gamma - gamma * kept)}, .z = 1};
    const Combination q{.slots = {1, h, h * h * beta * past, h * h * (0.5 - beta - beta * kept)}, .z = r};
    plan.slots = {"q", "v", "b", "a"};
    plan.initial = {{1, 0}, {0, 1}, {0, 0}, {0, 0}};
    plan.start = {structure_acceleration(0, 4)};
    plan.start[0].update[3] = {.slots = {}, .z = 1};
    Stage stage;
    stage.matrix = {1 / h, mu, mu * r};
    for (std::size_t j = 0; j < 4; ++j) stage.history.push_back({0, -mu * (j ? v.slots[j] : 0), -mu * q.slots[j]});
    stage.load = {{1, mu}};
    stage.update = {q, v, {.slots = {0, 0, 1}}, {.slots = {0, 0, 0, 1}}};
    stage.impact = impact(v, h, 1);
    // A spring too is a mean force of the step.
    read_mean_force(stage, q, v, halfway(v, 1), {.slots = {1, h / 2}});
    plan.stages = {stage};
    if (projected_) {
      Stage projection;
      projection.matrix = {1 / (h * h), 0, 0};
      projection.impact = {.value = {.slots = {1}, .z = 1}, .bound = {{1, 1}}};
      projection.update = {{.slots = {1}, .z = 1}, {.slots = {0, 1}}, stage.update[2], stage.update[3]};
      plan.stages.push_back(projection);
    }
    plan.stages.push_back(structure_acceleration(1, 4));
    plan.stages.back().update[3] = {.slots = {0, 0, past, -kept}, .z = f / m};
  }

  void balance(StepPlan& plan) const {
    Stage& step = plan.stages.front();
    const Combination rate = halfway(step.update[1], 1);
    conserve_mean_force(step, step.update[0], rate);
    balance_mean_force(step, step.update[0], rate);
    step.at(Evaluation::conserving)->effort = {half_ ? 0.0 : 1.0};
    step.work->impulse = half_ ? 1 : 0;
    if (!half_) plan.stages.back().work = {{}, {.slots = {0, 1}}, {{1, 1}}};  // moves nothing
  }

  AlphaMethod method_;
  double e_;
  bool half_, projected_;
};

void register_all(Registry& registry) {
  registry.add_time(
      {.name = "nonsmooth-generalised-alpha",
       .summary = "generalised α whose velocities jump by Newton's impact law",
       .text =
           "The smooth motion is that of generalised-alpha, of second order with ρ∞ at the highest frequencies; "
           "contact "
           "is an impulse of the step that jumps velocities, on which that damping does not act, and the restitution "
           "holds exactly for each point that the gap test q + h v + ½h² a finds closed and that does not leave. With "
           "`half` positions move by half of the jump, as the authors have it; with `beta` by β/γ of it, the same at "
           "ρ∞ = 1; `projected` adds a projection of positions, so that no step ends beyond a stop. Contact never "
           "gives "
           "energy with `half`, in the energy of the scheme, nor with `beta` at ρ∞ = 1; elsewhere it may.",
       .source = "Chen, Acary, Virlez and Brüls (2013), A nonsmooth generalized-α scheme for flexible multibody "
                 "systems with unilateral constraints; projected: after Brüls, Acary and Cardona (2014)",
       .parameters = {real_parameter("rho_inf", "1", 0.8, {.low = 0, .high = 1},
                                     "ρ∞, what a step leaves of the highest frequencies; 1 does not damp"),
                      with_role(real_parameter("restitution", "1", 0.0, {.low = 0, .high = 1},
                                               "e, Newton's restitution coefficient"),
                                ParameterRole::restitution),
                      word_parameter(
                          "position", {"half", "beta", "projected"}, "half",
                          "what a jump w moves positions by: half, (h/2)w; beta, (β/γ)h w; projected, that and "
                          "onto the stops")}},
      [](const Parameters& p) {
        return std::make_unique<NonsmoothGeneralisedAlpha>(p.real("rho_inf"), p.real("restitution"),
                                                           p.word("position"));
      });
}

}  // namespace

RICOCHET_PLUGIN(time, nonsmooth_generalised_alpha, register_all)
