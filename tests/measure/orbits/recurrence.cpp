// What repeats, what arrives, what leaves and what never returns, on maps whose answer is known.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <ricochet/measure/orbits/recurrence.hpp>

#include "tests/allocations.hpp"

using namespace ricochet;

namespace {

constexpr double tolerance = 1e-6;

SectionSeries series_of(int rows, const std::function<std::vector<double>(int)>& row) {
  SectionSeries series;
  for (int k = 0; k < rows; ++k) {
    const std::vector<double> x = row(k);
    series.width = static_cast<int>(x.size());
    series.values.insert(series.values.end(), x.begin(), x.end());
  }
  return series;
}

SectionSeries scalar(int rows, const std::function<double(int)>& x) {
  return series_of(rows, [&](int k) { return std::vector<double>{x(k)}; });
}

/// x ← r x (1 − x), after a transient.
SectionSeries logistic(double r, int rows, int transient = 5000) {
  double x = 0.4;
  for (int k = 0; k < transient; ++k) x = r * x * (1 - x);
  return scalar(rows, [&](int) {
    const double now = x;
    x = r * x * (1 - x);
    return now;
  });
}

Recurrence recurrence(const SectionSeries& series, double within = tolerance) {
  return find_recurrence(series, std::vector<double>(static_cast<std::size_t>(series.width), 1.0), within);
}

}  // namespace

TEST_CASE("recurrence: the logistic map's periods, and none at r = 4") {
  for (const auto& [r, period] : std::vector<std::pair<double, int>>{
           {2.8, 1}, {3.2, 2}, {3.5, 4}, {3.55, 8}, {3.566, 16}, {3.83, 3}, {3.7389, 5}}) {
    INFO("r = " << r);
    const Recurrence found = recurrence(logistic(r, 300));
    CHECK(found.period == period);
    CHECK(found.distance <= tolerance);
    CHECK(found.window == 300);
    CHECK(found.contraction == 1);  // at round-off after 5000 iterates
  }
  const Recurrence none = recurrence(logistic(4, 300));
  CHECK(none.period == 0);
  CHECK(none.window == 300);
  // 300 iterates of the full interval come nowhere near themselves at any lag.
  CHECK(none.distance > 0.5);
}

TEST_CASE("recurrence: a stable cycle is approached by its multiplier") {
  // The 2-cycle of the logistic map has the multiplier 4 + 2r − r² per two iterates.
  for (const double r : {3.1, 3.2, 3.4}) {
    const double multiplier = 4 + 2 * r - r * r;
    const Recurrence found = recurrence(logistic(r, 80, 10));
    INFO("r = " << r);
    CHECK(found.period == 2);
    // Two percent: the nonlinear part of the first distances.
    CHECK(found.contraction == Approx(std::sqrt(std::abs(multiplier))).epsilon(0.02));
  }
}

TEST_CASE("recurrence: a rotation never returns, and returns within a tolerance at Fibonacci lags") {
  const auto rotation = series_of(600, [](int k) {
    const double angle = 2 * std::numbers::pi * std::numbers::phi * k;
    return std::vector<double>{std::cos(angle), std::sin(angle)};
  });
  const Recurrence none = recurrence(rotation);
  CHECK(none.period == 0);
  CHECK(none.contraction == Approx(1).margin(1e-3));
  // 34 φ is 0.0132 from an integer, 21 φ 0.0213: chords of 0.0827 and 0.133 (columns see 1 of them at most).
  CHECK(recurrence(rotation, 0.1).period == 34);
  CHECK(recurrence(rotation, 0.1).distance == Approx(2 * std::sin(std::numbers::pi * 0.013156)).epsilon(1e-3));
}

