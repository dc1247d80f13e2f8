#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>
#include <vector>

/// \file
/// Between two readings a watched quantity g is its cubic Hermite interpolant, within (δ⁴/384) max|g''''|.
namespace ricochet::event_driven {

/// What a bound leaves of |e^{rτ}| between two readings δ apart, x = |r|δ. While x is small it is the interpolation
/// error, else the function and its interpolant.
inline double interpolation_loss(double x) {
  return std::min(x * x * x * x / 384, 1 + 0.3 * x);
}

/// Cubic on s ∈ [0, 1] through values and slopes (per unit of s) at both ends.
struct Cubic {
  double start, start_slope, end, end_slope;

  double at(double s) const {
    const double rise = end - start, b = 3 * rise - 2 * start_slope - end_slope, c = start_slope + end_slope - 2 * rise;
    return start + s * (start_slope + s * (b + s * c));
  }

  /// Where it turns inside ]0, 1[, in order; entries beyond the last turn are 1.
  std::array<double, 2> turns() const {
    const double rise = end - start, b = 3 * rise - 2 * start_slope - end_slope,
                 c = 3 * (start_slope + end_slope - 2 * rise);
    std::array<double, 2> result = {1, 1};
    const double discriminant = b * b - c * start_slope;
    if (discriminant <= 0) return result;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    const auto keep = [](double s) { return s > 0 && s < 1 ? s : 1.0; };
    result = {keep(c != 0 ? q / c : 1), keep(q != 0 ? start_slope / q : 1)};
    std::sort(result.begin(), result.end());
    return result;
  }
};

/// One bound that ends a phase when g passes it. Just after a switch the truncated expansion may leave g a hair beyond
/// the bound. The guard is then off until g has been further inside than `slack`, or the time `until` has come.
/// Meanwhile passing the bound by more than the slack ends the phase as well.
struct Guard {
  double bound = 0;
  int inside = 1;  ///< +1: g stays above; −1: below
  double slack = 0;
  bool on = true;
  double until = std::numeric_limits<double>::infinity();

  double margin(double g) const { return inside * (g - bound); }
  double threshold() const { return on ? 0 : -slack; }
  bool waits() const { return !on && std::isfinite(until); }
  void read(double t, double g) { on = on || margin(g) > slack || t >= until; }

  /// Smallest margin of a cubic.
  double least(const Cubic& cubic) const {
    double result = std::min(margin(cubic.start), margin(cubic.end));
    for (const double s : cubic.turns())
      if (s < 1) result = std::min(result, margin(cubic.at(s)));
    return result;
  }
  /// First end or turn of a cubic where the margin is below the threshold by more than `tolerance`.
  std::optional<double> passed_by(const Cubic& cubic, double tolerance) const {
    for (const double s : cubic.turns())
      if (margin(cubic.at(s)) < threshold() - tolerance) return s;
    if (margin(cubic.end) < threshold() - tolerance) return 1;
    return std::nullopt;
  }
};

/// Root of a margin that falls from `low` (≥ 0 there) to `high` (< 0 there): Newton kept inside a shrinking bracket.
/// `f` returns value and slope.
template <class Function>
double falling_root(const Function& f, double low, double high) {
  double x = 0.5 * (low + high);
  for (int i = 0; i < 100; ++i) {
    const auto [value, slope] = f(x);
    if (value == 0) return x;
    (value > 0 ? low : high) = x;
    double next = x - value / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - x) <= 1e-15 * high) return next;
    x = next;
  }
  return x;
}

}  // namespace ricochet::event_driven

/// \file
/// Independent damped oscillators y'' + 2ζy' + ω₀²y = 0, one per mode, moved by their exact solution whatever ζ ≥ 0:
///
///     y(τ) = C y₀ + S v₀,   v(τ) = −ω₀²S y₀ + S' v₀,   C = S' + 2ζS,   S the response to a unit velocity
namespace ricochet::event_driven {

class Oscillators {
 public:
  /// C, S, S' of one time τ, per mode.
  struct Flow {
    Eigen::ArrayXd stay, kick, keep;
  };

