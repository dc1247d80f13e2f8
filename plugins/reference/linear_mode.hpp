#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <optional>

/// \file
/// The linear oscillator, solved exactly, in forms that keep their digits in every regime. These are under-, critically
/// and over-damped, without stiffness, forced at rest, in resonance, and near each of these.
///
///     y'' + 2δ y' + λ y = f e^{στ}                   δ ≥ 0, λ ≥ 0, σ = 0 or iω
///     y = y₀ c + v₀ s + f r                           c(0) = s'(0) = 1, c'(0) = s(0) = 0, r(0) = r'(0) = 0
///
/// r is the second divided difference of e^{·τ} at the two roots s₁, s₂ and σ. Where they are all near, it is summed;
/// where σ is near one root, it is the difference of two first divided differences.
namespace ricochet::reference {

using Complex = std::complex<double>;

/// (e^z − 1)/z, 1 at z = 0.
inline Complex relative_growth(Complex z) {
  if (std::abs(z) < 1e-300) return 1;
  const double half = std::sin(z.imag() / 2), grown = std::expm1(z.real());
  const Complex rise{grown * std::cos(z.imag()) - 2 * half * half, (grown + 1) * std::sin(z.imag())};
  return rise / z;
}

/// ∫₀^τ e^{σx} dx, with e^{στ} at hand and the start's phase left out.
inline Complex integrated(Complex exponent, double tau) {
  return tau * relative_growth(exponent * tau);
}

/// First divided difference (e^{aτ} − e^{στ})/(a − σ): the response from rest of z' = a z + e^{στ}. Re a ≤ 0.
inline Complex first_order_response(Complex a, Complex exponent, double tau, Complex phasor) {
  return phasor * tau * relative_growth((a - exponent) * tau);
}

/// y, y', y''.
struct Motion {
  double value = 0, rate = 0, curve = 0;
};

/// δ (1/s) and λ (1/s²) of y'' + 2δ y' + λ y.
class LinearMode {
 public:
  LinearMode() = default;
  LinearMode(double decay, double square) : decay_(decay), square_(square), gap_(square - decay * decay) {
    root_ = std::sqrt(std::abs(gap_));
    if (gap_ > 0) return;
    fast_ = decay + root_;
    slow_ = fast_ > 0 ? square / fast_ : 0;
  }
  double decay() const { return decay_; }
  double square() const { return square_; }
  /// The largest of |s₁| and |s₂|, rad/s.
  double pulsation() const { return gap_ > 0 ? std::sqrt(square_) : fast_; }

  /// λ + 2δσ + σ²: what divides the steady response to e^{σt}; 0 in resonance.
  Complex detuning(Complex exponent) const { return square_ + exponent * (2 * decay_ + exponent); }
  bool resonates(Complex exponent) const {
    return std::abs(detuning(exponent)) <= 1e-3 * (square_ + std::norm(exponent));
  }

  /// A bound size·e^{−decay·τ} of what turns or decays with `rate`.
  struct Content {
    double rate = 0, decay = 0, size = 0;
  };
  /// What the free motion from y and y' consists of: one turning part, or a fast and a slow decaying one.
  std::array<Content, 2> contents(double place, double speed) const {
    if (gap_ > 0 && root_ > 0.1 * pulsation())
      return {{{pulsation(), decay_, std::hypot(place, (speed + decay_ * place) / root_)}, {}}};
    if (gap_ <= 0 && root_ > 0.1 * fast_)
      return {{{fast_, fast_, std::abs(slow_ * place + speed) / (2 * root_)},
               {slow_, slow_, std::abs(fast_ * place + speed) / (2 * root_)}}};
    const double rate = pulsation();  // about critical: (1 + x)e^{−x} < 2.5 e^{−x/2}
    return {{{rate, decay_ / 2, rate > 0 ? 2.5 * (std::abs(place) + std::abs(speed) / rate) : 0}, {}}};
  }

  /// c, s and s' at τ; c' = −λ s.
  struct Fundamental {
    double c = 1, s = 0, s_rate = 1;
  };
  Fundamental fundamental(double tau) const {
    if (gap_ > 0) {
      const double shrunk = std::exp(-decay_ * tau), turn = root_ * tau;
      const double sine = shrunk * std::sin(turn) / root_, cosine = shrunk * std::cos(turn);
      return {cosine + decay_ * sine, sine, cosine - decay_ * sine};
    }
    const double late = std::exp(-slow_ * tau), early = std::exp(-fast_ * tau), spread = 2 * root_ * tau;
    const double sine = late * tau * (spread > 0 ? -std::expm1(-spread) / spread : 1);
    return {late + slow_ * sine, sine, early - slow_ * sine};
  }

  /// r at τ for σ = 0; its rate is s.
  double to_constant(double tau, const Fundamental& at) const {
    if (pulsation() * tau <= 1) return summed(0, tau).value.real();
    if (gap_ > 0 || root_ <= 0.05 * fast_) return (1 - at.c) / square_;
    const auto mean = [tau](double rate) { return rate > 0 ? -std::expm1(-rate * tau) / rate : tau; };
    return (mean(slow_) - mean(fast_)) / (2 * root_);
  }

