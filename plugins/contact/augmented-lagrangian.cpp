#include <algorithm>
#include <cmath>
#include <ricochet/contact_solvers/box_problem.hpp>
#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

/// Rigid stops approached by augmentations: given a multiplier λ, solve
///     lower ≤ y + (p − λ)/r ⊥ p ≤ upper                                                                        (1)
/// then λ ← p, until p stops changing. From λ = 0 one augmentation is the penalty of stiffness r; the fixed point is
/// Signorini.
class AugmentedLagrangian final : public ContactLaw {
 public:
  AugmentedLagrangian(int iterations, double tolerance, bool from_previous)
      : iterations_(iterations), tolerance_(tolerance), from_previous_(from_previous) {}

  void prepare(int points, std::span<const Parameters> lanes) override {
    const auto size = static_cast<std::size_t>(points);
    solver_.prepare(points);
    augmentation_.clear();
    for (const Parameters& lane : lanes) augmentation_.push_back(lane.real("augmentation"));
    free_.resize(size);
    lower_.resize(size);
    upper_.resize(size);
    effort_.resize(size);
    multiplier_.resize(size);
  }

  void solve(ReducedProblem& problem) override {
    for (const int lane : problem.touched)
      problem.outcome[lane] = solve_lane(problem.lane(lane), augmentation_[static_cast<std::size_t>(lane)]);
  }
  std::string how_solved() const override { return "augmentations, each an active-set solve"; }

 private:
  LaneOutcome solve_lane(const LaneProblem& lane, double r) {
    const auto points = static_cast<std::size_t>(lane.points);
    for (std::size_t i = 0; i < points; ++i) {
      lower_[i] = lane.lower[i];
      upper_[i] = lane.upper[i];
      multiplier_[i] = from_previous_ ? lane.effort[i] : 0.0;
      effort_[i] = multiplier_[i];
    }
    LaneOutcome outcome;
    for (int k = 0; k < iterations_; ++k) {
      for (std::size_t i = 0; i < points; ++i) free_[i] = lane.free[i] - multiplier_[i] / r;
      const LaneOutcome inner = solver_.solve(*lane.delassus, lane.reach, 1 / r, free_.data(), lower_.data(),
                                              upper_.data(), effort_.data(), lane.points);
      outcome.converged = outcome.converged && inner.converged;
      outcome.iterations += inner.iterations;
      double change = 0, size = 0;
      for (std::size_t i = 0; i < points; ++i) {
        change = std::max(change, std::abs(effort_[i] - multiplier_[i]));
        size = std::max(size, std::abs(effort_[i]));
        multiplier_[i] = effort_[i];
      }
      // By (1) the measure passes its bound by (λ − p)/r: what is left of complementarity.
      outcome.residual = change / r;
      if (change <= tolerance_ * size) break;
    }
    for (std::size_t i = 0; i < points; ++i) lane.effort[i] = effort_[i];
    return outcome;
  }

  int iterations_;
  double tolerance_;
  bool from_previous_;
  BoxSolver solver_;
  std::vector<double> augmentation_, free_, lower_, upper_, effort_, multiplier_;
};

void register_augmented_lagrangian(Registry& registry) {
  ParameterSpec augmentation =
      real_parameter("augmentation", "N/m", std::nullopt, {.low = 0, .low_open = true},
                     "r, stiffness of each augmentation (per unit of the scheme's impact measure)");
  augmentation.per_lane = true;
  registry.add_contact(
      {.name = "augmented-lagrangian",
       .summary = "hybrid: penalty steps that update a multiplier",
       .text = R"(Repeats a penalty solve of stiffness r around a multiplier that each solve replaces by its effort.
          One iteration from zero is the penalty of the same stiffness, many are Signorini; in between, the
          penetration that is left is the complementarity residual that the run reports. The measure is the scheme's
          impact measure, restitution included.)",
       .source = "Hestenes (1969), Powell (1969); for unilateral contact Alart and Curnier (1991)",
       .parameters = {augmentation,
                      integer_parameter("iterations", 50, {.low = 1, .high = 100000}, "most augmentations in one step"),
                      real_parameter("tolerance", "1", 1e-10, {.low = 0, .high = 1},
                                     "relative change of the efforts at which a step stops; 0: always all iterations"),
                      word_parameter("start", {"zero", "previous"}, "previous",
                                     "the multiplier that a step starts from: zero, or the last step's effort")},
       .words = "augmented Lagrangian"},
      [](const Parameters& p) {
        return std::make_unique<AugmentedLagrangian>(static_cast<int>(p.integer("iterations")), p.real("tolerance"),
                                                     p.word("start") == "previous");
      });
}

}  // namespace

RICOCHET_PLUGIN(contact, augmented_lagrangian, register_augmented_lagrangian)
