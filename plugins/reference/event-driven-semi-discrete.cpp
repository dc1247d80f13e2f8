#include <fmt/format.h>

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <ricochet/algebra/box_problem.hpp>
#include <ricochet/contract/plugin.hpp>

#include "contact_phase.hpp"

namespace {

using namespace ricochet;
using namespace ricochet::reference;
using Eigen::Index;

constexpr Index most_dofs = 60;
constexpr long long work_limit = 300'000'000;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Thrown inside a solve, a Refusal outside.
struct Stopped {
  std::string sentence;
};

/// Columns of a small dense W.
class DenseColumns final : public DelassusColumns {
 public:
  explicit DenseColumns(Eigen::MatrixXd W) : W_(std::move(W)) {}
  const double* column(int j) override { return W_.col(j).data(); }

 private:
  Eigen::MatrixXd W_;
};

/// R with xᵀA x = |R x|², A positive semidefinite: a small energy is not the difference of large ones.
Eigen::MatrixXd square_root(const Eigen::MatrixXd& A, const Eigen::VectorXd& scale) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * A * scale.asDiagonal());
  const double largest = eigen.eigenvalues().size() ? eigen.eigenvalues().tail(1)[0] : 0;
  const Eigen::VectorXd roots =
      (eigen.eigenvalues().array() < 1e-14 * largest).select(0, eigen.eigenvalues().cwiseMax(0).cwiseSqrt());
  return roots.asDiagonal() * eigen.eigenvectors().transpose() * scale.cwiseInverse().asDiagonal();
}

LinearStructure structure_of(const ReferenceProblem& problem) {
  const DiscreteProblem& discrete = *problem.discrete;
  const Index n = discrete.mass.rows();
  LinearStructure structure;
  structure.mass = discrete.mass;
  structure.stiffness = discrete.stiffness;
  structure.alpha = problem.damping_stiffness;
  structure.eta = problem.damping_mass;
  structure.spring = problem.contact_absent ? 0 : problem.contact_stiffness;
  std::vector<Index> stopped;
  for (Index i = 0; i < (problem.contact_absent ? 0 : discrete.contact.rows()); ++i)
    if (std::isfinite(discrete.lower[i]) || std::isfinite(discrete.upper[i])) stopped.push_back(i);
  structure.contact = discrete.contact(stopped, Eigen::all);
  const Index m = structure.points();

  const Complex support = std::polar(problem.support_amplitude, problem.support_phase - M_PI / 2);
  const Complex push =
      std::polar(std::abs(problem.force_amplitude), problem.force_phase + (problem.force_amplitude < 0 ? M_PI : 0));
  structure.exponents = {0};
  const auto column = [&](double pulsation) -> Index {
    if (pulsation == 0) return 0;
    structure.exponents.push_back({0, pulsation});
    return static_cast<Index>(structure.exponents.size()) - 1;
  };
  const Index moved = problem.support_amplitude != 0 ? column(problem.support_pulsation) : 0;
  const Index pushed = problem.force_amplitude != 0 ? column(problem.force_pulsation) : 0;
  const auto signals = static_cast<Index>(structure.exponents.size());
  structure.force = Signals::Zero(n, signals);
  structure.lower = Signals::Zero(m, signals);
  structure.upper = Signals::Zero(m, signals);
  // An oscillator's load may come with its harmonic force inside: read apart.
  if (problem.structure == "oscillator") {
    if (!problem.load_zero && problem.load) structure.force(0, 0) += problem.load(0, 0);
    structure.force(0, pushed) += pushed == 0 ? push.real() : push;
  } else if (!problem.load_zero) {
    structure.force.col(0) += discrete.load_constant;
  }
  const double pulsation = problem.support_pulsation;
  if (moved > 0) structure.force.col(moved) += pulsation * pulsation * support * discrete.support_shape;
  if (m > 0) {
    structure.lower.col(0) = discrete.lower(stopped).cast<Complex>();
    structure.upper.col(0) = discrete.upper(stopped).cast<Complex>();
    for (Signals* bound : {&structure.lower, &structure.upper})
      bound->col(moved).array() -= moved == 0 ? Complex(support.real()) : support;
  }
  structure.prepare();
  return structure;
}

