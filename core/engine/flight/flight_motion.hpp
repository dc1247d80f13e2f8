#pragma once
#include <ricochet/engine/flight/step_rows.hpp>

namespace ricochet {

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
