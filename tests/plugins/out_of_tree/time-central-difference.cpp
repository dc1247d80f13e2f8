// A scheme in one file: central differences, with the constraint on (q_{n+1} + e q_{n−1})/(1+e).
#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

/// With d_n = q_n − q_{n−1} and the unknown z = q_{n+1} − 2q_n + q_{n−1} (kept, not q_{n−1}: differences of positions
/// would lose 1/h² in round-off):
///
///     (M/h² + C/(2h)) z = F(t) − C d_n/h − K q_n + Hᵀp,     q_{n+1} = q_n + d_n + z,     d_{n+1} = d_n + z
///     y = H(q_{n+1} + e q_{n−1})/(1+e) = H[q_n + (1−e)/(1+e) d_n + z/(1+e)]
///
/// Stable up to hω = 2. Invariant (undamped, free): ½|d/h|²_M + ½|q_n − d_n/2|²_K − ⅛|d_n|²_K after the step, which the
/// test displacement (q_{n+1} − q_{n−1})/2 = d_n + z/2 balances.
class CentralDifference final : public TimeScheme {
 public:
  explicit CentralDifference(double restitution) : e_(restitution) {}

  PlanOrRefusal plan(double h, const ProblemFacts& facts) const override {
    if (facts.mass_kernel_dimension > 0)
      return Refusal{
          "central differences need a regular mass matrix: without inertia nothing holds the kernel of this "
          "one; take a consistent or a lumped mass, or an implicit scheme"};
    StepPlan plan;
    plan.slots = {"q", "d"};
    plan.initial = {{1, 0}, {0, h}};
    plan.velocity = {.slots = {0, 1 / h}};
    plan.stages = {step(h)};
    plan.start = {start(h)};
    plan.start_advances = true;
    plan.energy = {{QuadraticTerm::Matrix::M, 0.5 / (h * h), {0, 1}},
                   {QuadraticTerm::Matrix::K, 0.5, {1, -0.5}},
                   {QuadraticTerm::Matrix::K, -0.125, {0, 1}}};
    plan.facts.order = 2;
    plan.facts.restitution = Restitution::asymptotic;
    plan.facts.needs_regular_mass = true;
    plan.facts.stability_limit = 2;
    plan.facts.contact_never_gains = e_ == 0;
    return plan;
  }

 private:
  Stage step(double h) const {
    Stage stage;
    stage.matrix = {1 / (h * h), 0.5 / h, 0};
    stage.history = {{0, 0, -1}, {0, -1 / h, 0}};
    stage.load = {{0, 1}};
    // When stops and their rates stand is found from the plan: here at t + h and t − h, weighted 1/(1+e) and e/(1+e).
    stage.impact = {.value = {.slots = {1, (1 - e_) / (1 + e_)}, .z = 1 / (1 + e_)}};
    const Combination rate{.slots = {0, 1 / h}, .z = 0.5 / h};
    // An explicit scheme reads a spring where the step begins; it can also find its force at the end.
    stage.at(Evaluation::implicit_end) = {.displacement = {.slots = {1, 1}, .z = 1}, .rate = rate};
    stage.at(Evaluation::explicit_start) = {.displacement = {.slots = {1}}, .rate = {.slots = {0, 1 / h}}};
    stage.update = {{.slots = {1, 1}, .z = 1}, {.slots = {0, 1}, .z = 1}};
    stage.work = {.displacement = {.slots = {0, 1}, .z = 0.5}, .rate = rate, .load = {{0, 1}}};
    return stage;
  }

  // q₋₁ = q₁ − 2h v₀ inside the scheme's own equation, z = 2(q₁ − q₀ − h v₀); d holds h v₀. A start has no steps before
  // it that tell when a rate stands: it says so itself.
  Stage start(double h) const {
    Stage stage = step(h);
    stage.matrix = {1 / (h * h), 0, 0};
    stage.impact = {.value = {.slots = {1, (1 - e_) / (1 + e_)}, .z = 0.5},
                    .bound = {{1, 1 / (1 + e_)}, {-1, e_ / (1 + e_)}}};
    const Combination end{.slots = {1, 1}, .z = 0.5}, rate{.slots = {0, 1 / h}};
    stage.at(Evaluation::implicit_end) = {end, {{1, 1}}, rate, {{0, 1}}, {1}};
    stage.at(Evaluation::explicit_start) = {{.slots = {1}}, {{0, 1}}, rate, {{0, 1}}, {1}};
    stage.update = {end, {.slots = {0, 1}, .z = 0.5}};
    stage.work.reset();
    return stage;
  }

  double e_;
};

void register_all(Registry& registry) {
  registry.add_time(
      {.name = "central-difference",
       .summary = "explicit three-level scheme, stable up to hω = 2",
       .text =
           "Central differences: one solve with M (and C), none with K. Of second order, conditionally stable, for a "
           "regular mass only. At a rigid stop the combination (q_{n+1} + e q_{n−1})/(1+e) is constrained: for e > 0 "
           "q_{n+1} itself may pass the stop by O(h).",
       .source = "Courant, Friedrichs and Lewy (1928); Paoli and Schatzman (2002) for the constrained combination",
       .parameters = {with_role(
           real_parameter("restitution", "1", 0.0, {.low = 0, .high = 1}, "e, restitution coefficient"),
           ParameterRole::restitution)}},
      [](const Parameters& p) { return std::make_unique<CentralDifference>(p.real("restitution")); });
}

}  // namespace

RICOCHET_PLUGIN(time, central_difference, register_all)