/// Follows the motion from event to event.
class EventDriven {
 public:
  EventDriven(const ReferenceProblem& problem, const SampleGrid& grid, double resolution)
      : problem_(problem),
        grid_(grid),
        resolution_(resolution),
        at_(structure_of(problem)),
        mass_root_(square_root(at_.mass, at_.scale)),
        stiffness_root_(square_root(at_.stiffness, at_.scale)),
        open_(contact_modes(at_, ContactSet(static_cast<std::size_t>(at_.points()), 0))) {
    const Index r = static_cast<Index>(open_.oscillators.size());
    const Pencil modes = pencil(at_, at_.stiffness, Eigen::MatrixXd(0, at_.dofs()));
    reach_ = at_.contact * modes.massless;
    moving_ = at_.contact * open_.shapes.leftCols(r);
    kernel_ = modes.massless.cols();
    judge_points();
  }

  SampledMotion run() {
    State now{0, problem_.discrete->position, problem_.discrete->velocity};
    end_ = grid_.times.empty() ? 0 : grid_.times.back();
    while (sampled_ < grid_.times.size() && grid_.times[sampled_] <= 0) sample(now, 0);
    set_.assign(static_cast<std::size_t>(at_.points()), 0);
    enter(now);
    while (const auto fall = march()) {
      if (fall->tau > 0) stuck_ = 0;
      if (++stuck_ > 40 + 4 * at_.points())
        throw Stopped{
            fmt::format("the contact set does not settle at t = {:.10g} s: a grazing without an exact "
                        "continuation; move the stops or the initial state a little",
                        now.time)};
      if (motion_.events.size() > 200'000)
        throw Stopped{"more than 200000 contacts begin or end: shorten the duration"};
      now = phase_->state(fall->tau);
      impulse_ += fall->impulse;
      turn(now, fall->watch);
    }
    return std::move(motion_);
  }

  const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct Fall {
    double tau = 0;
    Watch watch;
    double impulse = 0;
  };

  bool rigid() const { return at_.spring == 0; }
  double support(double t) const {
    return problem_.support_amplitude * std::sin(problem_.support_pulsation * t + problem_.support_phase);
  }
  double support_rate(double t) const {
    return problem_.support_amplitude * problem_.support_pulsation *
           std::cos(problem_.support_pulsation * t + problem_.support_phase);
  }
  /// The stops of one side as they bound H w at t.
  Eigen::VectorXd bound(int sign, double t) const {
    Eigen::VectorXd result = at_.bound(sign).col(0).real();
    for (Index k = 1; k < at_.force.cols(); ++k)
      result += (at_.bound(sign).col(k) * std::exp(at_.exponents[static_cast<std::size_t>(k)] * t)).real();
    return result;
  }

  /// What a contact point moves against: massless modes alone, or mass.
  void judge_points() {
    const Index m = at_.points();
    if (m == 0) return;
    const auto S = at_.scale.asDiagonal();
    const Eigen::MatrixXd K = S * (at_.stiffness + at_.shift * at_.mass) * S, across = (at_.contact * S).transpose();
    const Eigen::MatrixXd soft = across.transpose() * K.llt().solve(across);
    const Eigen::VectorXd unit = soft.diagonal().cwiseSqrt().cwiseInverse();
    const auto smallest = [&](const Eigen::MatrixXd& W) {
      return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(unit.asDiagonal() * W * unit.asDiagonal(),
                                                            Eigen::EigenvaluesOnly)
          .eigenvalues()[0];
    };
    if (rigid() && smallest(soft) < 1e-12)
      throw Stopped{"two contact points coincide, and rigid stops share their force in no unique way: keep one"};
    massless_ = smallest(reach_ * reach_.transpose()) > 1e-9 * smallest(soft);
    if (!rigid() || massless_) return;
    if (m > 1)
      throw Stopped{fmt::format(
          "{} contact points with inertia and rigid stops: simultaneous impacts have no unique law; use a singular "
          "mass whose kernel carries the contact, a compliant law, or stops at the tip alone",
          m)};
    if (reach_.squaredNorm() > 1e-9 * soft(0, 0))
      throw Stopped{"the contact point has no inertia of its own but the massless part does not carry it alone"};
  }

  const ContactModes& modes(const ContactSet& set) {
    const auto known = known_.find(set);
    if (known != known_.end()) return known->second;
    if (known_.size() > 1000) known_.clear();
    return known_.emplace(set, contact_modes(at_, set)).first->second;
  }

  // ---- which points are closed -------------------------------------------------------------------------------------

  /// The set of p in lower ≤ y + W p ⊥ p ≤ upper.
  ContactSet box(const Eigen::MatrixXd& W, double compliance, const Eigen::VectorXd& y, const Eigen::VectorXd& lower,
                 const Eigen::VectorXd& upper) {
    DenseColumns columns(W);
    Eigen::VectorXd p = Eigen::VectorXd::Zero(y.size());
    BoxSolver solver;
    solver.prepare(static_cast<int>(y.size()));
    const auto outcome = solver.solve(columns, 1, compliance, y.data(), lower.data(), upper.data(), p.data(),
                                      static_cast<int>(y.size()));
    if (!outcome.converged) throw Stopped{"the complementarity problem of the contact points was not solved"};
    ContactSet set;
    for (const double effort : p) set.push_back(effort > 0 ? 1 : (effort < 0 ? -1 : 0));
    return set;
  }

  /// The set at t = 0.
  void enter(State& now) {
    const ContactPhase free(at_, open_, now);
    State released = free.state(0);
    note_jump(now, released);
    if (at_.points() > 0) close_at_start(released);
    now = released;
    begin(now);
  }

  void close_at_start(State& now) {
    const Eigen::VectorXd lower = bound(1, 0), upper = bound(-1, 0), y = at_.contact * now.place;
    for (Index i = 0; i < y.size(); ++i)
      for (const double gap : {y[i] - lower[i], upper[i] - y[i]})
        if (std::isfinite(gap)) travel_ = std::max(travel_, std::abs(gap));
    const bool at_once = at_.alpha == 0 && massless_;
    if (!rigid() || at_once) {
      const Eigen::MatrixXd W = (at_.alpha == 0 ? 1 : 0) * reach_ * reach_.transpose();
      change(now, box(W, rigid() ? 0 : 1 / at_.spring, y, lower, upper));
    } else if (const ContactSet touching = touched(now); massless_) {
      change(now, pushed_set(now, touching));
    } else if (touching[0] != 0) {
      strike(now, {0, touching[0], false});
    }
  }

  /// Points that lie on a stop already.
  ContactSet touched(const State& now) const {
    ContactSet set(set_.size(), 0);
    const Eigen::VectorXd y = at_.contact * now.place;
    for (const int sign : {1, -1}) {
      const Eigen::VectorXd stop = bound(sign, now.time);
      for (Index i = 0; i < y.size(); ++i)
        if (std::abs(y[i] - stop[i]) <= 1e-13 * (std::abs(stop[i]) + now.place.lpNorm<Eigen::Infinity>()))
          set[static_cast<std::size_t>(i)] = static_cast<signed char>(sign);
    }
    return set;
  }

  /// Viscous massless points: of those that touch, which are pushed. Their rates follow at once, α Zᵀ K Z being their
  /// only resistance.
  ContactSet pushed_set(const State& now, const ContactSet& touching) {
    const ContactPhase free(at_, open_, now);
    const Eigen::VectorXd rates = at_.contact * free.state(0).rate;
    Eigen::VectorXd lower = Eigen::VectorXd::Constant(rates.size(), -INFINITY), upper = -lower;
    for (Index i = 0; i < rates.size(); ++i) {
      const signed char sign = touching[static_cast<std::size_t>(i)];
      if (sign != 0) (sign > 0 ? lower : upper)[i] = -support_rate(now.time);
    }
    return box(reach_ * reach_.transpose() / at_.alpha, 0, rates, lower, upper);
  }

  void note_jump(const State& given, const State& released) {
    if (kernel_ == 0 || at_.alpha > 0) return;
    const Eigen::VectorXd jump = released.place - given.place;
    const double moved = (stiffness_root_ * jump).squaredNorm(), stored = (stiffness_root_ * given.place).squaredNorm();
    if (moved > 1e-18 * stored)
      notes_.push_back(fmt::format(
          "the initial state is off the constraint of the singular mass: at t = 0⁺ the massless part jumps to its "
          "equilibrium, which holds {:.6g} J less; the sample at t = 0 is the state as it was given",
          0.5 * moved));
  }

  // ---- transitions -------------------------------------------------------------------------------------------------

  void change(const State& now, const ContactSet& next, bool struck = false) {
    const double tip = problem_.discrete->tip.dot(now.rate) + support_rate(now.time);
    for (const int sign : {1, -1}) {
      const auto on = [&](const ContactSet& set) {
        return std::any_of(set.begin(), set.end(), [&](signed char one) { return one == sign; });
      };
      if (!on(set_) && on(next)) motion_.events.push_back({now.time, -sign, true, struck ? struck_speed_ : tip});
      if (on(set_) && !on(next)) motion_.events.push_back({now.time, -sign, false, 0});
    }
    set_ = next;
  }

  void turn(State& now, const Watch& watch) {
    const auto point = static_cast<std::size_t>(watch.point);
    ContactSet next = set_;
    next[point] = 0;
    if (!watch.closed) {
      if (rigid() && !massless_) {
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

  /// Newton's impact at the one point that has inertia: v⁺ = v + X Xᵀ Hᵀ P, which gives the relative speed −e times
  /// what it was. A bounce too low to be seen ends in contact.
  void strike(State& now, const Watch& watch) {
    const double sign = watch.sign;
    const Eigen::RowVectorXd row = at_.contact.row(watch.point);
    const double compliance = moving_.row(watch.point).squaredNorm();
    const double approach = std::min(sign * (row.dot(now.rate) + support_rate(now.time)), 0.0);
    const double rebound = -problem_.restitution * approach;
    struck_speed_ = problem_.discrete->tip.dot(now.rate) + support_rate(now.time);
    const Index r = moving_.cols();
    now.rate +=
        open_.shapes.leftCols(r) * moving_.row(watch.point).transpose() * (sign * (rebound - approach) / compliance);

    const ContactPhase free(at_, open_, now);
    Columns at;
    free.read(0, at);
    double pull = 0, haze = 0;
    for (Index k = 0; k < static_cast<Index>(open_.watches.size()); ++k)
      if (open_.watches[static_cast<std::size_t>(k)].sign == watch.sign) {
        pull = free.watched_curve(k, at);
        haze = open_.watch_place.row(k).cwiseAbs().dot(at.value.cwiseAbs());
      }
    const double height = pull < 0 ? rebound * rebound / (-2 * pull) : INFINITY;
    const bool rests = height <= 1e-14 * travel_ + 16 * epsilon * haze;
    impulse_ += sign * ((rests ? 0 : rebound) - approach) / compliance;
    ContactSet closed = set_;
    closed[static_cast<std::size_t>(watch.point)] = static_cast<signed char>(watch.sign);
    change(now, closed, true);
    if (rests) return;
    if (std::isfinite(height)) travel_ = std::max(travel_, height);
    closed[static_cast<std::size_t>(watch.point)] = 0;
    change(now, closed);
  }

  /// `point` is where a gap or a force has just become zero: what round-off leaves there is no event.
  void begin(const State& now, int point = -1) {
    phase_.emplace(at_, modes(set_), now);
    const auto& watches = phase_->modes().watches;
    haze_.setZero(static_cast<Index>(watches.size()));
    phase_->read(0, scratch_);
    for (Index k = 0; k < haze_.size(); ++k)
      if (watches[static_cast<std::size_t>(k)].point == point) haze_[k] = -4 * phase_->watched(k, scratch_);
  }

  // ---- one phase ---------------------------------------------------------------------------------------------------

  void read(double tau, Columns& at) {
    work_ += 1 + phase_->modes().columns();
    phase_->read(tau, at);
  }

  /// How fast what matters still changes, and how curved each watched function may be until then.
  struct Survey {
    double step = 0;
    Eigen::VectorXd curve, noise;
    std::vector<double> left;  // of each content
  };
  void survey(double tau, const Columns& at, Survey& now) const {
    const ContactModes& modes = phase_->modes();
    const auto& contents = phase_->contents();
    now.curve = modes.watch_steady;
    now.noise.resize(now.curve.size());
    now.left.resize(contents.size());
    for (std::size_t c = 0; c < contents.size(); ++c)
      now.left[c] = contents[c].of.size * std::exp(-contents[c].of.decay * tau);
    double fastest = 0;
    for (const Complex& exponent : at_.exponents) fastest = std::max(fastest, std::abs(exponent));
    for (const Index i : phase_->resonant()) fastest = std::max(fastest, modes.rates[i]);
    for (Index k = 0; k < now.curve.size(); ++k) {
      double swing = 0, size = modes.watch_signal.row(k).cwiseAbs().sum();
      for (Index i = 0; i < modes.columns(); ++i)
        size += std::abs(modes.watch_place(k, i) * at.value[i]) + std::abs(modes.watch_rate(k, i) * at.rate[i]);
      now.noise[k] = std::clamp(haze_[k], 64 * epsilon * size, 1e4 * epsilon * size);
      const auto part = [&](std::size_t c) {
        const auto& [column, of] = contents[c];
        return (std::abs(modes.watch_place(k, column)) + of.rate * std::abs(modes.watch_rate(k, column))) * now.left[c];
      };
      for (std::size_t c = 0; c < contents.size(); ++c) {
        swing += part(c);
        now.curve[k] += part(c) * contents[c].of.rate * contents[c].of.rate;
      }
      for (const Index i : phase_->resonant())
        now.curve[k] +=
            std::abs(modes.watch_place(k, i)) * (std::abs(at.curve[i]) + modes.rates[i] * std::abs(at.rate[i])) +
            std::abs(modes.watch_rate(k, i)) * modes.rates[i] * modes.rates[i] *
                (std::abs(at.rate[i]) + modes.rates[i] * std::abs(at.value[i]));
      const double seen = std::max(1e-10 * swing, now.noise[k]);
      for (std::size_t c = 0; c < contents.size(); ++c)
        if (contents[c].of.rate > fastest && part(c) > seen) fastest = contents[c].of.rate;
    }
    now.step = fastest > 0 ? resolution_ / fastest : std::numeric_limits<double>::infinity();
  }

  /// Follows the phase to its end, taking samples on the way; none: the motion is over.
  std::optional<Fall> march() {
    const double last = end_ - phase_->start();
    double tau = 0, impulse = 0;
    Columns here, there;
    Survey now;
    phase_->read(0, here);
    while (true) {
      survey(tau, here, now);
      double next = std::min(tau + now.step, last);
      const bool sampling = sampled_ < grid_.times.size() && grid_.times[sampled_] - phase_->start() <= next;
      if (sampling) next = std::max(tau, grid_.times[sampled_] - phase_->start());
      if (work_ > work_limit)
        throw Stopped{
            "the motion has to be watched too closely for too long: fewer elements, a shorter duration, a "
            "softer stop or some damping"};
      read(next, there);
      const auto fall = next > tau ? first_of(tau, here, next, there, now) : std::nullopt;
      if (fall) return Fall{fall->tau, fall->watch, impulse + pushed(tau, fall->tau)};
      impulse += pushed(tau, next);
      if (sampling) {
        State seen = phase_->state(next);
        do sample(seen, impulse_ + impulse);
        while (sampled_ < grid_.times.size() && grid_.times[sampled_] <= seen.time);
      }
      if (next >= last) {
        impulse_ += impulse;
        return std::nullopt;
      }
      tau = next;
      std::swap(here, there);
    }
  }

  std::optional<Fall> first_of(double from, const Columns& here, double to, const Columns& there, const Survey& now) {
    std::optional<Fall> first;
    for (Index k = 0; k < static_cast<Index>(phase_->modes().watches.size()); ++k) {
      const auto reading = [&](double tau, const Columns& at) {
        return Reading{tau, phase_->watched(k, at), phase_->watched_rate(k, at)};
      };
      const auto read = [&](double tau) {
        this->read(tau, scratch_);
        return reading(tau, scratch_);
      };
      const auto found = first_fall(read, reading(from, here), reading(to, there), 1.5 * now.curve[k], now.noise[k], 4);
      if (found && (!first || *found < first->tau))
        first = Fall{*found, phase_->modes().watches[static_cast<std::size_t>(k)], 0};
    }
    return first;
  }

  /// ∫Σp by Gauss's four points, exact to degree 7 over a step that resolves what is fastest.
  double pushed(double from, double to) {
    const ContactModes& modes = phase_->modes();
    if (to <= from || modes.watches.empty() || !modes.watches.back().closed) return 0;
    constexpr std::array<std::array<double, 2>, 4> gauss = {{{0.0694318442029737124, 0.1739274225687269287},
                                                             {0.3300094782075718676, 0.3260725774312730713},
                                                             {0.6699905217924281324, 0.3260725774312730713},
                                                             {0.9305681557970262876, 0.1739274225687269287}}};
    double sum = 0;
    for (const auto& [place, weight] : gauss) {
      read(from + place * (to - from), scratch_);
      for (Index k = 0; k < static_cast<Index>(modes.watches.size()); ++k) {
        const Watch& watch = modes.watches[static_cast<std::size_t>(k)];
        if (watch.closed) sum += weight * watch.sign * (rigid() ? 1 : at_.spring) * phase_->watched(k, scratch_);
      }
    }
    return sum * (to - from);
  }

  void sample(const State& now, double impulse) {
    const DiscreteProblem& discrete = *problem_.discrete;
    const double t = grid_.times[sampled_++], moved = support(t), rate = support_rate(t);
    double energy = 0.5 * ((mass_root_ * now.rate).squaredNorm() + (stiffness_root_ * now.place).squaredNorm());
    if (!rigid()) {
      const Eigen::VectorXd y = at_.contact * now.place, lower = bound(1, t), upper = bound(-1, t);
      for (Index i = 0; i < y.size(); ++i) {
        const double depth = std::max({0.0, lower[i] - y[i], y[i] - upper[i]});
        energy += 0.5 * at_.spring * depth * depth;
      }
    }
    motion_.tip.push_back(discrete.tip.dot(now.place) + moved);
    motion_.tip_velocity.push_back(discrete.tip.dot(now.rate) + rate);
    motion_.energy.push_back(energy);
    motion_.impulse.push_back(impulse);
    const auto put = [](std::vector<double>& out, const Eigen::VectorXd& values, double add) {
      for (const double value : values) out.push_back(value + add);
    };
    put(motion_.displacement, discrete.places * now.place, moved);
    put(motion_.strain, discrete.strains * now.place, 0);
    put(motion_.velocity, discrete.places * now.rate, rate);
  }

  const ReferenceProblem& problem_;
  const SampleGrid& grid_;
  double resolution_;  // step × fastest rate
  LinearStructure at_;
  Eigen::MatrixXd mass_root_, stiffness_root_;
  ContactModes open_;
  Eigen::MatrixXd reach_, moving_;  // H Z, H X
  Index kernel_ = 0;
  bool massless_ = false;  // the massless modes carry every contact point
  std::map<ContactSet, ContactModes> known_;

  ContactSet set_;
  std::optional<ContactPhase> phase_;
  SampledMotion motion_;
  std::vector<std::string> notes_;
  Columns scratch_;
  Eigen::VectorXd haze_;
  double end_ = 0, impulse_ = 0, travel_ = 0, struck_speed_ = 0;
  std::size_t sampled_ = 0;
  long long work_ = 0;  // columns read
  Index stuck_ = 0;
};

/// Exact in time on the mesh of the case: separates what the time scheme does from what the mesh does.
class EventDrivenSemiDiscrete final : public ReferenceSolver {
 public:
  bool of_the_mesh() const override { return true; }

  ReferenceOrRefusal solve(const ReferenceProblem& problem, const SampleGrid& grid) const override {
    if (!problem.discrete) return Refusal{"the matrices of a mesh are missing: this reference is one of the mesh"};
    if (problem.discrete->mass.rows() > most_dofs)
      return Refusal{
          fmt::format("{} dofs: the exact semi-discrete solution is worked out for at most {}, 20 elements of "
                      "a beam; use fewer elements, or the reference event-driven or self",
                      problem.discrete->mass.rows(), most_dofs)};
    if (!problem.load_constant)
      return Refusal{
          "the load depends on time by a formula: between events only constant and harmonic forces are "
          "exact; use the reference self"};
    if (problem.contact_nonlinear)
      return Refusal{
          "the contact law is not linear: between events the motion is not a sum of modes; use the "
          "reference self"};
    try {
      EventDriven fine(problem, grid, 0.5);
      ReferenceMotion found;
      found.motion = fine.run();
      found.coarser = EventDriven(problem, grid, 2).run();
      found.how = fmt::format(
          "modes of each contact set of the {} dofs, exact between events; events watched twice per "
          "radian of the fastest mode that matters, and polished to round-off",
          problem.discrete->mass.rows());
      found.notes = fine.notes();
      return found;
    } catch (const Stopped& stopped) {
      return Refusal{stopped.sentence};
    }
  }
};

void register_all(Registry& registry) {
  registry.add_reference(
      {.name = "event-driven-semi-discrete",
       .summary = "the semi-discrete motion on the mesh of the case, exact in time between changes of the contact set",
       .text =
           "While the set of closed contact points stays as it is, M w'' + C w' + K w = F + Hᵀp is linear with "
           "constant "
           "coefficients, and its modes are known: closed points are bilateral constraints (rigid law) or springs "
           "(linear compliant law, κ per point), forces are constant or harmonic, and the modes solve it exactly, "
           "under-"
           ", critically and over-damped ones alike. The massless modes of a singular mass follow at once (α = 0) or "
           "relax with rate 1/α; where they carry all contact points, contact opens and closes without any impact and "
           "restitution has no part in it. A single point with inertia rebounds by Newton's law, v⁺ = −e v⁻, and a "
           "bounce below 1e-14 of the highest ends a chattering; several such points under a rigid law are refused. "
           "Events (a gap, a contact force or a penetration that falls below zero) are watched at a step that resolves "
           "the fastest mode that still matters, with a bound of the curvature between, and polished to round-off. "
           "Initial data off the constraint of a singular mass jump to it at t = 0⁺ when α = 0. At most 60 dofs.",
       .source = "Acary and Brogliato (2008), ch. 8 (event-driven schemes); Renard (2010) for contact without inertia; "
                 "modes as M x = μ K x, so that slow ones keep their digits",
       .parameters = {}},
      [](const Parameters&) { return std::make_unique<EventDrivenSemiDiscrete>(); });
}

}  // namespace

RICOCHET_PLUGIN(reference, event_driven_semi_discrete, register_all)
