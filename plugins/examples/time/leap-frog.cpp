// A time scheme in one file: central differences. Every number that a scheme consists of stands here once, with what it
// means; put yours in their place.
#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;
using namespace ricochet::plan_algebra;

/// The step S z = b + Hᵀp, with d_n = q_n − q_{n−1} and the unknown z = q_{n+1} − 2q_n + q_{n−1}. The scheme keeps d_n,
/// not q_{n−1}: differences of positions would lose 1/h² in round-off.
///
///     (M/h² + C/(2h)) z = F(t) − C d_n/h − K q_n + Hᵀp,     q_{n+1} = q_n + d_n + z,     d_{n+1} = d_n + z
///     y = H(q_{n+1} + e q_{n−1})/(1+e) = H[q_n + (1−e)/(1+e) d_n + z/(1+e)]
///
/// Stable up to hω = 2. Invariant (undamped, free): ½|d/h|²_M + ½|q_n − d_n/2|²_K − ⅛|d_n|²_K after the step, which the
/// test displacement (q_{n+1} − q_{n−1})/2 = d_n + z/2 balances.
Stage step(double h, double e) {
  const auto [q, d] = slots<2>();
  const Combination next = q + d + z, before = q - d, rate = d / h + 0.5 / h * z;
  Stage stage;
  // S, and b without its load.
  stage.matrix = M / (h * h) + 0.5 / h * C;
  stage.history = -(K * q) - C * (d / h);
  // F(t), the load at the beginning of the step; at(0.5) is its middle, at(1) its end.
  stage.load = at(0);
  // y, what a rigid law holds between the stops. Left out are `bound`, `gate` and `effort`. `bound`: the times at which
  // y reads the stops, found from y: 1/(1+e) at t + h, e/(1+e) at t − h. `gate`: for laws at velocity level. `effort`:
  // the weights of p, p₋₁, … in the equation ({1}).
  stage.impact = ImpactMeasure{.value = (next + e * before) / (1 + e)};
  // g and u, what a compliant law reads: displacement and rate at the end of the step, or where the step begins. The
  // ways `averaged` and `conserving` are not offered: a law that asks for them is refused with a sentence.
  stage.at(Evaluation::implicit_end) = ComplianceMeasure{.displacement = next, .rate = rate};
  stage.at(Evaluation::explicit_start) = ComplianceMeasure{.displacement = q, .rate = d / h};
  // Each slot after the stage, over the slots before it and z.
  stage.update = {next, d + z};
  // The balance of plan.energy: its change is s·F − s·C r + s·Hᵀp, with s and r these. None: the balance is unknown.
  stage.work = WorkForm{.displacement = d + 0.5 * z, .rate = rate, .load = stage.load};
  // stage.loss: what the scheme itself dissipates, as squares. Central differences dissipate nothing.
  return stage;
}

// The same equation with q₋₁ = q₁ − 2h v₀: z = 2(q₁ − q₀ − h v₀), while d holds h v₀.
Stage start(double h, double e) {
  const auto [q, d] = slots<2>();
  const Combination first = q + d + 0.5 * z, rate = d / h;
  Stage stage = step(h, e);
  stage.matrix = M / (h * h);
  // No q₋₁ was marched that a stop could lean on. With e = 0 the stop holds q₁. With e > 0 the sides that the free q₁
  // passes are closed, and (q₁ − q₀)/h rebounds with −e v₀.
  stage.impact = ImpactMeasure{.value = first};
  if (e > 0) {
    stage.impact->value = rate + 0.5 / h * z;
    stage.impact->gate = VelocityGate{
        .predictor = first, .predictor_bound = {}, .approach = rate, .approach_bound = {}, .restitution = e};
  }
  // Times of the stops may also be given: v₀ stands where the step begins.
  stage.at(Evaluation::implicit_end) = ComplianceMeasure{.displacement = first, .rate = rate, .rate_bound = at(0)};
  stage.at(Evaluation::explicit_start) = ComplianceMeasure{.displacement = q, .rate = rate, .rate_bound = at(0)};
  stage.update = {first, d + 0.5 * z};
  stage.work.reset();
  return stage;
}

// The plan for the checked parameters of a study, the step h (s) and what is known of the problem.
PlanOrRefusal scheme(const Parameters& p, double h, const ProblemFacts& facts) {
  // What cannot work is refused, with the cause and what to take instead: the case becomes a row `refused`.
  if (facts.mass_kernel_dimension > 0)
    return Refusal{
        "central differences need a regular mass matrix: without inertia nothing holds the kernel of this one. Take a "
        "consistent or a lumped mass, or an implicit scheme"};
  const double e = p.real("restitution");
  const auto [q, d] = slots<2>();
  StepPlan plan;
  // The vectors that are kept from step to step; the first is always the position.
  plan.slots = {"q", "d"};
  // Each of them at t = 0, {a, b}: a q₀ + b v₀.
  plan.initial = {{1, 0}, {0, h}};
  // What makes the motion begin, once, and whether time has moved by h after it. Empty: nothing to do.
  plan.start = {start(h, e)};
  plan.start_advances = true;
  // The solves of a step, one after the other. A scheme of two solves has two.
  plan.stages = {step(h, e)};
  // The velocity, over the slots after a step; where in the step it stands is found from the plan.
  plan.velocity = d / h;
  // The scheme's own invariant, Σ coefficient·|combination of slots|²_A after a step. Empty: it has none.
  plan.energy = {square(EnergyMatrix::M, 0.5 / (h * h), d), square(EnergyMatrix::K, 0.5, q - 0.5 * d),
                 square(EnergyMatrix::K, -0.125, d)};
  // What the scheme claims; `ricochet check` measures each.
  plan.facts.order = 2;                              // in h, without contact, with this start
  plan.facts.contact_order = std::nullopt;           // in h, at rigid stops: not known
  plan.facts.restitution = Restitution::asymptotic;  // e is met as h → 0 (exact: at any h; ignored: it has no e)
  plan.facts.needs_regular_mass = true;              // as refused above
  plan.facts.stability_limit = 2;                    // largest h·ω; none: any step is stable
  plan.facts.contact_never_gains = e == 0;           // whether a stop at rest can never add to plan.energy
  return plan;
}

void register_all(Registry& registry) {
  registry.add_time(
      {.name = "leap-frog",
       .summary = "explicit three-level scheme, stable up to hω = 2",
       .text = R"(Central differences: one solve with M (and C), none with K. Of second order, conditionally stable,
          for a regular mass only. At a rigid stop the combination (q_{n+1} + e q_{n−1})/(1+e) is constrained: for e
          > 0 q_{n+1} itself may pass the stop by O(h).)",
       .source = "Courant, Friedrichs and Lewy (1928); Paoli and Schatzman (2002) for the constrained combination",
       // Key, unit, default (std::nullopt: the study must give it), range, meaning; references find e by its role.
       .parameters = {with_role(
           real_parameter("restitution", "1", 0.0, {.low = 0, .high = 1}, "e, restitution coefficient"),
           ParameterRole::restitution)}},
      scheme);
}

}  // namespace

// Role, name ('-' written '_'), and the function above.
RICOCHET_PLUGIN(time, leap_frog, register_all)
