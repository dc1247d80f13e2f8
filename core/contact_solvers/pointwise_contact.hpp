#pragma once
#include <ricochet/contact_solvers/pointwise_solver.hpp>

namespace ricochet {

/// How a force of the depth becomes the force of a step: at the measure where the scheme evaluates it, or from the
/// depths δ⁻ before the step and δ after it, the measure with a `before`.
///
///     at_measure   Φ(δ, δ̇)
///     midpoint     Φ(½(δ+δ⁻), δ̇)
///     hybrid       the same where δ⁻ > 0, else ½Φ(δ, δ̇): then p(δ − δ⁻) ≥ U(δ) − U(δ⁻) for a linear Φ
///                  (Chouly, Hild and Renard 2015)
///     gradient     [U(δ) − U(δ⁻)]/(δ − δ⁻), for any Φ: p(δ − δ⁻) = U(δ) − U(δ⁻)   (Gonzalez 2000)
enum class StepForce { at_measure, midpoint, hybrid, gradient };

/// What a law reads, and what it makes of it.
struct ForceEvaluation {
  Evaluation measure = Evaluation::implicit_end;  ///< conserving where `force` is not at_measure
  StepForce force = StepForce::at_measure;
};

/// A contact law that is a force of the depth at each point: what is left to write is Φ and its energy.
///
/// From here come the means over a step, the solve, the outcome, the slopes, and the shift of potentials by the layer.
/// A derived class gives at(), gradient() and stored(), and what it declares of itself: reads_rate(), layer(),
/// memory_per_point().
class PointwiseContact : public ContactLaw, protected PointwiseLaw {
 public:
  explicit PointwiseContact(const ForceEvaluation& evaluation) : evaluation_(evaluation) {}

  std::optional<Evaluation> reads() const final { return evaluation_.measure; }
  bool conserves_energy() const final { return evaluation_.force == StepForce::gradient; }
  /// Calls set_lanes(), then sizes the workspaces.
  void prepare(int points, std::span<const Parameters> lanes) override {
    solver_.prepare(points, static_cast<int>(lanes.size()));
    set_lanes(lanes);
  }
  bool per_point() const override { return true; }
  void prepare_points(int points, int lanes, std::span<const Parameters> sets) override {
    solver_.prepare(points, lanes, true);
    set_lanes(sets);
  }
  void solve(ReducedProblem& problem) override {
    for (const int lane : problem.touched) problem.outcome[lane] = solver_.solve(*this, problem, lane);
  }
  double potential(double depth, int set) const final {
    const double beyond = depth + layer(set);
    return beyond > 0 ? stored(beyond, set) : 0.0;
  }
  bool offers_slopes() const override { return true; }
  ContactSlopes slopes(int point, int lane) const override { return solver_.slopes(point, lane); }
  std::string how_solved() const override {
    return "Newton on the force law of each point, Gauss–Seidel with halving where that fails";
  }

 protected:
  /// Keeps what at() needs of each set of parameters: one per lane, or per point and lane (ContactState::set).
  virtual void set_lanes(std::span<const Parameters> sets) = 0;
  /// Φ(δ, δ̇), zero where δ ≤ 0; δ⁻ is not looked at.
  virtual PointForce at(const ContactState& state) const = 0;
  /// The discrete gradient of stored() from δ⁻ to δ, at least one of them > 0; of a law that damps, with what comes on
  /// top.
  virtual PointForce gradient(const ContactState& state) const = 0;
  /// Energy (J) at δ > 0 (m), beyond the bound that the solver is given: the integral of the force at rest.
  virtual double stored(double depth, int set) const = 0;

 private:
  PointForce force(const ContactState& state) const final;

  ForceEvaluation evaluation_;
  PointwiseSolver solver_;
};

inline PointForce PointwiseContact::force(const ContactState& state) const {
  const auto midpoint = [&] {
    ContactState half = state;
    half.depth = 0.5 * (state.depth + state.before);
    PointForce force = at(half);
    force.before = force.stiffness = 0.5 * force.stiffness;
    return force;
  };
  switch (evaluation_.force) {
    case StepForce::at_measure:
      break;
    case StepForce::midpoint:
      return midpoint();
    case StepForce::hybrid: {
      if (state.before > 0) return midpoint();
      PointForce force = at(state);
      for (double* part : {&force.value, &force.stiffness, &force.viscosity, &force.dissipation}) *part *= 0.5;
      return force;
    }
    case StepForce::gradient:
      return gradient(state);
  }
  return at(state);
}

}  // namespace ricochet
