#pragma once
#include <Eigen/Core>
#include <ricochet/engine/compile.hpp>
#include <ricochet/engine/stage_operator.hpp>
#include <vector>

namespace ricochet {

// One step as a matrix of a few numbers per mode. While no contact point opens or closes, a step is linear with
// constant coefficients; over modes with φᵀKφ = 1 and φᵀMφ = μ, which diagonalise M, K and C = αK + ηM at once, it
// falls into
//
//     x⁺ = x + D x + B e,     e⁺ = e + R e          x: the s slots of one mode;  e: what drives it (1)
//
// with e at the beginning of the step, as far as the scene has it: (A sin(ωt + ψ), A cos(ωt + ψ), 1), the supports'
// motion, or (sin Ωt, cos Ωt, 1) of a load of one pulsation. What is kept is the change D of a step, not I + D: of
// small steps I + D would forget the frequency.

/// What drives a motion beside its own state.
struct FlightDrive {
  bool support = false;   ///< A sin(ωt + ψ) and A cos(ωt + ψ), m
  bool load = false;      ///< sin Ωt and cos Ωt, where no support moves
  bool constant = false;  ///< 1
  double angle = 0;       ///< ωh or Ωh
  bool harmonic() const { return support || load; }
  int count() const { return (harmonic() ? 2 : 0) + (constant ? 1 : 0); }
  /// Where 1 stands among them.
  int one() const { return harmonic() ? 2 : 0; }
  /// R of k steps, count() × count().
  Eigen::MatrixXd change(double steps) const;
};

/// A stage over r modes.
struct FlightStage {
  FoldedStage folded;
  std::vector<Combination> update;  ///< one per slot
  Eigen::MatrixXd force;            ///< r × drives: what they add to b
};

/// Rows of one step over (x, e), mode by mode: s + drives numbers each.
class StepRows {
 public:
  /// `damping`: c of each mode where damping goes by modes; else empty.
  StepRows(const std::vector<FlightStage>& stages, int slots, const Eigen::VectorXd& mass,
           const Eigen::VectorXd& damping, const FlightDrive& drive);

  int modes() const { return static_cast<int>(maps_.size()); }
  int slots() const { return slots_; }
  int stages() const { return static_cast<int>(maps_.front().size()) - 1; }
  int width() const { return slots_ + drive_.count(); }
  const FlightDrive& drive() const { return drive_; }

  /// Of Σ_j c_j x_j + c_z z before stage `stage` and with its unknown; `stage` = number of stages: after the step.
  Eigen::RowVectorXd of(int mode, int stage, const Combination& c) const;
  /// (D B): s × width.
  const Eigen::MatrixXd& change(int mode) const { return maps_[static_cast<std::size_t>(mode)].back().change; }

 private:
  struct StageMap {
    Eigen::MatrixXd change;      // of the slots since the step began, s × width
    Eigen::RowVectorXd unknown;  // z
  };
  Eigen::RowVectorXd slot(const StageMap& map, int j) const;

  int slots_;
  FlightDrive drive_;
  std::vector<std::vector<StageMap>> maps_;  // of each mode: before each stage, and after the last
};

// What stands on the right of a step, over what drives it.

/// `factor` times a combination of levels of the clamp's motion, over e.
Eigen::RowVectorXd harmonic(const PhaseWeights& phase, const FlightDrive& drive, double factor = 1);

/// A load over e, in the coordinates of the integration (rows × drives). It is that of the clamp's inertia and of a
/// distributed load F = c + a sin Ωt + b cos Ωt, known by F at 0, π/2Ω and π/Ω.
Eigen::MatrixXd load_over_drive(const Program& program, const Levels& levels, const FlightDrive& drive);

/// The weight of slot j; trailing ones may be left out.
inline double weight_at(const std::vector<double>& weights, int j) {
  return static_cast<std::size_t>(j) < weights.size() ? weights[static_cast<std::size_t>(j)] : 0.0;
}

/// Weights of all slots a plan may have, then that of z.
std::vector<double> slot_weights(const Combination& c);

/// What an effort of 1 N along one row of modes does to a step, over modes with φᵀKφ = 1 and φᵀMφ = μ: the effort that
/// stage `stage` found `ago` steps before, as far as the stages of this step weigh it, the slots zero where it begins.
class EffortResponse {
 public:
  EffortResponse(const Program& program, int stage, int ago, const Eigen::VectorXd& row);

