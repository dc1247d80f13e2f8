#include <ricochet/contact_solvers/box_problem.hpp>

#include "runners/check/bench.hpp"

namespace ricochet::checking {
namespace {

class NoContact final : public ContactLaw {
 public:
  bool absent() const override { return true; }
  void prepare(int, std::span<const Parameters>) override {}
  void solve(ReducedProblem&) override {}
};

/// Rigid stops, or springs behind them: the same box problem, its diagonal shifted by 1/κ.
class Stops final : public ContactLaw {
 public:
  Stops(std::optional<Evaluation> evaluation, double stiffness) : evaluation_(evaluation), stiffness_(stiffness) {}
  std::optional<Evaluation> reads() const override { return evaluation_; }
  void prepare(int points, std::span<const Parameters>) override { solver_.prepare(points); }
  void solve(ReducedProblem& problem) override {
    for (const int lane : problem.touched)
      problem.outcome[lane] = solver_.solve(*problem.delassus, problem.reach, evaluation_ ? 1 / stiffness_ : 0.0,
                                            problem.free + lane, problem.lower + lane, problem.upper + lane,
                                            problem.effort + lane, problem.points, problem.lanes);
  }
  double potential(double depth, int) const override { return evaluation_ ? 0.5 * stiffness_ * depth * depth : 0; }

 private:
  std::optional<Evaluation> evaluation_;
  double stiffness_;
  BoxSolver solver_;
};

class GluedSpring final : public ContactLaw {
 public:
  GluedSpring(Evaluation evaluation, double stiffness, double damping)
      : evaluation_(evaluation), stiffness_(stiffness), damping_(damping) {}
  std::optional<Evaluation> reads() const override { return evaluation_; }
  bool reads_rate() const override { return damping_ != 0; }
  void prepare(int, std::span<const Parameters>) override {}
  void solve(ReducedProblem& problem) override {
    const double W = problem.delassus->column(0)[0];
    const bool mean = evaluation_ == Evaluation::conserving;
    const double kappa = mean ? 0.5 * stiffness_ : stiffness_;
    for (const int lane : problem.touched) {
      double push = kappa * (problem.lower[lane] - problem.free[lane]);
      if (mean) push += kappa * (problem.lower[lane] - problem.before[lane]);
      double yields = 1 + kappa * problem.reach * W;
      if (damping_ != 0) {
        push -= damping_ * problem.rate_free[lane];
        yields += damping_ * problem.rate_reach * W;
      }
      problem.effort[lane] = push / yields;
      problem.outcome[lane] = {};
    }
  }

 private:
  Evaluation evaluation_;
  double stiffness_, damping_;
};

}  // namespace

std::unique_ptr<ContactLaw> no_contact() {
  return std::make_unique<NoContact>();
}
std::unique_ptr<ContactLaw> rigid_stops() {
  return std::make_unique<Stops>(std::nullopt, 0);
}
std::unique_ptr<ContactLaw> springs(Evaluation evaluation, double stiffness) {
  return std::make_unique<Stops>(evaluation, stiffness);
}
std::unique_ptr<ContactLaw> glued_spring(Evaluation evaluation, double stiffness, double damping) {
  return std::make_unique<GluedSpring>(evaluation, stiffness, damping);
}

}  // namespace ricochet::checking