  /// r and r' at τ; `phasor` is e^{στ}.
  struct Response {
    Complex value, rate;
  };
  Response response(Complex exponent, double tau, Complex phasor, const Fundamental& at) const {
    const double nearby = std::max(pulsation(), std::abs(exponent));
    if (nearby * tau <= 1) return summed(exponent, tau);
    const Complex off = detuning(exponent);
    const bool apart = gap_ > 0 ? std::abs(off) > 0.05 * (square_ + std::norm(exponent)) : root_ <= 0.05 * fast_;
    if (apart)
      return {(phasor - at.c - exponent * at.s) / off,
              (exponent * phasor + square_ * at.s - exponent * at.s_rate) / off};
    const Complex first = gap_ > 0 ? Complex(-decay_, root_) : Complex(-slow_);
    const Complex second = gap_ > 0 ? Complex(-decay_, -root_) : Complex(-fast_);
    const Complex one = first_order_response(first, exponent, tau, phasor);
    const Complex two = first_order_response(second, exponent, tau, phasor);
    return {(one - two) / (first - second), (first * one - second * two) / (first - second)};
  }

 private:
  /// Σ_k a_k τ^{k+2}/(k+2)!, Σ a_k z^k = 1/((1 + 2δz + λz²)(1 − σz)): for |s₁τ|, |s₂τ|, |στ| ≤ 1, to round-off.
  Response summed(Complex exponent, double tau) const {
    const double reach = std::max(pulsation(), std::abs(exponent)) * tau;
    Complex sum = 0;
    double before = 0, term = 1, factorial = tau, left = 1;
    Response total{};
    for (int k = 0; k < 24 && left > 1e-19; ++k) {
      sum = term + exponent * sum;
      total.rate += sum * factorial;
      factorial *= tau / (k + 2);
      total.value += sum * factorial;
      left *= reach / (k + 1);
      const double next = -2 * decay_ * term - square_ * before;
      before = term;
      term = next;
    }
    return total;
  }

  double decay_ = 0, square_ = 0, gap_ = 0, root_ = 0, fast_ = 0, slow_ = 0;
};

// When a smooth function first falls below zero: the search for contact events, impacts and releases alike.

/// A function read at one time: its value and its rate.
struct Reading {
  double at = 0, value = 0, rate = 0;
};

/// The zero of `read` between `above` (value ≥ 0, or rising from a value of round-off) and `below` (value < 0). Newton
/// is kept inside its bracket and goes to the last digit of the time.
template <class Function>
double crossing(const Function& read, Reading above, Reading below) {
  double left = above.at, right = below.at;
  Reading now = std::abs(above.value) < std::abs(below.value) ? above : below;
  for (int k = 0; k < 200; ++k) {
    const double newton = now.rate != 0 ? now.at - now.value / now.rate : right;
    const double middle = left + (right - left) / 2;
    const bool inside = newton > left && newton < right && k % 8 != 7;
    const double next = inside ? newton : middle;
    if (next <= left || next >= right || next == now.at) break;
    now = read(next);
    (now.value >= 0 ? left : right) = next;
    if (now.value == 0) break;
  }
  return left;
}

/// The time in [a, b] where the rate changes its sign.
template <class Function>
Reading turning(const Function& read, Reading a, Reading b) {
  const bool rises = a.rate > 0;
  for (int k = 0; k < 200; ++k) {
    const double middle = a.at + (b.at - a.at) / 2;
    if (middle <= a.at || middle >= b.at) break;
    const Reading now = read(middle);
    ((now.rate > 0) == rises ? a : b) = now;
  }
  return rises ? (a.value > b.value ? a : b) : (a.value < b.value ? a : b);
}

/// The first time in [a, b] where the function passes from at least zero to below −noise; none when it does not.
/// `curve` bounds |f''| there: a chord lies above the function by at most curve·(b − a)²/8, so most intervals are
/// dismissed unread. Others are halved `depth` times; the last ones are taken to turn once at most. A function that
/// starts at zero and falls is there already; one that starts at zero and rises must come back first.
template <class Function>
std::optional<double> first_fall(const Function& read, const Reading& a, const Reading& b, double curve, double noise,
                                 int depth) {
  const double width = b.at - a.at;
  if (std::min(a.value, b.value) > curve * width * width / 8) return std::nullopt;
  if (depth > 0) {
    const Reading middle = read(a.at + width / 2);
    if (auto found = first_fall(read, a, middle, curve, noise, depth - 1)) return found;
    return first_fall(read, middle, b, curve, noise, depth - 1);
  }
  Reading below = b;
  if (below.value >= -noise) {
    if (a.rate >= 0 || b.rate <= 0) return std::nullopt;
    below = turning(read, a, b);
    if (below.value >= -noise) return std::nullopt;
  }
  Reading above = a;
  if (above.value <= 0) {
    if (above.rate <= 0 || below.rate >= 0) return above.at;
    above = turning(read, a, below);
    if (above.value <= 0) return a.at;
  }
  return crossing(read, above, below);
}

}  // namespace ricochet::reference
