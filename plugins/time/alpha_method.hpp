#pragma once
#include "shared_steps.hpp"

namespace ricochet {

/// The α-methods: Newmark's updates, with inertia weighted over both ends of the step by α_m, and elastic, viscous and
/// applied forces by α_f. With f = 1 − α_f and z = a_{n+1}:
///
///     M((1−α_m) z + α_m a_n) + f(C v_{n+1} + K q_{n+1}) + α_f(C v_n + K q_n) = f F(t+h) + α_f F(t) + Hᵀπ(p)
///     q ← q + h v + (½−β)h² a + βh² z,   v ← v + (1−γ)h a + γh z,   a ← z,   y = H q_{n+1}
///
/// π(p) = p, or f p + α_f p₋₁ where contact is one of the weighted forces. α_m = α_f = 0 is Newmark (1959), α_m = 0
/// Hilber, Hughes and Taylor (1977), α_f = 0 Wood, Bossak and Zienkiewicz (1980), both Chung and Hulbert (1993).
struct AlphaMethod {
  double mass = 0;   ///< α_m
  double force = 0;  ///< α_f
  double beta = 0.25, gamma = 0.5;
  bool weighted_contact = false;

  /// Chung and Hulbert's, which keep ρ of the highest frequencies.
  static AlphaMethod chung_hulbert(double rho) {
    AlphaMethod method;
    method.mass = (2 * rho - 1) / (rho + 1);
    method.force = rho / (rho + 1);
    const double shift = method.force - method.mass;
    method.gamma = 0.5 + shift;
    method.beta = 0.25 * (1 + shift) * (1 + shift);
    return method;
  }

  static AlphaMethod newmark(double beta, double gamma) { return {.beta = beta, .gamma = gamma}; }

  double now() const { return 1 - force; }
  /// q_{n+1} and v_{n+1} without a_{n+1}, and with it.
  Combination ahead(double h) const {
    const auto [q, v, a] = plan_algebra::slots<3>();
    return q + h * v + (0.5 - beta) * h * h * a;
  }
  Combination ahead_rate(double h) const {
    const auto [q, v, a] = plan_algebra::slots<3>();
    return v + (1 - gamma) * h * a;
  }
  Combination end(double h) const { return ahead(h) + beta * h * h * plan_algebra::z; }
  Combination end_rate(double h) const { return ahead_rate(h) + gamma * h * plan_algebra::z; }
  Combination increment(double h) const { return end(h) - plan_algebra::slots<1>()[0]; }
  std::vector<double> both_ends() const { return force == 0 ? std::vector{1.0} : std::vector{now(), force}; }

  /// Slots q, v, a and the stages; energy, work and facts are the method's own.
  StepPlan plan(double h, const ProblemFacts& facts) const {
    const auto [q, v] = plan_algebra::slots<2>();
    StepPlan plan = plan_with({"q", "v", "a"});
    plan.start = {initial_acceleration(h, 1, facts.mass_kernel_dimension > 0 ? beta * h * h : 0)};
    plan.stages = {step(h)};
    plan.energy = {square(EnergyMatrix::M, 0.5, v), square(EnergyMatrix::K, 0.5, q)};
    plan.facts.order = 2;
    return plan;
  }

  Stage step(double h) const {
    using namespace plan_algebra;
    const auto [q, v, a] = slots<3>();
    const double f = now();
    Stage stage;
    stage.matrix = (1 - mass) * M + f * gamma * h * C + f * beta * h * h * K;
    stage.history = -(mass * M * a) - C * (v + f * (ahead_rate(h) - v)) - K * (q + f * (ahead(h) - q));
    stage.load = f * at(1);
    if (force != 0) stage.load = stage.load + force * at(0);
    stage.impact = {.value = end(h), .bound = at(1), .effort = weighted_contact ? both_ends() : std::vector{1.0}};
    stage.at(Evaluation::implicit_end) = {end(h), at(1), end_rate(h), at(1), {1}};
    // The elastic force enters as K q of both ends, and so does the spring.
    stage.at(Evaluation::averaged) = {end(h), at(1), end_rate(h), at(1), both_ends()};
    stage.at(Evaluation::explicit_start) = {ahead(h), at(1), ahead_rate(h), at(1), {1}};
    stage.update = {end(h), end_rate(h), z};
    return stage;
  }

