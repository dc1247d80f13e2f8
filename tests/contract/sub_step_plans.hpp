#pragma once
#include <ricochet/contract/plan_algebra.hpp>
#include <ricochet/contract/step_plan.hpp>
#include <tuple>

/// \file
/// Plans of several sub-steps whose unknown is the new position.
namespace ricochet::testing {

inline Stage position_stage(const Combination& acceleration, const Combination& rate, double end) {
  using namespace plan_algebra;
  Stage stage = equation(M * acceleration + C * rate + K * z, at(end));
  stage.impact = ImpactMeasure{.value = z};
  stage.at(Evaluation::implicit_end) = ComplianceMeasure{.displacement = z, .rate = rate};
  return stage;
}

/// Bathe and Baig (2005): a trapezium to t + γh, then the three-point backward difference to t + h.
inline StepPlan bathe_by_position(double h, double gamma) {
  using namespace plan_algebra;
  const double s = gamma * h, c1 = (1 - gamma) / (gamma * h), c2 = -1 / ((1 - gamma) * gamma * h),
               c3 = (2 - gamma) / ((1 - gamma) * h);
  const auto [q, v, a, q0, v0] = slots<5>();
  const Combination rate = 2 / s * (z - q) - v, late = c1 * q0 + c2 * q + c3 * z;
  Stage one = position_stage(2 / s * (rate - v) - a, rate, gamma);
  one.update = {z, rate, 2 / s * (rate - v) - a, q, v};
  const Combination acceleration = c1 * v0 + c2 * v + c3 * late;
  Stage two = position_stage(acceleration, late, 1);
  two.update = {z, late, acceleration, q0, v0};
  StepPlan plan;
  plan.slots = {"q", "v", "a", "q0", "v0"};
  plan.initial = {{1, 0}, {0, 1}, {0, 0}, {1, 0}, {0, 1}};
  plan.stages = {one, two};
  plan.velocity = v;
  plan.facts.order = 2;
  return plan;
}

/// Ji and Xing (2020): trapezia to t + ch and t + 2ch, then a quadrature over all four rates; one matrix, eight slots.
inline StepPlan three_sub_steps(double h, double c) {
  using namespace plan_algebra;
  const double s = c * h, w3 = c / 2, w1 = (1 - w3) / 2, w2 = (0.5 - w3 - c * w1) / (2 * c), w0 = w1 - w2;
  const auto [q, v, a, q0, v0, a0, v1, a1] = slots<8>();
  const Combination trapezium = 2 / s * (z - q) - v, curve = 2 / s * (trapezium - v) - a;
  Stage one = position_stage(curve, trapezium, c), two = position_stage(curve, trapezium, 2 * c);
  one.update = {z, trapezium, curve, q, v, a, v1, a1};
  two.update = {z, trapezium, curve, q0, v0, a0, v, a};
  const auto last = [&, w0 = w0](const Combination& now, const Combination& x0, const Combination& x1,
                                 const Combination& x2, const Combination& before) {
    return 1 / (w3 * h) * (now - before) - w0 / w3 * x0 - w1 / w3 * x1 - w2 / w3 * x2;
  };
  const Combination rate = last(z, v0, v1, v, q0), acceleration = last(rate, a0, a1, a, v0);
  Stage three = position_stage(acceleration, rate, 1);
  three.update = {z, rate, acceleration, q0, v0, a0, v1, a1};
  StepPlan plan;
  plan.slots = {"q", "v", "a", "q0", "v0", "a0", "v1", "a1"};
  plan.initial = {{1, 0}, {0, 1}, {0, 0}, {1, 0}, {0, 1}, {0, 0}, {0, 1}, {0, 0}};
  plan.stages = {one, two, three};
  plan.velocity = v;
  plan.facts.order = 2;
  return plan;
}

}  // namespace ricochet::testing
