#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <ricochet/measure/orbits/judge_orbit.hpp>
#include <ricochet/measure/statistics/quantiles.hpp>
#include <utility>
#include <vector>

namespace ricochet {
namespace {

constexpr std::size_t frequencies = 100, longest_lag = 100;
constexpr double no_variation = 1e-12;  // of a series that does not vary

// Correlation of (1, …, m) with D.
double correlation(const std::vector<double>& D) {
  const double n = static_cast<double>(D.size()), middle = 0.5 * (n - 1);
  double mean = 0, both = 0, squares = 0;
  for (const double d : D) mean += d / n;
  for (std::size_t i = 0; i < D.size(); ++i) {
    both += (static_cast<double>(i) - middle) * (D[i] - mean);
    squares += (D[i] - mean) * (D[i] - mean);
  }
  if (squares == 0) return 0;
  return both / std::sqrt(squares * n * (n * n - 1) / 12);
}

}  // namespace

std::optional<double> zero_one_test(std::span<const double> series, std::uint64_t seed) {
  const std::size_t count = series.size();
  if (count < zero_one_readings) return std::nullopt;
  double mean = 0, largest = 0, spread = 0;
  for (const double x : series) {
    if (!std::isfinite(x)) return std::nullopt;
    mean += x / static_cast<double>(count);
    largest = std::max(largest, std::abs(x));
  }
  for (const double x : series) spread = std::max(spread, std::abs(x - mean));
  if (!std::isfinite(mean)) return std::nullopt;
  if (spread <= no_variation * largest) return 0.0;

  std::mt19937_64 random(seed);
  const std::size_t lags = std::min(count / 10, longest_lag), from = count - lags;
  std::vector<double> p(count + 1), q(count + 1), D(lags), K(frequencies);
  for (double& k : K) {
    const double unit = static_cast<double>(random() >> 11) * 0x1p-53;
    const double c = std::numbers::pi * (0.2 + 0.6 * unit);
    for (std::size_t j = 0; j < count; ++j) {
      const double phi = (series[j] - mean) / spread, angle = c * static_cast<double>(j + 1);
      p[j + 1] = p[j] + phi * std::cos(angle);
      q[j + 1] = q[j] + phi * std::sin(angle);
    }
    for (std::size_t n = 1; n <= lags; ++n) {
      double sum = 0;
      for (std::size_t j = 0; j < from; ++j) {
        const double dp = p[j + n] - p[j], dq = q[j + n] - q[j];
        sum += dp * dp + dq * dq;
      }
      D[n - 1] = sum / static_cast<double>(from);
    }
    k = correlation(D);
  }
  return median(std::move(K));
}

namespace {

using Points = std::vector<std::array<double, 2>>;

// The last round of the strobed orbit and that of its image.
bool is_own_image(const Orbit& orbit, int period, const SectionPlan& plan, double tolerance) {
  Points here, opposite;
  const auto last = static_cast<std::ptrdiff_t>(std::min(orbit.strobed.size(), static_cast<std::size_t>(period)));
  for (auto point = orbit.strobed.end() - last; point != orbit.strobed.end(); ++point) {
    here.push_back({point->displacement, point->velocity});
    opposite.push_back({point->opposite_displacement, point->opposite_velocity});
  }
  return same_cloud(here, opposite, {plan.scale, plan.scale * plan.pulsation}, tolerance);
}

}  // namespace

bool touches(const Orbit& orbit) {
  return orbit.contact_steps > 0;
}

bool rests(const Orbit& orbit) {
  return orbit.rests;
}

double impacts_per_period(const Orbit& orbit) {
  if (orbit.impact_counts.empty()) return 0;
  const double sum = std::accumulate(orbit.impact_counts.begin(), orbit.impact_counts.end(), 0.0);
  return sum / static_cast<double>(orbit.impact_counts.size());
}

OrbitPeriod orbit_period(const Orbit& orbit, const SectionPlan& plan) {
  OrbitPeriod out;
  const std::vector<double> scale = plan.reading_scale();
  double largest = 0;
  for (std::size_t i = 0; i < orbit.readings.values.size(); ++i)
    if (const double unit = scale[i % scale.size()]; unit > 0)
      largest = std::max(largest, std::abs(orbit.readings.values[i]) / unit);
  const double h = 2 * std::numbers::pi / (plan.pulsation * plan.steps_per_period);
  out.placed = plan.scale > 0 ? h * orbit.rebounds / plan.scale : 0;
  out.open = std::min(most_amplified * out.placed, most_left_open * largest);
  out.tolerance = std::max(recurrence_tolerance, out.open / 2);
  out.recurrence = find_recurrence(orbit.readings, scale, out.tolerance);
  if (out.tolerance == recurrence_tolerance) return out;
  const int below = out.recurrence.period > 0 ? out.recurrence.period : longest_period + 1;
  for (int lag = 1; lag < below && out.doubtful == 0; ++lag)
    if (const double apart = lag_distance(orbit.readings, scale, lag); apart < 2 * out.open)
      out.doubtful = lag, out.doubtful_distance = apart;
  return out;
}

bool outlives(const OrbitPeriod& period, const Interval& exponent, const SectionPlan& plan) {
  const Recurrence& r = period.recurrence;
  if (r.period == 0 || period.doubtful > 0 || r.contraction > 1 || r.distance <= recurrence_tolerance) return false;
  const double time = 2 * std::numbers::pi / plan.pulsation * r.window;
  return std::log(r.distance) + exponent.low * time > 0;
}

namespace {

// (3)
double left_open(const OrbitPeriod& period, const std::optional<Interval>& exponent, double forcing_period) {
  const double kept =
      exponent && exponent->high < 0 ? std::exp(exponent->high * forcing_period) : period.recurrence.contraction;
  return std::min(period.open, period.placed / std::max(1 - kept, 1 / most_amplified));
}

}  // namespace

JudgedOrbit judge(const Orbit& orbit, const SectionPlan& plan, const std::optional<Interval>& exponent) {
  JudgedOrbit out;
  if (orbit.stage != Orbit::Stage::complete) return out;
  const OrbitPeriod period = orbit_period(orbit, plan);
  out.recurrence = period.recurrence;
  std::vector<double> displacements;
  for (const SectionPoint& point : orbit.strobed) displacements.push_back(point.displacement);
  out.zero_one = zero_one_test(displacements);
  RegimeInput input;
  input.contact = touches(orbit);
  input.rests = orbit.rests;
  input.sticks = orbit.lasting > 0;
  input.recurrence = out.recurrence;
  input.zero_one = out.zero_one;
  input.shrunk = shrunk_ranges(orbit.readings);
  input.exponent = exponent;
  input.impacts_per_period = impacts_per_period(orbit);
  input.settled = orbit.settled;
  input.tolerance = period.tolerance;
  input.placed = period.placed;
  input.doubtful = period.doubtful;
  input.doubtful_distance = period.doubtful_distance;
  input.forcing_period = 2 * std::numbers::pi / plan.pulsation;
  out.verdict = classify(input);
  out.verdict.open = left_open(period, exponent, input.forcing_period);
  if (out.recurrence.period > 0)
    out.symmetric =
        is_own_image(orbit, out.recurrence.period, plan, std::max(10 * recurrence_tolerance, period.tolerance));
  return out;
}

void keep_end(Orbit& orbit, const SectionPlan& plan) {
  if (orbit.stage == Orbit::Stage::complete && !orbit.verdict) {
    orbit.verdict = judge(orbit, plan, std::nullopt).verdict;
    orbit.verdict->evidence.clear();
    const int wanted = orbit.verdict->period > 0 ? orbit.verdict->period : longest_end;
    const std::size_t first = orbit.strobed.size() - std::min(orbit.strobed.size(), static_cast<std::size_t>(wanted));
    const auto width = static_cast<std::size_t>(orbit.readings.width);
    SectionSeries displacements{.width = 1, .values = {}};
    for (std::size_t i = first; i < orbit.strobed.size(); ++i)
      displacements.values.push_back(orbit.readings.values[i * width]);
    orbit.readings = std::move(displacements);
    orbit.strobed = {orbit.strobed.begin() + static_cast<std::ptrdiff_t>(first), orbit.strobed.end()};
  }
  if (orbit.stage == Orbit::Stage::stopped) {
    orbit.readings = {};
    orbit.strobed = {};
  }
  orbit.points = {};
  orbit.impacts = {};
  orbit.impact_counts = {};
  orbit.settling = {};
  orbit.lane = {};
  orbit.entry = orbit.now = {};
}

std::optional<MotionClass> rough_class(const Orbit& orbit, const SectionPlan& plan) {
  if (orbit.stage != Orbit::Stage::complete) return std::nullopt;
  if (!touches(orbit)) return MotionClass{Regime::no_contact};
  if (orbit.rests) return MotionClass{Regime::at_rest};
  const OrbitPeriod found = orbit_period(orbit, plan);
  const int period = found.doubtful > 0 ? 0 : found.recurrence.period;
  if (period == 0) return MotionClass{Regime::undecided};
  return MotionClass{orbit.lasting > 0 ? Regime::chattering : Regime::periodic, period};
}

}  // namespace ricochet
