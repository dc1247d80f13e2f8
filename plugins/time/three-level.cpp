#include <fmt/format.h>

#include <cmath>
#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

/// The three-level β scheme in increment form. With d_n = q_n − q_{n−1} and z = q_{n+1} − 2q_n + q_{n−1}:
///
///     (M/h² + C/(2h) + βK) z = F^β − C d_n/h − K q_n + Hᵀp,   F^β = βF(t+h) + (1−2β)F(t) + βF(t−h)
///     y = H(q_{n+1} + e q_{n−1})/(1+e)
///
/// Invariant (undamped, free): E = ½|d/h|²_M + ½|q̄|²_K + ½(β−¼)|d|²_K, q̄ = q_n + d_{n+1}/2; the test displacement
/// (q_{n+1} − q_{n−1})/2 = d_n + z/2 gives its exact balance. Dumont and Paoli (2006); β = 0 is Paoli and Schatzman
/// (2002), and with e = 0 Carpenter, Taylor and Katona (1991).
class ThreeLevel final : public TimeScheme {
 public:
  ThreeLevel(double beta, double restitution, bool second_order)
      : beta_(beta), e_(restitution), second_order_(second_order) {}

  PlanOrRefusal plan(double h, const ProblemFacts& facts) const override {
    if (facts.mass_kernel_dimension > 0 && beta_ == 0 && !facts.damped)
      return Refusal{
          "beta = 0 leaves S singular on the kernel of a singular mass: use beta ≥ 0.25 of newmark-dumont-paoli"};
    if (facts.mass_kernel_dimension > 0 && beta_ < 0.25)
      return Refusal{
          fmt::format("beta = {:g} < 0.25 makes the kernel of a singular mass diverge at any step "
                      "(roots of βr² + (1−2β)r + β outside the unit circle): use beta ≥ 0.25 of newmark-dumont-paoli",
                      beta_)};
    using namespace plan_algebra;
    const auto [q, d] = slots<2>();
    StepPlan plan;
    plan.slots = {"q", "d"};
    plan.initial = {{1, 0}, {0, h}};
    plan.velocity = d / h;
    plan.stages = {step(h)};
    plan.start = {start(h)};
    plan.start_advances = true;
    plan.energy = {square(EnergyMatrix::M, 0.5 / (h * h), d), square(EnergyMatrix::K, 0.5, q - 0.5 * d),
                   square(EnergyMatrix::K, 0.5 * (beta_ - 0.25), d)};
    plan.facts.order = second_order_ ? 2 : 1;
    plan.facts.contact_order = 1;
    plan.facts.restitution = Restitution::asymptotic;
    plan.facts.needs_regular_mass = beta_ < 0.25;
    if (beta_ < 0.25) plan.facts.stability_limit = 2 / std::sqrt(1 - 4 * beta_);
    plan.facts.contact_never_gains = e_ == 0;
    return plan;
  }

 private:
  Levels mean_levels() const {
    using namespace plan_algebra;
    return beta_ * at(1) + (1 - 2 * beta_) * at(0) + beta_ * at(-1);
  }

  Stage step(double h) const {
    using namespace plan_algebra;
    const auto [q, d] = slots<2>();
    const Combination next = q + d + z, before = q - d, rate = d / h + 0.5 / h * z;
    Stage stage;
    stage.matrix = M / (h * h) + 0.5 / h * C + beta_ * K;
    stage.history = -(K * q) - C * (d / h);
    stage.load = mean_levels();
    stage.impact = {(next + e_ * before) / (1 + e_), 1 / (1 + e_) * at(1) + e_ / (1 + e_) * at(-1), std::nullopt};
    stage.at(Evaluation::implicit_end) = {next, at(1), rate, at(0), {1}};
    stage.at(Evaluation::averaged) = {next, at(1), rate, at(0), {beta_, 1 - 2 * beta_, beta_}};
    stage.at(Evaluation::explicit_start) = {q, at(0), d / h, at(-0.5), {1}};
    // Mid-step displacements: their difference is the test displacement, and E + U(g) is kept.
    stage.at(Evaluation::conserving) = {q + 0.5 * d + 0.5 * z, 0.5 * at(0) + 0.5 * at(1), rate, at(0), {1},
                                        q - 0.5 * d,           0.5 * at(0) + 0.5 * at(-1)};
    stage.update = {next, d + z};
    stage.work = {d + 0.5 * z, rate, mean_levels(), {1}, 0.5 * at(1) - 0.5 * at(-1)};
    return stage;
  }

