#include "beam_run.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ricochet/contract/said_format.hpp>
#include <utility>

namespace ricochet::event_driven {

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

BeamRun::BeamRun(const ReferenceProblem& problem, const SampleGrid& grid, const Settings& settings)
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

std::variant<SampledMotion, Refusal> BeamRun::motion() {
  reserve();
  if (auto refusal = begin()) return *refusal;
  while (next_ < grid_.times.size()) {
    if (auto refusal = side_ == 0 ? fly() : touch()) return *refusal;
  }
  return std::move(out_);
}

void BeamRun::set_scales(double displacement, double velocity) {
  first_period_ = 2 * std::numbers::pi / std::sqrt(flight_.oscillators().stiffness(0));
  shortest_period_ = 2 * std::numbers::pi / std::sqrt(contact_.oscillators().stiffness(settings_.modes - 1));
  scale_ = std::max({std::abs(beam_.support.amplitude), displacement, velocity * first_period_ / (2 * std::numbers::pi),
                     (beam_.free.end_value * beam_.load_free / flight_.oscillators().stiffness()).abs().sum()});
  if (scale_ == 0) scale_ = beam_.length;
}

BeamRun::Failure BeamRun::begin() {
  const Support& support = beam_.support;
  const double L = beam_.length;
  const PanelSeries displacement(problem_.displacement, L, panels), velocity(problem_.velocity, L, panels);
  if (!displacement.finite() || !velocity.finite())
    return Refusal{"the initial displacement or velocity is not a finite number everywhere on the beam"};
  set_scales(displacement.largest(), velocity.largest());
  const double step = problem_.displacement(0) - support.at(0), slope = displacement.slope(0);
  if (std::abs(step) > 1e-9 * scale_ || std::abs(slope) * L > 1e-6 * scale_)
    return Refusal{
        said("the initial displacement does not follow the clamp: at x = 0, u − φ is {:.3g} m and its slope "
             "{:.3g}, but both must be 0. A continuous beam has no finite energy otherwise. Start from a shape "
             "that the clamp allows, or use `self`",
             step, slope)};
  const double tip = problem_.displacement(L), touching = 1e-9 * scale_;
  if (tip < lower_ - touching || tip > upper_ + touching)
    return Refusal{
        said("the tip starts at {:g} m, beyond its stops [{:g}, {:g}] m: start between them or move the stops", tip,
             lower_, upper_)};
  const auto position = [&](double x) { return problem_.displacement(x) - support.at(0); };
  const auto rate = [&](double x) { return problem_.velocity(x) - support.rate(0); };
  a_ = Beam::projection(position, beam_.free, L);
  b_ = Beam::projection(rate, beam_.free, L);
  state_ = flight_.start(0, a_, b_);
  sample_start(displacement);
  const double hair = std::abs(flight_.read(state_).value - tip);
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

bool BeamRun::goes_out(const Guard& guard, double noise) {
  const double start = flight_.read(state_).value;
  for (int level = ModalPhase::levels - 1; level >= 0; --level) {
    const double moved = guard.inside * (flight_.read_at(state_, flight_.step(level)).value - start);
    if (std::abs(moved) > noise) return moved < 0;
  }
  return false;
}

BeamRun::Failure BeamRun::fly() {
  const auto passed = march(flight_, guards_, tolerance());
  if (const auto* refusal = std::get_if<Refusal>(&passed)) return *refusal;
  const int guard = std::get<int>(passed);
  if (guard >= 0) impact(guard == 0 ? -1 : 1, flight_.read(state_).slope);
  return {};
}

BeamRun::Failure BeamRun::touch() {
  const auto passed = march(contact_, guards_, force_tolerance());
  if (const auto* refusal = std::get_if<Refusal>(&passed)) return *refusal;
  if (std::get<int>(passed) >= 0) release();
  return {};
}

void BeamRun::impact(int side, double velocity) {
  flight_.whole(state_, state_.time, a_, b_);
  const ModalState before = state_;
  if (tangent_) move_tangent(flight_, before.time);
  enter_contact(side, velocity, (beam_.lift_free * a_).sum(), (beam_.lift_free * b_).sum(),
                beam_.change.transpose() * a_.matrix(), beam_.change.transpose() * b_.matrix());
  if (tangent_) {
    set_instants(flight_, velocity);
    switch_tangent(flight_, contact_, before, beam_.change.transpose(), -beam_.lift_pinned);
  }
  // Continuous in the speed: a contact that its first force would end is left at once.
  if (mapped_ && guards_[0].margin(contact_.read(state_).value) <= 0) release(true);
}

void BeamRun::enter_contact(int side, double velocity, double on_lift, double rate_on_lift,
                            const Eigen::ArrayXd& on_modes, const Eigen::ArrayXd& rate_on_modes) {
  const double t = state_.time;
  side_ = side;
  // A tip that starts on its stop and does not move into it hits nothing.
  if (t > 0 || side * velocity > 0) out_.events.push_back({t, side, true, velocity});
  momentum_ = momentum(t, rate_on_lift, on_lift);
  state_ = contact_.start(t, on_modes - lift(t) * beam_.lift_pinned, rate_on_modes - lift_rate(t) * beam_.lift_pinned);
  contact_.set_offset(3 * stop() / std::pow(beam_.length, 3));
  guards_ = {Guard{0, -side}, Guard{-infinity, 1}};
  if (held()) guards_[0] = guards_[1];
  const double force = contact_.read(state_).value;
  if (guards_[0].margin(force) <= 0) {
    guards_[0].on = false;
    guards_[0].slack = infinity;
    guards_[0].until = t + shortest_period_;
  }
}

void BeamRun::release(bool at_once) {
  const double t = state_.time;
  contact_.whole(state_, t, a_, b_);
  impulse_ += contact_impulse(t);
  out_.events.push_back({t, side_, false, 0});
  const ModalState before = state_;
  if (tangent_ && !at_once) {
    move_tangent(contact_, t);
    set_instants(contact_, contact_.read(state_).slope);
  }
  state_ = flight_.start(t, (beam_.change * a_.matrix()).array() + lift(t) * beam_.lift_free,
                         (beam_.change * b_.matrix()).array() + lift_rate(t) * beam_.lift_free);
  if (tangent_) switch_tangent(contact_, flight_, before, beam_.change, beam_.lift_free);
  guards_ = {Guard{lower_, 1}, Guard{upper_, -1}};
  Guard& left = guards_[side_ < 0 ? 0 : 1];
  left.on = false;
  left.slack = 4 * std::abs(flight_.read(state_).value - stop()) + 10 * tolerance();
  side_ = 0;
}

void BeamRun::move_tangent(const ModalPhase& phase, double t) {
  const Oscillators& modes = phase.oscillators();
  Oscillators::Flow flow = modes.empty_flow();
  modes.flow(t - tangent_time_, modes.size(), flow);
  const Eigen::Index n = modes.size();
  for (Eigen::Index m = 0; m < n; ++m) {
    const Eigen::RowVectorXd place = tangent_->row(m), rate = tangent_->row(n + m);
    tangent_->row(m) = flow.stay(m) * place + flow.kick(m) * rate;
    tangent_->row(n + m) = flow.keep(m) * rate - modes.stiffness(m) * flow.kick(m) * place;
  }
  tangent_time_ = t;
}

void BeamRun::set_instants(const ModalPhase& phase, double slope) {
  const Eigen::Index n = phase.size();
  const ModalPhase::Watched& g = phase.watched();
  instants_ = -(g.position.matrix().transpose() * tangent_->topRows(n) +
                g.rate.matrix().transpose() * tangent_->bottomRows(n)) /
              slope;
}

template <class Basis>
void BeamRun::switch_tangent(const ModalPhase& phase, const ModalPhase& next_phase, const ModalState& before,
                             const Basis& basis, const Eigen::ArrayXd& lifted) {
  const Eigen::Index n = basis.rows();
  const Support& support = beam_.support;
  const double lift_curve = support.pulsation * support.pulsation * support.at(before.time);
  // Displacements and velocities go on: accelerations alone jump.
  const Eigen::VectorXd jump =
      basis * phase.acceleration(before).matrix() + (lift_curve * lifted - next_phase.acceleration(state_)).matrix();
  tangent_->topRows(n) = basis * tangent_->topRows(n);
  tangent_->bottomRows(n) = basis * tangent_->bottomRows(n) + jump * instants_;
}

void BeamRun::project_start(Eigen::ArrayXd& a, Eigen::ArrayXd& b) const {
  const Support& support = beam_.support;
  a = Beam::projection([&](double x) { return problem_.displacement(x) - support.at(0); }, beam_.free, beam_.length);
  b = Beam::projection([&](double x) { return problem_.velocity(x) - support.rate(0); }, beam_.free, beam_.length);
}

std::variant<SampledMotion, Refusal> BeamRun::motion_from(Eigen::ArrayXd& a, Eigen::ArrayXd& b,
                                                          Eigen::MatrixXd* tangent) {
  out_ = {};
  reserve();
  next_ = 0;
  side_ = level_ = 0;
  looks_ = 0;
  impulse_ = 0;
  mapped_ = true;
  tangent_ = tangent;
  tangent_time_ = 0;
  set_scales(0, 0);
  state_ = flight_.start(0, a, b);
  const double tip = flight_.read(state_).value;
  if (!std::isfinite(tip)) return Refusal{"the state is not finite"};
  if (tip < lower_ - tolerance() || tip > upper_ + tolerance())
    return Refusal{said("the tip is at {:g} m at t = 0, at or beyond a stop; shift the phase of the support", tip)};
  guards_ = {Guard{lower_, 1}, Guard{upper_, -1}};
  while (next_ < grid_.times.size())
    if (auto refusal = side_ == 0 ? fly() : touch()) return *refusal;
  if (side_ != 0)
    return Refusal{said("the tip is at its stop at t = {:g} s; shift the phase of the support", grid_.times.back())};
  if (tangent_) move_tangent(flight_, grid_.times.back());
  tangent_ = nullptr;
  a = a_;
  b = b_;
  return std::move(out_);
}

double BeamRun::momentum(double t, double rate, double position) const {
  return rate + beam_.support.rate(t) * beam_.lift_mean() + beam_.eta * position +
         3 * beam_.k2 / std::pow(beam_.length, 3) * (stop() * t - beam_.support.integral(t) + beam_.alpha * lift(t)) -
         t * beam_.load_lift;
}

double BeamRun::contact_impulse(double t) const {
  const double now = momentum(t, lift_rate(t) * beam_.lift_square() + (beam_.lift_pinned * b_).sum(),
                              lift(t) * beam_.lift_square() + (beam_.lift_pinned * a_).sum());
  return beam_.density * (now - momentum_);
}

}  // namespace ricochet::event_driven
