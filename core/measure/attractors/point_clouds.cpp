#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <ricochet/measure/attractors/attractors.hpp>

namespace ricochet {
namespace {

constexpr std::size_t kDirections = 8, kExact = 16, kLargest = 64, kBlocks = 10, kFewest = 20;
constexpr std::size_t kDraws = 19, kLanes = 20;  // draws, and with one of weight 0 to fill a vector
constexpr double kInfinite = std::numeric_limits<double>::infinity();

using Points = std::span<const CloudPoint>;

double length(const CloudPoint& a, const CloudPoint& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}

bool finite(const CloudPoint& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]);
}

const std::array<CloudPoint, kDirections>& directions() {
  static const auto all = [] {
    std::array<CloudPoint, kDirections> out;
    for (std::size_t k = 0; k < kDirections; ++k) {
      const double angle = std::numbers::pi * (static_cast<double>(k) + 0.5) / kDirections;
      out[k] = {std::cos(angle), std::sin(angle)};
    }
    return out;
  }();
  return all;
}

double projection(const CloudPoint& p, const CloudPoint& direction) {
  return p[0] * direction[0] + p[1] * direction[1];
}

std::vector<double> sorted_slices(Points points) {
  std::vector<double> out;
  out.reserve(kDirections * points.size());
  for (const CloudPoint& direction : directions()) {
    const std::size_t first = out.size();
    for (const CloudPoint& p : points) out.push_back(projection(p, direction));
    std::sort(out.begin() + static_cast<std::ptrdiff_t>(first), out.end());
  }
  return out;
}

// ∫ |F_a − F_b| of two sorted samples.
double line_distance(std::span<const double> a, std::span<const double> b) {
  const double na = static_cast<double>(a.size()), nb = static_cast<double>(b.size());
  double sum = 0;
  if (a.size() == b.size()) {
    for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
    return sum / na;
  }
  std::size_t i = 0, j = 0;
  double last = std::min(a[0], b[0]);
  while (i < a.size() || j < b.size()) {
    const bool left = j == b.size() || (i < a.size() && a[i] <= b[j]);
    const double next = left ? a[i] : b[j];
    sum += (next - last) * std::abs(static_cast<double>(i) / na - static_cast<double>(j) / nb);
    last = next;
    ++(left ? i : j);
  }
  return sum;
}

double slices_distance(std::span<const double> a, std::span<const double> b) {
  const std::size_t n = a.size() / kDirections, m = b.size() / kDirections;
  double sum = 0;
  for (std::size_t k = 0; k < kDirections; ++k) sum += line_distance(a.subspan(k * n, n), b.subspan(k * m, m));
  return std::numbers::pi / 2 * sum / kDirections;
}

double distance(Points a, Points b, std::span<const double> a_slices, std::span<const double> b_slices) {
  if (std::min(a.size(), b.size()) <= kExact) return exact_wasserstein(a, b);
  if (a_slices.empty() || b_slices.empty()) return sliced_wasserstein(a, b);
  return slices_distance(a_slices, b_slices);
}

std::vector<CloudPoint> scaled(Points points, const CloudPoint& scale) {
  std::vector<CloudPoint> out;
  for (const CloudPoint& p : points)
    if (finite(p)) out.push_back({p[0] / scale[0], p[1] / scale[1]});
  return out;
}

std::vector<CloudPoint> even_sample(Points points, std::size_t count) {
  std::vector<CloudPoint> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(points[i * points.size() / count]);
  return out;
}

std::size_t sample_size(std::size_t run) {
  return std::clamp<std::size_t>(run / 2, 1, kLargest);
}

// Which half each block goes to: the first draw is the first half against the second.
const std::array<std::array<bool, kBlocks>, kDraws>& draws() {
  static const auto all = [] {
    std::array<std::array<bool, kBlocks>, kDraws> out;
    std::mt19937_64 random(1);
    for (auto& draw : out) {
      for (std::size_t k = 0; k < kBlocks; ++k) draw[k] = k >= kBlocks / 2;
      if (&draw == &out[0]) continue;
      for (std::size_t k = kBlocks; k-- > 1;) std::swap(draw[k], draw[random() % (k + 1)]);
    }
    return out;
  }();
  return all;
}

std::size_t block_of(std::size_t i, std::size_t count) {
  return i * kBlocks / count;
}

