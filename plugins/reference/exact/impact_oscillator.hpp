#pragma once
#include <limits>
#include <optional>
#include <ricochet/contract/reference.hpp>
#include <ricochet/contract/said_format.hpp>
#include <utility>
#include <vector>

#include "linear_mode.hpp"

/// \file
/// One degree of freedom between two stops, exactly: a chain of arcs, each a closed form.
namespace ricochet::reference {

/// Re(Σ a e^{σt}), t from the start of the motion.
class Signal {
 public:
  void add_constant(double value) { terms_.push_back({0, value}); }
  /// amplitude·cos(ωt + phase), the constant it is when ω = 0.
  void add_cosine(double amplitude, double pulsation, double phase) { add(std::polar(amplitude, phase), pulsation); }
  void add(Complex amplitude, double pulsation) {
    if (pulsation == 0) add_constant(amplitude.real());
    if (pulsation != 0) terms_.push_back({{0, pulsation}, amplitude});
  }
  double at(double t) const {
    double sum = 0;
    for (const auto& [exponent, amplitude] : terms_) sum += std::real(amplitude * std::exp(exponent * t));
    return sum;
  }
  double rate(double t) const {
    double sum = 0;
    for (const auto& [exponent, amplitude] : terms_) sum += std::real(exponent * amplitude * std::exp(exponent * t));
    return sum;
  }
  double integral(double from, double tau) const {
    double sum = 0;
    for (const auto& [exponent, amplitude] : terms_)
      sum += std::real(amplitude * std::exp(exponent * from) * integrated(exponent, tau));
    return sum;
  }
  /// Σ |σ|^power |a|
  double size(int power) const {
    double sum = 0;
    for (const auto& [exponent, amplitude] : terms_) sum += std::pow(std::abs(exponent), power) * std::abs(amplitude);
    return sum;
  }
  double pulsation() const {
    double largest = 0;
    for (const auto& term : terms_) largest = std::max(largest, std::abs(term.exponent));
    return largest;
  }
  /// The response from rest at `from` of an oscillator of unit mass.
  Motion response(const LinearMode& mode, double from, double tau, const LinearMode::Fundamental& basis) const {
    Motion sum;
    for (const auto& [exponent, amplitude] : terms_) {
      if (exponent == 0.0) {
        sum.value += amplitude.real() * mode.to_constant(tau, basis);
        sum.rate += amplitude.real() * basis.s;
        continue;
      }
      const auto unit = mode.response(exponent, tau, std::exp(exponent * tau), basis);
      const Complex start = amplitude * std::exp(exponent * from);
      sum.value += std::real(start * unit.value);
      sum.rate += std::real(start * unit.rate);
    }
    return sum;
  }

 private:
  struct Term {
    Complex exponent, amplitude;
  };
  std::vector<Term> terms_;
};

/// m u'' + c u' + k u = f(t) + p, u absolute: f holds what the support passes on, kφ + cφ'. Stops stand still.
struct OscillatorSpec {
  double mass = 1, viscosity = 0, stiffness = 0;            ///< kg, N s/m, N/m
  Signal force;                                             ///< f, N
  Signal support;                                           ///< φ, m
  double lower = -std::numeric_limits<double>::infinity();  ///< m
  double upper = std::numeric_limits<double>::infinity();   ///< m
  double restitution = 0;                                   ///< v⁺ = −e v⁻, of a rigid stop
  double contact_stiffness = 0;                             ///< κ of a stop that is a spring, N/m; 0: rigid
  double position = 0, velocity = 0;                        ///< u(0), u'(0)
};

/// Flights, sticking phases and phases on a spring, each exact. An arc counts its time and its displacement from where
/// it began, so that small bounces keep their digits. A bounce lower than 10⁻¹⁵ of the highest ends a chattering.
class ImpactOscillator {
 public:
  explicit ImpactOscillator(OscillatorSpec spec) : spec_(std::move(spec)) {}

  /// The motion at the times of the grid, or the sentence that says why not.
  std::variant<SampledMotion, Refusal> sample(const SampleGrid& grid) {
    grid_ = &grid;
    end_ = grid.times.empty() ? 0 : grid.times.back();
    for (const double stop : {spec_.lower, spec_.upper})
      if (std::isfinite(stop)) travel_ = std::max(travel_, std::abs(spec_.position - stop));
    if (spec_.lower > spec_.upper)
      return Refusal{
          "the stops pass each other and push from both sides at once, which arcs on one stop do not know: "
          "use the reference self"};
    if (rigid() && pressed() != 0)
      return Refusal{
          said("the start lies beyond the {} stop, which is rigid here: use event-driven-semi-discrete, "
               "which follows a linear spring, or self",
               pressed() < 0 ? "lower" : "upper")};
    hold();
    // A spring pushes from the start what lies beyond it.
    begin(0, rigid() ? 0 : pressed(), spec_.position, spec_.velocity);
    while (true) {
      const auto fall = march();
      if (steps_ > step_limit)
        return Refusal{
            "this oscillator turns too often within the duration to be followed exactly: shorten the "
            "duration, or lower the pulsation or the stiffness"};
      if (!fall) return std::move(motion_);
      if (fall->tau > 0) stuck_ = 0;
      if (++stuck_ > 1000)
        return Refusal{
            "contact opens and closes without time passing, at a grazing that has no exact continuation: "
            "move the stop or the initial state a little"};
      turn(*fall);
    }
  }

