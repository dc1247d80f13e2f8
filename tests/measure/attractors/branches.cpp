// Identities of attractors: within a value, along the parameter, over cases; and the choice behind a difference.
#include <catch2/catch.hpp>
#include <random>
#include <ricochet/measure/attractors/attractors.hpp>
#include <ricochet/measure/statistics/choices.hpp>

using namespace ricochet;

namespace {

SettledSection orbit(double x, int period = 1) {
  return {{Regime::periodic, period}, true, make_cloud(std::vector<CloudPoint>{{x, 0}}, {}, {1, 1}, 1)};
}

SettledSection noise(std::mt19937& random, double x) {
  std::normal_distribution<double> normal;
  std::vector<CloudPoint> points;
  for (int k = 0; k < 300; ++k) points.push_back({x + normal(random), normal(random)});
  return {{Regime::chaotic}, false, make_cloud(points, {}, {1, 1}, 0)};
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
  CHECK(cluster_starts({{{Regime::periodic, 3}, true, {}},
                        {{Regime::periodic, 3}, true, {}},
                        {{Regime::periodic, 4}, true, {}}}) == std::vector<int>{0, 0, 1});
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
