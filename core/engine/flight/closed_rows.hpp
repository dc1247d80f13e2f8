#pragma once
#include <array>
#include <ricochet/engine/flight/effort_response.hpp>
#include <ricochet/engine/flight/flight_set.hpp>
#include <span>

namespace ricochet {

/// The numbers of a step with these points closed: everything that is linear in the state, in what drives it, and in
/// the efforts of this step and of those before that still act, worked out once. Efforts stand stage by stage, point by
/// point.
class ClosedRows {
 public:
  /// Σ w x + Σ d e + Σ_q a_q p₋q, a number. What is zero of w at its ends is left out.
  struct Row {
    std::size_t first = 0;
    std::vector<double> x;
    std::array<double, 3> e{};
    std::vector<double> p;  // of this step, then of the one before, …
  };
  /// The same for each mode.
  struct Vector {
    std::vector<double> table;                                   // (slots + drives) × modes
    std::vector<std::pair<std::size_t, std::vector<double>>> p;  // where in (p, p₋₁, …), and its column
  };
  /// What a stage that reads contact asks of a closed point.
  struct Point {
    double side = 1, stop = 0;
    double target = 0;  // t of (7)
    Row law;            // F, E, W
    Row depth, before, rate;
    Row place;  // absolute, before the stage
  };
  /// What the balance of a stage asks.
  struct Balance {
    int stage = 0, first = 0;  // its first effort; −1: it reads no contact
    Vector displacement, rate;
    double along = 0;                                        // r = along · s; 0: by `rate`
    std::vector<double> damping;                             // of each mode; empty: none
    std::vector<std::pair<int, std::vector<double>>> loads;  // of a drive
    std::vector<std::pair<std::size_t, double>> work_effort;  // p̄: where its first term stands in (p, p₋₁, …), weight
    std::array<double, 3> lift{};
    struct Loss {
      Vector value;
      std::vector<double> weight;
    };
    std::vector<Loss> losses;
  };

  ClosedRows(const Program& program, FlightSet& free, std::vector<ClosedPoint> closed);

  const std::vector<ClosedPoint>& closed() const { return closed_; }
  int modes() const { return modes_; }
  int slots() const { return slots_; }
  int drives() const { return drives_; }
  int stages() const { return static_cast<int>(first_.size()); }
  bool reads(int stage) const { return first_[static_cast<std::size_t>(stage)] >= 0; }
  int first(int stage) const { return first_[static_cast<std::size_t>(stage)]; }
  int contact_points() const { return static_cast<int>(contact_.rows()); }
  /// H of a closed point.
  const double* row_of_point(std::size_t i) const {
    return closed_contact_.data() + i * static_cast<std::size_t>(modes_);
  }
  /// Efforts of a step.
  std::size_t efforts() const { return m_; }
  /// Steps back to which an effort acts.
  std::size_t memory() const { return memory_; }

  bool damps = false, means = false, rigid = false;
  double viscosity = 0;
  std::vector<double> momentum;  ///< of each effort
  std::vector<Point> points;     ///< of each effort
  std::vector<double> solution;  ///< W₀⁻¹, by rows
  std::vector<Balance> balances;
  std::vector<std::pair<std::size_t, std::vector<double>>> change;  ///< U: where in (p, p₋₁, …), slots × modes
  std::vector<Row> start;  ///< absolute place of each closed point where a step begins
  Row tip;                 ///< of the tip there
  /// How far an effort may take a measure of an open point within 2^k steps: of each watch of the free motion, points ×
  /// efforts for each k.
  std::vector<std::vector<std::vector<double>>> reach;

 private:
  Row row_of(int stage, const Combination& c, const Eigen::RowVectorXd& at_point,
             const Eigen::RowVectorXd& drive) const;
  Vector vector_of(int stage, const Combination& c) const;
  void add_points(const Program& program);
  void add_balances(const Program& program);
  void add_reach(FlightSet& free);
  void find_memory(const Program& program);

  std::vector<ClosedPoint> closed_;
  const StepRows* rows_;  // while it is made
  FlightDrive drive_;
  int modes_, slots_, drives_;
  std::vector<int> first_;
  std::size_t m_ = 0, memory_ = 0;
  Eigen::MatrixXd contact_;
  std::vector<double> closed_contact_;
  Eigen::VectorXd mass_;
  std::vector<std::vector<EffortResponse>> responses_;  // of q steps before, of each effort
};

}  // namespace ricochet
