#include "shared_steps.hpp"

namespace {

using namespace ricochet;
using namespace plan_algebra;

/// The mid-point rule on positions and velocities. With z = v_{n+1} − v_n:
///
///     (M/h + ½C + h/4 K) z = F(t+h/2) − C v − K(q + h/2 v) + Hᵀp
///     q ← q + h v + h/2 z,   v ← v + z,   y = H q_{n+1} (end) or H(q_n + q_{n+1})/2 (middle)
///
/// Invariant (undamped, free): ½|v|²_M + ½|q|²_K. The effort meets the test displacement q_{n+1} − q_n = h(v + z/2)
/// whole. With the constraint at the end contact gives p(bound − H q_n) ≤ 0.
PlanOrRefusal midpoint(const Parameters& p, double h, const ProblemFacts&) {
  const bool in_the_middle = p.word("constraint") == "middle";
  const auto [q] = slots<1>();
  Stage step = mean_step(h, middle());
  if (in_the_middle) step.impact = {.value = halfway(q, step.update[0]), .bound = both_ends()};
  StepPlan plan = mean_step_plan();
  plan.stages = {step};
  plan.facts.contact_never_gains = !in_the_middle;
  return plan;
}

void register_midpoint(Registry& registry) {
  registry.add_time(
      {.name = "midpoint",
       .summary = "mid-point rule, stops at position level",
       .text = R"(Forces at mid-step, positions between the stops at its end: of second order, unconditionally
          stable, and contact never gives energy; a massed point keeps between none and all of its speed, one half
          on average. With a law that takes the discrete gradient of its potential (evaluation conserving) the sum
          of the energies is kept to round-off. With the constraint at the middle the rebound is up to three times
          too fast: it is here to show that. On the kernel of a singular undamped mass the root −1 stays.)",
       .source = R"(Simo and Tarnow (1992), The discrete energy–momentum method; Armero and Petocz (1998) for contact
          that conserves; Kane, Repetto, Ortiz and Marsden (1999) for the constraint at the end)",
       .parameters = {word_parameter("constraint", {"end", "middle"}, "end",
                                     "which position lies between the stops: that of the end, or the mean of both")},
       .words = "mid-point"},
      midpoint);
}

}  // namespace

RICOCHET_PLUGIN(time, midpoint, register_midpoint)
