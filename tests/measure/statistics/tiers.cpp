// Methods that are told apart, and those that are not.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <ricochet/measure/statistics/tiers.hpp>

using namespace ricochet;

namespace {

Limit at(double value, double u) {
  Limit out;
  out.status = LimitStatus::settles;
  out.value = value;
  out.uncertainty = u;
  out.low = value - u;
  out.high = value + u;
  return out;
}

}  // namespace

TEST_CASE("a tier begins where the gap to all before is wider than the tolerance") {
  const Tiers found = tiers_of({at(0.99, 0.001), at(0.80, 0.002), at(0.985, 0.001), at(0.795, 0.001)}, 0.01);
  REQUIRE(found.tiers.size() == 2);
  CHECK(found.tiers[0] == Members{3, 1});
  CHECK(found.tiers[1] == Members{2, 0});
  CHECK(found.nowhere.empty());
}

TEST_CASE("one that is not firm joins the tier that it touches alone, makes its own, or is nowhere") {
  const std::vector<Limit> firm = {at(1.0, 0.001), at(0.5, 0.001)};
  auto joined = firm;
  joined.push_back(at(0.75, 0.22));  // reaches 0.97: between both, and touches none
  CHECK(tiers_of(joined, 0.01).tiers.size() == 3);
  auto touching = firm;
  touching.push_back(at(0.8, 0.2));
  CHECK(tiers_of(touching, 0.01).tiers.size() == 2);
  auto both = firm;
  both.push_back(at(0.75, 0.4));
  CHECK(tiers_of(both, 0.01).nowhere == Members{2});
  CHECK(tiers_of({at(1, 0.5), at(1.1, 0.6)}, 0.01).none_firm);
}

TEST_CASE("those that are not firm and overlap are one tier of their own") {
  const Tiers found = tiers_of({at(1.0, 1e-5), at(1.0001, 1e-5), at(0.7, 0.26), at(0.7001, 0.27), at(0.2, 0.25)}, 1e-3);
  REQUIRE(found.tiers.size() == 2);
  CHECK(found.tiers[0] == Members{4, 3, 2});
  CHECK(found.tiers[1].size() == 2);
}

TEST_CASE("the order of methods leaves their tiers") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform;
  for (int draw = 0; draw < 100; ++draw) {
    std::vector<Limit> limits;
    for (int k = 0; k < 9; ++k) limits.push_back(at(uniform(random), 0.05 * uniform(random)));
    std::vector<std::size_t> order(limits.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::shuffle(order.begin(), order.end(), random);
    std::vector<Limit> shuffled;
    for (const std::size_t k : order) shuffled.push_back(limits[k]);
    const auto sets = [](const Tiers& tiers, const auto& original) {
      std::vector<std::vector<std::size_t>> out;
      for (const Members& tier : tiers.tiers) {
        std::vector<std::size_t> one;
        for (const std::size_t k : tier) one.push_back(original(k));
        std::sort(one.begin(), one.end());
        out.push_back(one);
      }
      return out;
    };
    CHECK(sets(tiers_of(limits, 0.02), [](std::size_t k) { return k; }) ==
          sets(tiers_of(shuffled, 0.02), [&](std::size_t k) { return order[k]; }));
  }
}

TEST_CASE("over decades a tier begins at three times the largest before, and nothing is one tier") {
  const Tiers found = tiers_over_decades({1e-15, 2e-13, 1, 2.9, 10, 0}, 1e-11);
  REQUIRE(found.tiers.size() == 3);
  CHECK(found.tiers[0].size() == 3);
  CHECK(found.tiers[1] == Members{2, 3});
  CHECK(found.tiers[2] == Members{4});
}

TEST_CASE("over decades no tier spans more than one, and values that chain part where their ratio is largest") {
  std::vector<double> values;
  for (int k = 0; k < 12; ++k) values.push_back(std::pow(2, k) * (k >= 5 ? 1.3 : 1));
  const Tiers found = tiers_over_decades(values, 1e-11);
  REQUIRE(found.tiers.size() > 1);
  std::size_t members = 0;
  for (const Members& tier : found.tiers) {
    members += tier.size();
    CHECK(values[tier.back()] <= 10 * values[tier.front()]);
  }
  CHECK(members == values.size());
  CHECK(tiers_over_decades({1, 2, 4, 8}, 1e-11).tiers.size() == 1);
  const Tiers apart = tiers_over_decades({1, 2, 5, 10, 20}, 1e-11);
  REQUIRE(apart.tiers.size() == 2);
  CHECK(apart.tiers[0] == Members{0, 1});
}
