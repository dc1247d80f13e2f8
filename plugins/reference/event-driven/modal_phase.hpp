#pragma once
#include <complex>
#include <vector>

#include "guarded_search.hpp"
#include "modal_oscillators.hpp"

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
struct Look {
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

  Look look(const ModalState& state) const {
    const Complex turned = turn(state.time) * watched_.harmonic;
    const auto y = state.y.head(state.count), v = state.v.head(state.count);
    return {
        (watched_.position.head(state.count) * y + watched_.rate.head(state.count) * v).sum() + watched_.constant +
            offset_ + turned.imag(),
        (slope_position_.head(state.count) * y + slope_rate_.head(state.count) * v).sum() + pulsation_ * turned.real()};
  }
  Look look_at(const ModalState& state, double t) {
    scratch_ = state;
    move(scratch_, t);
    return look(scratch_);
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
