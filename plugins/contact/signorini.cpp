#include <ricochet/contact_solvers/box_problem.hpp>
#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

/// Rigid stops by Lagrange multipliers: lower ≤ y ⊥ p ≤ upper with y = y° + reach·W p, the scheme's impact measure.
class Signorini final : public ContactLaw {
 public:
  void prepare(int points, std::span<const Parameters>) override { solver_.prepare(points); }

  void solve(ReducedProblem& problem) override {
    for (const int lane : problem.touched) problem.outcome[lane] = solver_.solve(problem.lane(lane), 0.0);
  }
  bool closed_form(int points) const override { return points == 1; }
  std::string how_solved() const override { return "one point: closed form; more: active set with a finite fallback"; }

 private:
  BoxSolver solver_;
};

void register_signorini(Registry& registry) {
  registry.add_contact(
      {.name = "signorini",
       .summary = "rigid stops, Lagrange multipliers (Signorini conditions on both sides)",
       .text = R"(Finds the contact efforts p such that the scheme's impact measure stays between the stops and p
          acts only where it touches one: lower ≤ y ⊥ p ≤ upper. What y is (a position, an average of positions, a
          velocity) and what restitution is folded into it is the time scheme's choice.)",
       .source =
           R"(Signorini (1959); Moreau (1988), complementarity; solved by the primal–dual active set of Hintermüller,
          Ito and Kunisch (2002), with Murty's (1974) least-index pivoting as the finite fallback)",
       .parameters = {},
       .words = "rigid stops"},
      [](const Parameters&) { return std::make_unique<Signorini>(); });
}

}  // namespace

RICOCHET_PLUGIN(contact, signorini, register_signorini)
