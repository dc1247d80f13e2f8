#include <algorithm>
#include <cmath>
#include <optional>
#include <ricochet/measure/orbits/recurrence.hpp>
#include <span>
#include <stdexcept>

namespace ricochet {
namespace {

constexpr double round_off = 1e-13;                    // of relative distances
constexpr double farthest = 1e9;                       // what does not repeat at all
constexpr double significant = 3;                      // standard errors
constexpr double largest_scatter = 0.1;                // relative, around L + A ρ^k
constexpr double stays = 0.9;                          // of a distance at the end of the window: it does not fall
constexpr int fewest_fitted = 8;                       // distances
constexpr double least_decay = 0.05, most_decay = 60;  // −ln ρ times the length of the window

double distance(const double* a, const double* b, const std::vector<double>& scale) {
  double largest = 0;
  for (std::size_t c = 0; c < scale.size(); ++c) {
    const double apart = std::abs(a[c] - b[c]);
    if (apart == 0) continue;
    const double relative = apart / scale[c];
    if (!(relative < farthest)) return farthest;
    largest = std::max(largest, relative);
  }
  return largest;
}

void check(const std::vector<double>& scale, int width) {
  if (static_cast<int>(scale.size()) != width) throw std::invalid_argument("a recurrence needs one scale per column");
  for (const double s : scale)
    if (!(s >= 0) || !std::isfinite(s)) throw std::invalid_argument("scales of a recurrence are finite, 0 or above");
}

/// ln d ≈ a + slope·k over a run of distances.
struct Trend {
  double slope = 0, end = 0;  // per period; the line at the end of the run
  bool rises = false, falls = false;
};

// The longer of the runs above round-off that begin and that end the window.
std::span<const double> above_round_off(std::span<const double> d) {
  std::size_t lead = 0, trail = 0;
  while (lead < d.size() && d[lead] > round_off) ++lead;
  while (trail < d.size() && d[d.size() - 1 - trail] > round_off) ++trail;
  return lead >= trail ? d.first(lead) : d.last(trail);
}

Trend trend_of(std::span<const double> d) {
  const std::span<const double> run = above_round_off(d);
  Trend trend;
  if (run.size() < fewest_fitted) return trend;
  const double n = static_cast<double>(run.size()), middle = 0.5 * (n - 1), sxx = n * (n * n - 1) / 12;
  double mean = 0, sxy = 0, squares = 0;
  for (std::size_t j = 0; j < run.size(); ++j) {
    const double y = std::log(run[j]);
    mean += y / n;
    sxy += (static_cast<double>(j) - middle) * y;
  }
  trend.slope = sxy / sxx;
  for (std::size_t j = 0; j < run.size(); ++j)
    squares += std::pow(std::log(run[j]) - mean - trend.slope * (static_cast<double>(j) - middle), 2);
  const double error = std::sqrt(squares / (n - 2) / sxx);
  trend.end = std::exp(mean + trend.slope * middle);
  trend.rises = trend.slope > significant * error;
  trend.falls = trend.slope < -significant * error;
  return trend;
}

/// d_j ≈ L + A e^{−λj}, relative least squares.
struct Decay {
  double limit = 0, amplitude = 0, rate = 0;
  double squares = HUGE_VAL;
};

Decay decay_at(std::span<const double> d, double rate) {
  double uu = 0, uv = 0, vv = 0, u1 = 0, v1 = 0;
  for (std::size_t j = 0; j < d.size(); ++j) {
    const double u = 1 / d[j], v = std::exp(-rate * static_cast<double>(j)) / d[j];
    uu += u * u, uv += u * v, vv += v * v, u1 += u, v1 += v;
  }
  Decay out;
  out.rate = rate;
  const double determinant = uu * vv - uv * uv;
  if (!(determinant > 1e-14 * uu * vv)) return out;
  out.limit = (u1 * vv - v1 * uv) / determinant;
  out.amplitude = (v1 * uu - u1 * uv) / determinant;
  out.squares = 0;
  for (std::size_t j = 0; j < d.size(); ++j)
    out.squares += std::pow(1 - (out.limit + out.amplitude * std::exp(-rate * static_cast<double>(j))) / d[j], 2);
  return out;
}

/// L with its uncertainty (three standard errors).
struct Limit {
  double value = 0, error = 0;
};

// Of the largest distances of each p periods: the p points of an orbit have amplitudes of their own. Nothing where the
// model does not fit.
std::optional<Limit> limit_of(std::span<const double> window, int p) {
  const std::span<const double> above = above_round_off(window);
  const std::size_t block = static_cast<std::size_t>(p), count = above.size() / block;
  if (count < fewest_fitted) return std::nullopt;
  std::vector<double> d(count);
  const std::span<const double> whole = above.last(count * block);
  for (std::size_t j = 0; j < count; ++j) {
    const auto part = whole.subspan(j * block, block);
    d[j] = *std::max_element(part.begin(), part.end());
  }
  const double length = static_cast<double>(count);
  constexpr int candidates = 48;
  const double ratio = std::pow(most_decay / least_decay, 1.0 / candidates);
  int best = 0;
  Decay found;
  for (int i = 0; i <= candidates; ++i)
    if (const Decay one = decay_at(d, least_decay * std::pow(ratio, i) / length); one.squares < found.squares)
      found = one, best = i;
  if (best == 0 || best == candidates) return std::nullopt;
  double low = found.rate / ratio, high = found.rate * ratio;
  for (int i = 0; i < 60; ++i) {
    const double a = low + 0.382 * (high - low), b = low + 0.618 * (high - low);
    if (decay_at(d, a).squares < decay_at(d, b).squares)
      high = b;
    else
      low = a;
  }
  found = decay_at(d, 0.5 * (low + high));
  const double scatter = std::sqrt(found.squares / (length - 3));
  if (!(scatter <= largest_scatter) || found.amplitude <= 0) return std::nullopt;
  // Normal equations of (L, A, λ): the variance of L is the first entry of their inverse.
  double n[3][3] = {};
  for (std::size_t j = 0; j < d.size(); ++j) {
    const double e = std::exp(-found.rate * static_cast<double>(j));
    const double g[3] = {1 / d[j], e / d[j], -found.amplitude * static_cast<double>(j) * e / d[j]};
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) n[a][b] += g[a] * g[b];
  }
  const double minor = n[1][1] * n[2][2] - n[1][2] * n[1][2];
  const double determinant = n[0][0] * minor - n[0][1] * (n[0][1] * n[2][2] - n[1][2] * n[0][2]) +
                             n[0][2] * (n[0][1] * n[1][2] - n[1][1] * n[0][2]);
  if (!(determinant > 0) || !(minor > 0)) return std::nullopt;
  return Limit{found.limit, significant * scatter * std::sqrt(minor / determinant)};
}

/// The distances of one lag over one window.
struct Lag {
  std::span<const double> d;
  double largest = 0;
  Trend trend;
  std::optional<Limit> limit;  // of what falls