  /// Explicit laws where the weighted forces stand, without the acceleration: that of the end would be fed back
  /// undamped.
  ComplianceMeasure asked_early(double h, double impulse = 1) const {
    using namespace plan_algebra;
    const auto [q, v] = slots<2>();
    return {q + now() * h * v, at(now()), v, at(0), {1}, std::nullopt, {}, impulse};
  }

  /// The same with velocities that jump by w and positions by (h/2)w, R w = Hᵀp. In the equation of z, q_{n+1} and
  /// v_{n+1} are those after the jump. A spring is one of the forces: no w.
  Stage jumping_step(double h, const OperatorWeights& R) const {
    using namespace plan_algebra;
    Stage stage = step(h);
    stage.impulse = {.R = R, .feed = -now() * C - now() * h / 2 * K};
    stage.update[0] = stage.update[0] + h / 2 * w;
    stage.update[1] = stage.update[1] + w;
    for (auto& compliance : stage.compliance)
      if (compliance) compliance->impulse = 0;
    return stage;
  }

  /// The balance of energy, with the test displacement Δq and the equations of both ends, weighted by `last` and
  /// `before`, 1 in all. Damping of the equation before is counted at v_n.
  void balance_both_ends(Stage& stage, double h, double last, double before) const {
    using namespace plan_algebra;
    const auto [q, v] = slots<2>();
    const double f = now();
    stage.work = {.displacement = increment(h),
                  .rate = (last + before) * v + last * f * (ahead_rate(h) - v) + last * f * gamma * h * z,
                  .load = (last * force + before * f) * at(0) + last * f * at(1),
                  .effort = {last, before}};
    if (force != 0) stage.work->load = stage.work->load + before * force * at(-1);
  }

  /// One more slot, kept by the start rule and by later stages, changed by the first stage.
  static void add_slot(StepPlan& plan, const char* name, std::array<double, 2> initial, const Combination& update) {
    plan.slots.emplace_back(name);
    plan.initial.push_back(initial);
    Combination kept;
    kept.slots.assign(plan.slots.size(), 0);
    kept.slots.back() = 1;
    for (Stage& stage : plan.start) stage.update.push_back(kept);
    for (Stage& stage : plan.stages) stage.update.push_back(&stage == &plan.stages[0] ? update : kept);
  }

  /// With ε = α_f − α_m > 0, γ = ½ + ε, β = ¼(1+ε)². A new slot holds σ ← (ε Δq − α_m σ)/(1−α_m), the last slot before
  /// it holds a. Increment Δq is that of the first stage. The energy
  ///
  ///     E = ½|v|²_M + ½|q|²_K + ⅛ε²h²|a|²_M + ((½−α_f)/2ε)|σ|²_K
  ///     −ΔE = ¼ε³h²|Δa|²_M + ((½−α_f)(½−α_m)/ε)|Δσ|²_K
  ///
  /// of the undamped free structure never grows. What it has beside ½|v|²_M + ½|q|²_K is added to plan.energy here;
  /// where ε = 0 nothing is.
  void add_filtered_energy(StepPlan& plan, double h) const {
    const double shift = force - mass;
    if (shift == 0) return;
    Combination a, sigma;
    a.slots.assign(plan.slots.size(), 0.0);
    sigma.slots.assign(plan.slots.size() + 1, 0.0);
    a.slots.back() = sigma.slots.back() = 1;
    const Combination increment = plan.stages[0].update[0] - plan_algebra::slots<1>()[0];
    add_slot(plan, "s", {0, 0}, shift / (1 - mass) * increment - mass / (1 - mass) * sigma);
    plan.energy.push_back(square(EnergyMatrix::M, 0.125 * shift * shift * h * h, a));
    if (force != 0.5) plan.energy.push_back(square(EnergyMatrix::K, (0.5 - force) / (2 * shift), sigma));
  }
};

}  // namespace ricochet
