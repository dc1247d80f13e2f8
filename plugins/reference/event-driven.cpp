#include <fmt/format.h>

#include <ricochet/contract/plugin.hpp>

#include "beam_modes.hpp"
#include "modal_phase.hpp"
#include "panel_series.hpp"

namespace {

using namespace ricochet;
using namespace ricochet::event_driven;

struct Settings {
  int modes = 80;
  double tolerance = 1e-12;  // of the stroke, on the gap (and the like on the force)
  double events_per_period = 2000;
};

/// The support φ = A sin θ, θ = ωt + ψ, and what the marching unknown w = u − φ feels of it.
struct Support {
  double amplitude, pulsation, phase;
  double at(double t) const { return amplitude * std::sin(pulsation * t + phase); }
  double rate(double t) const { return amplitude * pulsation * std::cos(pulsation * t + phase); }
  double integral(double t) const {
    return pulsation > 0 ? -amplitude / pulsation * std::cos(pulsation * t + phase) : at(0) * t;
  }
};

/// The continuous beam per unit of ρS, in the two bases, and the L² products that lead from one to the other. With the
/// lift p = (3x²L − x³)/(2L³) of contact:
///
///     ⟨φ_m,ψ_n⟩ = φ_m(L)ψ_n'''(L)/(μ_n⁴ − λ_m⁴),  ⟨p,φ_m⟩ = 3φ_m(L)/(L³λ_m⁴),  ⟨p,ψ_n⟩ = ψ_n'''(L)/μ_n⁴
struct Beam {
  Beam(const ReferenceProblem& problem, int modes)
      : length(problem.length),
        k2(problem.stiffness / problem.inertia),
        density(problem.inertia),
        alpha(problem.damping_stiffness),
        eta(problem.damping_mass),
        support{problem.support_amplitude, problem.support_pulsation, problem.support_phase},
        free(BeamModes::End::free, modes, length),
        pinned(BeamModes::End::pinned, modes, length) {
    const Eigen::ArrayXd free4 = free.wave_number.square().square(), pinned4 = pinned.wave_number.square().square();
    change.resize(modes, modes);
    for (int n = 0; n < modes; ++n)
      change.col(n) = (free.end_value * pinned.end_shear(n) / (pinned4(n) - free4)).matrix();
    lift_free = 3 * free.end_value / (std::pow(length, 3) * free4);
    lift_pinned = pinned.end_shear / pinned4;
    load_free = load_pinned = Eigen::ArrayXd::Zero(modes);
    if (problem.load_zero) return;
    const auto load = [&](double x) { return problem.load(x, 0) / density; };
    for (int m = 0; m < modes; ++m) {
      load_free(m) = product(load, free, m);
      load_pinned(m) = product(load, pinned, m);
    }
    load_lift = PanelSeries::integral([&](double x) { return load(x) * lift(x); }, length, modes);
  }

  double lift(double x) const { return x * x * (3 * length - x) / (2 * std::pow(length, 3)); }
  double lift_curvature(double x) const { return 3 * (length - x) / std::pow(length, 3); }
  double lift_mean() const { return 3 * length / 8; }
  double lift_square() const { return 33 * length / 140; }
  Eigen::ArrayXd stiffness(const BeamModes& modes) const { return k2 * modes.wave_number.square().square(); }
  template <class Function>
  double product(const Function& f, const BeamModes& modes, int m) const {
    return PanelSeries::integral([&](double x) { return f(x) * modes.value(m, x); }, length, modes.count());
  }