// The largest sliced distance of the halves of `pool`, over the draws; every other point's slices go to `slices`.
double null_by_slices(Points pool, std::vector<double>* slices) {
  using PerDraw = std::array<double, kLanes>;
  std::array<std::size_t, kBlocks> block_sizes{};
  std::vector<std::uint32_t> block(pool.size());
  for (std::size_t i = 0; i < pool.size(); ++i) {
    block[i] = static_cast<std::uint32_t>(block_of(i, pool.size()));
    ++block_sizes[block[i]];
  }
  std::array<PerDraw, kBlocks> weights{};
  for (std::size_t d = 0; d < kDraws; ++d) {
    const auto& draw = draws()[d];
    std::array<std::size_t, 2> sizes{};
    for (std::size_t k = 0; k < kBlocks; ++k) sizes[draw[k]] += block_sizes[k];
    for (std::size_t k = 0; k < kBlocks; ++k)
      weights[k][d] = (draw[k] ? -1.0 : 1.0) / static_cast<double>(sizes[draw[k]]);
  }
  PerDraw sums{};
  std::vector<std::pair<double, std::uint32_t>> sorted(pool.size());
  for (const CloudPoint& direction : directions()) {
    for (std::size_t i = 0; i < pool.size(); ++i)
      sorted[i] = {projection(pool[i], direction), static_cast<std::uint32_t>(i)};
    std::sort(sorted.begin(), sorted.end());
    if (slices)
      for (const auto& [value, i] : sorted)
        if (i % 2 == 0) slices->push_back(value);
    PerDraw gaps{};
    for (std::size_t i = 0; i + 1 < sorted.size(); ++i) {
      const PerDraw& weight = weights[block[sorted[i].second]];
      const double width = sorted[i + 1].first - sorted[i].first;
      for (std::size_t d = 0; d < kLanes; ++d) {
        gaps[d] += weight[d];
        sums[d] += std::abs(gaps[d]) * width;
      }
    }
  }
  return std::numbers::pi / 2 * *std::max_element(sums.begin(), sums.end()) / kDirections;
}

struct Halves {
  std::vector<CloudPoint> first, second;
};

Halves halves(Points pool, const std::array<bool, kBlocks>& draw) {
  Halves out;
  for (std::size_t i = 0; i < pool.size(); ++i)
    (draw[block_of(i, pool.size())] ? out.second : out.first).push_back(pool[i]);
  return out;
}

}  // namespace

double exact_wasserstein(Points a, Points b) {
  const std::size_t n = a.size(), m = b.size();
  const std::size_t common = std::gcd(n, m);
  std::vector<std::size_t> supply(n, m / common), demand(m, n / common), flow(n * m, 0);
  std::vector<double> cost(n * m);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < m; ++j) cost[i * m + j] = length(a[i], b[j]);
  if (n == 1 || m == 1) return std::accumulate(cost.begin(), cost.end(), 0.0) / static_cast<double>(n * m);
  // Nodes 0 … n−1 are the points of a, n … n+m−1 those of b. Reduced costs stay ≥ 0.
  std::vector<double> potential(n + m, 0), far(n + m);
  std::vector<std::size_t> before(n + m);
  std::vector<char> done(n + m);
  const std::size_t none = n + m;
  std::size_t left = n * (m / common);
  while (left > 0) {
    for (std::size_t k = 0; k < n + m; ++k) {
      far[k] = k < n && supply[k] > 0 ? 0 : kInfinite;
      before[k] = none;
      done[k] = 0;
    }
    std::size_t end = none;
    while (true) {
      std::size_t at = none;
      for (std::size_t k = 0; k < n + m; ++k)
        if (!done[k] && (at == none || far[k] < far[at])) at = k;
      done[at] = 1;
      if (at >= n && demand[at - n] > 0) {
        end = at;
        break;
      }
      const auto relax = [&](std::size_t to, double step) {
        const double through = far[at] + std::max(0.0, step + potential[at] - potential[to]);
        if (!done[to] && through < far[to]) {
          far[to] = through;
          before[to] = at;
        }
      };
      if (at < n)
        for (std::size_t j = 0; j < m; ++j) relax(n + j, cost[at * m + j]);
      else
        for (std::size_t i = 0; i < n; ++i)
          if (flow[i * m + at - n] > 0) relax(i, -cost[i * m + at - n]);
    }
    for (std::size_t k = 0; k < n + m; ++k) potential[k] += std::min(far[k], far[end]);
    std::size_t amount = demand[end - n], start = end;
    for (std::size_t k = end; before[k] != none; k = start = before[k])
      if (k < n) amount = std::min(amount, flow[k * m + before[k] - n]);
    amount = std::min(amount, supply[start]);
    for (std::size_t k = end; before[k] != none; k = before[k]) {
      if (k >= n)
        flow[before[k] * m + k - n] += amount;
      else
        flow[k * m + before[k] - n] -= amount;
    }
    supply[start] -= amount;
    demand[end - n] -= amount;
    left -= amount;
  }
  double total = 0;
  for (std::size_t k = 0; k < n * m; ++k) total += static_cast<double>(flow[k]) * cost[k];
  return total / static_cast<double>(n * (m / common));
}

double sliced_wasserstein(Points a, Points b) {
  return slices_distance(sorted_slices(a), sorted_slices(b));
}

double hausdorff_distance(Points a, Points b) {
  const auto farthest = [](Points from, Points to) {
    double worst = 0;
    for (const CloudPoint& p : from) {
      double nearest = kInfinite;
      for (const CloudPoint& q : to) {
        const double x = p[0] - q[0], v = p[1] - q[1];
        nearest = std::min(nearest, x * x + v * v);
        if (nearest <= worst) break;
      }
      worst = std::max(worst, nearest);
    }
    return worst;
  };
  return std::sqrt(std::max(farthest(a, b), farthest(b, a)));
}