  /// Whether no stage of this step weighs it.
  bool none() const { return none_; }
  /// Σ_j c_j x_j + c_z z before stage `at` and with its unknown; `at` = number of stages: after the step. One per mode.
  Eigen::VectorXd of(int at, const Combination& c) const;
  /// The slots after the step, modes × slots.
  const Eigen::MatrixXd& change() const { return slots_.back(); }

 private:
  bool none_ = true;
  std::vector<Eigen::MatrixXd> slots_;    // before each stage, and after the last
  std::vector<Eigen::VectorXd> unknown_;  // of each stage
};

/// (D B) of a step becomes that of two, by (2); `turn`: R of the step.
void double_change(Eigen::MatrixXd& change, int slots, const Eigen::MatrixXd& turn);

/// k steps of r uncoupled modes at once, for any k, by tables of D and B of (1) for 1, 2, 4, … steps:
///
///     D₂ₖ = 2 Dₖ + Dₖ Dₖ,     B₂ₖ = 2 Bₖ + Dₖ Bₖ + Bₖ Rₖ (2)
///
/// What is composed is the step itself: nothing is approximated.
class FlightMotion {
 public:
  /// Tables for flights of up to 2^powers − 1 steps.
  FlightMotion(const StepRows& rows, int powers);

  int modes() const { return modes_; }
  int slots() const { return slots_; }
  const FlightDrive& drive() const { return drive_; }
  long long longest() const { return (1LL << tables_.size()) - 1; }
  /// D and B of 2^power steps: slots × (slots + drives) arrays, one number per mode; and their R, drives × drives.
  const double* table(int power) const { return tables_[static_cast<std::size_t>(power)].data(); }
  const double* rotation(int power) const { return rotations_[static_cast<std::size_t>(power)].data(); }
  int powers() const { return static_cast<int>(tables_.size()); }
  /// One step from x to `next`, which is another place; e with it.
  void step(const double* x, double* e, double* next) const { leap_to(0, x, e, next); }
  /// x of all modes and e, 2^power steps later. `x`: slots × r numbers, slot by slot.
  void leap(int power, double* x, double* e) const;
  /// The same for k steps, k ≤ longest().
  void advance(long long k, double* x, double* e) const;

 private:
  void double_table(const double* change, const double* turn, double* twice) const;
  void leap_to(int power, const double* x, double* e, double* next) const;

  int modes_, slots_, width_;
  FlightDrive drive_;
  std::vector<std::vector<double>> tables_;     // of a power: slots × width × modes
  std::vector<std::vector<double>> rotations_;  // R of 2^i steps
  mutable std::vector<double> next_;
};

/// Works over many steps, J.
struct FlightSums {
  double damping = 0;  ///< Σ sᵀC r
  double loads = 0;    ///< Σ sᵀF̄, and the support's work through the stops
  double scheme = 0;   ///< Σ of the plan's loss terms
  double contact = 0;  ///< Σ p̄ᵀ(H s + Δφ); points that rest on rigid stops do none
  double law = 0;      ///< what the law dissipates of it
  double gain = 0;     ///< contact − damping − scheme of the step where that is largest, not below 0

  FlightSums& operator+=(const FlightSums& other);
};

/// Σ over k steps of quantities that are quadratic in the state of each mode, y = (x, e):
///
///     Σ_{i<2k} y_iᵀ Q y_i = y₀ᵀ (Gₖ + Aₖᵀ Gₖ Aₖ) y₀,     Gₖ = Σ_{i<k} (Aⁱ)ᵀ Q Aⁱ (5)
class FlightWorks {
 public:
  /// Q of each mode over (x, e), symmetric; empty: zero.
  using Form = std::vector<Eigen::MatrixXd>;
  struct Forms {
    Form damping, loads, scheme;
  };
  FlightWorks(const FlightMotion& motion, const Forms& forms);

  /// Adds what 2^power steps from (x, e) on bring.
  void add(int power, const double* x, const double* e, FlightSums& sums) const;
  /// Whether neither damping nor the scheme gives energy in any step, whatever the state.
  bool never_gains() const { return never_gains_; }

 private:
  using Tables = std::vector<std::vector<double>>;  // of a power: width(width+1)/2 × modes; empty: zero
  static Tables tables(const FlightMotion& motion, const Form& form);

  int modes_, slots_, drives_;
  Tables damping_, loads_, scheme_;
  bool never_gains_ = true;
};

}  // namespace ricochet
