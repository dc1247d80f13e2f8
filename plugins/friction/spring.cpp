#include <cmath>
#include <ricochet/contact_solvers/friction_solver.hpp>
#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

/// p = −κ x − c x', |p| ≤ s, x the elongation of a spring whose anchor slides: x₁ = x₀ + h u while it holds. Then
/// u + (p + κ x₀)/(κh + c) = 0: exact friction of A + 1/(κh + c). Kept of each row: x.
class Spring final : public FrictionLaw {
 public:
  explicit Spring(const Parameters& parameters)
      : stiffness_(parameters.real("stiffness")), damping_(parameters.real("damping")) {}
  void prepare(int points, int rows) override {
    solver_.prepare(points, rows);
    matrix_.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(rows));
    free_.resize(static_cast<std::size_t>(rows));
  }
  LaneOutcome solve(FrictionProblem& problem) override {
    const int rows = problem.rows();
    const double firm = stiffness_ * problem.h + damping_;
    FrictionProblem softer = problem;
    softer.matrix = matrix_.data();
    softer.stride = rows;
    softer.free = free_.data();
    for (int i = 0; i < rows; ++i) {
      const auto at = static_cast<std::size_t>(i);
      for (int j = 0; j < rows; ++j)
        matrix_[at * static_cast<std::size_t>(rows) + static_cast<std::size_t>(j)] =
            problem.at(i, j) + (i == j ? 1 / firm : 0.0);
      free_[at] = problem.free[i] + stiffness_ * problem.remembered[i] / firm;
    }
    const LaneOutcome outcome = solver_.solve(softer);
    for (int i = 0; i < rows; ++i)
      problem.remembers[i] =
          problem.remembered[i] - problem.h * (problem.effort[i] + stiffness_ * problem.remembered[i]) / firm;
    return outcome;
  }
  double gives_way() const override { return 1 / stiffness_; }
  int memory_per_row() const override { return 1; }
  double stored(const double* remembered) const override { return 0.5 * stiffness_ * remembered[0] * remembered[0]; }
  bool must_settle() const override { return false; }

 private:
  double stiffness_, damping_;
  FrictionSolver solver_;
  std::vector<double> matrix_, free_;
};

void register_spring(Registry& registry) {
  registry.add_friction(
      {.name = "spring",
       .summary = "friction through a tangential spring and damper whose anchor slides at the bound",
       .text = R"(While it holds, the surface gives way by the load over κ, and swings on the spring. At the bound the
          anchor slides, and only that wears. The anchor is dropped when the stop opens. The stiffer the spring, the
          nearer to exact friction; without damping it rings after each stop.)",
       .source = "code_aster R5.06.03, DIS_CHOC with tangential stiffness; Cundall and Strack (1979)",
       .parameters = {real_parameter("stiffness", "N/m", 1e6, {.low = 0, .low_open = true}, "κ, along the surface"),
                      real_parameter("damping", "N s/m", 0, {.low = 0}, "c, along the surface")},
       .words = "friction through a spring"},
      [](const Parameters& parameters) { return std::make_unique<Spring>(parameters); });
}

}  // namespace

RICOCHET_PLUGIN(friction, spring, register_spring)
