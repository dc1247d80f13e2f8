#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <ricochet/measure/motion/motion_errors.hpp>
#include <stdexcept>

namespace ricochet {
namespace {

// A sample time within this share of the horizon counts as being on it.
constexpr double rounding = 1e-9;

class Comparison {
 public:
  Comparison(const SampledMotion& motion, const SampledMotion& reference, const SampleGrid& grid, double horizon)
      : a_(motion), b_(reference), grid_(grid), horizon_(horizon) {
    while (times_ < grid.times.size() && grid.times[times_] <= horizon * (1 + rounding)) ++times_;
  }

  bool complete() const { return a_.tip.size() >= times_ && b_.tip.size() >= times_ && times_ >= 2; }

  MotionError measure(const std::string& name) const {
    MotionError error{name, std::nullopt, ""};
    if (!complete()) {
      error.reason = times_ < 2 ? "fewer than two samples lie within the horizon"
                                : fmt::format("the motion ends at t = {:.6g} s, before the horizon of {:.6g} s",
                                              reached(), horizon_);
      return error;
    }
    if (name == "tip-linf") {
      error.value = largest(a_.tip, b_.tip);
    } else if (name == "tip-l2") {
      error.value = std::sqrt(mean([&](std::size_t k) { return squared(a_.tip[k] - b_.tip[k]); }));
    } else if (name == "displacement-l2") {
      error.value = grid_.places.empty() ? measure("tip-l2").value : field(a_.displacement, b_.displacement);
    } else if (name == "displacement-h2") {
      if (grid_.places.empty())
        error.reason = "an oscillator has no strain";
      else
        error.value = field(a_.strain, b_.strain);
    } else if (name == "velocity-l2") {
      error.value =
          grid_.places.empty()
              ? std::sqrt(mean([&](std::size_t k) { return squared(a_.tip_velocity[k] - b_.tip_velocity[k]); }))
              : field(a_.velocity, b_.velocity);
    } else if (name == "energy") {
      error.value = mean([&](std::size_t k) { return std::abs(a_.energy[k] - b_.energy[k]); });
    } else if (name == "impulse") {
      error.value = largest(a_.impulse, b_.impulse);
      const auto none = [](const SampledMotion& motion) {
        return std::all_of(motion.impulse.begin(), motion.impulse.end(), [](double value) { return value == 0; });
      };
      if (none(a_) && none(b_)) {
        error.value.reset();
        error.reason = no_contact;
      }
    } else if (name == "impact-times") {
      impact_times(error);
    } else {
      throw std::logic_error("no such error: " + name);
    }
    if (error.value && !std::isfinite(*error.value)) {
      error.value.reset();
      error.reason = "the difference is not finite";
    }
    return error;
  }

 private:
  static double squared(double x) { return x * x; }
  double reached() const {
    const std::size_t samples = std::min({a_.tip.size(), b_.tip.size(), grid_.times.size()});
    return samples == 0 ? 0 : grid_.times[samples - 1];
  }

  double largest(const std::vector<double>& a, const std::vector<double>& b) const {
    double most = 0;
    for (std::size_t k = 0; k < times_; ++k) {
      const double difference = std::abs(a[k] - b[k]);
      if (!(difference <= most)) most = difference;
    }
    return most;
  }

  // 1/T ∫ f dt by the trapezoidal rule.
  double mean(const std::function<double(std::size_t)>& f) const {
    double sum = 0;
    for (std::size_t k = 0; k + 1 < times_; ++k) sum += 0.5 * (grid_.times[k + 1] - grid_.times[k]) * (f(k) + f(k + 1));
    return sum / (grid_.times[times_ - 1] - grid_.times[0]);
  }

  double field(const std::vector<double>& a, const std::vector<double>& b) const {
    const std::size_t places = grid_.places.size();
    return std::sqrt(mean([&](std::size_t k) {
      double sum = 0;
      for (std::size_t i = 0; i < places; ++i) sum += grid_.weights[i] * squared(a[k * places + i] - b[k * places + i]);
      return sum;
    }));
  }

  static const char* name_of(int side) { return side < 0 ? "lower" : "upper"; }

  /// From when to when a motion touches the stops.
  struct Touch {
    int side = 0;
    double from = 0, to = 0;
  };
  static std::vector<Touch> touches(const SampledMotion& motion) {
    std::vector<Touch> all;
    for (const ContactEvent& event : motion.events) {
      if (event.begins) {
        all.push_back({event.side, event.time, event.time});
        continue;
      }
      const auto last =
          std::find_if(all.rbegin(), all.rend(), [&](const Touch& one) { return one.side == event.side; });
      if (last != all.rend()) last->to = event.time;
    }
    return all;
  }

