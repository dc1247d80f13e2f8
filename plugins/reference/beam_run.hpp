#pragma once
#include <fmt/format.h>

#include <limits>
#include <optional>

#include "continuous_beam.hpp"

/// \file
/// One trajectory of the continuous beam: flight, impact, contact, release, and so on, each phase exact.
namespace ricochet::event_driven {

struct Settings {
  int modes = 80;
  double tolerance = 1e-12;         ///< of the gap, over the largest displacement of the scene
  double events_per_period = 2000;  ///< of the first mode
};

/// Whether anything can be touched: a contact law, and a stop at one of its points.
inline bool stops_act(const ReferenceProblem& problem) {
  if (problem.contact_absent) return false;
  const auto there = [&](double x) {
    return (problem.lower && std::isfinite(problem.lower(x))) || (problem.upper && std::isfinite(problem.upper(x)));
  };
  return (problem.stops_at_tip && there(problem.length)) ||
         std::any_of(problem.stop_places.begin(), problem.stop_places.end(), there);
}

inline bool only_the_tip(const ReferenceProblem& problem) {
  return problem.stops_at_tip || std::all_of(problem.stop_places.begin(), problem.stop_places.end(), [&](double x) {
           return std::abs(x - problem.length) <= 1e-12 * problem.length;
         });
}

/// The motion from event to event, read on the grid as it passes.
class BeamRun {
 public:
  BeamRun(const ReferenceProblem& problem, const SampleGrid& grid, const Settings& settings)
      : problem_(problem),
        grid_(grid),
        settings_(settings),
        beam_(problem, settings.modes),
        flight_(flight_of(beam_)),
        contact_(contact_of(beam_)),
        flight_shapes_(beam_.free, grid.places),
        contact_shapes_(beam_.pinned, grid.places) {
    if (stops_act(problem)) {
      if (problem.lower) lower_ = problem.lower(problem.length);
      if (problem.upper) upper_ = problem.upper(problem.length);
    }
  }

  std::variant<SampledMotion, Refusal> motion() {
    reserve();
    if (auto refusal = begin()) return *refusal;
    while (next_ < grid_.times.size()) {
      if (auto refusal = side_ == 0 ? fly() : touch()) return *refusal;
    }
    return std::move(out_);
  }

  /// Share of the initial energy that the modes do not hold: large where the initial displacement is bent at the tip.
  double initial_energy_left_out() const { return initial_energy_ > 0 ? left_out_ / initial_energy_ : 0; }

 private:
  using Failure = std::optional<Refusal>;
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  /// Rows of shapes and curvatures at the places of the grid.
  struct Shapes {
    Shapes(const BeamModes& modes, const std::vector<double>& places)
        : value(static_cast<Eigen::Index>(places.size()), modes.count()), curvature(value) {
      for (Eigen::Index i = 0; i < value.rows(); ++i)
        for (int m = 0; m < modes.count(); ++m) {
          value(i, m) = modes.value(m, places[static_cast<std::size_t>(i)]);
          curvature(i, m) = modes.curvature(m, places[static_cast<std::size_t>(i)]);
        }
    }
    Eigen::MatrixXd value, curvature;
  };

  void reserve() {
    const std::size_t times = grid_.times.size(), fields = times * grid_.places.size();
    for (auto* curve : {&out_.tip, &out_.tip_velocity, &out_.energy, &out_.impulse}) curve->reserve(times);
    for (auto* field : {&out_.displacement, &out_.strain, &out_.velocity}) field->reserve(fields);
    field_.resize(static_cast<Eigen::Index>(grid_.places.size()));
  }

  double stop() const { return side_ < 0 ? lower_ : upper_; }
  double lift(double t) const { return stop() - beam_.support.at(t); }
  double lift_rate(double t) const { return -beam_.support.rate(t); }

