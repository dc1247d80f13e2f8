// Distances of clouds: metric laws, closed forms, and what the null covers.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <random>
#include <ricochet/measure/attractors/attractors.hpp>
#include <ricochet/measure/statistics/choices.hpp>

using namespace ricochet;

namespace {

std::vector<CloudPoint> cloud(std::mt19937& random, int count) {
  std::normal_distribution<double> normal;
  std::vector<CloudPoint> out;
  for (int k = 0; k < count; ++k) out.push_back({normal(random), normal(random)});
  return out;
}

std::vector<CloudPoint> moved(std::vector<CloudPoint> points, double x, double v) {
  for (CloudPoint& p : points) p = {p[0] + x, p[1] + v};
  return points;
}

// The best of all assignments, by trying them.
double by_force(const std::vector<CloudPoint>& a, const std::vector<CloudPoint>& b) {
  std::vector<std::size_t> order(a.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  double best = 1e9;
  do {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += std::hypot(a[k][0] - b[order[k]][0], a[k][1] - b[order[k]][1]);
    best = std::min(best, sum / static_cast<double>(a.size()));
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

std::vector<CloudPoint> repeated(const std::vector<CloudPoint>& points, int times) {
  std::vector<CloudPoint> out;
  for (int k = 0; k < times; ++k) out.insert(out.end(), points.begin(), points.end());
  return out;
}

}  // namespace

TEST_CASE("the exact distance is the best assignment") {
  std::mt19937 random(1);
  for (int trial = 0; trial < 40; ++trial) {
    const int n = 1 + trial % 7;
    const auto a = cloud(random, n), b = cloud(random, n);
    CHECK(exact_wasserstein(a, b) == Approx(by_force(a, b)).epsilon(1e-12));  // sums of a few hypotenuses
  }
}

TEST_CASE("clouds of different sizes carry the same mass") {
  std::mt19937 random(2);
  for (const auto& [n, m] : {std::pair(2, 3), std::pair(4, 6), std::pair(1, 5), std::pair(16, 64), std::pair(5, 12)}) {
    const auto a = cloud(random, n), b = cloud(random, m);
    const int whole = std::lcm(n, m);
    const double distance = exact_wasserstein(a, b);
    CHECK(distance == Approx(exact_wasserstein(repeated(a, whole / n), repeated(b, whole / m))).epsilon(1e-10));
    CHECK(distance == Approx(exact_wasserstein(b, a)).epsilon(1e-10));
  }
}

TEST_CASE("both distances are metrics that translations measure exactly") {
  std::mt19937 random(3);
  for (int trial = 0; trial < 20; ++trial) {
    const auto a = cloud(random, 12), b = cloud(random, 12), c = cloud(random, 12);
    CHECK(exact_wasserstein(a, a) == Approx(0).margin(1e-15));
    CHECK(hausdorff_distance(a, a) == 0);
    CHECK(hausdorff_distance(a, b) == hausdorff_distance(b, a));
    CHECK(exact_wasserstein(a, c) <= exact_wasserstein(a, b) + exact_wasserstein(b, c) + 1e-12);
    CHECK(hausdorff_distance(a, c) <= hausdorff_distance(a, b) + hausdorff_distance(b, c) + 1e-12);
    const double angle = 0.3 * trial, length = 0.7;
    const auto far = moved(a, length * std::cos(angle), length * std::sin(angle));
    CHECK(exact_wasserstein(a, far) == Approx(length));
    // Eight directions: (π/2) mean |cos| lies within 0.987 and 1.0065 of one.
    CHECK(sliced_wasserstein(a, far) > 0.987 * length);
    CHECK(sliced_wasserstein(a, far) < 1.0066 * length);
    CHECK(sliced_wasserstein(a, b) <= 1.0066 * exact_wasserstein(a, b));
    CHECK(hausdorff_distance(a, far) <= length + 1e-12);
  }
}

TEST_CASE("slices of unequal clouds are those of the repeated ones") {
  std::mt19937 random(4);
  const auto a = cloud(random, 20), b = cloud(random, 30);
  CHECK(sliced_wasserstein(a, b) == Approx(sliced_wasserstein(repeated(a, 3), repeated(b, 2))).epsilon(1e-12));
}

TEST_CASE("a mirror image is the motion itself") {
  std::mt19937 random(5);
  const auto run = cloud(random, 200), opposite = moved(cloud(random, 200), 3, 0);
  const SectionCloud one = make_cloud(run, opposite, {1, 1}, 0), image = make_cloud(opposite, run, {1, 1}, 0);
  CHECK(cloud_distance(one, image) == Approx(0).margin(1e-12));
  CHECK(cloud_distance(image, one) == Approx(0).margin(1e-12));
  CHECK(cloud_hausdorff(one, image) == Approx(0).margin(1e-12));
  const SectionCloud alone = make_cloud(run, {}, {1, 1}, 0), other = make_cloud(opposite, {}, {1, 1}, 0);
  CHECK(cloud_distance(alone, other) > 2.5);
  CHECK(cloud_distance(alone, SectionCloud{}) == std::numeric_limits<double>::infinity());
  CHECK(cloud_distance(SectionCloud{}, SectionCloud{}) == 0);
}

TEST_CASE("a run exceeds the null of another about once in twenty") {
  std::mt19937 random(6);
  int beyond = 0, beyond_hausdorff = 0;
  const int trials = 300;
  for (int trial = 0; trial < trials; ++trial) {
    const auto one = cloud(random, 300), other = cloud(random, 300);
    const SectionCloud a = make_cloud(one, {}, {1, 1}, 0), b = make_cloud(other, {}, {1, 1}, 0);
    const HalvesNull null = null_of_halves(one, {1, 1}, 0);
    CHECK(null.wasserstein == Approx(a.null));
    beyond += cloud_distance(a, b) > null.wasserstein;
    beyond_hausdorff += cloud_hausdorff(a, b) > null.hausdorff;
  }
  // 5 % nominal; 300 trials scatter by 1.3 %, and 19 draws of one run by as much again.
  CHECK(beyond <= 0.1 * trials);
  // Outliers are shared by all draws of a run: about once in five.
  CHECK(beyond_hausdorff <= 0.27 * trials);
  CHECK(beyond >= 0.005 * trials);
  // A shift of the mean by one standard deviation is far outside.
  const auto run = cloud(random, 300);
  const SectionCloud here = make_cloud(run, {}, {1, 1}, 0), there = make_cloud(moved(run, 1, 0), {}, {1, 1}, 0);
  CHECK(cloud_distance(here, there) > 1.5 * here.null);
}

TEST_CASE("a cycle is its last points, and its null what is left of the transient") {
  std::vector<CloudPoint> run;
  for (int k = 0; k < 40; ++k) run.push_back({k % 2 + std::pow(0.5, k), 0});
  const SectionCloud cycle = make_cloud(run, {}, {2, 1}, 2);
  REQUIRE(cycle.points.size() == 2);
  CHECK(cycle.points[1][0] == Approx(0.5));
  CHECK(cycle.null == 0);
  // From {1, 1.5}/2 to {0, 1}/2: ½ and ¼ away, and the mean of both.
  CHECK(null_of_halves(run, {2, 1}, 2).wasserstein == Approx(0.375).margin(1e-6));
  CHECK(distinct_points(run, 1e-3).size() > 2);
  const double nan = std::nan("");
  CHECK(make_cloud(std::vector<CloudPoint>{{nan, 0}}, {}, {1, 1}, 0).empty());
}

TEST_CASE("the scale is the spread, and never zero") {
  ScaleOfPoints scale;
  CHECK(scale.scale() == CloudPoint{1, 1});
  scale.add({3, 0});
  CHECK(scale.scale() == CloudPoint{3, 1});
  scale.add({5, 0});
  scale.add({std::nan(""), 1});
  CHECK(scale.scale()[0] == Approx(1));
}

// Identities of attractors: within a value, along the parameter, over cases; and the choice behind a difference.

namespace {

SettledSection orbit(double x, int period = 1) {
  return {{Regime::periodic, period}, make_cloud(std::vector<CloudPoint>{{x, 0}}, {}, {1, 1}, 1)};
}

/// One that its steps leave open by so much.
SettledSection open_orbit(double x, double open) {
  return {{Regime::periodic, 1}, make_cloud(std::vector<CloudPoint>{{x, 0}}, {}, {2, 1}, 1, open)};
}

SettledSection noise(std::mt19937& random, double x) {
  std::normal_distribution<double> normal;
  std::vector<CloudPoint> points;
  for (int k = 0; k < 300; ++k) points.push_back({x + normal(random), normal(random)});
  return {{Regime::chaotic}, make_cloud(points, {}, {1, 1}, 0)};
}

}  // namespace

TEST_CASE("starts that settle on one orbit, or on one cloud, are one attractor") {
  CHECK(cluster_starts({orbit(0), orbit(0.5), orbit(1e-4), orbit(0, 7)}) == std::vector<int>{0, 1, 0, 2});
  std::mt19937 random(1);
  int split = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const auto labels = cluster_starts({noise(random, 0), noise(random, 0), noise(random, 3)});
    split += labels[1] != 0;
    CHECK(labels[2] != 0);
  }
  // Half above a null that one in 20 exceeds: rarer than one in 50.
  CHECK(split <= 2);
  CHECK(cluster_starts({}).empty());
  // Unknown sections: the class alone.
  CHECK(cluster_starts({{{Regime::periodic, 3}, {}}, {{Regime::periodic, 3}, {}}, {{Regime::periodic, 4}, {}}}) ==
        std::vector<int>{0, 0, 1});
}

TEST_CASE("cycles that are nearer than their steps place them are one, as far as either is open") {
  // In units of the scale, 2: 0.05 apart, open by 0.04; half again as much is one.
  const SettledSection sharp = open_orbit(0, 0), near = open_orbit(0.1, 0), open = open_orbit(0.1, 0.08);
  CHECK(open.cloud.null == Approx(0.04));
  CHECK(cluster_starts({sharp, near}) == std::vector<int>{0, 1});
  CHECK(cluster_starts({sharp, open}) == std::vector<int>{0, 0});
  CHECK(cluster_starts({open, sharp}) == std::vector<int>{0, 0});
  CHECK(cluster_starts({open_orbit(0, 0.08), open_orbit(0.2, 0.08)}) == std::vector<int>{0, 1});
}

TEST_CASE("two attractors of one case never become one, however near another case puts one between them") {
  const SettledSection a = orbit(0), b = orbit(0.08), between = orbit(0.05);
  const auto labels = match_owners({{0, &a}, {0, &b}, {1, &between}});
  CHECK(labels == std::vector<int>{0, 1, 1});
}

TEST_CASE("branches that cross nobody keep their identity from birth to death") {
  Branches branches;
  for (int k = 0; k < 20; ++k) {
    // One moves by a unit in all, another stays, a third lives from 5 to 9, the order of the sections changes.
    std::vector<SettledSection> sections = {orbit(3 + 0.05 * k), orbit(0)};
    if (k % 2) std::swap(sections[0], sections[1]);
    if (k >= 5 && k < 10) sections.push_back(orbit(-3));
    const auto labels = branches.add(sections);
    CHECK(labels[0] == k % 2);
    CHECK(labels[1] == 1 - k % 2);
    if (sections.size() == 3) CHECK(labels[2] == 2);
  }
  CHECK(branches.count() == 3);
  // A short absence is bridged, a long one is not; another class is another branch.
  Branches one;
  CHECK(one.add({orbit(0)}) == std::vector<int>{0});
  one.add({});
  one.add({});
  CHECK(one.add({orbit(0.1)}) == std::vector<int>{0});
  for (int k = 0; k < 5; ++k) one.add({});
  CHECK(one.add({orbit(0.1)}) == std::vector<int>{1});
  CHECK(one.add({orbit(0.1, 2)}) == std::vector<int>{2});
}

TEST_CASE("branches of different cases are matched as wholes") {
  // Cases 0 and 1 have two branches each; one value is a coincidence that the medians outweigh.
  const std::vector<CaseBranch> branches = {{0, {0, 1, 2}}, {0, {1, 2}}, {1, {0, 1, 2}}, {1, {2}}, {2, {3}}};
  const std::vector<BranchPair> pairs = {{0, 2, {0.9, 0.2, 0.3}}, {1, 2, {0.1, 0.8}}, {1, 3, {0.4}}, {0, 3, {0.25}}};
  CHECK(match_branches(branches, pairs) == std::vector<int>{0, 1, 1, 0, 2});
  CHECK(match_branches(branches, {}) == std::vector<int>{0, 1, 2, 3, 4});
  // Beyond the threshold nothing is joined.
  CHECK(match_branches(branches, {{0, 2, {1.1, 1.2, 0.1}}}) == std::vector<int>{0, 1, 2, 3, 4});
}

TEST_CASE("Wilson's interval: closed forms and coverage") {
  // Nothing of n: from 0 to z²/(n + z²).
  const double z2 = 1.959963984540054 * 1.959963984540054;
  CHECK(wilson_interval(0, 10).low == 0);
  CHECK(wilson_interval(0, 10).high == Approx(z2 / (10 + z2)));
  CHECK(wilson_interval(1, 10).high == 1);
  CHECK(wilson_interval(0.5, 0).high == 1);
  std::mt19937 random(2);
  for (const double p : {0.1, 0.5, 0.8}) {
    std::binomial_distribution<int> draw(30, p);
    int covered = 0;
    for (int trial = 0; trial < 2000; ++trial) {
      const Proportion share = wilson_interval(draw(random) / 30.0, 30);
      covered += share.low <= p && p <= share.high;
    }
    CHECK(covered > 0.92 * 2000);  // 95 % nominal, 1 % of lattice and 0.5 % of sampling each
  }
}

TEST_CASE("the share that an axis explains") {
  CHECK(explained_share({0, 0, 1, 1}, {"a", "a", "b", "b"}) == Approx(1));
  CHECK(explained_share({0, 1, 0, 1}, {"a", "a", "b", "b"}) == Approx(0).margin(1e-15));
  CHECK(explained_share({1, 1, 1}, {"a", "b", "c"}) == 0);
  // η² of two groups with means 1 and ⅓: between (6·(2/3)²·¼…) = 1 − (3·0 + 3·2/9)/(6·2/9).
  CHECK(explained_share({1, 1, 1, 1, 0, 0}, {"a", "a", "a", "b", "b", "b"}) == Approx(0.5));
}

TEST_CASE("the deciding choice is the axis behind the labels, not one that names every case") {
  ChoiceAxis a{"a", {}}, b{"b", {}}, each{"each", {}}, same{"same", {}};
  std::vector<int> by_a, by_both;
  for (int k = 0; k < 12; ++k) {
    a.levels.push_back(std::to_string(k % 2));
    b.levels.push_back(std::to_string(k / 2 % 3));
    each.levels.push_back(std::to_string(k));
    same.levels.push_back("0");
    by_a.push_back(k % 2);
    by_both.push_back(k % 2 == 1 && k / 2 % 3 == 2);
  }
  const DecidingChoice one = deciding_choice(by_a, {each, same, b, a});
  CHECK(one.name == "a");
  CHECK(one.share == Approx(1));
  const DecidingChoice two = deciding_choice(by_both, {each, same, b, a});
  CHECK(two.name == "b × a");
  CHECK(two.share == Approx(1));
  CHECK(deciding_choice(by_a, {each}).name == "each");
  CHECK(deciding_choice(by_a, {same}).name.empty());
  // A parameter that only one of three methods has, and the method itself.
  ChoiceAxis mass{"mass", {}}, rotation{"mass.rotation", {}};
  std::vector<int> lumped;
  for (int k = 0; k < 12; ++k) {
    mass.levels.push_back(k % 3 == 0 ? "lumped" : std::to_string(k % 3));
    rotation.levels.push_back(k % 3 == 0 ? "scaled" : "");
    lumped.push_back(k % 3 == 0);
  }
  CHECK(deciding_choice(lumped, {mass, rotation}).name == "mass");
  CHECK(deciding_choice(std::vector<int>(12, 3), {a, b}).name.empty());
}