  Lag(std::span<const double> distances, int p) : d(distances), trend(trend_of(distances)) {
    largest = *std::max_element(d.begin(), d.end());
    if (trend.falls) limit = limit_of(d, p);
  }
  double contraction() const { return trend.rises || trend.falls ? std::exp(trend.slope) : 1.0; }
  bool repeats(double tolerance, int window) const {
    if (largest <= tolerance) return !trend.rises || trend.end * std::exp(trend.slope * window) <= tolerance;
    return limit && std::abs(limit->value) + limit->error <= tolerance;
  }
  // Whether it may repeat one day: falling, and not about to stop. Short of that, an exponential through an algebraic
  // decay has a limit as well.
  bool may_repeat() const {
    if (!trend.falls || std::exp(trend.slope * static_cast<double>(d.size())) > stays) return false;
    return !limit || limit->value - limit->error < stays * d.back();
  }
};

bool near(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& scale,
          double tolerance) {
  for (std::size_t c = 0; c < 2; ++c)
    if (!(std::abs(a[c] - b[c]) <= tolerance * scale[c])) return false;
  return true;
}

// Whether every point of `from` has one of `sorted` (by the first column) near it.
bool covered(const std::vector<std::array<double, 2>>& from, const std::vector<std::array<double, 2>>& sorted,
             const std::array<double, 2>& scale, double tolerance) {
  // A little wider than what near() takes, so that round-off of the bounds hides no point.
  const double reach = tolerance * scale[0];
  return std::all_of(from.begin(), from.end(), [&](const auto& point) {
    const double slack = 1e-12 * std::abs(point[0]);
    auto at = std::lower_bound(sorted.begin(), sorted.end(), point[0] - reach - slack,
                               [](const auto& q, double x) { return q[0] < x; });
    for (; at != sorted.end() && (*at)[0] <= point[0] + reach + slack; ++at)
      if (near(point, *at, scale, tolerance)) return true;
    return false;
  });
}

}  // namespace