  Failure begin() {
    const Support& support = beam_.support;
    const double L = beam_.length;
    const PanelSeries displacement(problem_.displacement, L, panels), velocity(problem_.velocity, L, panels);
    if (!displacement.finite() || !velocity.finite())
      return Refusal{"the initial displacement or velocity is not a finite number everywhere on the beam"};
    first_period_ = 2 * std::numbers::pi / std::sqrt(flight_.oscillators().stiffness(0));
    shortest_period_ = 2 * std::numbers::pi / std::sqrt(contact_.oscillators().stiffness(settings_.modes - 1));
    scale_ = std::max({std::abs(support.amplitude), displacement.largest(),
                       velocity.largest() * first_period_ / (2 * std::numbers::pi),
                       (beam_.free.end_value * beam_.load_free / flight_.oscillators().stiffness()).abs().sum()});
    if (scale_ == 0) scale_ = L;
    const double step = problem_.displacement(0) - support.at(0), slope = displacement.slope(0);
    if (std::abs(step) > 1e-9 * scale_ || std::abs(slope) * L > 1e-6 * scale_)
      return Refusal{
          fmt::format("the initial displacement does not follow the clamp: at x = 0, u − φ is {:.3g} m and its slope "
                      "{:.3g} where both are 0, and a continuous beam has no finite energy then; start from a shape "
                      "that the clamp allows, or use `self`",
                      step, slope)};
    const double tip = problem_.displacement(L), touching = 1e-9 * scale_;
    if (tip < lower_ - touching || tip > upper_ + touching)
      return Refusal{
          fmt::format("the tip starts at {:g} m, beyond its stops [{:g}, {:g}] m: start between them or move the stops",
                      tip, lower_, upper_)};
    const auto position = [&](double x) { return problem_.displacement(x) - support.at(0); };
    const auto rate = [&](double x) { return problem_.velocity(x) - support.rate(0); };
    a_ = Beam::projection(position, beam_.free, L);
    b_ = Beam::projection(rate, beam_.free, L);
    state_ = flight_.start(0, a_, b_);
    sample_start(displacement);
    const double hair = std::abs(flight_.look(state_).value - tip);
    guards_ = {Guard{lower_, 1}, Guard{upper_, -1}};
    for (Guard& guard : guards_) {
      if (guard.margin(tip) > touching) continue;
      guard.on = false;
      guard.slack = 4 * hair + 10 * tolerance();
      if (held() || goes_out(guard, guard.slack)) {
        // Straight from the formulas: the modes of flight converge slowly towards a beam that is held.
        const auto against_lift = [&](const auto& f) {
          return PanelSeries::integral([&](double x) { return f(x) * beam_.lift(x); }, L, settings_.modes);
        };
        enter_contact(-guard.inside, problem_.velocity(L), against_lift(position), against_lift(rate),
                      Beam::projection(position, beam_.pinned, L), Beam::projection(rate, beam_.pinned, L));
        break;
      }
    }
    return {};
  }

  bool held() const { return upper_ - lower_ <= 1e-12 * scale_; }
  double tolerance() const { return settings_.tolerance * scale_; }
  double force_tolerance() const { return 3 * tolerance() / std::pow(beam_.length, 3); }

  /// Whether a tip that starts on a stop would first move beyond it if it were free.
  bool goes_out(const Guard& guard, double noise) {
    const double start = flight_.look(state_).value;
    for (int level = ModalPhase::levels - 1; level >= 0; --level) {
      const double moved = guard.inside * (flight_.look_at(state_, flight_.step(level)).value - start);
      if (std::abs(moved) > noise) return moved < 0;
    }
    return false;
  }

  Failure fly() {
    const auto passed = march(flight_, guards_, tolerance());
    if (const auto* refusal = std::get_if<Refusal>(&passed)) return *refusal;
    const int guard = std::get<int>(passed);
    if (guard >= 0) impact(guard == 0 ? -1 : 1, flight_.look(state_).slope);
    return {};
  }