TEST_CASE("recurrence: an orbit that has not quite arrived counts where its limit is known") {
  // Period 3 with a slow part: at the end of 300 rows the lag-3 distance is 3e-3·0.97^300 ~ 1e-5 of a unit, over the
  // tolerance. Both contract alike at every lag, so the fit must not stop at lag 1 or 2, whose limits are not zero.
  for (const double rho : {0.9, 0.97, 0.98}) {
    const auto slow = scalar(300, [&](int k) { return 0.3 * (k % 3) + 0.1 * std::pow(rho, k); });
    INFO("ρ = " << rho);
    const Recurrence found = recurrence(slow);
    CHECK(found.period == 3);
    CHECK(found.distance > tolerance);
    CHECK(found.window == 300);
    CHECK(found.contraction == Approx(rho).epsilon(1e-5));  // sums of 300 logarithms of rounded differences
  }
  // A split of 1e-4 between odd and even periods is not something that decays.
  const auto split = scalar(300, [](int k) { return (k % 2 == 0 ? 1e-4 : 0.0) + 0.1 * std::pow(0.97, k); });
  CHECK(recurrence(split).period == 2);
  // A few percent of noise on the decay leave the limit known where the distances themselves are small.
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0, 0.03);
  double x = 0;
  const auto rough = scalar(300, [&](int k) { return x += std::pow(0.94, k) * (1 + noise(random)); });
  CHECK(recurrence(rough).period == 1);
  CHECK(recurrence(rough).contraction == Approx(0.94).epsilon(1e-3));
}

TEST_CASE("recurrence: a flip that dies out is one period, however small its doubled distances are") {
  // x_k = (−ρ)^k: d_k(2) is d_k(1) times (1 − ρ²)/(1 + ρ)ρ, a hundredth and less.
  for (const double rho : {0.95, 0.98, 0.99}) {
    INFO("ρ = " << rho);
    CHECK(recurrence(scalar(300, [&](int k) { return 0.5 + 1e-3 * std::pow(-rho, k); })).period == 1);
    // The same on the way to a cycle of two.
    CHECK(recurrence(scalar(300, [&](int k) { return 0.1 * (k % 2) + 1e-3 * std::pow(-rho, k); })).period == 2);
  }
  // Near the threshold the decay is not geometric: lag 2 is within the tolerance, and which it is is not known.
  const auto threshold = scalar(300, [](int k) { return (k % 2 ? 1e-4 : -1e-4) / std::sqrt(1 + 0.01 * k); });
  CHECK(recurrence(threshold).period == 0);
  CHECK(recurrence(threshold).distance < tolerance);
}

TEST_CASE("recurrence: a spiral into an orbit is that orbit or not known yet, never a multiple of it") {
  // Multipliers ρ e^{±iθ}: lags at which pθ is near a turn have small distances of their own long before the others.
  int arrived = 0;
  for (const double rho : {0.85, 0.93, 0.96, 0.98, 0.99})
    for (const double turn : {0.2001, 0.2499, 0.3334, 0.5002, 0.0101, 0.3819}) {
      INFO("ρ = " << rho << ", θ = " << turn << " turns");
      const Recurrence found = recurrence(series_of(300, [&](int k) {
        const double angle = 2 * std::numbers::pi * turn * k, size = 1e-2 * std::pow(rho, k);
        return std::vector<double>{0.3 + size * std::cos(angle), -1 + size * std::sin(angle)};
      }));
      CHECK((found.period == 0 || found.period == 1));
      // What shrinks does so at its own rate, up to the beating of a column against the other.
      if (found.contraction != 1) CHECK(found.contraction == Approx(rho).epsilon(0.01));
      arrived += found.period == 1;
    }
  // ρ ≤ 0.93 leaves 2e-7 to the second half at most, whatever the angle; slower ones only where columns do not beat.
  CHECK(arrived >= 12);
}

namespace {

/// Two harmonics about an orbit of period 1, multipliers ρ e^{±iθ}, with the readings half a period before.
SectionSeries spiral(int rows, double rho, double turn, double phase) {
  return series_of(rows, [=](int k) {
    std::vector<double> row;
    for (const double at : {k + phase, k + phase - 0.5}) {
      const double angle = 2 * std::numbers::pi * turn * at, size = std::pow(rho, at);
      row.push_back(size * (std::cos(angle) + 0.3 * size * std::cos(2 * angle + 1)));
      row.push_back(size * (std::sin(angle) + 0.2 * size * std::sin(2 * angle)));
    }
    return row;
  });
}

constexpr double irrational_turns[] = {0.3819, 0.2763, 0.4142, 0.1357};

}  // namespace