  double length, k2, density, alpha, eta;
  Support support;
  BeamModes free, pinned;
  Eigen::MatrixXd change;  ///< ⟨φ_m, ψ_n⟩
  Eigen::ArrayXd lift_free, lift_pinned, load_free, load_pinned;
  double load_lift = 0;  ///< ⟨f/ρS, p⟩
};

/// Whether anything can be touched: a contact law, and a stop at one of its points.
bool stops_act(const ReferenceProblem& problem) {
  if (problem.contact_absent) return false;
  const auto there = [&](double x) {
    return (problem.lower && std::isfinite(problem.lower(x))) || (problem.upper && std::isfinite(problem.upper(x)));
  };
  return (problem.stops_at_tip && there(problem.length)) ||
         std::any_of(problem.stop_places.begin(), problem.stop_places.end(), there);
}

bool only_the_tip(const ReferenceProblem& problem) {
  return problem.stops_at_tip || std::all_of(problem.stop_places.begin(), problem.stop_places.end(), [&](double x) {
           return std::abs(x - problem.length) <= 1e-12 * problem.length;
         });
}

Oscillators oscillators(const Beam& beam, const BeamModes& modes) {
  const Eigen::ArrayXd stiffness = beam.stiffness(modes);
  return {stiffness, beam.alpha * stiffness + beam.eta};
}

Eigen::ArrayXcd steady(const Oscillators& modes, const Eigen::ArrayXcd& forcing, double pulsation) {
  Eigen::ArrayXcd result(modes.size());
  for (Eigen::Index m = 0; m < modes.size(); ++m)
    result(m) = forcing(m) / Complex(modes.stiffness(m) - pulsation * pulsation, modes.damping(m) * pulsation);
  return result;
}

/// Free flight: a'' + (αω₀² + η)a' + ω₀²a = ⟨f/ρS − φ'', φ_m⟩, watched at the tip (absolute).
ModalPhase flight_of(const Beam& beam) {
  const Support& s = beam.support;
  const Oscillators modes = oscillators(beam, beam.free);
  const Eigen::ArrayXd still = beam.load_free / modes.stiffness();
  const Eigen::ArrayXcd swing =
      steady(modes, (s.amplitude * s.pulsation * s.pulsation * beam.free.mean).cast<Complex>(), s.pulsation);
  ModalPhase::Watched tip{beam.free.end_value, Eigen::ArrayXd::Zero(modes.size()), (beam.free.end_value * still).sum(),
                          (beam.free.end_value * swing).sum() + s.amplitude};
  return {modes, still, swing, tip, s.pulsation, s.phase};
}

/// Contact, w = r p + Σ c_n ψ_n with r = s − φ: c'' + (αω₀² + η)c' + ω₀²c = ⟨f/ρS − φ''(1 − p) + ηφ'p, ψ_n⟩, watched by
/// the force of the stop over EI, 3(r + αr')/L³ − Σψ_n'''(L)(c_n + αc_n'). Modes left out follow their load at once:
/// Σ over all n of ψ_n'''⟨g,ψ_n⟩/μ_n⁴ is ⟨g,p⟩, which closes the sum.
ModalPhase contact_of(const Beam& beam) {
  const Support& s = beam.support;
  const Oscillators modes = oscillators(beam, beam.pinned);
  const double inertia = s.amplitude * s.pulsation * s.pulsation, drag = beam.eta * s.amplitude * s.pulsation;
  const Eigen::ArrayXd rest = beam.pinned.mean - beam.lift_pinned;
  const Eigen::ArrayXd still = beam.load_pinned / modes.stiffness();
  const Eigen::ArrayXcd swing =
      steady(modes, inertia * rest.cast<Complex>() + Complex(0, drag) * beam.lift_pinned, s.pulsation);
  const Complex damped(1, beam.alpha * s.pulsation);
  ModalPhase::Watched force{-beam.pinned.end_shear, -beam.alpha * beam.pinned.end_shear};
  force.constant = (force.position * still).sum();
  force.harmonic = -3 * s.amplitude / std::pow(beam.length, 3) * damped + (force.position * swing).sum() * damped;
  force.constant -= (beam.load_lift - (beam.lift_pinned * beam.load_pinned).sum()) / beam.k2;
  const double highest = std::sqrt(modes.stiffness()(modes.size() - 1));
  if (s.pulsation < 0.3 * highest)
    force.harmonic -= (inertia * (beam.lift_mean() - beam.lift_square() - (beam.lift_pinned * rest).sum()) +
                       Complex(0, drag) * (beam.lift_square() - beam.lift_pinned.square().sum())) /
                      beam.k2;
  return {modes, still, swing, force, s.pulsation, s.phase};
}

/// The motion from event to event, read on the grid as it passes.
class Run {
 public:
  Run(const ReferenceProblem& problem, const SampleGrid& grid, const Settings& settings)
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
                       velocity.largest() * first_period_ / (2 * std::numbers::pi)});
    for (const double bound : {lower_, upper_})
      if (std::isfinite(bound)) scale_ = std::max(scale_, std::abs(bound));
    if (scale_ == 0) scale_ = L;
    const double gap = displacement.value(0) - support.at(0), slope = displacement.slope(0);
    if (std::abs(gap) > 1e-8 * scale_ || std::abs(slope) * L > 1e-6 * scale_)
      return Refusal{fmt::format(
          "the initial displacement leaves the clamp, of which u − φ is {:g} m and the slope {:g}: a continuous beam "
          "has no finite energy then; start from a displacement that equals φ(0) and is flat at x = 0",
          gap, slope)};
    const double tip = problem_.displacement(L);
    const double touching = 1e-9 * scale_;
    if (tip < lower_ - touching || tip > upper_ + touching)
      return Refusal{
          fmt::format("the tip starts at {:g} m, beyond its stops [{:g}, {:g}] m: start between them or move the stops",
                      tip, lower_, upper_)};
    sample_start(displacement);
    a_.resize(settings_.modes);
    b_.resize(settings_.modes);
    for (int m = 0; m < settings_.modes; ++m) {
      a_(m) = beam_.product([&](double x) { return problem_.displacement(x) - support.at(0); }, beam_.free, m);
      b_(m) = beam_.product([&](double x) { return problem_.velocity(x) - support.rate(0); }, beam_.free, m);
    }
    state_ = flight_.start(0, a_, b_);
    const double hair = std::abs(flight_.look(state_).value - tip);
    guards_ = {Guard{lower_, 1}, Guard{upper_, -1}};
    const double velocity_of_tip = problem_.velocity(L);
    for (std::size_t i = 0; i < 2; ++i) {
      Guard& guard = guards_[i];
      if (guard.margin(tip) > touching) continue;
      guard.on = false;
      guard.slack = 4 * hair + 10 * tolerance();
      if (held() || goes_out(guard, guard.slack)) {
        impact(guard.inside > 0 ? -1 : 1, velocity_of_tip);
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
    const double t = state_.time;
    flight_.whole(state_, t, a_, b_);
    side_ = side;
    out_.events.push_back({t, side, true, velocity});
    momentum_ = momentum(t, (beam_.lift_free * b_).sum(), (beam_.lift_free * a_).sum());
    state_ = contact_.start(t, (beam_.change.transpose() * a_.matrix()).array() - lift(t) * beam_.lift_pinned,
                            (beam_.change.transpose() * b_.matrix()).array() - lift_rate(t) * beam_.lift_pinned);
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
      for (;; ++level_, ++looks_) {
        ahead_ = state_;
        phase.move_by_level(ahead_, level_);
        const Look there = phase.look(ahead_);
        const double step = phase.step(level_), error = phase.interpolation_error(level_);
        const Cubic cubic{here.value, step * here.slope, there.value, step * there.slope};
        bool clear = true;
        for (const Guard& guard : guards) clear = clear && guard.least(cubic) - error > guard.threshold();
        if (!clear && error > tolerance && level_ + 1 < ModalPhase::levels) continue;
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

  void sample_until(ModalPhase& phase, double t) {
    for (; next_ < grid_.times.size() && grid_.times[next_] <= t; ++next_) {
      const double now = grid_.times[next_];
      phase.whole(state_, now, a_, b_);
      const Support& support = beam_.support;
      const Eigen::ArrayXd& stiffness = phase.oscillators().stiffness();
      double kinetic = b_.square().sum(), elastic = (stiffness * a_.square()).sum();
      if (side_ == 0) {
        out_.tip.push_back((beam_.free.end_value * a_).sum() + support.at(now));
        out_.tip_velocity.push_back((beam_.free.end_value * b_).sum() + support.rate(now));
        out_.impulse.push_back(impulse_);
      } else {
        const double r = lift(now), rate = lift_rate(now);
        kinetic += rate * (rate * beam_.lift_square() + 2 * (beam_.lift_pinned * b_).sum());
        elastic += 3 * beam_.k2 * r * r / std::pow(beam_.length, 3);
        out_.tip.push_back(stop());
        out_.tip_velocity.push_back(0);
        out_.impulse.push_back(impulse_ + contact_impulse(now));
      }
      out_.energy.push_back(0.5 * beam_.density * (kinetic + elastic));
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

  // The modal sums converge slowly at t = 0 only, where the formulas are known.
  void sample_start(const PanelSeries& displacement) {
    const Support& support = beam_.support;
    for (; next_ < grid_.times.size() && grid_.times[next_] <= 0; ++next_) {
      const auto square = [](double value) { return value * value; };
      const double kinetic = PanelSeries::integral(
          [&](double x) { return square(problem_.velocity(x) - support.rate(0)); }, beam_.length, panels);
      const double elastic =
          PanelSeries::integral([&](double x) { return square(displacement.curvature(x)); }, beam_.length, panels);
      out_.tip.push_back(problem_.displacement(beam_.length));
      out_.tip_velocity.push_back(problem_.velocity(beam_.length));
      out_.energy.push_back(0.5 * beam_.density * (kinetic + beam_.k2 * elastic));
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

/// Modal phases of the continuous beam, exact between impacts and releases of the tip.
class EventDriven final : public ReferenceSolver {
 public:
  explicit EventDriven(Settings settings) : settings_(settings) {}

  ReferenceOrRefusal solve(const ReferenceProblem& problem, const SampleGrid& grid) const override {
    if (auto refusal = does_not_apply(problem)) return *refusal;
    Settings half = settings_;
    half.modes = settings_.modes / 2;
    auto fine = Run(problem, grid, settings_).motion();
    if (auto* refusal = std::get_if<Refusal>(&fine)) return *refusal;
    auto coarse = Run(problem, grid, half).motion();
    if (auto* refusal = std::get_if<Refusal>(&coarse)) return *refusal;
    ReferenceMotion result;
    result.motion = std::move(std::get<SampledMotion>(fine));
    result.coarser = std::move(std::get<SampledMotion>(coarse));
    result.how = fmt::format(
        "continuous beam, exact between events: {} clamped–free modes in flight, as many clamped–pinned modes and a "
        "lift in contact, events isolated within {:g} of the largest displacement; coarser: {} modes",
        settings_.modes, settings_.tolerance, half.modes);
    result.notes = notes(problem, result);
    return result;
  }

 private:
  std::optional<Refusal> does_not_apply(const ReferenceProblem& problem) const {
    if (problem.structure != "beam")
      return Refusal{
          fmt::format("event-driven solves the continuous beam, and the structure is a{} {}: the closed "
                      "forms of `exact` are made for it, `self` refines any scheme",
                      problem.structure.starts_with('o') ? "n" : "", problem.structure)};
    if (problem.right_fixed)
      return Refusal{
          "event-driven solves a beam that is clamped at x = 0 and free at x = L; this one is fixed at x = L"};
    const bool touched = stops_act(problem);
    if (touched && !only_the_tip(problem))
      return Refusal{
          "event-driven knows stops at the tip only, where one contact phase has one set of modes; place the stops at "
          "\"tip\", or use `event-driven-semi-discrete`, which follows any points of a coarse mesh"};
    if (touched && (problem.contact_stiffness > 0 || problem.contact_nonlinear))
      return Refusal{
          "event-driven holds the tip on a rigid stop, and the contact law is compliant: its motion differs by the "
          "penetration; use a rigid law, or `event-driven-semi-discrete`, which follows a linear spring"};
    if (!problem.load_zero && !problem.load_constant)
      return Refusal{
          "the load depends on time, and event-driven has the exact solution of constant loads only: drop t from "
          "`load` "
          "(the support may move), or use `self`"};
    if (!(problem.damping_stiffness >= 0 && problem.damping_mass >= 0))
      return Refusal{"event-driven needs damping coefficients that are not negative"};
    return resonance(problem, touched);
  }

  std::optional<Refusal> resonance(const ReferenceProblem& problem, bool touched) const {
    if (problem.support_amplitude == 0) return {};
    const Beam beam(problem, settings_.modes);
    const double pulsation = problem.support_pulsation;
    for (const BeamModes* modes : {&beam.free, &beam.pinned}) {
      if (modes == &beam.pinned && !touched) break;
      const Oscillators mode = oscillators(beam, *modes);
      for (Eigen::Index m = 0; m < mode.size(); ++m)
        if (std::hypot(mode.stiffness(m) - pulsation * pulsation, mode.damping(m) * pulsation) <
            1e-7 * mode.stiffness(m))
          return Refusal{
              fmt::format("the support moves at the pulsation of undamped mode {} {} ({:.9g} rad/s), which grows "
                          "without bound: add "
                          "damping, or move the pulsation by more than 1e-7 of it",
                          m + 1, modes == &beam.free ? "of the free beam" : "of the beam held at its tip",
                          std::sqrt(mode.stiffness(m)))};
    }
    return {};
  }

  std::vector<std::string> notes(const ReferenceProblem& problem, const ReferenceMotion& result) const {
    std::vector<std::string> found;
    const bool touched = !result.motion.events.empty();
    if (touched && problem.damping_stiffness == 0)
      found.push_back(
          "without stiffness-proportional damping the modes converge slowly: at each impact the energy of the modes "
          "left out is lost (about one part in `modes`), and contact breaks into many short ones; impulses, energies "
          "and the first impact are known, late trajectories are not");
    if (touched && problem.restitution > 0)
      found.push_back(
          fmt::format("the restitution {:g} has no part in it: the tip of a continuous beam has no mass, schemes tend "
                      "to this motion "
                      "as the mesh is refined, whatever their coefficient",
                      problem.restitution));
    if (problem.projected)
      found.push_back(
          "it starts from the formulas of the initial state, the methods from its projection on the mesh: the two "
          "differ "
          "by an amount that the mesh decides");
    const double highest =
        oscillators(Beam(problem, 2), BeamModes(BeamModes::End::free, settings_.modes, problem.length))
            .stiffness(settings_.modes - 1);
    if (problem.support_amplitude != 0 && problem.support_pulsation > 0.3 * std::sqrt(highest))
      found.push_back(fmt::format(
          "the support moves at {:g} rad/s, near or above the highest mode kept ({:.4g} rad/s): raise `modes`",
          problem.support_pulsation, std::sqrt(highest)));
    if (result.motion.events.size() != result.coarser.events.size())
      found.push_back(fmt::format("half the modes find {} events instead of {}: the two motions part on the way",
                                  result.coarser.events.size(), result.motion.events.size()));
    return found;
  }

  Settings settings_;
};

void register_all(Registry& registry) {
  registry.add_reference(
      {.name = "event-driven",
       .summary = "the continuous beam between stops at its tip, exact between impacts and releases",
       .text =
           "No mesh and no step. In flight the beam is a sum of clamped–free modes, in contact a cubic lift plus "
           "clamped–pinned modes; each mode is a damped oscillator with its closed form (C = αK + ηM, below, at and "
           "above critical damping), forced by the support A sin(ωt + ψ) and by a load constant in time. Displacement "
           "and velocity are continuous (L²) at switches. Impacts are roots of the gap, releases are changes of sign "
           "of "
           "the stop's force, both isolated by looks between which the quantity is its cubic interpolant within a "
           "bound "
           "that the modes give, so that no touch is stepped over. Just after a switch the truncated sum leaves the "
           "tip "
           "a hair beyond the stop: a new touch counts once the gap has opened beyond that hair. The restitution of "
           "schemes has no counterpart. With α > 0 many digits are known; with α = 0 convergence is slow.",
       .source = "modes: Young and Felgar (1949); the contact problem: Dumont and Paoli (2006); the switch between two "
                 "modal bases is elementary L² projection",
       .parameters = {integer_parameter("modes", 80, {.low = 4, .high = 320},
                                        "number of modes of each phase; the coarser motion has half of it"),
                      real_parameter("tolerance", "1", 1e-12, {.low = 1e-14, .high = 1e-6},
                                     "how closely the gap is resolved in the search for events, over the largest "
                                     "displacement of the scene"),
                      integer_parameter(
                          "events", 2000, {.low = 1, .high = 1e9},
                          "impacts and releases allowed per period of the first mode before the motion is "
                          "refused as chatter")}},
      [](const Parameters& p) {
        return std::make_unique<EventDriven>(Settings{static_cast<int>(p.integer("modes")), p.real("tolerance"),
                                                      static_cast<double>(p.integer("events"))});
      });
}

}  // namespace

RICOCHET_PLUGIN(reference, event_driven, register_all)
