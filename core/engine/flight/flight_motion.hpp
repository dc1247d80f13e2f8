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

}  // namespace ricochet
