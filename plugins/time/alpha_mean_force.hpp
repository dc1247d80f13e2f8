#pragma once
#include "alpha_method.hpp"

/// \file
/// α-methods whose contact is left out of the acceleration: velocities jump, p is the mean force of the step.
namespace ricochet {

/// Newmark's step at β = γ/2 in the unknown z = q_{n+1} − q*, with q* = q + h v + (½−β)h² a and k = (1−γ)h. The
/// acceleration a of the structure alone comes after it (structure_acceleration):
///
///     (2/h² M + 2γ/h C + γK) z = γ(F(t+h) − C(v + k a) − K q*) + Hᵀp,   y = H q_{n+1}
///     q ← q* + z,   v ← v + k a + (2/h) z
inline Stage newmark_mean_step(const AlphaMethod& newmark, double h) {
  using namespace plan_algebra;
  const auto [q, v, a] = slots<3>();
  const double gamma = newmark.gamma;
  const Combination ahead = newmark.ahead(h), ahead_rate = newmark.ahead_rate(h);
  Stage stage = mean_step(h, both_ends(), ahead + z, ahead_rate + 2 / h * z);
  stage.matrix = 2 / (h * h) * M + 2 * gamma / h * C + gamma * K;
  stage.history = -(gamma * C * ahead_rate) - gamma * K * ahead;
  stage.load = gamma * at(1);
  stage.work->rate = v + gamma * (ahead_rate - v) + 2 * gamma / h * z;
  stage.work->load = (1 - gamma) * at(0) + gamma * at(1);
  stage.loss = {{EnergyMatrix::K, gamma - 0.5, stage.work->displacement}};
  stage.update.push_back(a);
  return stage;
}

/// Newmark's step for any β and γ whose velocities jump by w and positions by (h/2)w, R w = Hᵀp: the effort acts
/// through w alone. `balanced`: laws that conserve may be asked.
inline Stage newmark_jumping_step(const AlphaMethod& newmark, double h, const OperatorWeights& R, bool balanced) {
  using namespace plan_algebra;
  const auto [q, v] = slots<2>();
  Stage stage = newmark.jumping_step(h, R);
  const Combination end = stage.update[0];
  // Laws that damp read Δq/h, which an effort moves as it moves Δq.
  const Combination rate = (newmark.ahead(h) - q) / h + newmark.beta * h * z + 0.5 * w;
  stage.impact = {.value = end, .bound = at(1), .effort = {0}};
  read_mean_force(stage, end, rate, rate, q + h / 2 * v);
  stage.at(Evaluation::implicit_end)->rate_bound = both_ends();
  if (balanced) conserve_mean_force(stage, end, rate);
  for (auto& compliance : stage.compliance)
    if (compliance) compliance->effort = {0};
  return stage;
}

/// The α-method with one unknown at a time: slots q, v, the true acceleration b and its filter a. With what is known of
/// v and q in v*, q*, κ = f/(1−α_m), f = 1 − α_f, μ = κγ, r = βh/γ,
///
///     stage 1, z = v_{n+1} − v*:   (M/h + μC + μrK) z = μ(F(t+h) − C v* − K q*) + Hᵀp,   v ← v* + z,   q ← q* + r z
///     stage 2, z = b_{n+1}:        M z = F(t+h) − C v − K q,   a ← (α_f b + f z − α_m a)/(1−α_m),   b ← z
///
/// Stage 1 comes without a measure of rigid laws.
inline StepPlan coupled_plan(const AlphaMethod& method, double h) {
  using namespace plan_algebra;
  const auto [q, v, b, a] = slots<4>();
  const double m = 1 - method.mass, f = method.now(), beta = method.beta, gamma = method.gamma;
  const double kept = method.mass / m, past = method.force / m, mu = gamma * f / m, r = beta * h / gamma;
  const Combination next_v = v + h * gamma * past * b + h * (1 - gamma - gamma * kept) * a + z;
  const Combination next = q + h * v + h * h * beta * past * b + h * h * (0.5 - beta - beta * kept) * a + r * z;
  StepPlan plan = mean_step_plan();
  plan.slots = {"q", "v", "b", "a"};
  plan.initial = {{1, 0}, {0, 1}, {0, 0}, {0, 0}};
  plan.start = {structure_acceleration<4>(0)};
  plan.start[0].update[3] = z;
  plan.stages = {equation(M / h * z + mu * C * next_v + mu * K * next, mu * at(1)), structure_acceleration<4>(1)};
  plan.stages[0].update = {next, next_v, b, a};
  // A spring too is a mean force of the step.
  read_mean_force(plan.stages[0], next, next_v, halfway(v, next_v), q + h / 2 * v);
  plan.stages[1].update[3] = past * b - kept * a + f / m * z;
  return plan;
}

}  // namespace ricochet