  Oscillators() = default;
  /// ω₀² > 0 (1/s²) and 2ζ ≥ 0 (1/s), per mode.
  Oscillators(Eigen::ArrayXd stiffness, Eigen::ArrayXd damping)
      : stiffness_(std::move(stiffness)), damping_(std::move(damping)), split_(stiffness_.size()) {
    for (Eigen::Index m = 0; m < size(); ++m) {
      const double zeta = damping_(m) / 2, omega = std::sqrt(stiffness_(m));
      split_(m) = std::sqrt(std::abs(zeta - omega)) * std::sqrt(zeta + omega);
    }
  }

  Eigen::Index size() const { return stiffness_.size(); }
  double stiffness(Eigen::Index m) const { return stiffness_(m); }
  double damping(Eigen::Index m) const { return damping_(m); }
  const Eigen::ArrayXd& stiffness() const { return stiffness_; }
  const Eigen::ArrayXd& damping() const { return damping_; }

  /// C, S, S' at τ ≥ 0 of the first `count` modes. Roots −ζ ± split: complex below critical damping; above it the slow
  /// one is −ω₀²/(ζ + split), and differences of exponentials go through expm1.
  void flow(double tau, Eigen::Index count, Flow& out) const {
    for (Eigen::Index m = 0; m < count; ++m) {
      const double zeta = damping_(m) / 2, s = split_(m);
      if (stiffness_(m) > zeta * zeta && s > 0) {
        const double decay = std::exp(-zeta * tau), sine = std::sin(s * tau) / s, cosine = std::cos(s * tau);
        out.kick(m) = decay * sine;
        out.keep(m) = decay * (cosine - zeta * sine);
        out.stay(m) = decay * (cosine + zeta * sine);
      } else {
        const double slow = -stiffness_(m) / (zeta + s), decay = std::exp(slow * tau);
        out.kick(m) = s > 0 ? decay * -std::expm1(-2 * s * tau) / (2 * s) : decay * tau;
        out.keep(m) = slow * out.kick(m) + std::exp(-(zeta + s) * tau);
        out.stay(m) = decay - slow * out.kick(m);
      }
    }
  }
  Flow empty_flow() const {
    const Eigen::ArrayXd zero = Eigen::ArrayXd::Zero(size());
    return {zero, zero, zero};
  }

  /// Moves the first `count` modes by one flow.
  void advance(const Flow& flow, Eigen::Index count, Eigen::ArrayXd& y, Eigen::ArrayXd& v) const {
    for (Eigen::Index m = 0; m < count; ++m) {
      const double position = flow.stay(m) * y(m) + flow.kick(m) * v(m);
      v(m) = flow.keep(m) * v(m) - stiffness_(m) * flow.kick(m) * y(m);
      y(m) = position;
    }
  }

  /// What bounds a mode from now on: y is at most first·|e^{r₁τ}| + second·|e^{r₂τ}|, likewise its derivatives with
  /// powers of |r|. Within 5 % of critical damping both roots count as one of modulus ω₀, its derivatives of fourth
  /// order included.
  struct Envelope {
    Eigen::ArrayXd first, second;
  };
  /// Moduli of the two roots (first the slow one).
  Envelope moduli() const {
    Envelope roots{stiffness_.sqrt(), Eigen::ArrayXd::Zero(size())};
    for (Eigen::Index m = 0; m < size(); ++m)
      if (overdamped(m)) {
        roots.second(m) = damping_(m) / 2 + split_(m);
        roots.first(m) = stiffness_(m) / roots.second(m);
      }
    return roots;
  }
  bool overdamped(Eigen::Index m) const { return !nearly_critical(m) && damping_(m) * damping_(m) > 4 * stiffness_(m); }
  bool nearly_critical(Eigen::Index m) const { return split_(m) * split_(m) < 0.0025 * stiffness_(m); }