  Failure touch() {
    const auto passed = march(contact_, guards_, force_tolerance());
    if (const auto* refusal = std::get_if<Refusal>(&passed)) return *refusal;
    if (std::get<int>(passed) >= 0) release();
    return {};
  }

  void impact(int side, double velocity) {
    flight_.whole(state_, state_.time, a_, b_);
    enter_contact(side, velocity, (beam_.lift_free * a_).sum(), (beam_.lift_free * b_).sum(),
                  beam_.change.transpose() * a_.matrix(), beam_.change.transpose() * b_.matrix());
  }

  /// With ⟨w,p⟩, ⟨w_t,p⟩ and all ⟨w,ψ_n⟩, ⟨w_t,ψ_n⟩.
  void enter_contact(int side, double velocity, double on_lift, double rate_on_lift, const Eigen::ArrayXd& on_modes,
                     const Eigen::ArrayXd& rate_on_modes) {
    const double t = state_.time;
    side_ = side;
    out_.events.push_back({t, side, true, velocity});
    momentum_ = momentum(t, rate_on_lift, on_lift);
    state_ =
        contact_.start(t, on_modes - lift(t) * beam_.lift_pinned, rate_on_modes - lift_rate(t) * beam_.lift_pinned);
    contact_.set_offset(3 * stop() / std::pow(beam_.length, 3));
    guards_ = {Guard{0, -side}, Guard{-infinity, 1}};
    if (held()) guards_[0] = guards_[1];
    const double force = contact_.look(state_).value;
    if (guards_[0].margin(force) <= 0) {
      guards_[0].on = false;
      guards_[0].slack = infinity;
      guards_[0].until = t + shortest_period_;
    }
  }

  void release() {
    const double t = state_.time;
    contact_.whole(state_, t, a_, b_);
    impulse_ += contact_impulse(t);
    out_.events.push_back({t, side_, false, 0});
    state_ = flight_.start(t, (beam_.change * a_.matrix()).array() + lift(t) * beam_.lift_free,
                           (beam_.change * b_.matrix()).array() + lift_rate(t) * beam_.lift_free);
    guards_ = {Guard{lower_, 1}, Guard{upper_, -1}};
    Guard& left = guards_[side_ < 0 ? 0 : 1];
    left.on = false;
    left.slack = 4 * std::abs(flight_.look(state_).value - stop()) + 10 * tolerance();
    side_ = 0;
  }

  /// Σ⟨·, p⟩ of the equation of motion, integrated over time, per ρS: its change over a contact phase is the impulse.
  ///
  ///     X = ⟨w_t + φ', p⟩ + η⟨w, p⟩ + (3k²/L³)(∫r dt + αr) − t⟨f/ρS, p⟩
  double momentum(double t, double rate, double position) const {
    return rate + beam_.support.rate(t) * beam_.lift_mean() + beam_.eta * position +
           3 * beam_.k2 / std::pow(beam_.length, 3) * (stop() * t - beam_.support.integral(t) + beam_.alpha * lift(t)) -
           t * beam_.load_lift;
  }
  /// ∫ of the stop's force since the impact; a_, b_ hold the contact modes at t.
  double contact_impulse(double t) const {
    const double now = momentum(t, lift_rate(t) * beam_.lift_square() + (beam_.lift_pinned * b_).sum(),
                                lift(t) * beam_.lift_square() + (beam_.lift_pinned * a_).sum());
    return beam_.density * (now - momentum_);
  }

