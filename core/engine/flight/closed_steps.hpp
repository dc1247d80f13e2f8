#pragma once
#include <array>
#include <memory>
#include <ricochet/engine/flight/flight_motion.hpp>
#include <ricochet/engine/flight/flight_set.hpp>
#include <span>

/// \file
/// Steps through which the same points stay closed, one by one, by what the law comes to there. With the efforts p of
/// all stages that read contact, a step of free modes is linear,
///
///     x⁺ = (I + D) x + B e + Σ_q U_q p₋q,     W₀ p = t − F x − E e − Σ_{q>0} W_q p₋q (7)
///
/// where a row of (7) is a measure at its stop, or p = k δ + c δ̇ + b δ⁻ of a linear law. Nothing is searched for, no
/// open point is measured and nobody observes: of all that a step with 50 points asks, a tenth is left.
namespace ricochet {

/// The numbers of a step with these points closed, worked out once. They hold all that is linear in the state, in the
/// drive, and in efforts that still act (of this step and of those before). Efforts stand stage by stage, point by
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
    double viscosity = 0;
    Row law;  // F, E, W
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
  std::vector<double> momentum;  ///< of each effort
  std::vector<Point> points;     ///< of each effort
  std::vector<double> solution;  ///< W₀⁻¹, by rows
  std::vector<Balance> balances;
  std::vector<std::pair<std::size_t, std::vector<double>>> change;  ///< U: where in (p, p₋₁, …), slots × modes
  std::vector<Row> start;  ///< absolute place of each closed point where a step begins
  Row tip;                 ///< of the tip there
  /// How far an effort may take a measure of an open point within 2^k steps. Of each watch of the free motion:
  /// points × efforts for each k.
  std::vector<std::vector<std::vector<double>>> reach;

 private:
  Row row_of(int stage, const Combination& c, const Eigen::RowVectorXd& at_point,
             const Eigen::RowVectorXd& drive) const;
  Vector vector_of(int stage, const Combination& c) const;
  void add_points(const Program& program);
  void add_to_law(Point& point, const Row& row, double factor) const;
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

class ClosedSteps {
 public:
  /// Longest run of steps at once.
  static constexpr long long longest = 2048;
  /// Of each stage that reads contact: efforts of one stage, of one step ago, of two, …: one per contact point each.
  using Past = std::span<const std::vector<double*>>;

  /// Why contact of this program does not go by such steps; empty where it does.
  static std::string why_not(const Program& program);

  /// `free`: the same motion without contact.
  ClosedSteps(const Program& program, FlightSet& free, std::vector<ClosedPoint> closed);

  /// Makes up to `most` steps from this state on, and returns how many. These points alone are closed in each of them
  /// and in the one after.
  long long march(const double* const* slots, const double* e, Past past, long long most);
  /// The state after them.
  void leave(double* const* slots, Past past) const;

  const FlightSums& sums() const { return sums_; }
  double penetration() const { return penetration_; }
  /// Absolute displacement of the tip after each of them, m.
  std::span<const double> tips() const { return {tips_.data(), static_cast<std::size_t>(flown_)}; }

  /// Each stage of each of these steps: `see`(stage, efforts of the closed points, absolute places of these before it).
  /// Empty where a stage reads no contact.
  template <class See>
  void each_stage(See&& see) const {
    const std::size_t points = rows_.closed().size(), m = rows_.efforts();
    for (long long step = 0; step < flown_; ++step) {
      const double* effort = efforts_.data() + (static_cast<std::size_t>(step) + rows_.memory()) * m;
      const double* place = places_.data() + static_cast<std::size_t>(step) * m;
      for (int stage = 0; stage < rows_.stages(); ++stage) {
        if (!rows_.reads(stage)) {
          see(stage, std::span<const double>{}, std::span<const double>{});
          continue;
        }
        see(stage, std::span<const double>(effort, points), std::span<const double>(place, points));
        effort += points;
        place += points;
      }
    }
  }

 private:
  bool begin(const double* const* slots, const double* e, Past past);
  long long run(long long most);
  bool solve(const double* x, long long step);
  FlightSums works(const double* x, long long step);
  bool stays_open(long long steps);
  /// p₋q of a step.
  double effort(long long step, std::size_t q, std::size_t i) const {
    return efforts_[(static_cast<std::size_t>(step) + rows_.memory() - q) * rows_.efforts() + i];
  }
  double row(const ClosedRows::Row& row, const double* x, long long step) const;
  const double* vector(const ClosedRows::Vector& vector, const double* x, long long step, double* out) const;

  ClosedRows rows_;
  FlightSet& free_;
  std::vector<double> start_, x_[2], efforts_, places_, tips_, impulse_, rest_, vector_;
  double start_e_[3] = {}, e_[3] = {};
  int at_ = 0;  // which of x_ is the end
  long long flown_ = 0;
  FlightSums sums_;
  double penetration_ = 0;
};

}  // namespace ricochet