  void envelope(const Eigen::ArrayXd& y, const Eigen::ArrayXd& v, Eigen::Index count, Envelope& out) const {
    for (Eigen::Index m = 0; m < count; ++m) {
      const double zeta = damping_(m) / 2, s = split_(m), rate = v(m) + zeta * y(m);
      if (nearly_critical(m)) {
        out.first(m) = std::abs(y(m)) + 5 * std::abs(rate) / std::sqrt(stiffness_(m));
        out.second(m) = 0;
      } else if (damping_(m) * damping_(m) > 4 * stiffness_(m)) {
        const double fast = zeta + s, slow = stiffness_(m) / fast;
        out.first(m) = std::abs(v(m) + fast * y(m)) / (2 * s);
        out.second(m) = std::abs(v(m) + slow * y(m)) / (2 * s);
      } else {
        out.first(m) = std::sqrt(y(m) * y(m) + rate * rate / (s * s));
        out.second(m) = 0;
      }
    }
  }

 private:
  Eigen::ArrayXd stiffness_, damping_, split_;
};

}  // namespace ricochet::event_driven

/// \file
/// A phase between two switches: modes that obey one set of equations, and one quantity g watched for its end.
///
///     a = y + still + Im(swing e^{iθ}),   θ = ωt + ψ;   y free oscillations
///     g = position·y + rate·v + constant + Im(harmonic e^{iθ})
namespace ricochet::event_driven {

using Complex = std::complex<double>;

/// Free oscillations at a time, modes beyond `count` being dead (zero).
struct ModalState {
  double time = 0;
  Eigen::Index count = 0;
  Eigen::ArrayXd y, v;
};

/// g and dg/dt.
struct Reading {
  double value = 0, slope = 0;
};

class ModalPhase {
 public:
  /// Weights of g on y and v, and its part that is not free oscillation.
  struct Watched {
    Eigen::ArrayXd position, rate;
    double constant = 0;
    Complex harmonic = 0;
  };

  ModalPhase(Oscillators oscillators, Eigen::ArrayXd still, Eigen::ArrayXcd swing, Watched watched, double pulsation,
             double phase)
      : oscillators_(std::move(oscillators)),
        still_(std::move(still)),
        swing_(std::move(swing)),
        watched_(std::move(watched)),
        pulsation_(pulsation),
        phase_(phase),
        moduli_(oscillators_.moduli()),
        envelope_(moduli_),
        flow_(oscillators_.empty_flow()) {
    slope_position_ = -watched_.rate * oscillators_.stiffness();
    slope_rate_ = watched_.position - watched_.rate * oscillators_.damping();
    first_ = watched_.position.abs();
    second_ = Eigen::ArrayXd::Zero(size());
    for (Eigen::Index m = 0; m < size(); ++m) {
      const double p = watched_.position(m), r = watched_.rate(m);
      if (oscillators_.overdamped(m)) {
        first_(m) = std::abs(p - r * moduli_.first(m));
        second_(m) = std::abs(p - r * moduli_.second(m));
      } else {
        first_(m) = std::abs(p) + std::abs(r) * moduli_.first(m);
      }
    }
    longest_ = 0.5 / std::max(std::sqrt(oscillators_.stiffness().minCoeff()), pulsation_);
  }

  Eigen::Index size() const { return oscillators_.size(); }
  const Oscillators& oscillators() const { return oscillators_; }
  /// Added to `constant` of g: the position of a stop.
  void set_offset(double offset) { offset_ = offset; }
  static constexpr int levels = 44;
  double step(int level) const { return std::ldexp(longest_, -level); }

  Complex turn(double t) const { return std::polar(1.0, pulsation_ * t + phase_); }