TEST_CASE("ranges: a spiral shrinks from third to third as slowly as it may, and by as much as its multiplier says") {
  for (const double rho : {0.98, 0.99, 0.995, 0.998, 0.999})
    for (const double turn : irrational_turns) {
      INFO("ρ = " << rho << ", θ = " << turn << " turns");
      const double shrunk = shrunk_ranges(spiral(300, rho, turn, 0));
      CHECK(shrunk < 1);
      // Between the largest readings of the first and the last third lie 200 periods, and the few of which an angle
      // comes round again: ten. The second harmonic shrinks by the square, with a third of the size.
      CHECK(shrunk < std::pow(rho, 190));
      CHECK(shrunk > std::pow(rho, 210) * (1 + 0.3 * std::pow(rho, 200)) / 1.3 * 0.9);
    }
}

TEST_CASE("ranges: a torus fills them again, chaos too") {
  int shrinking = 0, tori = 0;
  for (const int rows : {60, 100, 200, 300})
    for (const double turn : irrational_turns)
      for (int k = 0; k < 10; ++k, ++tori) shrinking += shrunk_ranges(spiral(rows, 1, turn, 7.3 * k)) < 1;
  // Two ranges that differ by chance alone fall twice in 1 of 36.
  CHECK(36 * shrinking <= tori);
  int falling = 0;
  for (int k = 0; k < 100; ++k) {
    const SectionSeries x = logistic(4, 120, 100 + 37 * k), y = logistic(3.9, 120, 100 + 41 * k);
    falling += shrunk_ranges(series_of(120, [&](int i) { return std::vector<double>{*x.row(i), *y.row(i)}; })) < 1;
  }
  // 1 of 36, and three standard deviations of that many.
  CHECK(falling <= 100 / 36 + 5);
  // Too few rows, no variation, nothing at all: nothing shrinks.
  CHECK(shrunk_ranges(spiral(23, 0.9, 0.3819, 0)) == 1);
  CHECK(shrunk_ranges(spiral(24, 0.9, 0.3819, 0)) < 1);
  CHECK(shrunk_ranges(scalar(100, [](int) { return 0.3; })) == 1);
  CHECK(shrunk_ranges({}) == 1);
}

TEST_CASE("recurrence: what slows down without arriving is not taken for an orbit") {
  // The ghost of a saddle-node drifts like 1/k, a period doubling at its threshold decays like k^(−1/2).
  CHECK(recurrence(scalar(300, [](int k) { return 1 / (50.0 + k); })).period == 0);
  CHECK(recurrence(logistic(3, 300, 300)).period == 0);
  // The same drift, seen from so far that 300 periods do not move it by the tolerance, is an orbit for all one can see.
  CHECK(recurrence(scalar(300, [](int k) { return 1 / (50.0 + k); }), 1e-3).period == 1);
}

TEST_CASE("recurrence: an unstable orbit that is being left does not count") {
  // 1e-12·1.08^k: distances reach 3.5e-7 in 200 rows, and pass the tolerance a dozen rows later.
  const auto leaving = scalar(200, [](int k) { return 0.5 + 1e-12 * std::pow(1.08, k); });
  const Recurrence found = recurrence(leaving);
  CHECK(found.period == 0);
  CHECK(found.distance < tolerance);
  CHECK(found.contraction == Approx(1.08).epsilon(2e-3));  // distances of 1e-13 on numbers of 0.5 carry 1e-16
  // Growth by a part in 10⁴ per period leaves it nowhere in another 200.
  CHECK(recurrence(scalar(200, [](int k) { return 0.5 + 1e-9 * std::pow(1.0001, k); })).period == 1);
}

TEST_CASE("recurrence: a transient that ends within the first half does no harm") {
  double x = 0.3;
  const auto captured = scalar(300, [&](int k) {
    x = k < 140 ? 4 * x * (1 - x) : k % 2;
    return x;
  });
  const Recurrence found = recurrence(captured);
  CHECK(found.period == 2);
  CHECK(found.window == 150);
}

