#pragma once
#include <cstddef>
#include <ricochet/contract/contact_law.hpp>
#include <vector>

namespace ricochet {

/// Where one side of one contact point stands when its force is asked.
struct ContactState {
  double depth = 0;   ///< δ, beyond the bound that the solver was given, m (positive: beyond)
  double rate = 0;    ///< δ̇, the speed of closing, m/s; 0 where the problem has no rate
  double before = 0;  ///< δ⁻, the depth one step before, m; 0 where the problem has none
  int point = 0, lane = 0;
  int set = 0;   ///< number of the parameter set: the lane, or that of the point in its lane
  int side = 1;  ///< the sign of its efforts: 1 of the lower stop, −1 of the upper one
};

/// The force of one side, and how it answers. Slopes ≥ 0 for a law that does not soften.
struct PointForce {
  double value = 0;        ///< p ≥ 0, N
  double stiffness = 0;    ///< ∂p/∂δ, N/m
  double viscosity = 0;    ///< ∂p/∂δ̇, N s/m
  double before = 0;       ///< ∂p/∂δ⁻, N/m
  double dissipation = 0;  ///< power that does not come back, (p − U′(δ)) δ̇ ≥ 0, W
};

/// A compliant law, one point and one side at a time: p = Φ(δ, δ̇, δ⁻). It is zero where neither δ nor δ⁻ is positive.
/// It grows with δ and δ̇, or at least does not fall. Both sides have the same law; what a point feels is Φ of the
/// lower stop minus Φ of the upper one.
class PointwiseLaw {
 public:
  virtual ~PointwiseLaw() = default;
  virtual PointForce force(const ContactState& state) const = 0;
};

/// The efforts of one lane under a law that acts point by point. With y = y° + ηWp, u = u° + η_uWp,
///
///     p_i = F_i(y_i, u_i),   F_i = Φ(lower_i − y_i, −u_i, lower_i − y⁻_i) − Φ(y_i − upper_i, u_i, y⁻_i − upper_i) (1)
///
/// W (m × m) symmetric positive semidefinite, read by columns on demand; bounds may be ±∞, and pass each other (both
/// sides then push). As F_i falls with x_i = (Wp)_i and depends on no other, (1) is where the convex function
///
///     E = ½ xᵀW⁻¹x − Σ_i ∫F_i dx_i,      its slope along δp:  E′ = (Wδp)ᵀ(p − F)                                  (2)
///
/// is least: p is unique wherever W is regular or F answers.
///
/// η = η_u = 0: closed form. One point: Newton between two bounds of p that close in, by halves where it would leave
/// them. Jumps and forces without bound are thus met too (a jump is bridged: p between its ends). Several points:
/// Newton from the last effort, halved until the slope (2) does not turn steeply upwards,
///
///     (I + DW) δp = F − p,     D = η ∂p/∂δ + η_u ∂p/∂δ̇ ≥ 0                                                       (3)
///
/// in the symmetric form I + √D W √D, whose eigenvalues are ≥ 1: no set is ever singular. Where that does not end
/// (Φ jumps, or is infinite), Gauss–Seidel with the one-point solve: each sweep lowers E.
///
/// Only columns of points that feel a force are asked for. Cost: O(m) to read the lane, and O(k³ + km) for each
/// iteration with k points in contact.
class PointwiseSolver {
 public:
  PointwiseSolver() = default;
  /// Reserves for m points and the slopes of `lanes` lanes; solve() allocates nothing after this. `per_point`: the set
  /// of point i of lane l is i·lanes + l, else l.
  void prepare(int points, int lanes, bool per_point = false);

  /// Solves (1) for one lane of the problem; `effort` holds the first guess, then p. The residual is the distance of
  /// (y_i, p_i) from the force law, m. Convergence means equality to the round-off of forming y; where Φ jumps, that p
  /// lies between the ends of the jump. Not converged, or data that are not finite: p = 0. The result depends on this
  /// lane's numbers only, bit for bit.
  LaneOutcome solve(const PointwiseLaw& law, ReducedProblem& problem, int lane);

  /// Slopes at the last solve of that point and lane, both sides together.
  const ContactSlopes& slopes(int point, int lane) const {
    return slopes_[static_cast<std::size_t>(point) * static_cast<std::size_t>(lanes_) + static_cast<std::size_t>(lane)];
  }

  /// Largest numbers of Newton iterations, then of sweeps (default 60 and 4000).
  void limit(int iterations, int sweeps) {
    most_iterations_ = iterations;
    most_sweeps_ = sweeps;
  }

 private:
  // F_i, its slopes, and the size of the bounds that it is measured from.
  struct Answer {
    double force = 0, stiffness = 0, viscosity = 0, before = 0, dissipation = 0, bound = 0;
    bool finite() const;
  };
  struct Lane {
    const PointwiseLaw& law;
    const ReducedProblem& problem;
    int lane;
    bool per_point;
    std::size_t at(int i) const {
      return static_cast<std::size_t>(i) * static_cast<std::size_t>(problem.lanes) + static_cast<std::size_t>(lane);
    }
    double weight(const Answer& answer) const;
    Answer answer(int i, double x) const;
    double round_off(int i, double terms, double p, const Answer& answer) const;
    double slack(int i, double terms, const Answer& answer) const;
    double dissipation_between(int i, double x, double terms, double p, const Answer& at) const;
    bool on_law(int i, double x, double terms, double p, const Answer& answer) const;
  };

  static double solve_point(const Lane& lane, int i, double others, double mobility, double guess);
  LaneOutcome solve_alone(const Lane& lane);
  LaneOutcome solve_known(const Lane& lane);
  LaneOutcome solve_coupled(const Lane& lane);
  bool newton(const Lane& lane, int& iterations);
  bool sweep(const Lane& lane, int& iterations);
  bool find_direction(const Lane& lane);
  double slope(const Lane& lane, double step) const;
  void move(const Lane& lane);
  bool settled(const Lane& lane) const;
  LaneOutcome finish(const Lane& lane, bool converged, int iterations);

  int points_ = 0, lanes_ = 0;
  bool per_point_ = false;
  int most_iterations_ = 60, most_sweeps_ = 4000;
  std::vector<double> effort_, moved_, terms_;  // p, x = Wp, Σ_j |W_ij p_j|
  std::vector<double> step_, shift_;            // δp, Wδp
  std::vector<double> factor_, right_, root_;   // k rows of m, k, √D of the set
  std::vector<int> set_;                        // k: points whose force answers to what moves them
  std::vector<const double*> column_;           // k
  std::vector<Answer> answer_;                  // m
  std::vector<ContactSlopes> slopes_;           // m × lanes
};

/// How a force of the depth becomes the force of a step. It is read at the measure where the scheme evaluates it, or
/// from the depths δ⁻ before the step and δ after it. Those two need the measure with a `before`.
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
/// memory_per_point(). One whose energy depends on what it keeps gives potential() itself.
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
  double potential(const StopState& state) const override {
    const double beyond = state.depth + layer(state.set);
    return beyond > 0 ? stored(beyond, state.set) : 0.0;
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
