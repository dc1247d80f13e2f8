#pragma once
#include <ricochet/algebra/pointwise_solver.hpp>

namespace ricochet {

/// A contact law that is a force of the depth at each point: what is left to write is Φ and its energy.
///
/// From here come the solve, the outcome, the slopes, and the shift of potentials by the layer. A derived class gives
/// force() and stored(), and what it declares of itself: reads_rate(), layer(), memory_per_point().
class PointwiseContact : public ContactLaw, protected PointwiseLaw {
 public:
  explicit PointwiseContact(Evaluation evaluation) : evaluation_(evaluation) {}

  std::optional<Evaluation> reads() const final { return evaluation_; }
  /// Calls set_lanes(), then sizes the workspaces.
  void prepare(int points, std::span<const Parameters> lanes) override {
    solver_.prepare(points, static_cast<int>(lanes.size()));
    set_lanes(lanes);
  }
  void solve(ReducedProblem& problem) override {
    for (const int lane : problem.touched) problem.outcome[lane] = solver_.solve(*this, problem, lane);
  }
  double potential(double depth, int lane) const final {
    const double beyond = depth + layer(lane);
    return beyond > 0 ? stored(beyond, lane) : 0.0;
  }
  bool offers_slopes() const override { return true; }
  ContactSlopes slopes(int point, int lane) const override { return solver_.slopes(point, lane); }
  std::string how_solved() const override {
    return "Newton on the force law of each point, Gauss–Seidel with halving where that fails";
  }

 protected:
  /// Keeps what force() needs of each lane's parameters.
  virtual void set_lanes(std::span<const Parameters> lanes) = 0;
  /// Energy (J) at δ > 0 (m), beyond the bound that the solver is given: the integral of the force at rest.
  virtual double stored(double depth, int lane) const = 0;
  Evaluation evaluation() const { return evaluation_; }

 private:
  Evaluation evaluation_;
  PointwiseSolver solver_;
};

}  // namespace ricochet
