#include <algorithm>
#include <cmath>
#include <ricochet/contact_solvers/box_problem.hpp>

#include "power_law.hpp"

namespace {

using namespace ricochet;

/// Rigid stops with a multiplier that gives way. With the scheme's impact measure y it solves
/// lower ≤ y + p/κ ⊥ p ≤ upper, the optimality of the Lagrangian less |p|²/2κ. κ → ∞ is Signorini;
/// augmented-lagrangian makes one such solve from λ = 0.
class PerturbedLagrangian final : public ContactLaw {
 public:
  void prepare(int points, std::span<const Parameters> lanes) override {
    solver_.prepare(points);
    stiffness_.clear();
    for (const Parameters& lane : lanes) stiffness_.push_back(lane.real("stiffness"));
  }

  void solve(ReducedProblem& problem) override {
    for (const int lane : problem.touched) {
      const double stiffness = stiffness_[static_cast<std::size_t>(lane)];
      const LaneProblem one = problem.lane(lane);
      LaneOutcome& outcome = problem.outcome[lane];
      outcome = solver_.solve(one, 1 / stiffness);
      // By how much the measure passes its bound.
      double largest = 0;
      for (int i = 0; i < one.points; ++i) largest = std::max(largest, std::abs(one.effort[i]));
      outcome.residual = largest / stiffness;
    }
  }
  std::string how_solved() const override { return "active set with a finite fallback"; }

 private:
  BoxSolver solver_;
  std::vector<double> stiffness_;
};

void register_perturbed_lagrangian(Registry& registry) {
  registry.add_contact(
      {.name = "perturbed-lagrangian",
       .summary = "a multiplier that gives way in proportion to its size, on the scheme's impact measure",
       .text = R"(Signorini's conditions with y + p/κ in place of the impact measure y: the multiplier of the rigid
          law, softened. It is one iteration of augmented-lagrangian from zero. Other than the penalty it acts on
          what the scheme constrains, restitution included; where that is the position at the end of the step it is
          the implicit penalty. What the measure passes its bound by is reported as complementarity residual.)",
       .source = R"(Simo, Wriggers and Taylor (1985), A perturbed Lagrangian formulation for the finite element
          solution of contact problems)",
       .parameters = {stiffness_parameter("N/m", "κ, effort per unit of the scheme's impact measure")},
       .words = "perturbed Lagrangian"},
      [](const Parameters&) { return std::make_unique<PerturbedLagrangian>(); });
}

}  // namespace

RICOCHET_PLUGIN(contact, perturbed_lagrangian, register_perturbed_lagrangian)
