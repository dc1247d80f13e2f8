#pragma once
#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace ricochet {

/// A quantity over time that has two derivatives. Any number of threads may ask.
class TimeHistory {
 public:
  virtual ~TimeHistory() = default;
  virtual double value(double t) const = 0;
  virtual double rate(double t) const = 0;
  virtual double acceleration(double t) const = 0;
};

/// A sin(ωt + ψ).
class HarmonicMotion : public TimeHistory {
 public:
  HarmonicMotion(double amplitude, double pulsation, double phase)
      : amplitude_(amplitude), pulsation_(pulsation), phase_(phase) {}
  double value(double t) const override { return amplitude_ * std::sin(pulsation_ * t + phase_); }
  double rate(double t) const override { return amplitude_ * pulsation_ * std::cos(pulsation_ * t + phase_); }
  double acceleration(double t) const override { return -pulsation_ * pulsation_ * value(t); }

 private:
  double amplitude_, pulsation_, phase_;
};

// Quantities given at instants: how they go on between these and beyond them.

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
  /// Throws InputError at `pointer` unless there are two instants or more, all increasing, with a value each, and all
  /// numbers finite. Where it repeats, it must be as long as the period and end as it begins.
  void check(const std::string& pointer) const;
};

/// A function of t in pieces, each a polynomial of degree 3: f(t) = Σ_k c_k (t − t_i)^k from t_i to t_{i+1}. The first
/// piece reaches to −∞, the last to +∞, unless f repeats with the period of its table. At an instant t_i the piece
/// behind it holds. Any number of threads may ask.
class PiecewiseCubic : public TimeHistory {
 public:
  using Piece = std::array<double, 4>;

  /// The values of a table: straight between instants, a natural cubic spline, or each value until the next instant.
  /// The spline has f'' = 0 at both ends; of a table that repeats, f' and f'' are equal there.
  static PiecewiseCubic interpolate(const TimeTable& table);
  /// ∫f dt, 0 at the first instant, of an f whose pieces have no t³. Of what repeats: where its mean is 0.
  PiecewiseCubic integral() const;
  /// The motion whose acceleration is that of a table, straight between instants. It has f'' exactly, and f and f' as
  /// its exact integrals with f(0) and f'(0) as given (m, m/s).
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

/// What supports do by histories, beside the harmonic φ of all: u = w + Σ_j ψ_j φ_j(t), ψ_j the static shape of the
/// supports that move by φ_j. A stop that moves with a support sees u less the motion of that support.
struct SupportMotions {
  std::vector<std::shared_ptr<const TimeHistory>> histories;  ///< φ_j, m; r of them
  std::vector<std::vector<std::size_t>> supports;             ///< that each moves
  Eigen::MatrixXd at_points;   ///< m × r: (Hψ)_j at the contact points, less 1 where the stop moves by φ_j
  Eigen::RowVectorXd at_tip;   ///< 1 × r: (ψ_j) at the tip; zero where displacements count from the supports
  bool from_supports = false;  ///< whether displacements that are shown do
  bool carry_stops = false;    ///< whether stops move with supports

  bool empty() const { return histories.empty(); }
  /// Σ_j A_ij φ_j(t) of contact point i, m, and its rate.
  double point(int i, double t) const { return empty() ? 0.0 : sum(at_points.row(i), t, false); }
  double point_rate(int i, double t) const { return empty() ? 0.0 : sum(at_points.row(i), t, true); }
  /// Σ_j A_ij φ_j''(t), m/s².
  double point_acceleration(int i, double t) const {
    double total = 0;
    for (std::size_t j = 0; j < histories.size(); ++j)
      total += at_points(i, static_cast<Eigen::Index>(j)) * histories[j]->acceleration(t);
    return total;
  }
  /// Σ_j A_ij φ_j(t) of the tip, m, and its rate.
  double tip(double t) const { return empty() ? 0.0 : sum(at_tip, t, false); }
  double tip_rate(double t) const { return empty() ? 0.0 : sum(at_tip, t, true); }

  /// φ_j(t), r numbers, or their rates. Allocates.
  Eigen::VectorXd values(double t, bool rate) const {
    Eigen::VectorXd out(static_cast<Eigen::Index>(histories.size()));
    for (std::size_t j = 0; j < histories.size(); ++j)
      out[static_cast<Eigen::Index>(j)] = rate ? histories[j]->rate(t) : histories[j]->value(t);
    return out;
  }

  /// Σ_j a_j φ_j(t), or its rate.
  double sum(const Eigen::Ref<const Eigen::RowVectorXd, 0, Eigen::InnerStride<>>& a, double t, bool rate) const {
    double total = 0;
    for (std::size_t j = 0; j < histories.size(); ++j) {
      const double share = a[static_cast<Eigen::Index>(j)];
      if (share != 0) total += share * (rate ? histories[j]->rate(t) : histories[j]->value(t));
    }
    return total;
  }
};

/// A spectrum that a load is drawn from: S(f), one-sided, unit²/Hz, on `lines` equal bands from `from` to `to`.
struct SpectrumSpec {
  std::function<double(double)> density;  ///< S(f); its value may be anything where the spectrum is not given
  double from = 0, to = 0;                ///< Hz
  int lines = 0;
  std::uint64_t seed = 0, load = 0;  ///< a load of another number, or seed, is independent
  std::string pointer;               ///< for errors
};

/// F(t) = Σ_i √(2 S(f_i) Δf) cos(2π f_i t + θ_i), f_i the middle of band i, θ_i from a counter-based generator
/// (SplitMix64 of seed, load and i): the same on every machine, in any order of asking.
///
/// Its mean square over 2/Δf is Σ S(f_i) Δf whatever the seed, where from/Δf is whole. After 1/Δf it repeats, but for a
/// phase. Between instants 1/(64·to) apart, at which value and slope are exact, it is the cubic of Hermite. It is off
/// by less than (2π/64)⁴/384 = 2.5e-7 of its amplitude.
class RandomLoad {
 public:
  /// Throws InputError at the pointer for bands without width, S(f) negative or not finite.
  explicit RandomLoad(const SpectrumSpec& spectrum);

  /// The first call makes the tables. Any number of threads may ask.
  double value(double t) const;
  double period() const { return 1 / band_; }          ///< 1/Δf, s
  double mean_square() const { return mean_square_; }  ///< Σ S Δf, unit²

 private:
  void make_tables() const;
  using Complex = std::complex<double>;
  double band_ = 0, spacing_ = 0, base_ = 0;  ///< Δf (Hz), instants (s), first line (rad/s)
  double mean_square_ = 0;
  std::vector<double> lines_, phases_;  ///< A_i and θ_i
  std::size_t count_ = 1;               ///< of instants in 1/Δf
  mutable std::once_flag made_;
  mutable std::vector<Complex> envelope_,
      slope_;  ///< Σ A_i e^{i(θ_i + 2π i Δf t)} at the instants, times iω of each line
};

}  // namespace ricochet