TEST_CASE("recurrence: units and the order of columns do not matter, every column counts") {
  const auto orbit = [](double length, double speed, bool swapped, double odd) {
    return series_of(200, [=](int k) {
      const double a = length * (k % 2 + std::pow(0.8, k)), b = speed * (k % 4 == 3 ? 1 + odd : 1);
      return swapped ? std::vector<double>{b, a} : std::vector<double>{a, b};
    });
  };
  const auto at = [&](double length, double speed, bool swapped, double odd) {
    return find_recurrence(orbit(length, speed, swapped, odd),
                           swapped ? std::vector<double>{speed, length} : std::vector<double>{length, speed},
                           tolerance);
  };
  const Recurrence one = at(1, 1, false, 0);
  CHECK(one.period == 2);
  for (const bool swapped : {false, true}) {
    const Recurrence other = at(1e-3, 1e5, swapped, 0);
    CHECK(other.period == one.period);
    CHECK(other.distance == Approx(one.distance).epsilon(1e-9));        // round-off of the scaled numbers
    CHECK(other.contraction == Approx(one.contraction).epsilon(1e-6));  // distances down to 1e-13 carry 1e-3 of it
    CHECK(at(1e-3, 1e5, swapped, 1e-3).period == 4);
    CHECK(at(1e-3, 1e5, swapped, 1e-7).period == 2);
  }
}

TEST_CASE("recurrence: 2p + 8 rows are needed, and a column without scale repeats only exactly") {
  const auto cycle = [](int rows) { return scalar(rows, [](int k) { return k % 5; }); };
  CHECK(recurrence(cycle(18)).period == 5);
  CHECK(recurrence(cycle(17)).period == 0);
  CHECK(recurrence(cycle(9)).window == 0);
  CHECK(find_recurrence(cycle(300), {1.0}, tolerance, 4).period == 0);
  CHECK(find_recurrence(cycle(300), {0.0}, tolerance).period == 5);
  const auto shaky = scalar(300, [](int k) { return k % 5 + 1e-9 * (k % 7); });
  CHECK(find_recurrence(shaky, {1.0}, tolerance).period == 5);
  CHECK(find_recurrence(shaky, {0.0}, tolerance).period == 35);
  CHECK(find_recurrence(scalar(100, [](int) { return 0.0; }), {0.0}, tolerance).period == 1);
}

TEST_CASE("recurrence: numbers that are not finite repeat nothing, and reach nobody") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto broken = scalar(100, [&](int k) { return k == 90 ? nan : 1.0; });
  const Recurrence found = recurrence(broken);
  CHECK(found.period == 0);
  CHECK(std::isfinite(found.distance));
  CHECK(std::isfinite(found.contraction));
  CHECK_THROWS_AS(find_recurrence(broken, {1.0, 1.0}, tolerance), std::invalid_argument);
  CHECK_THROWS_AS(find_recurrence(broken, {-1.0}, tolerance), std::invalid_argument);
  CHECK_THROWS_AS(find_recurrence(broken, {nan}, tolerance), std::invalid_argument);
}

TEST_CASE("settling: a cycle of p is seen after p + max(p, 4) + 4 periods") {
  for (const int p : {1, 2, 3, 7, 64}) {
    Settling settling({1.0, 2.0}, tolerance);
    int periods = 0;
    for (bool settled = false; !settled; ++periods) {
      REQUIRE(periods < 200);
      const std::vector<double> row = {0.1 * (periods % p), 5.0};
      settled = settling.add(row.data());
      CHECK(settled == settling.settled());
    }
    CHECK(periods == p + std::max(p, 4) + 4);
    CHECK(settling.period() == p);
    settling.clear();
    CHECK_FALSE(settling.settled());
  }
}

