#include <algorithm>
#include <bit>
#include <cmath>
#include <ricochet/engine/flight/clear_steps.hpp>

namespace ricochet {
namespace {

constexpr int block = StepReadings::block;
constexpr long long least_leap = 4;  // below it steps are read one by one

// The largest whole k with g − k s > 0 or g + k d − ½ k (k−1) z > 0: steps that cannot use up g, of what changes by d
// in the next of them, at most by s in any, and its change by z.
double steps_within(double g, double d, double s, double z) {
  const double by_pace = g / s, slope = d + 0.5 * z, by_bend = (slope + std::sqrt(slope * slope + 2 * z * g)) / z;
  const double most = std::max(by_pace, by_bend);
  return most > 0 ? std::floor(0.999 * most) : 0.0;
}

}  // namespace

const StepReadings& ClearSteps::readings(int watch) {
  readings_.resize(static_cast<std::size_t>(bound_.watches()));
  auto& made = readings_[static_cast<std::size_t>(watch)];
  if (!made) made = std::make_unique<StepReadings>(rows_, bound_.watch(watch), bound_.row(watch, 0));
  return *made;
}

void ClearSteps::advance(long long k) {
  motion_.advance(k, x_.data(), e_);
}

long long ClearSteps::count(const std::vector<double>& x, const double* e, long long most, long long& pace) {
  x_ = x;
  std::copy_n(e, 3, e_);
  long long done = 0;
  while (done < most) {
    const long long left = std::min(most - done, bound_.longest());
    bound_.look(x_.data(), e_);
    long long k = std::min(pace, left);
    bool all = bound_.holds(k);
    if (all) {
      while (k < left && bound_.holds(std::min(2 * k, left))) k = std::min(2 * k, left);
    } else {
      while (!bound_.find_exposed(k, exposed_, k > block ? few : static_cast<std::size_t>(-1))) k /= 2;
      all = exposed_.empty();
    }
    pace = std::max<long long>(k, block);
    if (all) {
      if (done + k < most) advance(k);
      done += k;
      continue;
    }
    const long long clear = follow(k);
    if (clear < k) return done + clear;
    done += k;
    pace = 2 * k;
  }
  return done;
}

// Goes on by up to `steps` steps, as long as the exposed points are between their bounds in each; the bound has looked
// at where they begin. Returns over how many they are; −1: not in the first.
long long ClearSteps::follow(long long steps) {
  paces_.clear();
  for (const auto& [watch, point] : exposed_) paces_.push_back(bound_.pace(watch, point));
  modes_.resize(2 * static_cast<std::size_t>(motion_.modes()));
  long long gone = 0;
  while (gone < steps) {
    long long leap = std::min(steps - gone, leap_ahead());
    if (leap < 0) return gone - 1;
    if (leap >= least_leap) {
      // Of few powers of two.
      const int low = std::bit_width(static_cast<unsigned long long>(leap)) - 2;
      leap = leap >> low << low;
    } else {
      leap = std::min<long long>(block, steps - gone);
      if (const int reached = read(static_cast<int>(leap)); reached > 0) return gone + reached - 1;
    }
    advance(leap);
    gone += leap;
  }
  return steps;
}

// How many steps the exposed points stay between their bounds from here on: by where they are, how far they go in the
// next step, and what steps can do at most. −1: one of them is not between them.
long long ClearSteps::leap_ahead() {
  double least = static_cast<double>(motion_.longest());
  double *const now = modes_.data(), *const next = now + motion_.modes();
  int read = -1;
  for (std::size_t i = 0; i < exposed_.size(); ++i) {
    const auto& [watch, point] = exposed_[i];
    const StepReadings& readings = this->readings(watch);
    if (watch != read) {
      readings.modes(0, x_.data(), e_, now);
      readings.modes(1, x_.data(), e_, next);
    }
    read = watch;
    const FlightWatch& bounds = bound_.watch(watch);
    const auto at = static_cast<std::size_t>(point);
    const auto& [step, bend, margin] = paces_[i];
    const double value = readings.value(point, 0, now, e_), change = readings.value(point, 1, next, e_) - value;
    // Its round-off counts once a step.
    const double slower = 1e-3 * margin;
    const double below = value - bounds.lower[at] - margin, above = bounds.upper[at] - value - margin;
    if (!(below > 0 && above > 0)) return -1;
    least = std::min(
        {least, steps_within(below, change - slower, step, bend), steps_within(above, -change - slower, step, bend)});
  }
  return static_cast<long long>(least);
}

// The first of the steps that begin 1 to `steps` steps on in which an exposed point is not strictly between its bounds;
// −1: none.
int ClearSteps::read(int steps) {
  for (int step = 1; step <= steps; ++step) {
    int read = -1;
    for (std::size_t i = 0; i < exposed_.size(); ++i) {
      const auto& [watch, point] = exposed_[i];
      const StepReadings& readings = this->readings(watch);
      if (watch != read) readings.modes(step, x_.data(), e_, modes_.data());
      read = watch;
      const double value = readings.value(point, step, modes_.data(), e_), margin = paces_[i].margin;
      const FlightWatch& bounds = bound_.watch(watch);
      const auto at = static_cast<std::size_t>(point);
      if (!(value - margin > bounds.lower[at] && value + margin < bounds.upper[at])) return step;
    }
  }
  return -1;
}

}  // namespace ricochet
