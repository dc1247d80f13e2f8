#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <ricochet/scene/history/time_history.hpp>
#include <string>
#include <vector>

/// \file
/// Quantities given at instants: how they go on between these and beyond them.
namespace ricochet {

/// A quantity at increasing instants: t (s) and its values.
struct TimeTable {
  enum class Between { linear, cubic, step };
  enum class Beyond { zero, hold, error };

  std::string name;  ///< for messages: "ground.csv"
  std::vector<double> times, values;
  Between between = Between::linear;
  /// Before the first and after the last instant. `error` holds the value: whoever integrates asks covers() first.
  Beyond before = Beyond::error, after = Beyond::error;
  double period = 0;  ///< s, from the first to the last instant, after which it repeats; 0: it does not

  /// Whether the quantity is given from t = `from` to `to`; up to a rounding of `slack`.
  bool covers(double from, double to, double slack) const {
    return period > 0 || ((before != Beyond::error || times.front() <= from + slack) &&
                          (after != Beyond::error || to <= times.back() + slack));
  }
  /// Throws InputError at `pointer` unless there are two instants or more, all increasing, and all numbers finite; and
  /// where it repeats, unless it is as long as the period and ends as it begins.
  void check(const std::string& pointer) const;
};

/// A function of t in pieces, each a polynomial of degree 3: f(t) = Σ_k c_k (t − t_i)^k from t_i to t_{i+1}. The first
/// piece reaches to −∞, the last to +∞, unless f repeats with the period of its table. At an instant t_i the piece
/// behind it holds. Any number of threads may ask.
class PiecewiseCubic : public TimeHistory {
 public:
  using Piece = std::array<double, 4>;

  /// The values of a table: straight between instants, a natural cubic spline (f'' = 0 at both ends; one of a table
  /// that repeats has f' and f'' equal there), or each value until the next instant.
  static PiecewiseCubic interpolate(const TimeTable& table);
  /// The motion whose acceleration is that of a table, straight between instants: f'' is exact, f and f' are its exact
  /// integrals with f(0) and f'(0) as given (m, m/s).
  static PiecewiseCubic integrate_twice(const TimeTable& acceleration, double position, double velocity);

  PiecewiseCubic(std::vector<double> starts, std::vector<Piece> pieces, double period = 0);
  PiecewiseCubic(const PiecewiseCubic& other);
  PiecewiseCubic& operator=(const PiecewiseCubic&) = delete;

  double value(double t) const override;
  double rate(double t) const override;
  double acceleration(double t) const override;

 private:
  std::size_t piece(double t) const;
  /// t less whole periods, from the first instant to the last.
  double within(double t) const;

  std::vector<double> starts_;
  std::vector<Piece> pieces_;
  double period_ = 0;
  mutable std::atomic<std::size_t> near_{0};  ///< the piece asked for last
};

/// What a motion whose acceleration repeats must begin with, so that it repeats, too: φ'' has no mean then, φ' has none
/// from φ'(0) = `velocity` on, and φ none from φ(0) = `position`.
struct SteadyStart {
  double mean_acceleration = 0, largest_acceleration = 0;  ///< m/s²
  double velocity = 0, largest_velocity = 0;               ///< m/s
  double position = 0;                                     ///< m, with that velocity
};
SteadyStart steady_start(const TimeTable& acceleration);

}  // namespace ricochet
