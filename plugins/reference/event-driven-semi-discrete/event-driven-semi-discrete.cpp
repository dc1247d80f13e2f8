#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <ricochet/contract/plugin.hpp>
#include <ricochet/contract/said_format.hpp>
#include <string>
#include <utility>
#include <vector>

#include "contact_modes.hpp"
#include "linear_structure.hpp"
#include "phase_march.hpp"

namespace ricochet::reference {

/// Follows the motion from event to event: which points are closed, and what happens where that changes. Throws Stopped
/// where it cannot.
class EventDriven {
 public:
  /// `resolution`: step of the search for events × fastest rate.
  EventDriven(const ReferenceProblem& problem, const SampleGrid& grid, double resolution);
  EventDriven(const EventDriven&) = delete;

  SampledMotion run();
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  bool rigid() const { return at_.spring == 0; }
  const ContactModes& modes(const ContactSet& set);

  // The set at t = 0.
  void enter(State& now);
  void close_at_start(State& now);
  double gap(const State& now, Eigen::Index i, int sign, double& round_off) const;
  void hold(const State& start);
  void let_go(const State& seen);
  ContactSet touched(const State& now) const;
  ContactSet pushed_set(const State& now, const ContactSet& touching);
  void note_jump(const State& given, const State& released);

  // Transitions.
  void change(const State& now, const ContactSet& next, bool struck = false);
  void turn(State& now, const Watch& watch);
  void strike(State& now, const Watch& watch);
  void begin(const State& now, int point = -1);

  const ReferenceProblem& problem_;
  LinearStructure at_;
  MotionRecord record_;
  ContactModes open_;
  ContactPoints points_;
  PhaseMarch march_;
  std::map<ContactSet, ContactModes> known_;