  /// Marches the phase until a guard is passed (its number, the state moved there) or the grid is read (−1).
  std::variant<int, Refusal> march(ModalPhase& phase, std::array<Guard, 2>& guards, double tolerance) {
    if (out_.events.size() > settings_.events_per_period * (1 + state_.time / first_period_))
      return Refusal{fmt::format(
          "more than {:g} impacts and releases per period of the first mode by t = {:g} s: the tip chatters, which "
          "modal phases cannot follow; raise `events`, add damping, or use another reference",
          settings_.events_per_period, state_.time)};
    Look here = phase.look(state_);
    for (Guard& guard : guards) guard.look(state_.time, here.value);
    while (next_ < grid_.times.size()) {
      if (++looks_ > most_looks)
        return Refusal{fmt::format(
            "the search for events needs more than {:g} looks at the gap to reach t = {:g} s: shorten the duration, "
            "lower `modes`, or loosen `tolerance`",
            static_cast<double>(most_looks), grid_.times.back())};
      phase.forget_dead_modes(state_, 1e-30 * scale_);
      phase.measure(state_);
      if (guards[0].waits())
        while (phase.step(level_) > shortest_period_) ++level_;
      const int deepest = deepest_level(phase);
      for (;; ++level_, ++looks_) {
        ahead_ = state_;
        phase.move_by_level(ahead_, level_);
        const Look there = phase.look(ahead_);
        const double step = phase.step(level_), error = phase.interpolation_error(level_);
        const Cubic cubic{here.value, step * here.slope, there.value, step * there.slope};
        bool clear = true;
        for (const Guard& guard : guards) clear = clear && guard.least(cubic) - error > guard.threshold();
        if (!clear && error > tolerance && level_ < deepest) continue;
        if (!clear) {
          const int passed = first_passed(phase, guards, cubic, step, 2 * tolerance);
          if (passed >= 0) return passed;
        }
        here = there;
        break;
      }
      sample_until(phase, ahead_.time);
      std::swap(state_, ahead_);
      for (Guard& guard : guards) guard.look(state_.time, here.value);
      if (level_ > 0) --level_;
    }
    return -1;
  }

  // Shorter steps would be lost in the round-off of t.
  int deepest_level(const ModalPhase& phase) const {
    const double least = 1e-14 * std::max(state_.time, first_period_);
    return std::clamp(static_cast<int>(std::log2(phase.step(0) / least)), level_, ModalPhase::levels - 1);
  }

  int first_passed(ModalPhase& phase, const std::array<Guard, 2>& guards, const Cubic& cubic, double step,
                   double tolerance) {
    int first = -1;
    double earliest = step;
    for (int i = 0; i < 2; ++i) {
      const Guard& guard = guards[static_cast<std::size_t>(i)];
      const auto beyond = guard.passed_by(cubic, tolerance);
      if (!beyond) continue;
      const double level = guard.threshold();
      const auto margin = [&](double tau) {
        const Look look = phase.look_at(state_, state_.time + tau);
        return std::pair{guard.margin(look.value) - level, guard.inside * look.slope};
      };
      const double tau = guard.margin(cubic.start) <= level ? 0 : falling_root(margin, 0, *beyond * step);
      if (first < 0 || tau < earliest) {
        first = i;
        earliest = tau;
      }
    }
    if (first >= 0) {
      sample_until(phase, state_.time + earliest);
      phase.move(state_, state_.time + earliest);
    }
    return first;
  }

  /// ½ρS Σ(b² + ω₀²a²) of what a_, b_ hold.
  double modal_energy(const ModalPhase& phase) const {
    return 0.5 * beam_.density * (b_.square().sum() + (phase.oscillators().stiffness() * a_.square()).sum());
  }