  // z = 2(q₁ − q₀ − h v₀), d holds h v₀. Second order: q₋₁ = q₁ − 2h v₀ inside the scheme's own equation, C acting on
  // v₀ alone. First order: no force acts, z is what rigid stops make it.
  Stage start(double h) const {
    using namespace plan_algebra;
    const auto [q, d] = slots<2>();
    const Combination first = q + d + 0.5 * z, rate = d / h;
    Stage stage;
    stage.matrix = M / (h * h) + beta_ * K;
    // There is no q₋₁ that contact may lean on: e = 0 holds q₁, e > 0 lets (q₁ − q₀)/h rebound with −e v₀ where the
    // free q₁ passes the stop.
    stage.impact = ImpactMeasure{first, at(1)};
    if (e_ > 0) stage.impact = {rate + 0.5 / h * z, at(0.5), VelocityGate{first, at(1), rate, at(0), e_}};
    stage.update = {first, d + 0.5 * z};
    if (!second_order_) return stage;
    stage.history = -(K * q) - C * rate;
    stage.load = mean_levels();
    stage.at(Evaluation::implicit_end) = stage.at(Evaluation::averaged) = {first, at(1), rate, at(0), {1}};
    stage.at(Evaluation::explicit_start) = {q, at(0), rate, at(0), {1}};
    // q₋₁ is taken as q₀ − h v₀: the difference is the first order's, and a start beyond a stop has no past anyway.
    stage.at(Evaluation::conserving) = {
        q + 0.5 * d + 0.25 * z, 0.5 * at(0) + 0.5 * at(1), rate, at(0), {1}, q - 0.5 * d, 0.5 * at(0) + 0.5 * at(-1)};
    return stage;
  }

  double beta_, e_;
  bool second_order_;
};

void register_newmark_dumont_paoli(Registry& registry) {
  registry.add_time(
      {.name = "newmark-dumont-paoli",
       .summary = "three-level β scheme with the constraint on (q_{n+1} + e q_{n−1})/(1+e)",
       .text = R"(The β-Newmark scheme (γ = ½) written on three levels, its contact effort at the middle level. With
          e = 0 the scheme's energy never increases at contact, for any β and any mass matrix. For e > 0 only the
          combination (q_{n+1} + e q_{n−1})/(1+e) is constrained: q_{n+1} itself may pass the stop by O(h). On the
          kernel of a singular mass β = ¼ leaves a double root −1, ¼ < β ≤ ½ roots on the unit circle (damped when α
          > 0). No q₋₁ exists that contact could lean on: in the first step e = 0 holds q₁ between the stops, and
          with e > 0 a point whose free q₁ passes its stop rebounds with (q₁ − q₀)/h = −e v₀. A start at a stop so
          keeps order 1, as an impact on the way does.)",
       .source = R"(Dumont and Paoli (2006), Vibrations of a beam between obstacles: convergence of a fully
          discretized approximation; Paoli and Schatzman (2002) for the combination that carries the restitution)",
       .parameters =
           {real_parameter("beta", "1", 0.5, {.low = 0, .high = 0.5}, "β, weight of the outer levels in K q and F"),
            with_role(real_parameter("restitution", "1", 0.0, {.low = 0, .high = 1}, "e, restitution coefficient"),
                      ParameterRole::restitution),
            word_parameter(
                "start", {"first-order", "second-order"}, "second-order",
                R"(first-order: q₁ = q₀ + h v₀; second-order: q₋₁ = q₁ − 2h v₀ in the scheme's own equation; stops
          hold either)")},
       .words = "Dumont–Paoli"},
      [](const Parameters& p) {
        return std::make_unique<ThreeLevel>(p.real("beta"), p.real("restitution"), p.word("start") == "second-order");
      });
}

void register_paoli_schatzman(Registry& registry) {
  registry.add_time({.name = "paoli-schatzman",
                     .summary = "central differences with the constraint on (q_{n+1} + e q_{n−1})/(1+e)",
                     .text = R"(Central differences whose effort keeps (q_{n+1} + e q_{n−1})/(1+e) between the stops:
          newmark-dumont-paoli with β = 0. As the step shrinks a point leaves its stop at e times the speed of
          arrival; q_{n+1} itself may pass the stop by O(h). Explicit where the mass is diagonal and nothing is
          damped; stable up to hω = 2. In the first step e = 0 holds q₁ between the stops, and with e > 0 a point
          whose free q₁ passes its stop rebounds with −e v₀: order 1, as an impact on the way.)",
                     .source = "Paoli and Schatzman (2002), A numerical scheme for impact problems",
                     .parameters = {with_role(
                         real_parameter("restitution", "1", 0.0, {.low = 0, .high = 1}, "e, restitution coefficient"),
                         ParameterRole::restitution)},
                     .words = "Paoli–Schatzman"},
                    [](const Parameters& p) { return std::make_unique<ThreeLevel>(0.0, p.real("restitution"), true); });
}

void register_carpenter_taylor_katona(Registry& registry) {
  registry.add_time(
      {.name = "carpenter-taylor-katona",
       .summary = "central differences, the multiplier keeps the next position admissible",
       .text = R"(Central differences whose predicted position is corrected by the effort so that q_{n+1} lies
          between the stops: newmark-dumont-paoli with β = 0 and e = 0. Explicit where the mass is diagonal and
          nothing is damped; stable up to hω = 2. A point that meets a stop stays there until it is pulled off, and
          contact never gives energy.)",
       .source = R"(Carpenter, Taylor and Katona (1991), Lagrange constraints for transient finite element surface
          contact)",
       .parameters = {},
       .words = "Carpenter–Taylor–Katona"},
      [](const Parameters&) { return std::make_unique<ThreeLevel>(0.0, 0.0, true); });
}

}  // namespace

RICOCHET_PLUGIN(time, newmark_dumont_paoli, register_newmark_dumont_paoli)
RICOCHET_PLUGIN(time, paoli_schatzman, register_paoli_schatzman)
RICOCHET_PLUGIN(time, carpenter_taylor_katona, register_carpenter_taylor_katona)