Recurrence find_recurrence(const SectionSeries& series, const std::vector<double>& scale, double tolerance,
                           int longest) {
  check(scale, series.width);
  const int rows = series.periods();
  Recurrence closest;
  std::vector<std::vector<double>> distances(1);  // per lag
  const auto lag = [&](int p, int window) {
    return Lag(
        std::span<const double>(distances[static_cast<std::size_t>(p)]).last(static_cast<std::size_t>(window - p)), p);
  };
  for (int p = 1; p <= longest && rows >= 2 * p + 8; ++p) {
    std::vector<double>& d = distances.emplace_back();
    for (int k = p; k < rows; ++k) d.push_back(distance(series.row(k), series.row(k - p), scale));
    for (const int window : {rows, (rows + 1) / 2}) {
      if (window < 2 * p + 8) continue;
      const Lag here = lag(p, window);
      if (here.repeats(tolerance, window)) {
        bool shorter = false;
        for (int q = 1; q < p && !shorter; ++q) shorter = p % q == 0 && lag(q, window).may_repeat();
        if (!shorter) return {p, here.largest, here.contraction(), window};
      }
      if (window == rows && (closest.window == 0 || here.largest < closest.distance))
        closest = {0, here.largest, here.contraction(), window};
    }
  }
  return closest;
}

double lag_distance(const SectionSeries& series, const std::vector<double>& scale, int lag) {
  check(scale, series.width);
  if (lag >= series.periods()) return HUGE_VAL;
  double largest = 0;
  for (int k = lag; k < series.periods(); ++k)
    largest = std::max(largest, distance(series.row(k), series.row(k - lag), scale));
  return largest;
}

double shrunk_ranges(const SectionSeries& series) {
  constexpr int thirds = 3;
  const int length = series.periods() / thirds;
  if (length < fewest_fitted) return 1;
  double largest = 0;
  for (int c = 0; c < series.width; ++c) {
    double first = 0, before = HUGE_VAL;
    for (int third = 0; third < thirds; ++third) {
      double low = HUGE_VAL, high = -HUGE_VAL;
      for (int k = 0; k < length; ++k) {
        const double x = series.row(series.periods() - (thirds - third) * length + k)[c];
        low = std::min(low, x);
        high = std::max(high, x);
      }
      if (!(high - low < before)) return 1;
      before = high - low;
      if (third == 0) first = before;
    }
    largest = std::max(largest, before / first);
  }
  return largest;
}

Settling::Settling(std::vector<double> scale_per_column, double relative_tolerance, int longest_lag)
    : scale(std::move(scale_per_column)),
      tolerance(relative_tolerance),
      longest(longest_lag),
      ring(scale.size() * static_cast<std::size_t>(std::max(longest_lag, 0))),
      repeats(static_cast<std::size_t>(std::max(longest_lag, 0)) + 1, 0) {
  check(scale, static_cast<int>(scale.size()));
}

bool Settling::add(const double* row) {
  const std::size_t width = scale.size(), lags = static_cast<std::size_t>(longest);
  const auto slot = [&](long long k) { return ring.data() + static_cast<std::size_t>(k % longest) * width; };
  bool reached = false;
  for (std::size_t p = 1; p <= lags && static_cast<long long>(p) <= periods; ++p) {
    const bool again = distance(row, slot(periods - static_cast<long long>(p)), scale) <= tolerance;
    repeats[p] = again ? repeats[p] + 1 : 0;
    reached = reached || repeats[p] >= static_cast<int>(std::max<std::size_t>(p, 4)) + 4;
  }
  if (longest > 0) std::copy(row, row + width, slot(periods));
  ++periods;
  return reached;
}

int Settling::period() const {
  for (int p = 1; p < static_cast<int>(repeats.size()); ++p)
    if (repeats[static_cast<std::size_t>(p)] >= std::max(p, 4) + 4) return p;
  return 0;
}

void Settling::clear() {
  std::fill(repeats.begin(), repeats.end(), 0);
  periods = 0;
}

bool same_cloud(const std::vector<std::array<double, 2>>& a, const std::vector<std::array<double, 2>>& b,
                const std::array<double, 2>& scale, double tolerance) {
  for (const auto* cloud : {&a, &b})
    for (const auto& point : *cloud)
      if (!std::isfinite(point[0]) || !std::isfinite(point[1])) return false;
  std::vector<std::array<double, 2>> sorted_a = a, sorted_b = b;
  std::sort(sorted_a.begin(), sorted_a.end());
  std::sort(sorted_b.begin(), sorted_b.end());
  return covered(a, sorted_b, scale, tolerance) && covered(b, sorted_a, scale, tolerance);
}

}  // namespace ricochet
