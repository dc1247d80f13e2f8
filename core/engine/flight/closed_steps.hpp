#pragma once
#include <array>
#include <memory>
#include <ricochet/engine/flight/closed_rows.hpp>

/// \file
/// Steps through which the same points stay closed, one by one, by what the law comes to there. With the efforts p of
/// all stages that read contact, a step of free modes is linear,
///
///     x⁺ = (I + D) x + B e + Σ_q U_q p₋q,     W₀ p = t − F x − E e − Σ_{q>0} W_q p₋q (7)
///
/// where a row of (7) is a measure at its stop, or p = k δ + c δ̇ + b δ⁻ of a linear law. Nothing is searched for, no
/// open point is measured and nobody looks: of all that a step with 50 points asks, a tenth is left.
namespace ricochet {

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

  /// Makes up to `most` steps from this state on, as long as these points alone are closed in each of them and in the
  /// one after; how many.
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