 private:
  static constexpr long long step_limit = 50'000'000;
  static constexpr double epsilon = std::numeric_limits<double>::epsilon();

  /// The end of an arc: contact begins on a side, or ends.
  struct Fall {
    double tau = 0;
    int side = 0;
  };

  bool rigid() const { return spec_.contact_stiffness == 0; }
  bool closed() const { return side_ != 0; }
  double stop(int side) const { return side < 0 ? spec_.lower : spec_.upper; }
  /// Lower stops push up.
  static double normal(int side) { return -side; }

  void begin(double time, int side, double base, double velocity) {
    start_ = time;
    side_ = side;
    base_ = base;
    velocity_ = velocity;
    const double spring = closed() ? spec_.contact_stiffness : 0;
    mode_ = LinearMode(spec_.viscosity / (2 * spec_.mass), (spec_.stiffness + spring) / spec_.mass);
    const double fastest = std::max(spec_.force.pulsation(), closed() && rigid() ? 0 : mode_.pulsation());
    step_ = fastest > 0 ? 0.25 / fastest : std::numeric_limits<double>::infinity();
  }

  /// Displacement from base, its rate and its acceleration.
  Motion arc(double tau) const {
    if (closed() && rigid()) return {};
    const auto basis = mode_.fundamental(tau);
    Motion forced = spec_.force.response(mode_, start_, tau, basis);
    const double pressed = closed() ? spec_.contact_stiffness * (base_ - stop(side_)) : 0;
    const double pull = (spec_.stiffness * base_ + pressed) / spec_.mass;
    Motion now;
    now.value = velocity_ * basis.s + forced.value / spec_.mass - pull * mode_.to_constant(tau, basis);
    now.rate = velocity_ * basis.s_rate + forced.rate / spec_.mass - pull * basis.s;
    now.curve =
        spec_.force.at(start_ + tau) / spec_.mass - pull - 2 * mode_.decay() * now.rate - mode_.square() * now.value;
    return now;
  }

  /// What may not fall below zero. In flight it is the gap to `side`. On a stop it is the force of a rigid one, the
  /// depth of a spring.
  Reading watch(int side, double tau) const {
    if (closed() && rigid()) {
      const double push = spec_.stiffness * stop(side) - spec_.force.at(start_ + tau);
      return {tau, normal(side) * push, -normal(side) * spec_.force.rate(start_ + tau)};
    }
    const Motion now = arc(tau);
    const double sign = closed() ? -normal(side) : normal(side);
    return {tau, sign * (now.value + (base_ - stop(side))), sign * now.rate};
  }

  /// A bound of |f''| over one step from `tau`.
  double curvature(double tau) const {
    if (closed() && rigid()) return spec_.force.size(2);
    const Motion now = arc(tau);
    const double change = std::isfinite(step_) ? spec_.force.size(1) * step_ / spec_.mass : 0;
    return 1.5 * (std::abs(now.curve) + mode_.pulsation() * std::abs(now.rate) + change);
  }

  double noise(int side, double tau) const {
    if (closed() && rigid()) return 16 * epsilon * (std::abs(spec_.stiffness * stop(side)) + spec_.force.size(0));
    const double fastest = std::max(mode_.pulsation(), spec_.force.pulsation());
    const double reach = fastest > 0 ? std::min(tau, 1 / fastest) : tau;
    const double pressed = closed() ? spec_.contact_stiffness * std::abs(base_ - stop(side_)) : 0;
    const double push = (spec_.force.size(0) + std::abs(spec_.stiffness * base_) + pressed) / spec_.mass;
    return 16 * epsilon * (std::abs(base_ - stop(side)) + std::abs(velocity_) * reach + push * reach * reach / 2);
  }

  /// Follows the arc to its end, taking samples on the way; none: the motion is over.
  std::optional<Fall> march() {
    const double last = end_ - start_;
    double tau = 0;
    while (true) {
      const double next = std::min(tau + step_, last);
      if (++steps_ > step_limit) return std::nullopt;
      const auto fall = next > tau ? first_of(tau, next) : std::nullopt;
      const double reached = fall ? fall->tau : next;
      for (; sampled_ < grid_->times.size(); ++sampled_) {
        const double when = grid_->times[sampled_] - start_;
        if (fall ? when >= reached : when > reached) break;
        read(std::max(when, 0.0));
      }
      if (fall) return fall;
      if (next >= last) return std::nullopt;
      tau = next;
    }
  }