  void sample_until(ModalPhase& phase, double t) {
    for (; next_ < grid_.times.size() && grid_.times[next_] <= t; ++next_) {
      const double now = grid_.times[next_];
      phase.whole(state_, now, a_, b_);
      double energy = modal_energy(phase);
      if (side_ == 0) {
        // Until the first impact, modes left out keep their energy where nothing but η damps them.
        if (beam_.alpha == 0 && out_.events.empty()) energy += left_out_ * std::exp(-beam_.eta * now);
        out_.tip.push_back((beam_.free.end_value * a_).sum() + beam_.support.at(now));
        out_.tip_velocity.push_back((beam_.free.end_value * b_).sum() + beam_.support.rate(now));
        out_.impulse.push_back(impulse_);
      } else {
        const double r = lift(now), rate = lift_rate(now);
        energy += 0.5 * beam_.density *
                  (rate * (rate * beam_.lift_square() + 2 * (beam_.lift_pinned * b_).sum()) +
                   3 * beam_.k2 * r * r / std::pow(beam_.length, 3));
        out_.tip.push_back(stop());
        out_.tip_velocity.push_back(0);
        out_.impulse.push_back(impulse_ + contact_impulse(now));
      }
      out_.energy.push_back(energy);
      sample_fields(side_ == 0 ? flight_shapes_ : contact_shapes_, now);
    }
  }

  void sample_fields(const Shapes& shapes, double t) {
    const auto append = [&](std::vector<double>& field, const Eigen::MatrixXd& rows, const Eigen::ArrayXd& modes,
                            double support, double lifted, auto&& lift_shape) {
      field_.noalias() = rows * modes.matrix();
      for (Eigen::Index i = 0; i < field_.size(); ++i)
        field.push_back(support + field_(i) +
                        (side_ == 0 ? 0 : lifted * lift_shape(grid_.places[static_cast<std::size_t>(i)])));
    };
    const auto shape = [&](double x) { return beam_.lift(x); };
    const auto bend = [&](double x) { return beam_.lift_curvature(x); };
    append(out_.displacement, shapes.value, a_, beam_.support.at(t), lift(t), shape);
    append(out_.strain, shapes.curvature, a_, 0, lift(t), bend);
    append(out_.velocity, shapes.value, b_, beam_.support.rate(t), lift_rate(t), shape);
  }

  // At t = 0 the formulas are known, and the modal sums may converge slowly.
  void sample_start(const PanelSeries& displacement) {
    const Support& support = beam_.support;
    const auto square = [](double value) { return value * value; };
    const auto kinetic = [&](double x) { return square(problem_.velocity(x) - support.rate(0)); };
    const auto elastic = [&](double x) { return beam_.k2 * square(displacement.curvature(x)); };
    initial_energy_ =
        0.5 * beam_.density *
        (PanelSeries::integral(kinetic, beam_.length, panels) + PanelSeries::integral(elastic, beam_.length, panels));
    left_out_ = std::max(0.0, initial_energy_ - modal_energy(flight_));
    for (; next_ < grid_.times.size() && grid_.times[next_] <= 0; ++next_) {
      out_.tip.push_back(problem_.displacement(beam_.length));
      out_.tip_velocity.push_back(problem_.velocity(beam_.length));
      out_.energy.push_back(initial_energy_);
      out_.impulse.push_back(0);
      for (const double x : grid_.places) {
        out_.displacement.push_back(problem_.displacement(x));
        out_.strain.push_back(displacement.curvature(x));
        out_.velocity.push_back(problem_.velocity(x));
      }
    }
  }

  static constexpr long long most_looks = 200'000'000;
  static constexpr int panels = 32;  // of the initial formulas

  const ReferenceProblem& problem_;
  const SampleGrid& grid_;
  Settings settings_;
  Beam beam_;
  ModalPhase flight_, contact_;
  Shapes flight_shapes_, contact_shapes_;
  double lower_ = -infinity, upper_ = infinity;
  double scale_ = 0, first_period_ = 0, shortest_period_ = 0;
  double initial_energy_ = 0, left_out_ = 0;

  int side_ = 0;  // of the stop that is touched, 0 in flight
  ModalState state_, ahead_;
  std::array<Guard, 2> guards_;
  Eigen::ArrayXd a_, b_;  // modal displacements and velocities, whole
  double impulse_ = 0, momentum_ = 0;
  int level_ = 0;
  long long looks_ = 0;
  std::size_t next_ = 0;
  Eigen::VectorXd field_;
  SampledMotion out_;
};

}  // namespace ricochet::event_driven
