#include <cmath>
#include <ricochet/contract/plugin.hpp>

#include "alpha_method.hpp"
#include "shared_steps.hpp"

namespace {

using namespace ricochet;

/// Kane, Repetto, Ortiz and Marsden's Newmark, contact implicit whatever β and γ: velocities jump by w, positions by
/// (h/2)w, p is the mean force of the step, z = a_{n+1} the acceleration of the structure alone. With k = (1−γ)h and
/// c = (½−β)h²,
///
///     (M + γhC + βh²K) z = F(t+h) − C(v + k a) − K(q + h v + c a) − (C + (h/2)K) w,     R w = Hᵀp
///     q ← q + h v + c a + βh² z + (h/2)w,   v ← v + k a + γh z + w,   a ← z,   y = H q_{n+1}
///
/// Energy (free): E = ½|v|²_M + ½|q|²_K + ½εh²|a|²_M, ε = β − γ/2; a step takes (γ−½)(|Δq|²_K + εh²|Δa|²_M). Contact
/// gives p(bound − H q_n) ≤ 0 with R = (M + εh²K)/h (`energy`), since M Δa + K Δq = ΔF − C Δv, and besides εh w·(CΔv −
/// ΔF), for which no work form is declared. R = M/h gives −εh²Δa·Hᵀp more, of either sign (`mass`). At β = γ/2 both are
/// the same, the balance is whole and no second unknown is needed: with q* = q + h v + c a
///
///     stage 1, z = q_{n+1} − q*:   (2/h² M + 2γ/h C + γK) z = γ(F(t+h) − C(v + k a) − K q*) + Hᵀp,   y = H q_{n+1}
///                                  q ← q* + z,   v ← v + k a + (2/h) z
///     stage 2, z = a_{n+1}:        M z = F(t+h) − C v − K q,   a ← z
///
/// and at (¼, ½) no acceleration: z = v_{n+1} − v_n, (M/h + ½C + h/4 K) z = ½F(t) + ½F(t+h) − C v − K(q + h/2 v) + Hᵀp.
class Kane final : public TimeScheme {
 public:
  Kane(double beta, double gamma, bool energy) : energy_(energy) {
    newmark_.beta = beta;
    newmark_.gamma = gamma;
  }

  PlanOrRefusal plan(double h, const ProblemFacts& facts) const override {
    const bool jumps = shift() != 0, damps = newmark_.gamma != 0.5;
    if ((jumps || damps) && facts.mass_kernel_dimension > 0)
      return Refusal{
          "the acceleration at the end of the step needs the inverse of the mass, which is singular here: "
          "use beta = 0.25 with gamma = 0.5, or a regular mass"};
    StepPlan plan = mean_step_plan();
    if (damps) plan.facts.order = 1;
    plan.facts.contact_never_gains = true;
    if (!damps && !jumps) {
      plan.stages = {mean_step(h, both_ends())};
      return plan;
    }
    using namespace plan_algebra;
    plan.slots.emplace_back("a");
    plan.initial.push_back({0, 0});
    plan.start = {structure_acceleration<3>(0)};
    plan.facts.needs_regular_mass = true;
    if (!jumps) {
      plan.stages = {step(h), structure_acceleration<3>(1)};
      return plan;
    }
    plan.stages = {jumping_step(h)};
    plan.energy.push_back(square(EnergyMatrix::M, 0.5 * shift() * h * h, slots<3>()[2]));
    plan.facts.contact_never_gains = energy_ && known_balance() && !facts.damped;
    if (shift() < 0) plan.facts.stability_limit = 1 / std::sqrt(-shift());
    return plan;
  }

 private:
  double shift() const { return newmark_.beta - newmark_.gamma / 2; }
  // With β < γ/2 what γ > ½ takes is no sum of squares.
  bool known_balance() const { return newmark_.gamma == 0.5 || shift() >= 0; }

  Stage step(double h) const {
    using namespace plan_algebra;
    const auto [q, v, a] = slots<3>();
    const double gamma = newmark_.gamma;
    const Combination ahead = newmark_.ahead(h), ahead_rate = newmark_.ahead_rate(h);
    const Combination end = ahead + z, end_rate = ahead_rate + 2 / h * z, mean_rate = halfway(v, end_rate);
    Stage stage;
    stage.matrix = 2 / (h * h) * M + 2 * gamma / h * C + gamma * K;
    stage.history = -(gamma * C * ahead_rate) - gamma * K * ahead;
    stage.load = gamma * at(1);
    stage.impact = {.value = end, .bound = at(1)};
    read_mean_force(stage, end, end_rate, mean_rate, q + h / 2 * v);
    conserve_mean_force(stage, end, mean_rate);
    balance_mean_force(stage, end, mean_rate);
    stage.work->rate = v + gamma * (ahead_rate - v) + 2 * gamma / h * z;
    stage.work->load = (1 - gamma) * at(0) + gamma * at(1);
    stage.loss = {{EnergyMatrix::K, gamma - 0.5, stage.work->displacement}};
    stage.update = {end, end_rate, a};
    return stage;
  }

  Stage jumping_step(double h) const {
    using namespace plan_algebra;
    const auto [q, v] = slots<2>();
    Stage stage = newmark_.jumping_step(h, M / h + (energy_ ? shift() * h : 0.0) * K);
    const Combination end = stage.update[0];
    // Laws that damp read Δq/h, which an effort moves as it moves Δq.
    const Combination rate = (newmark_.ahead(h) - q) / h + newmark_.beta * h * z + 0.5 * w;
    stage.impact = {.value = end, .bound = at(1), .effort = {0}};
    read_mean_force(stage, end, rate, rate, q + h / 2 * v);
    stage.at(Evaluation::implicit_end)->rate_bound = both_ends();
    if (known_balance()) conserve_mean_force(stage, end, rate);
    for (auto& compliance : stage.compliance)
      if (compliance) compliance->effort = {0};
    return stage;
  }

  AlphaMethod newmark_;
  bool energy_;
};

void register_kane(Registry& registry) {
  registry.add_time(
      {.name = "kane",
       .summary = "Newmark whose contact is implicit in position and left out of the acceleration",
       .text = R"(Newmark's updates; the contact force is a mean over the step that keeps q_{n+1} between the stops,
          and the acceleration that the next step starts from is that of the structure alone. A massed point keeps
          between none and all of its speed, one half on average. Contact never gives energy for β = γ/2, nor,
          undamped and with impulse energy, for γ = ½ or β > γ/2. With (¼, ½) it is the mid-point rule with loads of
          both ends; γ = ½ is of second order whatever β, above it damps, at first order; β < γ/2 limits the step.)",
       .source = R"(Kane, Repetto, Ortiz and Marsden (1999), Finite element analysis of nonsmooth contact; Kane,
          Marsden, Ortiz and West (2000), Variational integrators and the Newmark algorithm)",
       .parameters = {real_parameter("beta", "1", 0.25, {.low = 0, .high = 0.5}, "β"),
                      real_parameter("gamma", "1", 0.5, {.low = 0.5, .high = 1}, "γ; above ½ it damps, at first order"),
                      word_parameter("impulse", {"energy", "mass"}, "energy",
                                     R"(where β ≠ γ/2, R of the jump R w = Hᵀp: energy, (M + (β−γ/2)h²K)/h, so that
          contact never gives energy; mass, M/h)")},
       .words = "Kane"},
      [](const Parameters& p) {
        return std::make_unique<Kane>(p.real("beta"), p.real("gamma"), p.word("impulse") == "energy");
      });
}

}  // namespace

RICOCHET_PLUGIN(time, kane, register_kane)