  std::optional<Fall> first_of(double from, double to) const {
    std::optional<Fall> first;
    const double curve = curvature(from);
    for (const int side : {-1, 1}) {
      if (closed() ? side != side_ : !std::isfinite(stop(side))) continue;
      const auto read = [&](double tau) { return watch(side, tau); };
      const auto found = first_fall(read, read(from), read(to), curve, noise(side, to), 4);
      if (found && (!first || *found < first->tau)) first = Fall{*found, side};
    }
    return first;
  }

  /// The stop that it starts beyond, or on without moving into it: what it closes there is no impact.
  void hold() {
    for (const int side : {-1, 1}) {
      if (!std::isfinite(stop(side))) continue;
      const double gap = normal(side) * (spec_.position - stop(side)), round_off = near(side);
      if (gap < -round_off || (gap <= round_off && normal(side) * spec_.velocity >= 0)) held_ = side;
    }
  }
  /// The side on which it starts beyond its stop by more than rounding.
  int pressed() const {
    for (const int side : {-1, 1})
      if (std::isfinite(stop(side)) && normal(side) * (spec_.position - stop(side)) < -near(side)) return side;
    return 0;
  }
  double near(int side) const { return 1e-12 * (std::abs(spec_.position) + std::abs(stop(side))); }

  /// From one arc to the next.
  void turn(const Fall& fall) {
    const double time = start_ + fall.tau, speed = arc(fall.tau).rate;
    // It is still held where the way there has not led away from the stop.
    const bool held = !closed() && held_ == fall.side && watch(fall.side, fall.tau / 2).value <= near(fall.side);
    held_ = 0;
    if (closed()) {
      impulse_ += pushed(fall.tau);
      motion_.events.push_back({time, fall.side, false, 0});
      return begin(time, 0, stop(fall.side), rigid() ? 0 : speed);
    }
    if (!held) motion_.events.push_back({time, fall.side, true, speed});
    if (!rigid()) return begin(time, fall.side, stop(fall.side), speed);
    strike(time, fall.side, speed);
  }

  void strike(double time, int side, double speed) {
    const double up = normal(side), approach = std::min(up * speed, 0.0), rebound = -spec_.restitution * approach;
    const double place = stop(side);
    const double pull =
        up * (spec_.force.at(time) - spec_.viscosity * up * rebound - spec_.stiffness * place) / spec_.mass;
    const double height = pull < 0 ? rebound * rebound / (-2 * pull) : std::numeric_limits<double>::infinity();
    const bool rests = height <= 1e-15 * travel_;
    impulse_ += up * spec_.mass * ((rests ? 0 : rebound) - approach);
    if (rests) return begin(time, side, place, 0);
    if (std::isfinite(height)) travel_ = std::max(travel_, height);
    motion_.events.push_back({time, side, false, 0});
    begin(time, 0, place, up * rebound);
  }

  /// ∫p of this arc. A spring: κ/(k + κ) (k g τ − ∫f + m Δu' + c Δu), g the stop, by its own equation of motion.
  double pushed(double tau) const {
    if (!closed()) return 0;
    const double held = spec_.stiffness * stop(side_) * tau - spec_.force.integral(start_, tau);
    if (rigid()) return held;
    const Motion now = arc(tau);
    return spec_.contact_stiffness / (spec_.stiffness + spec_.contact_stiffness) *
           (held + spec_.mass * (now.rate - velocity_) + spec_.viscosity * now.value);
  }

  void read(double tau) {
    const double time = start_ + tau;
    const Motion now = arc(tau);
    const double position = base_ + now.value;
    const double across = position - spec_.support.at(time), rate = now.rate - spec_.support.rate(time);
    const double depth = closed() ? now.value + (base_ - stop(side_)) : 0;
    motion_.tip.push_back(position);
    motion_.tip_velocity.push_back(now.rate);
    motion_.energy.push_back(
        0.5 * (spec_.mass * rate * rate + spec_.stiffness * across * across + spec_.contact_stiffness * depth * depth));
    motion_.impulse.push_back(impulse_ + pushed(tau));
    for (std::size_t i = 0; i < grid_->places.size(); ++i) {
      motion_.displacement.push_back(position);
      motion_.strain.push_back(0);
      motion_.velocity.push_back(now.rate);
    }
  }

  OscillatorSpec spec_;
  const SampleGrid* grid_ = nullptr;
  SampledMotion motion_;
  LinearMode mode_;
  double start_ = 0, base_ = 0, velocity_ = 0, step_ = 0;  // of the arc
  int side_ = 0;                                           // the stop it lies on
  int held_ = 0;                                           // the one that it starts on
  double end_ = 0, impulse_ = 0, travel_ = 0;
  std::size_t sampled_ = 0;
  long long steps_ = 0;
  int stuck_ = 0;
};

}  // namespace ricochet::reference
