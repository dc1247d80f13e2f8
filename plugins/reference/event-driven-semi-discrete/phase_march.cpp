#include "phase_march.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <ricochet/kernels/eigenvalues.hpp>
#include <utility>

#include "linear_mode.hpp"
#include "linear_structure.hpp"

namespace ricochet::reference {
namespace {

constexpr long long most_work = 300'000'000;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

}  // namespace

void PhaseMarch::begin(const ContactModes& modes, const State& from, int point) {
  phase_.emplace(at_, modes, from);
  const auto& watches = modes.watches;
  haze_.setZero(static_cast<Eigen::Index>(watches.size()));
  phase_->read(0, scratch_);
  for (Eigen::Index k = 0; k < haze_.size(); ++k)
    if (watches[static_cast<std::size_t>(k)].point == point) haze_[k] = -4 * phase_->watched(k, scratch_);
}

void PhaseMarch::read(double tau, Columns& at) {
  work_ += 1 + phase_->modes().columns();
  phase_->read(tau, at);
}

void PhaseMarch::survey(double tau, const Columns& at, Survey& now) const {
  const ContactModes& modes = phase_->modes();
  const auto& contents = phase_->contents();
  now.curve = modes.watch_steady;
  now.noise.resize(now.curve.size());
  now.left.resize(contents.size());
  for (std::size_t c = 0; c < contents.size(); ++c)
    now.left[c] = contents[c].of.size * std::exp(-contents[c].of.decay * tau);
  double fastest = 0;
  for (const Complex& exponent : at_.exponents) fastest = std::max(fastest, std::abs(exponent));
  for (const Eigen::Index i : phase_->resonant()) fastest = std::max(fastest, modes.rates[i]);
  for (Eigen::Index k = 0; k < now.curve.size(); ++k) {
    double swing = 0, size = modes.watch_signal.row(k).cwiseAbs().sum();
    for (Eigen::Index i = 0; i < modes.columns(); ++i)
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
    for (const Eigen::Index i : phase_->resonant())
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

std::optional<Fall> PhaseMarch::march(double impulse_before) {
  const double last = record_.end() - phase_->start();
  double tau = 0, impulse = 0;
  Columns here, there;
  Survey now;
  phase_->read(0, here);
  while (true) {
    survey(tau, here, now);
    double next = std::min(tau + now.step, last);
    const bool sampling = record_.pending() && record_.next() - phase_->start() <= next;
    if (sampling) next = std::max(tau, record_.next() - phase_->start());
    if (work_ > most_work)
      throw Stopped{
          "the motion has to be watched too closely for too long: fewer elements, a shorter duration, a "
          "softer stop or some damping"};
    read(next, there);
    const auto fall = next > tau ? first_of(tau, here, next, there, now) : std::nullopt;
    if (fall) return Fall{fall->tau, fall->watch, impulse + pushed(tau, fall->tau)};
    impulse += pushed(tau, next);
    if (sampling) record_.sample(phase_->state(next), impulse_before + impulse);
    if (next >= last) return std::nullopt;
    tau = next;
    std::swap(here, there);
  }
}

std::optional<Fall> PhaseMarch::first_of(double from, const Columns& here, double to, const Columns& there,
                                         const Survey& now) {
  std::optional<Fall> first;
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(phase_->modes().watches.size()); ++k) {
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

// ∫Σp by Gauss's four points, exact to degree 7 over a step that resolves what is fastest.
double PhaseMarch::pushed(double from, double to) {
  const ContactModes& modes = phase_->modes();
  if (to <= from || modes.watches.empty() || !modes.watches.back().closed) return 0;
  constexpr std::array<std::array<double, 2>, 4> gauss = {{{0.0694318442029737124, 0.1739274225687269287},
                                                           {0.3300094782075718676, 0.3260725774312730713},
                                                           {0.6699905217924281324, 0.3260725774312730713},
                                                           {0.9305681557970262876, 0.1739274225687269287}}};
  double sum = 0;
  for (const auto& [place, weight] : gauss) {
    read(from + place * (to - from), scratch_);
    for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(modes.watches.size()); ++k) {
      const Watch& watch = modes.watches[static_cast<std::size_t>(k)];
      if (watch.closed) sum += weight * watch.sign * (at_.spring == 0 ? 1 : at_.spring) * phase_->watched(k, scratch_);
    }
  }
  return sum * (to - from);
}

namespace {

// R with xᵀA x = |R x|², A positive semidefinite: a small energy is not the difference of large ones.
Eigen::MatrixXd square_root(const Eigen::MatrixXd& A, const Eigen::VectorXd& scale) {
  const SymmetricModes eigen = symmetric_modes(scale.asDiagonal() * A * scale.asDiagonal());
  const double largest = eigen.values.size() ? eigen.values.tail(1)[0] : 0;
  const Eigen::VectorXd roots =
      (eigen.values.array() < 1e-14 * largest).select(0, eigen.values.cwiseMax(0).cwiseSqrt());
  return roots.asDiagonal() * eigen.vectors.transpose() * scale.cwiseInverse().asDiagonal();
}

}  // namespace

MotionRecord::MotionRecord(const ReferenceProblem& problem, const SampleGrid& grid, const LinearStructure& structure)
    : problem_(problem),
      grid_(grid),
      structure_(structure),
      mass_root_(square_root(structure.mass, structure.scale)),
      stiffness_root_(square_root(structure.stiffness, structure.scale)) {}

void MotionRecord::sample(const State& now, double impulse) {
  do sample_one(now, impulse);
  while (pending() && next() <= now.time);
}

void MotionRecord::sample_one(const State& now, double impulse) {
  const DiscreteProblem& discrete = *problem_.discrete;
  const double t = grid_.times[sampled_++], moved = support_at(problem_, t), rate = support_rate_at(problem_, t);
  double energy = 0.5 * ((mass_root_ * now.rate).squaredNorm() + (stiffness_root_ * now.place).squaredNorm());
  if (structure_.spring > 0) {
    const Eigen::VectorXd y = structure_.contact * now.place, lower = structure_.bound_at(1, t),
                          upper = structure_.bound_at(-1, t);
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      const double depth = std::max({0.0, lower[i] - y[i], y[i] - upper[i]});
      energy += 0.5 * structure_.spring * depth * depth;
    }
  }
  motion.tip.push_back(discrete.tip.dot(now.place) + moved);
  motion.tip_velocity.push_back(discrete.tip.dot(now.rate) + rate);
  motion.energy.push_back(energy);
  motion.impulse.push_back(impulse);
  const auto put = [](std::vector<double>& out, const Eigen::VectorXd& values, double add) {
    for (const double value : values) out.push_back(value + add);
  };
  put(motion.displacement, discrete.places * now.place, moved);
  put(motion.strain, discrete.strains * now.place, 0);
  put(motion.velocity, discrete.places * now.rate, rate);
}

}  // namespace ricochet::reference