  /// Free oscillations that make modal displacements and velocities a, b at time t.
  ModalState start(double t, const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) const {
    const Complex turned = turn(t);
    return {t, size(), a - still_ - (swing_ * turned).imag(), b - (swing_ * (Complex(0, pulsation_) * turned)).imag()};
  }
  /// The whole a, b at time t ≥ state.time, by the exact solution.
  void whole(const ModalState& state, double t, Eigen::ArrayXd& a, Eigen::ArrayXd& b) {
    scratch_ = state;
    move(scratch_, t);
    const Complex turned = turn(t);
    a = scratch_.y + still_ + (swing_ * turned).imag();
    b = scratch_.v + (swing_ * (Complex(0, pulsation_) * turned)).imag();
  }
  /// a'' at the time of a state.
  Eigen::ArrayXd acceleration(const ModalState& state) const {
    return (swing_ * (-pulsation_ * pulsation_ * turn(state.time))).imag() - oscillators_.stiffness() * state.y -
           oscillators_.damping() * state.v;
  }
  const Watched& watched() const { return watched_; }
  void move(ModalState& state, double t) {
    oscillators_.flow(t - state.time, state.count, flow_);
    oscillators_.advance(flow_, state.count, state.y, state.v);
    state.time = t;
  }
  /// By one search step, whose flow is kept.
  void move_by_level(ModalState& state, int level) {
    oscillators_.advance(at(level).flow, state.count, state.y, state.v);
    state.time += step(level);
  }

  Reading read(const ModalState& state) const {
    const Complex turned = turn(state.time) * watched_.harmonic;
    const auto y = state.y.head(state.count), v = state.v.head(state.count);
    return {
        (watched_.position.head(state.count) * y + watched_.rate.head(state.count) * v).sum() + watched_.constant +
            offset_ + turned.imag(),
        (slope_position_.head(state.count) * y + slope_rate_.head(state.count) * v).sum() + pulsation_ * turned.real()};
  }
  Reading read_at(const ModalState& state, double t) {
    scratch_ = state;
    move(scratch_, t);
    return read(scratch_);
  }

  /// Prepares interpolation_error for the steps that start from this state.
  void measure(const ModalState& state) {
    oscillators_.envelope(state.y, state.v, state.count, envelope_);
    measured_ = state.count;
  }
  /// How far g may be from its cubic interpolant over one step from the measured state.
  double interpolation_error(int level) {
    const Level& l = at(level);
    return (l.first.head(measured_) * envelope_.first.head(measured_) +
            l.second.head(measured_) * envelope_.second.head(measured_))
               .sum() +
           std::abs(watched_.harmonic) * interpolation_loss(pulsation_ * step(level));
  }

  /// Lets modes die that have less than `floor` left (|y| + |v|/ω₀), from the highest down.
  void forget_dead_modes(ModalState& state, double floor) const {
    while (state.count > 1) {
      const Eigen::Index m = state.count - 1;
      if (std::abs(state.y(m)) + std::abs(state.v(m)) / std::sqrt(oscillators_.stiffness(m)) > floor) return;
      state.y(m) = state.v(m) = 0;
      --state.count;
    }
  }

 private:
  struct Level {
    Oscillators::Flow flow;
    Eigen::ArrayXd first, second;  // weight on g times interpolation loss, per root
  };

  const Level& at(int level) {
    if (static_cast<std::size_t>(level) >= levels_.size()) levels_.resize(static_cast<std::size_t>(level) + 1);
    Level& l = levels_[static_cast<std::size_t>(level)];
    if (l.first.size() == 0) {
      l.flow = oscillators_.empty_flow();
      oscillators_.flow(step(level), size(), l.flow);
      const auto loss = [&](double modulus) { return interpolation_loss(modulus * step(level)); };
      l.first = first_ * moduli_.first.unaryExpr(loss);
      l.second = second_ * moduli_.second.unaryExpr(loss);
    }
    return l;
  }

  Oscillators oscillators_;
  Eigen::ArrayXd still_;
  Eigen::ArrayXcd swing_;
  Watched watched_;
  double pulsation_, phase_, offset_ = 0, longest_ = 0;
  Eigen::ArrayXd slope_position_, slope_rate_, first_, second_;
  Oscillators::Envelope moduli_, envelope_;
  Oscillators::Flow flow_;
  ModalState scratch_;
  std::vector<Level> levels_;
  Eigen::Index measured_ = 0;
};

}  // namespace ricochet::event_driven
