#include "three_level.hpp"

namespace {

using namespace ricochet;

PlanOrRefusal paoli_schatzman(const Parameters& p, double h, const ProblemFacts& facts) {
  return ThreeLevel{.e = p.real("restitution")}.plan(h, facts);
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
                    paoli_schatzman);
}

}  // namespace

RICOCHET_PLUGIN(time, paoli_schatzman, register_paoli_schatzman)
