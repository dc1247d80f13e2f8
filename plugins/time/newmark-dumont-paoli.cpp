#include "three_level.hpp"

namespace {

using namespace ricochet;

PlanOrRefusal newmark_dumont_paoli(const Parameters& p, double h, const ProblemFacts& facts) {
  const bool second_order = p.word("start") == "second-order";
  return ThreeLevel{.beta = p.real("beta"), .e = p.real("restitution"), .second_order = second_order}.plan(h, facts);
}

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
      newmark_dumont_paoli);
}

}  // namespace

RICOCHET_PLUGIN(time, newmark_dumont_paoli, register_newmark_dumont_paoli)
