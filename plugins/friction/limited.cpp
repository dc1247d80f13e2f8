#include <cmath>
#include <ricochet/contact_solvers/friction_solver.hpp>
#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

/// p = −s u/max(|u|, v₀). Within the bound u + (v₀/s) p = 0: exact friction of A + diag(v₀/s).
class Limited final : public FrictionLaw {
 public:
  explicit Limited(const Parameters& parameters) : speed_(parameters.real("speed")) {}
  void prepare(int points, int rows) override {
    solver_.prepare(points, rows);
    matrix_.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(rows));
  }
  LaneOutcome solve(FrictionProblem& problem) override {
    const int rows = problem.rows();
    FrictionProblem softer = problem;
    softer.matrix = matrix_.data();
    softer.stride = rows;
    softer.bound_static = nullptr;
    const auto put = [&](int i, int j, double value) { matrix_[static_cast<std::size_t>(i * rows + j)] = value; };
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < rows; ++j) put(i, j, problem.at(i, j));
    for (int point = 0; point < problem.points; ++point)
      for (int i = problem.first_row[point]; i < problem.first_row[point + 1]; ++i)
        if (problem.bound[point] > 0) put(i, i, problem.at(i, i) + speed_ / problem.bound[point]);
    const LaneOutcome outcome = solver_.solve(softer);
    for (int point = 0; point < problem.points; ++point) {
      double size = 0;
      for (int i = problem.first_row[point]; i < problem.first_row[point + 1]; ++i)
        size = std::hypot(size, problem.effort[i]);
      if (problem.bound[point] > 0) problem.slid[point] += speed_ * size / problem.bound[point];
      problem.sticks[point] = 0;
    }
    return outcome;
  }
  double creeps(double load_over_bound) const override { return speed_ * load_over_bound; }
  bool must_settle() const override { return false; }

 private:
  double speed_;
  FrictionSolver solver_;
  std::vector<double> matrix_;
};

void register_limited(Registry& registry) {
  registry.add_friction(
      {.name = "limited",
       .summary = "friction in proportion to the speed below v₀, its bound beyond",
       .text = R"(Below the speed v₀ the force is μN |u|/v₀, beyond it μN. Nothing sticks: a point that is held by a
          share of its bound creeps by that share of v₀, for ever. The smaller v₀, the nearer to exact friction.)",
       .source = "Oden and Martins (1985), Models and computational methods for dynamic friction phenomena",
       .parameters = {real_parameter("speed", "m/s", 1e-3, {.low = 0, .low_open = true}, "v₀")},
       .words = "limited friction"},
      [](const Parameters& parameters) { return std::make_unique<Limited>(parameters); });
}

}  // namespace

RICOCHET_PLUGIN(friction, limited, register_limited)
