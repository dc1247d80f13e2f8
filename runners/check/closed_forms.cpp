#include "runners/check/closed_forms.hpp"

#include <algorithm>
#include <cmath>

namespace ricochet::checking {

HarmonicMotion::HarmonicMotion(double m, double c, double k, double constant, std::vector<Term> terms, double w,
                               double v, double start)
    : decay_(c / (2 * m)),
      ringing_(std::sqrt(k / m - decay_ * decay_)),
      rest_(constant / k),
      start_(start),
      response_(std::move(terms)) {
  // (k − mω²)A + cωB = a,  (k − mω²)B − cωA = b for A cos + B sin.
  for (Term& term : response_) {
    const double stiff = k - m * term.pulsation * term.pulsation, damp = c * term.pulsation;
    const double size = stiff * stiff + damp * damp;
    const double cosine = (stiff * term.cosine - damp * term.sine) / size;
    const double sine = (stiff * term.sine + damp * term.cosine) / size;
    term.cosine = cosine;
    term.sine = sine;
  }
  const double w_forced = displacement(start), v_forced = velocity(start);
  along_ = w - w_forced;
  across_ = (v - v_forced + decay_ * along_) / ringing_;
}

double HarmonicMotion::displacement(double t) const {
  const double s = t - start_, angle = ringing_ * s;
  double w = rest_ + std::exp(-decay_ * s) * (along_ * std::cos(angle) + across_ * std::sin(angle));
  for (const Term& term : response_)
    w += term.cosine * std::cos(term.pulsation * t) + term.sine * std::sin(term.pulsation * t);
  return w;
}

double HarmonicMotion::velocity(double t) const {
  const double s = t - start_, angle = ringing_ * s;
  double v = std::exp(-decay_ * s) * ((across_ * ringing_ - decay_ * along_) * std::cos(angle) -
                                      (along_ * ringing_ + decay_ * across_) * std::sin(angle));
  for (const Term& term : response_)
    v += term.pulsation * (term.sine * std::cos(term.pulsation * t) - term.cosine * std::sin(term.pulsation * t));
  return v;
}

MeasuredOrder measured_order(const std::vector<double>& steps, const std::vector<double>& errors, double scale) {
  MeasuredOrder result;
  result.finest = errors.back();
  result.exact = *std::max_element(errors.begin(), errors.end()) <= 1e-11 * scale;
  if (result.exact) return result;
  const std::size_t used = std::min<std::size_t>(3, errors.size()), first = errors.size() - used;
  double x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t i = first; i < errors.size(); ++i) {
    const double a = std::log(steps[i]), b = std::log(std::max(errors[i], 1e-13 * scale));
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  const auto n = static_cast<double>(used);
  result.order = (n * xy - x * y) / (n * xx - x * x);
  return result;
}

}  // namespace ricochet::checking