  ContactSet set_;
  ContactSet held_;  // by the stop that they start on
  std::vector<std::string> notes_;
  double impulse_ = 0, travel_ = 0, struck_speed_ = 0;
  Eigen::Index stuck_ = 0;
};

EventDriven::EventDriven(const ReferenceProblem& problem, const SampleGrid& grid, double resolution)
    : problem_(problem),
      at_(structure_of(problem)),
      record_(problem, grid, at_),
      open_(contact_modes(at_, ContactSet(static_cast<std::size_t>(at_.points()), 0))),
      points_(at_, open_),
      march_(at_, resolution, record_) {}

SampledMotion EventDriven::run() {
  State now{0, problem_.discrete->position, problem_.discrete->velocity};
  if (record_.pending() && record_.next() <= 0) record_.sample(now, 0);
  set_.assign(static_cast<std::size_t>(at_.points()), 0);
  hold(now);
  enter(now);
  while (const auto fall = march_.march(impulse_)) {
    let_go(march_.state(fall->tau / 2));
    if (fall->tau > 0) stuck_ = 0;
    if (++stuck_ > 40 + 4 * at_.points())
      throw Stopped{
          fmt::format("the contact set does not settle at t = {:.10g} s: a grazing without an exact "
                      "continuation; move the stops or the initial state a little",
                      now.time)};
    if (record_.motion.events.size() > 200'000)
      throw Stopped{"more than 200000 contacts begin or end: shorten the duration"};
    now = march_.state(fall->tau);
    impulse_ += fall->impulse;
    turn(now, fall->watch);
  }
  return std::move(record_.motion);
}

const ContactModes& EventDriven::modes(const ContactSet& set) {
  const auto known = known_.find(set);
  if (known != known_.end()) return known->second;
  if (known_.size() > 1000) known_.clear();
  return known_.emplace(set, contact_modes(at_, set)).first->second;
}

// The set at t = 0.
void EventDriven::enter(State& now) {
  const ContactPhase free(at_, open_, now);
  State released = free.state(0);
  note_jump(now, released);
  if (at_.points() > 0) close_at_start(released);
  now = released;
  begin(now);
}

void EventDriven::close_at_start(State& now) {
  const Eigen::VectorXd lower = at_.bound_at(1, 0), upper = at_.bound_at(-1, 0), y = at_.contact * now.place;
  if ((lower.array() > upper.array()).any())
    throw Stopped{
        "stops that pass each other push from both sides at once, and modes are those of one side: use the "
        "reference self"};
  for (Eigen::Index i = 0; i < y.size(); ++i)
    for (const double gap : {y[i] - lower[i], upper[i] - y[i]})
      if (std::isfinite(gap)) travel_ = std::max(travel_, std::abs(gap));
  const bool at_once = at_.alpha == 0 && points_.massless;
  if (!rigid() || at_once) {
    const Eigen::MatrixXd W = (at_.alpha == 0 ? 1 : 0) * points_.reach * points_.reach.transpose();
    change(now, box_set(W, rigid() ? 0 : 1 / at_.spring, y, lower, upper));
  } else if (const ContactSet touching = touched(now); points_.massless) {
    change(now, pushed_set(now, touching));
  } else if (touching[0] != 0) {
    strike(now, {0, touching[0], false});
  }
}

// How far a point is from its stop, and what of it is round-off; infinite where there is none.
double EventDriven::gap(const State& now, Eigen::Index i, int sign, double& round_off) const {
  const double place = at_.contact.row(i).dot(now.place), stop = at_.bound_at(sign, now.time)[i];
  round_off = std::isfinite(stop) ? 1e-12 * (std::abs(stop) + now.place.lpNorm<Eigen::Infinity>()) : 0;
  return sign * (place - stop);
}

// Points that lie beyond a stop at the start, or on it without moving into it: what they close there is no impact.
void EventDriven::hold(const State& start) {
  held_.assign(set_.size(), 0);
  const double lifted = support_rate_at(problem_, start.time);
  const double still = 1e-12 * (std::abs(lifted) + start.rate.lpNorm<Eigen::Infinity>());
  for (Eigen::Index i = 0; i < at_.points(); ++i)
    for (const int sign : {1, -1}) {
      double round_off = 0;
      const double gap = this->gap(start, i, sign, round_off);
      const double approach = -sign * (at_.contact.row(i).dot(start.rate) + lifted);
      if (gap < -round_off || (gap <= round_off && approach <= still))
        held_[static_cast<std::size_t>(i)] = static_cast<signed char>(sign);
    }
}

// Of these, those that are seen away from their stop.
void EventDriven::let_go(const State& seen) {
  for (std::size_t i = 0; i < held_.size(); ++i) {
    double round_off = 0;
    if (held_[i] != 0 && gap(seen, static_cast<Eigen::Index>(i), held_[i], round_off) > round_off) held_[i] = 0;
  }
}

// Points that lie on a stop already. No point lies on a stop that is absent.
ContactSet EventDriven::touched(const State& now) const {
  ContactSet set(set_.size(), 0);
  const Eigen::VectorXd y = at_.contact * now.place;
  for (const int sign : {1, -1}) {
    const Eigen::VectorXd stop = at_.bound_at(sign, now.time);
    for (Eigen::Index i = 0; i < y.size(); ++i)
      if (std::isfinite(stop[i]) &&
          std::abs(y[i] - stop[i]) <= 1e-13 * (std::abs(stop[i]) + now.place.lpNorm<Eigen::Infinity>()))
        set[static_cast<std::size_t>(i)] = static_cast<signed char>(sign);
  }
  return set;
}

// Viscous massless points: of those that touch, which are pushed. Their rates follow at once, α Zᵀ K Z being their only
// resistance.
ContactSet EventDriven::pushed_set(const State& now, const ContactSet& touching) {
  const ContactPhase free(at_, open_, now);
  const Eigen::VectorXd rates = at_.contact * free.state(0).rate;
  Eigen::VectorXd lower = Eigen::VectorXd::Constant(rates.size(), -INFINITY), upper = -lower;
  for (Eigen::Index i = 0; i < rates.size(); ++i) {
    const signed char sign = touching[static_cast<std::size_t>(i)];
    if (sign != 0) (sign > 0 ? lower : upper)[i] = -support_rate_at(problem_, now.time);
  }
  return box_set(points_.reach * points_.reach.transpose() / at_.alpha, 0, rates, lower, upper);
}

void EventDriven::note_jump(const State& given, const State& released) {
  if (points_.kernel == 0 || at_.alpha > 0) return;
  const Eigen::VectorXd jump = released.place - given.place;
  const double moved = record_.elastic_energy(jump), stored = record_.elastic_energy(given.place);
  if (moved > 1e-18 * stored)
    notes_.push_back(fmt::format(
        "the initial state is off the constraint of the singular mass: at t = 0⁺ the massless part jumps to its "
        "equilibrium. The equilibrium holds {:.6g} J less. The sample at t = 0 is the state as it was given",
        moved));
}

void EventDriven::change(const State& now, const ContactSet& next, bool struck) {
  const double tip = problem_.discrete->tip.dot(now.rate) + support_rate_at(problem_, now.time);
  for (const int sign : {1, -1}) {
    const auto on = [&](const ContactSet& set) {
      return std::any_of(set.begin(), set.end(), [&](signed char one) { return one == sign; });
    };
    const auto hit = [&] {
      for (std::size_t i = 0; i < next.size(); ++i)
        if (next[i] == sign && held_[i] != sign) return true;
      return false;
    };
    if (!on(set_) && on(next) && hit())
      record_.motion.events.push_back({now.time, -sign, true, struck ? struck_speed_ : tip});
    if (on(set_) && !on(next)) record_.motion.events.push_back({now.time, -sign, false, 0});
  }
  set_ = next;
  for (std::size_t i = 0; i < held_.size(); ++i)
    if (set_[i] != 0) held_[i] = 0;
}

void EventDriven::turn(State& now, const Watch& watch) {
  const auto point = static_cast<std::size_t>(watch.point);
  ContactSet next = set_;
  next[point] = 0;
  if (!watch.closed) {
    if (rigid() && !points_.massless) {
      strike(now, watch);
      return begin(now, watch.point);
    }
    next[point] = static_cast<signed char>(watch.sign);
    if (rigid() && at_.alpha > 0) {
      ContactSet pushed = pushed_set(now, next);
      pushed[point] = next[point];
      next = pushed;
    }
  }
  change(now, next);
  begin(now, watch.point);
}

// Newton's impact at the one point that has inertia: v⁺ = v + X Xᵀ Hᵀ P, which gives the relative speed −e times what
// it was. A bounce too low to be seen ends in contact.
void EventDriven::strike(State& now, const Watch& watch) {
  const double sign = watch.sign;
  const Eigen::RowVectorXd row = at_.contact.row(watch.point);
  const double compliance = points_.moving.row(watch.point).squaredNorm();
  const double approach = std::min(sign * (row.dot(now.rate) + support_rate_at(problem_, now.time)), 0.0);
  const double rebound = -problem_.restitution * approach;
  struck_speed_ = problem_.discrete->tip.dot(now.rate) + support_rate_at(problem_, now.time);
  const Eigen::Index r = points_.moving.cols();
  now.rate += open_.shapes.leftCols(r) * points_.moving.row(watch.point).transpose() *
              (sign * (rebound - approach) / compliance);

  const ContactPhase free(at_, open_, now);
  Columns at;
  free.read(0, at);
  double pull = 0, haze = 0;
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(open_.watches.size()); ++k)
    if (open_.watches[static_cast<std::size_t>(k)].sign == watch.sign) {
      pull = free.watched_curve(k, at);
      haze = open_.watch_place.row(k).cwiseAbs().dot(at.value.cwiseAbs());
    }
  const double height = pull < 0 ? rebound * rebound / (-2 * pull) : INFINITY;
  // At rest on its stop since the start, and pulled away: nothing hits, and nothing holds it.
  if (held_[static_cast<std::size_t>(watch.point)] == watch.sign && pull >= 0) return;
  const bool rests = height <= 1e-14 * travel_ + 16 * std::numeric_limits<double>::epsilon() * haze;
  impulse_ += sign * ((rests ? 0 : rebound) - approach) / compliance;
  ContactSet closed = set_;
  closed[static_cast<std::size_t>(watch.point)] = static_cast<signed char>(watch.sign);
  change(now, closed, true);
  if (rests) return;
  if (std::isfinite(height)) travel_ = std::max(travel_, height);
  closed[static_cast<std::size_t>(watch.point)] = 0;
  change(now, closed);
}

void EventDriven::begin(const State& now, int point) {
  march_.begin(modes(set_), now, point);
}

}  // namespace ricochet::reference