SectionCloud make_cloud(Points run, Points opposite, const CloudPoint& scale, int cycle, double open) {
  SectionCloud cloud;
  std::vector<CloudPoint> points = scaled(run, scale), mirrored = scaled(opposite, scale);
  if (points.empty()) return cloud;
  if (mirrored.size() != points.size()) mirrored.clear();
  if (cycle > 0) {
    const std::size_t length = std::min(static_cast<std::size_t>(cycle), std::min(points.size(), kLargest));
    cloud.points.assign(points.end() - static_cast<std::ptrdiff_t>(length), points.end());
    if (!mirrored.empty()) cloud.opposite.assign(mirrored.end() - static_cast<std::ptrdiff_t>(length), mirrored.end());
    cloud.null = open / scale[0];
    return cloud;
  }
  const std::size_t count = sample_size(points.size());
  if (points.size() < kFewest) {
    cloud.points = even_sample(points, count);
    cloud.slices = sorted_slices(cloud.points);
  } else {
    const std::vector<CloudPoint> pool = even_sample(points, 2 * count);
    for (std::size_t i = 0; i < pool.size(); i += 2) cloud.points.push_back(pool[i]);
    cloud.null = null_by_slices(pool, &cloud.slices);
  }
  if (!mirrored.empty()) {
    cloud.opposite = even_sample(mirrored, count);
    cloud.opposite_slices = sorted_slices(cloud.opposite);
  }
  return cloud;
}

std::vector<CloudPoint> distinct_points(Points points, double tolerance) {
  std::vector<CloudPoint> out;
  for (const CloudPoint& p : points)
    if (finite(p) && std::none_of(out.begin(), out.end(), [&](const auto& q) { return length(p, q) <= tolerance; }))
      out.push_back(p);
  return out;
}

bool compared_exactly(const SectionCloud& a, const SectionCloud& b) {
  return std::min(a.points.size(), b.points.size()) <= kExact;
}

double cloud_distance(const SectionCloud& a, const SectionCloud& b) {
  if (a.empty() || b.empty()) return a.empty() && b.empty() ? 0 : kInfinite;
  double least = distance(a.points, b.points, a.slices, b.slices);
  if (!b.opposite.empty()) least = std::min(least, distance(a.points, b.opposite, a.slices, b.opposite_slices));
  if (!a.opposite.empty()) least = std::min(least, distance(a.opposite, b.points, a.opposite_slices, b.slices));
  return least;
}

double cloud_hausdorff(const SectionCloud& a, const SectionCloud& b) {
  if (a.empty() || b.empty()) return a.empty() && b.empty() ? 0 : kInfinite;
  double least = hausdorff_distance(a.points, b.points);
  if (!b.opposite.empty()) least = std::min(least, hausdorff_distance(a.points, b.opposite));
  if (!a.opposite.empty()) least = std::min(least, hausdorff_distance(a.opposite, b.points));
  return least;
}

HalvesNull null_of_halves(Points run, const CloudPoint& scale, int cycle) {
  const std::vector<CloudPoint> points = scaled(run, scale);
  HalvesNull out;
  if (cycle > 0) {
    const std::size_t length = static_cast<std::size_t>(cycle);
    if (points.size() < 2 * length || length > kLargest) return out;
    const Points all(points);
    out.wasserstein = exact_wasserstein(all.first(length), all.last(length));
    out.hausdorff = hausdorff_distance(all.first(length), all.last(length));
    return out;
  }
  if (points.size() < kFewest) return out;
  const std::vector<CloudPoint> pool = even_sample(points, 2 * sample_size(points.size()));
  out.wasserstein = null_by_slices(pool, nullptr);
  for (const auto& draw : draws()) {
    const Halves split = halves(pool, draw);
    out.hausdorff = std::max(out.hausdorff, hausdorff_distance(split.first, split.second));
  }
  return out;
}

void ScaleOfPoints::add(const CloudPoint& point) {
  if (!finite(point)) return;
  ++count_;
  for (std::size_t c = 0; c < 2; ++c) {
    const double change = point[c] - mean_[c];
    mean_[c] += change / static_cast<double>(count_);
    squares_[c] += change * (point[c] - mean_[c]);
    largest_[c] = std::max(largest_[c], std::abs(point[c]));
  }
}

CloudPoint ScaleOfPoints::scale() const {
  CloudPoint out = {1, 1};
  for (std::size_t c = 0; c < 2; ++c) {
    const double spread = count_ > 0 ? std::sqrt(squares_[c] / static_cast<double>(count_)) : 0;
    if (spread > 1e-9 * largest_[c])
      out[c] = spread;
    else if (largest_[c] > 0)
      out[c] = largest_[c];
  }
  return out;
}

}  // namespace ricochet
