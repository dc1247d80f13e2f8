// A friction law in one file: a viscous film between the surfaces, whose force c|u| breaks at the bound μN. One row and
// two rows a point, one and many points.
#include <algorithm>
#include <cmath>
#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

class Film final : public FrictionLaw {
 public:
  explicit Film(const Parameters& parameters) : viscosity_(parameters.real("viscosity")) {}

  // Called before anything else: what solve() needs is allocated here.
  void prepare(int, int rows) override { rate_.resize(static_cast<std::size_t>(rows)); }

  // One lane of one stage: efforts p with |p| ≤ s of each point, where the rates are u = free + matrix·p. Point by
  // point, each with the others as they are, until nothing moves. No allocation here.
  LaneOutcome solve(FrictionProblem& problem) override {
    constexpr int most = 10000;
    constexpr double settled = 1e-14;
    LaneOutcome outcome;
    for (outcome.converged = false; !outcome.converged && outcome.iterations < most; ++outcome.iterations) {
      double change = 0, largest = 0;
      for (int point = 0; point < problem.points; ++point) {
        change = std::max(change, press(problem, point));
        largest = std::max(largest, problem.bound[point]);
      }
      outcome.converged = change <= settled * largest;
    }
    for (int point = 0; point < problem.points; ++point) {
      problem.sticks[point] = 0;  // a film always slides
      problem.slid[point] = 0;
      for (int i = problem.first_row[point]; i < problem.first_row[point + 1]; ++i)
        problem.slid[point] = std::hypot(problem.slid[point], rate(problem, i));
    }
    return outcome;
  }

  // How fast a point drifts that is held by this share of its bound; the bound of `check` is 1 N.
  double creeps(double load_over_bound) const override { return load_over_bound / viscosity_; }
  // It never holds: any scheme will do.
  bool must_settle() const override { return false; }

 private:
  static double rate(const FrictionProblem& problem, int row) {
    double sum = problem.free[row];
    for (int j = 0; j < problem.rows(); ++j) sum += problem.at(row, j) * problem.effort[j];
    return sum;
  }

  // A step of u + p/c towards 0 by the largest that one row answers, then into the disc; how much p changed.
  double press(FrictionProblem& problem, int point) {
    const int first = problem.first_row[point], last = problem.first_row[point + 1];
    double answers = 1 / viscosity_, size = 0, change = 0;
    for (int i = first; i < last; ++i) answers += problem.at(i, i);
    for (int i = first; i < last; ++i) {
      rate_[static_cast<std::size_t>(i)] =
          problem.effort[i] - (rate(problem, i) + problem.effort[i] / viscosity_) / answers;
      size = std::hypot(size, rate_[static_cast<std::size_t>(i)]);
    }
    const double bound = problem.bound[point], scale = size > bound ? bound / size : 1.0;
    for (int i = first; i < last; ++i) {
      const double next = scale * rate_[static_cast<std::size_t>(i)];
      change = std::max(change, std::abs(next - problem.effort[i]));
      problem.effort[i] = next;
    }
    return change;
  }

  double viscosity_;
  std::vector<double> rate_;
};

void register_film(Registry& registry) {
  registry.add_friction(
      {.name = "viscous-film",
       .summary = "a viscous film whose force breaks at the bound of friction",
       .text = R"(The force is c|u| against the motion, and at most μN. Nothing sticks: a held point creeps by its load
          over c.)",
       .source = "—",
       .parameters = {real_parameter("viscosity", "N s/m", 1e4, {.low = 0, .low_open = true}, "c")},
       .words = "a viscous film"},
      [](const Parameters& parameters) { return std::make_unique<Film>(parameters); });
}

}  // namespace

RICOCHET_PLUGIN(friction, viscous_film, register_film)
