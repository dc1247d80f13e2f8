#include "contact_phase.hpp"

#include <cmath>

namespace ricochet::reference {
namespace {

// x₀, x₁, x̄₁, x₂, x̄₂, …
void both_sides(const Eigen::VectorXcd& of, Eigen::VectorXcd& result) {
  result.resize(2 * of.size() - 1);
  result[0] = of[0];
  for (Eigen::Index k = 1; k < of.size(); ++k) {
    result[2 * k - 1] = of[k];
    result[2 * k] = std::conj(of[k]);
  }
}

}  // namespace

ContactPhase::ContactPhase(const LinearStructure& structure, const ContactModes& modes, const State& from)
    : structure_(&structure), modes_(&modes), start_(from.time) {
  exponents_ = structure.sigma();
  both_sides(exponents_, doubled_exponents_);
  const Eigen::VectorXcd entered = (exponents_ * start_).array().exp();
  const Eigen::VectorXd place = from.place - (modes.offset * entered).real();
  const Eigen::VectorXd rate = from.rate - (structure.rate(modes.offset) * entered).real();
  place_ = modes.oscillator_reader * place;
  rate_ = modes.oscillator_reader * rate;
  relaxed_ = modes.place_reader * place + modes.rate_reader * rate;
  force_ = modes.oscillator_force * entered.asDiagonal();
  Eigen::VectorXcd doubled;
  both_sides(entered, doubled);
  relaxing_force_ = modes.relaxation_force * doubled.asDiagonal();
  for (Eigen::Index i = 0; i < place_.size(); ++i) split_oscillator(i);
  for (Eigen::Index j = 0, column = place_.size(); j < relaxed_.size(); ++j) split_relaxation(j, column);
}

void ContactPhase::read(double tau, Columns& at) const {
  const Eigen::Index count = modes_->columns();
  at.value.resize(count);
  at.rate.resize(count);
  at.curve.resize(count);
  at.turned = (exponents_ * tau).array().exp();
  at.phasors = (exponents_ * (start_ + tau)).array().exp();
  if (relaxed_.size() > 0) both_sides(at.turned, at.doubled_turned);
  for (Eigen::Index i = 0; i < place_.size(); ++i) read_oscillator(i, tau, at);
  read_relaxations(tau, place_.size(), at);
}

State ContactPhase::state(double tau) const {
  Columns at;
  read(tau, at);
  State result{start_ + tau, modes_->shapes * at.value, modes_->shapes * at.rate};
  result.place += (modes_->offset * at.phasors).real();
  result.rate += (structure_->rate(modes_->offset) * at.phasors).real();
  return result;
}

double ContactPhase::watched(Eigen::Index row, const Columns& at) const {
  return modes_->watch_place.row(row).dot(at.value) + modes_->watch_rate.row(row).dot(at.rate) +
         std::real((modes_->watch_signal.row(row) * at.phasors).value());
}

double ContactPhase::watched_rate(Eigen::Index row, const Columns& at) const {
  return modes_->watch_place.row(row).dot(at.rate) + modes_->watch_rate.row(row).dot(at.curve) +
         std::real((modes_->watch_signal.row(row) * exponents_.cwiseProduct(at.phasors)).value());
}

double ContactPhase::watched_curve(Eigen::Index row, const Columns& at) const {
  return modes_->watch_place.row(row).dot(at.curve) +
         std::real((modes_->watch_signal.row(row) * exponents_.cwiseAbs2().asDiagonal() * -at.phasors).value());
}

void ContactPhase::split_oscillator(Eigen::Index i) {
  const LinearMode& mode = modes_->oscillators[static_cast<std::size_t>(i)];
  double place = place_[i], rate = rate_[i];
  for (Eigen::Index k = 0; k < exponents_.size(); ++k) {
    if (force_(i, k) == 0.0) continue;
    if (mode.resonates(exponents_[k])) return resonant_.push_back(i);
    const Complex steady = force_(i, k) / mode.detuning(exponents_[k]);
    place -= steady.real();
    rate -= std::real(exponents_[k] * steady);
  }
  for (const auto& one : mode.contents(place, rate))
    if (one.size > 0) contents_.push_back({i, one});
}

void ContactPhase::split_relaxation(Eigen::Index j, Eigen::Index& column) {
  const Complex s = modes_->relaxations[static_cast<std::size_t>(j)];
  Complex value = relaxed_[j];
  for (Eigen::Index k = 0; k < doubled_exponents_.size(); ++k)
    value -= relaxing_force_(j, k) / (doubled_exponents_[k] - s);
  const int columns = modes_->single[static_cast<std::size_t>(j)] ? 1 : 2;
  for (int c = 0; c < columns; ++c) contents_.push_back({column++, {std::abs(s), -s.real(), std::abs(value)}});
}

void ContactPhase::read_oscillator(Eigen::Index i, double tau, Columns& at) const {
  const LinearMode& mode = modes_->oscillators[static_cast<std::size_t>(i)];
  const auto basis = mode.fundamental(tau);
  double value = place_[i] * basis.c + rate_[i] * basis.s;
  double rate = rate_[i] * basis.s_rate - mode.square() * place_[i] * basis.s;
  double push = force_(i, 0).real();
  if (push != 0) {
    value += push * mode.to_constant(tau, basis);
    rate += push * basis.s;
  }
  for (Eigen::Index k = 1; k < exponents_.size(); ++k) {
    if (force_(i, k) == 0.0) continue;
    const auto unit = mode.response(exponents_[k], tau, at.turned[k], basis);
    value += std::real(force_(i, k) * unit.value);
    rate += std::real(force_(i, k) * unit.rate);
    push += std::real(force_(i, k) * at.turned[k]);
  }
  at.value[i] = value;
  at.rate[i] = rate;
  at.curve[i] = push - 2 * mode.decay() * rate - mode.square() * value;
}

// Massless modes relax alike: what depends on s alone is worked out when it changes.
void ContactPhase::read_relaxations(double tau, Eigen::Index column, Columns& at) const {
  Complex before = 0, decay = 1;
  at.answers.resize(doubled_exponents_.size());
  for (Eigen::Index j = 0; j < relaxed_.size(); ++j) {
    const Complex s = modes_->relaxations[static_cast<std::size_t>(j)];
    if (j == 0 || s != before) {
      decay = std::exp(s * tau);
      for (Eigen::Index k = 0; k < doubled_exponents_.size(); ++k)
        at.answers[k] = first_order_response(s, doubled_exponents_[k], tau, at.doubled_turned[k]);
      before = s;
    }
    Complex value = relaxed_[j] * decay, push = 0, change = 0;
    for (Eigen::Index k = 0; k < doubled_exponents_.size(); ++k) {
      const Complex force = relaxing_force_(j, k);
      value += force * at.answers[k];
      push += force * at.doubled_turned[k];
      change += force * doubled_exponents_[k] * at.doubled_turned[k];
    }
    const Complex rate = s * value + push, curve = s * rate + change;
    const auto put = [&](double a, double b, double c) {
      at.value[column] = a;
      at.rate[column] = b;
      at.curve[column++] = c;
    };
    put(value.real(), rate.real(), curve.real());
    if (!modes_->single[static_cast<std::size_t>(j)]) put(value.imag(), rate.imag(), curve.imag());
  }
}

}  // namespace ricochet::reference