  /// The largest distance from an impact within the horizon to the nearest of `among` on its side; −1 of no impact,
  /// infinite where that side has none, and then `lonely` is the impact.
  template <class Distance>
  double farthest(const std::vector<Touch>& impacts, const std::vector<Touch>& among, Touch& lonely,
                  Distance distance) const {
    double most = -1;
    for (const Touch& one : impacts) {
      if (one.from > horizon_) continue;
      double nearest = std::numeric_limits<double>::infinity();
      for (const Touch& other : among)
        if (other.side == one.side) nearest = std::min(nearest, distance(one, other));
      most = std::max(most, nearest);
      if (!std::isinf(nearest)) continue;
      lonely = one;
      break;
    }
    return most;
  }

  // Each impact of the reference has to be met, and each of the motion to be one of the reference.
  void impact_times(MotionError& error) const {
    const std::vector<Touch> found = touches(a_), expected = touches(b_);
    Touch lonely;
    const double missed = farthest(
        expected, found, lonely, [](const Touch& one, const Touch& other) { return std::abs(other.from - one.from); });
    if (std::isinf(missed)) {
      error.reason = fmt::format("no impact on the {} stop, which the reference first hits at t = {:.6g} s",
                                 name_of(lonely.side), lonely.from);
      return;
    }
    const double added = farthest(found, expected, lonely, [](const Touch& one, const Touch& other) {
      return std::max({0.0, other.from - one.from, one.from - other.to});
    });
    if (std::isinf(added))
      error.reason = fmt::format("an impact on the {} stop at t = {:.6g} s, which the reference never hits",
                                 name_of(lonely.side), lonely.from);
    else if (const double most = std::max(missed, added); most >= 0)
      error.value = most;
    else
      error.reason = found.empty() && expected.empty() ? no_contact : "neither motion has an impact within the horizon";
  }

  const SampledMotion& a_;
  const SampledMotion& b_;
  const SampleGrid& grid_;
  double horizon_;
  std::size_t times_ = 0;
};

}  // namespace

std::vector<MotionError> motion_errors(const SampledMotion& motion, const SampledMotion& reference,
                                       const SampleGrid& grid, double horizon, const std::vector<std::string>& names) {
  const Comparison comparison(motion, reference, grid, horizon);
  std::vector<MotionError> errors;
  for (const std::string& name : names) errors.push_back(comparison.measure(name));
  return errors;
}

std::vector<MotionSize> motion_sizes(const SampledMotion& reference, const SampleGrid& grid, double horizon,
                                     const std::vector<std::string>& names) {
  SampledMotion rest = reference;
  for (auto* series :
       {&rest.tip, &rest.tip_velocity, &rest.energy, &rest.impulse, &rest.displacement, &rest.strain, &rest.velocity})
    std::fill(series->begin(), series->end(), 0.0);
  double displacement = 0;
  for (const auto* series : {&reference.tip, &reference.displacement})
    for (const double value : *series) displacement = std::max(displacement, std::abs(value));
  std::vector<MotionSize> sizes;
  for (const MotionError& error : motion_errors(rest, reference, grid, horizon, names)) {
    const double size = error.name == "impact-times" ? horizon : error.value.value_or(0);
    const bool tip = error.name == "tip-linf" || error.name == "tip-l2";
    sizes.push_back({size, std::numeric_limits<double>::epsilon() * (tip ? displacement : size)});
  }
  return sizes;
}

double common_horizon(const SampledMotion& a, const SampledMotion& b, const SampleGrid& grid, double share) {
  double size = 0;
  for (const double tip : a.tip) size = std::max(size, std::abs(tip));
  const std::size_t samples = std::min(a.tip.size(), b.tip.size());
  for (std::size_t k = 0; k < samples; ++k)
    if (!(std::abs(a.tip[k] - b.tip[k]) <= share * size)) return grid.times[k];
  return samples == 0 ? 0 : grid.times[samples - 1];
}

SampledMotion extrapolated(const SampledMotion& fine, const SampledMotion& coarse, double ratio, double order) {
  const double factor = 1 / (std::pow(ratio, order) - 1);
  SampledMotion result = fine;
  const auto improve = [&](std::vector<double>& out, const std::vector<double>& other) {
    const std::size_t common = std::min(out.size(), other.size());
    for (std::size_t i = 0; i < common; ++i) out[i] += factor * (out[i] - other[i]);
  };
  improve(result.tip, coarse.tip);
  improve(result.tip_velocity, coarse.tip_velocity);
  improve(result.energy, coarse.energy);
  improve(result.impulse, coarse.impulse);
  improve(result.displacement, coarse.displacement);
  improve(result.strain, coarse.strain);
  improve(result.velocity, coarse.velocity);
  bool same = fine.events.size() == coarse.events.size();
  for (std::size_t i = 0; same && i < fine.events.size(); ++i)
    same = fine.events[i].side == coarse.events[i].side && fine.events[i].begins == coarse.events[i].begins;
  for (std::size_t i = 0; same && i < fine.events.size(); ++i)
    result.events[i].time += factor * (fine.events[i].time - coarse.events[i].time);
  return result;
}

}  // namespace ricochet