TEST_CASE("settling: agrees with the recurrence of what follows, and a chaotic or broken integration never settles") {
  Settling periodic({1.0}, tolerance), chaotic({1.0}, tolerance), broken({1.0}, tolerance);
  double x = 0.4, y = 0.4;
  int settled_at = 0;
  for (int k = 0; k < 2000; ++k) {
    x = 3.55 * x * (1 - x), y = 4 * y * (1 - y);
    const double bad = k % 8 == 7 ? std::nan("") : 1.0;
    if (periodic.add(&x) && settled_at == 0) settled_at = k;
    CHECK_FALSE(chaotic.add(&y));
    // Seven equal rows between two that are broken are one short of 8.
    CHECK_FALSE(broken.add(&bad));
  }
  CHECK(periodic.period() == 8);
  CHECK(settled_at > 16);
  CHECK(settled_at < 500);
  const auto after = logistic(3.55, 300, settled_at);
  CHECK(recurrence(after, 2 * tolerance).period == 8);
}

TEST_CASE("settling: a copy goes on as if it had not stopped, adding allocates nothing") {
  Settling whole({1.0, 3.0}, tolerance, 20), parts = whole;
  const auto row = [](int k) { return std::vector<double>{std::pow(0.7, k) + k % 6, 2.0 * (k % 3)}; };
  for (int k = 0; k < 80; ++k) {
    const auto x = row(k);
    const long before = allocations();
    const bool one = whole.add(x.data());
    CHECK(allocations() == before);
    CHECK(parts.add(x.data()) == one);
    // Plain data: what a checkpoint copies is all there is.
    if (k % 7 == 0) parts = Settling(parts);
  }
  CHECK(whole.period() == 6);
  CHECK(parts.ring == whole.ring);
  CHECK(parts.repeats == whole.repeats);
  CHECK(parts.periods == whole.periods);
}

TEST_CASE("clouds: the same whatever their order, up to the tolerance in each direction") {
  using Cloud = std::vector<std::array<double, 2>>;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(-1, 1), jitter(-0.9, 0.9);
  Cloud a(500), b;
  for (auto& point : a) point = {place(random), 10 * place(random)};
  b = a;
  std::shuffle(b.begin(), b.end(), random);
  for (auto& point : b) point = {point[0] + 1e-6 * jitter(random), point[1] + 1e-5 * jitter(random)};
  const std::array<double, 2> scale = {1, 10};
  CHECK(same_cloud(a, b, scale, 1e-6));
  CHECK(same_cloud(b, a, scale, 1e-6));
  CHECK_FALSE(same_cloud(a, b, scale, 1e-7));
  Cloud more = b;
  more.push_back({0.1234, 11.0});
  CHECK_FALSE(same_cloud(a, more, scale, 1e-6));
  CHECK_FALSE(same_cloud(more, a, scale, 1e-6));
  // Points of the same place may come more often in one.
  b.insert(b.end(), a.begin(), a.begin() + 100);
  CHECK(same_cloud(a, b, scale, 1e-6));
  CHECK(same_cloud({}, {}, scale, 1e-6));
  CHECK_FALSE(same_cloud(a, {}, scale, 1e-6));
  CHECK_FALSE(same_cloud({{std::nan(""), 0.0}}, {{std::nan(""), 0.0}}, scale, 1e-6));
}

TEST_CASE("clouds: a symmetric orbit is its own image under x → −x half a period later, an odd harmonic's is not") {
  // x(t) = cos t + ε cos 2t over the strobes of period 2π: the image of phase t is −x(t + π).
  for (const double even : {0.0, 1e-3}) {
    std::vector<std::array<double, 2>> section, image;
    const auto x = [&](double t) {
      return std::array<double, 2>{std::cos(t) + even * std::cos(2 * t), -std::sin(t) - 2 * even * std::sin(2 * t)};
    };
    for (int k = 0; k < 20; ++k) {
      const double t = 2 * std::numbers::pi * k + 0.3;
      const auto opposite = x(t + std::numbers::pi);
      section.push_back(x(t));
      image.push_back({-opposite[0], -opposite[1]});
    }
    CHECK(same_cloud(section, image, {1, 1}, 1e-9) == (even == 0.0));
  }
}