namespace {

using namespace ricochet;
using namespace ricochet::reference;

constexpr Eigen::Index most_dofs = 60;

/// Exact in time on the mesh of the case: separates what the time scheme does from what the mesh does.
class EventDrivenSemiDiscrete final : public ReferenceSolver {
 public:
  bool of_the_mesh() const override { return true; }

  ReferenceOrRefusal solve(const ReferenceProblem& problem, const SampleGrid& grid) const override {
    if (!problem.discrete) return Refusal{"the matrices of a mesh are missing: this reference is one of the mesh"};
    if (problem.discrete->mass.rows() > most_dofs)
      return Refusal{
          said("{} dofs: the exact semi-discrete solution is worked out for at most {}, 20 elements of "
               "a beam; use fewer elements, or the reference event-driven or self",
               problem.discrete->mass.rows(), most_dofs)};
    if (!problem.load_constant)
      return Refusal{
          "the load depends on time by a formula: between events only constant and harmonic forces are "
          "exact; use the reference self"};
    if (problem.contact_nonlinear)
      return Refusal{
          "the contact law is not linear: between events the motion is not a sum of modes; use the reference self"};
    try {
      EventDriven fine(problem, grid, 0.5);
      ReferenceMotion found;
      found.motion = fine.run();
      found.coarser = EventDriven(problem, grid, 2).run();
      found.how = fmt::format(
          "modes of each contact set of the {} dofs, exact between events. Events are watched twice per radian of the "
          "fastest mode that matters, and polished to round-off",
          problem.discrete->mass.rows());
      found.notes = fine.notes();
      return found;
    } catch (const Stopped& stopped) {
      return Refusal{stopped.sentence};
    }
  }
};

void register_event_driven_semi_discrete(Registry& registry) {
  registry.add_reference(
      {.name = "event-driven-semi-discrete",
       .summary = "the motion of the case's own mesh, exact in time between changes of the contact set",
       .text = R"(While the set of closed contact points stays as it is, M w'' + C w' + K w = F + Hᵀp is linear with
          constant coefficients, and its modes are known: closed points are bilateral constraints (rigid law) or
          springs (linear compliant law, κ per point), forces are constant or harmonic, and the modes solve it
          exactly, under-, critically and over-damped ones alike. The massless modes of a singular mass follow at
          once (α = 0) or relax with rate 1/α; where they carry all contact points, contact opens and closes without
          any impact and restitution has no part in it. A single point with inertia rebounds by Newton's law, v⁺ =
          −e v⁻, and a bounce below 1e-14 of the highest ends a chattering; several such points under a rigid law
          are refused. Events (a gap, a contact force or a penetration that falls below zero) are watched at a step
          that resolves the fastest mode that still matters, with a bound of the curvature between, and polished to
          round-off. Initial data off the constraint of a singular mass jump to it at t = 0⁺ when α = 0. At most 60
          dofs.)",
       .source = R"(Acary and Brogliato (2008), ch. 8 (event-driven schemes); Renard (2010) for contact without
          inertia; modes as M x = μ K x, so that slow ones keep their digits)",
       .parameters = {}},
      [](const Parameters&) { return std::make_unique<EventDrivenSemiDiscrete>(); });
}

}  // namespace

RICOCHET_PLUGIN(reference, event_driven_semi_discrete, register_event_driven_semi_discrete)
