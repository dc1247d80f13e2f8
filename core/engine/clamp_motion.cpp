#include <cmath>
#include <ricochet/engine/clamp_motion.hpp>
#include <utility>

namespace ricochet {

ClampMotion::ClampMotion(double pulsation, int width)
    : pulsation_(pulsation), amplitude_(1, width), cos_phase_(1, width), sin_phase_(1, width) {}

void ClampMotion::place(int lane, double amplitude, double phase) {
  amplitude_.at(0, lane) = amplitude;
  cos_phase_.at(0, lane) = std::cos(phase);
  sin_phase_.at(0, lane) = std::sin(phase);
  phases_ = phases_ || phase != 0;
}

void ClampMotion::set_time(double t) {
  if (t == time_) return;
  time_ = t;
  sine_ = std::sin(pulsation_ * t);
  cosine_ = std::cos(pulsation_ * t);
}

void ClampMotion::offsets(const PhaseWeights& phase, double* out, bool rate) const {
  double s = sine_ * phase.along + cosine_ * phase.across, c = cosine_ * phase.along - sine_ * phase.across;
  if (rate) {
    std::swap(s, c);
    s *= pulsation_;
    c *= -pulsation_;
  }
  for (int lane = 0; lane < amplitude_.lanes(); ++lane)
    out[lane] = amplitude_.at(0, lane) * (phases_ ? s * cos_phase_.at(0, lane) + c * sin_phase_.at(0, lane) : s);
}

void ClampMotion::accelerations(const PhaseWeights& phase, double* out) const {
  offsets(phase, out, false);
  for (int lane = 0; lane < amplitude_.lanes(); ++lane) out[lane] *= pulsation_ * pulsation_;
}

}  // namespace ricochet
