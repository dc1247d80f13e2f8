// Names of special points over cases: what is the same point, what a step invented, what is missing.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>
#include <ricochet/measure/attractors/match_points.hpp>

using namespace ricochet;

namespace {

constexpr PointScales scales{0.06, 0.02, 1};

/// Cases 0 … count − 1 along one refinement, the finest first.
std::vector<CaseLink> chain(std::size_t count, const std::string& along = "steps_per_period") {
  std::vector<CaseLink> out(count);
  for (std::size_t k = 1; k < count; ++k) out[k] = {k - 1, along, true};
  return out;
}

CasePoint point(std::size_t owner, double parameter, double displacement = 0, const std::string& family = "fold") {
  return {owner, 1, family, parameter, 1e-7, displacement, 0.1, 0};
}

/// A fold, a first contact and a torus that move as h², on cases of 8000, 4000, 2000, 1000 steps per period.
std::vector<CasePoint> moving(std::size_t cases) {
  std::vector<CasePoint> out;
  for (std::size_t c = 0; c < cases; ++c) {
    const double h2 = std::pow(4.0, static_cast<double>(c));
    out.push_back(point(c, 0.100565 - 4e-6 * h2, 0.005));
    out.push_back(point(c, 0.0791792 - 1e-8 * h2, -0.008, "first contact"));
    out.push_back(point(c, 0.08495 - 1e-5 * h2, -0.003, "torus"));
  }
  return out;
}

}  // namespace

TEST_CASE("points that move with the step keep their names") {
  const auto points = moving(4);
  const MatchedPoints found = match_points(points, chain(4), scales);
  CHECK(found.names == 3);
  for (std::size_t k = 0; k < points.size(); ++k) {
    // By kind: first contact, fold, torus.
    CHECK(found.name[k] == std::vector<int>{1, 0, 2}[k % 3]);
    CHECK(found.sharing[k] == 1);
  }
}

TEST_CASE("a point of one fine case alone has no name, nor has one of a coarse case") {
  auto points = moving(3);
  points.push_back(point(0, 0.071, 0.001));   // the finest alone
  points.push_back(point(2, 0.115, -0.004));  // the coarsest alone
  const MatchedPoints found = match_points(points, chain(3), scales);
  CHECK(found.names == 3);
  CHECK(found.name[points.size() - 2] == -1);
  CHECK(found.name[points.size() - 1] == -1);
  CHECK(found.sharing[points.size() - 1] == 0);
}

TEST_CASE("folds that a step invents leave the names of the others as they are") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(0.067, 0.08), tip(-0.01, 0.01);
  auto points = moving(3);
  for (std::size_t c = 0; c < 3; ++c)
    points.push_back(point(c, 0.067423 + 1.3e-5 * static_cast<double>(c * c), 0.0061));
  const std::size_t real = points.size();
  for (int k = 0; k < 300; ++k) points.push_back(point(2, place(random), tip(random)));
  const MatchedPoints found = match_points(points, chain(3), scales);
  CHECK(found.names == 4);
  for (std::size_t k = real; k < points.size(); ++k) CHECK(found.name[k] <= 1);
  for (std::size_t k = real - 3; k < real - 1; ++k) CHECK(found.name[k] == 1);
  // Each name has one point of a case.
  for (std::size_t owner = 0; owner < 3; ++owner)
    for (int name = 0; name < found.names; ++name) {
      int count = 0;
      for (std::size_t k = 0; k < points.size(); ++k) count += points[k].owner == owner && found.name[k] == name;
      CHECK(count == 1);
    }
}

TEST_CASE("turns around the place of a point share it") {
  auto points = moving(3);
  // The fold moved by 1.2e-5 m between the finest two: at 2000 steps three lie within four times that of its place.
  points.push_back(point(2, 0.100565 - 4e-6 * 16 + 2e-5, 0.005));
  points.push_back(point(2, 0.100565 - 4e-6 * 16 + 1e-5, 0.005));
  points.push_back(point(2, 0.0995, 0.005));
  const MatchedPoints found = match_points(points, chain(3), scales);
  const auto fold = std::find(found.sharing.begin(), found.sharing.end(), 3);
  REQUIRE(fold != found.sharing.end());
  const auto at = static_cast<std::size_t>(fold - found.sharing.begin());
  CHECK(points[at].owner == 2);
  CHECK(points[at].family == "fold");
}

TEST_CASE("a finer pair is not farther apart than four times what coarser pairs show") {
  // 2000 and 4000 steps are 1e-4 m apart, 4000 and 8000 1e-3 m: the finest has another fold.
  const std::vector<CasePoint> points = {point(0, 0.1), point(1, 0.101), point(2, 0.1011)};
  const MatchedPoints found = match_points(points, chain(3), scales);
  CHECK(found.names == 0);
  const std::vector<CasePoint> nearer = {point(0, 0.1), point(1, 0.1003), point(2, 0.1004)};
  CHECK(match_points(nearer, chain(3), scales).names == 1);
}

TEST_CASE("where the parameter turns, the motion is known as the root of its parameter is") {
  // Found within λ ± half: u is open by the root of that over the curvature. By chance two coarser ones agree better.
  std::vector<CasePoint> points;
  const double half[] = {2.6e-6, 8e-6, 1.8e-5}, at[] = {0.2234311, 0.2234310, 0.2234276};
  const double u[] = {-0.131547, -0.130800, -0.130819};
  for (const bool turns : {true, false}) {
    points.clear();
    for (std::size_t c = 0; c < 3; ++c) {
      points.push_back({c, 1, "fold", at[c], half[c], u[c], 0.54, 0, turns});
      points.push_back({c, 1, "fold", 0.0876201 - 1e-6 * static_cast<double>(c), 1e-7, -0.0848, 0.16, 0, turns});
    }
    const MatchedPoints found = match_points(points, chain(3), {0.295, 0.2947, 1});
    CHECK(found.names == (turns ? 2 : 1));
  }
}

TEST_CASE("what points of one kind show is no bound for another") {
  // First contacts stay where they are; folds move by 1e-4 m, and the coarsest case has another one.
  std::vector<CasePoint> points = {point(0, 0.1005), point(1, 0.1004), point(2, 0.0931)};
  for (std::size_t c = 0; c < 3; ++c) points.push_back(point(c, 0.07918, -0.008, "first contact"));
  const MatchedPoints found = match_points(points, chain(3, "contact.stiffness"), scales);
  CHECK(found.name == std::vector<int>{1, 1, -1, 0, 0, 0});
}

TEST_CASE("a wiggle beside a fold is not the fold") {
  std::vector<CasePoint> points = {point(0, 0.1005), point(1, 0.1004), point(1, 0.10049)};
  points[0].prominence = 0.018;
  points[1].prominence = 0.017;
  points[2].prominence = 1e-5;
  CHECK(match_points(points, chain(2), scales).name == std::vector<int>{0, 0, -1});
}

TEST_CASE("a point that may be either of two has no name") {
  // 1e-4 m from one, 1.5e-4 m from the other.
  CHECK(match_points({point(0, 0.1), point(1, 0.1001), point(1, 0.10015)}, chain(2), scales).names == 0);
  CHECK(match_points({point(0, 0.1), point(1, 0.1001), point(1, 0.1005)}, chain(2), scales).names == 1);
}

TEST_CASE("a method without the point stands beside one that has it") {
  // 0: reference, 1: its coarser step; 2, 3: another method; 4: a third one, fold elsewhere.
  std::vector<CaseLink> links = chain(2);
  links.push_back({0, "mass.velocity", false});
  links.push_back({2, "steps_per_period", true});
  links.push_back({0, "contact.stiffness", true});
  const std::vector<CasePoint> points = {point(0, 0.100565), point(1, 0.10055), point(3, 0.10053), point(4, 0.09)};
  const MatchedPoints found = match_points(points, links, scales);
  CHECK(found.names == 1);
  // Case 2 lacks it: case 3 is compared with the reference.
  CHECK(found.name == std::vector<int>{0, 0, 0, -1});
}

TEST_CASE("two branches that meet at a point have it once") {
  std::vector<CasePoint> points = moving(2);
  CasePoint twin = points[1];
  twin.branch = 2;
  twin.arc = 0;
  points.push_back(twin);
  const MatchedPoints found = match_points(points, chain(2), scales);
  CHECK(found.names == 3);
  CHECK(found.name.back() == found.name[1]);
  CHECK(found.sharing[1] == 1);
}

TEST_CASE("the order of cases and points changes nothing") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(0.067, 0.11), tip(-0.01, 0.01);
  std::vector<CasePoint> points;
  for (const CasePoint& one : moving(4)) points.push_back(one);
  for (std::size_t c = 0; c < 4; ++c)
    for (int k = 0; k < 10; ++k) points.push_back(point(c, place(random), tip(random)));
  const std::vector<CaseLink> links = chain(4);
  const MatchedPoints expected = match_points(points, links, scales);
  CHECK(expected.names >= 3);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<std::size_t> cases(4), order(points.size());
    std::iota(cases.begin(), cases.end(), 0);
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(cases.begin(), cases.end(), random);
    std::shuffle(order.begin(), order.end(), random);
    std::vector<CaseLink> moved(4);
    for (std::size_t c = 0; c < 4; ++c) {
      moved[cases[c]] = links[c];
      if (links[c].to) moved[cases[c]].to = cases[*links[c].to];
    }
    std::vector<CasePoint> shuffled;
    for (const std::size_t k : order) {
      shuffled.push_back(points[k]);
      shuffled.back().owner = cases[points[k].owner];
    }
    const MatchedPoints found = match_points(shuffled, moved, scales);
    REQUIRE(found.names == expected.names);
    for (std::size_t k = 0; k < order.size(); ++k) {
      CHECK(found.name[k] == expected.name[order[k]]);
      CHECK(found.sharing[k] == expected.sharing[order[k]]);
    }
  }
}

TEST_CASE("links that lead nowhere or in a circle are refused") {
  CHECK_THROWS_AS(match_points({}, {{5, "step", true}}, scales), std::invalid_argument);
  CHECK_THROWS_AS(match_points({}, {{1, "step", true}, {0, "step", true}}, scales), std::invalid_argument);
  CHECK_THROWS_AS(match_points({point(3, 0.1)}, chain(2), scales), std::invalid_argument);
  CHECK(match_points({}, {}, scales).names == 0);
}

TEST_CASE("a branch that passed a place without the point says how far it went") {
  std::optional<BranchReach> passed;
  CHECK(presence_of(0.1, 1e-4, 1, {}, &passed) == PointPresence::found);
  CHECK(presence_of(0.1, 1e-4, 3, {}, &passed) == PointPresence::many);
  CHECK(presence_of(0.1, 1e-4, 0, {{0.06, 0.125}, {0.08, 0.11}}, &passed) == PointPresence::absent);
  REQUIRE(passed);
  CHECK(passed->to == 0.125);
  // It ended before, or turned within the margin.
  CHECK(presence_of(0.1, 1e-4, 0, {{0.06, 0.0999}}, &passed) == PointPresence::not_reached);
  CHECK(presence_of(0.1, 1e-4, 0, {{0.06, 0.10005}}, &passed) == PointPresence::not_reached);
  CHECK_FALSE(passed);
}

// Orders and limits of special points whose law is known: v = x + c hᵖ, with noise inside the intervals.

namespace {

std::vector<PointLevel> levels(const std::vector<double>& sizes, const std::function<double(double)>& law,
                               double half = 0) {
  std::vector<PointLevel> out;
  for (const double size : sizes) out.push_back({size, law(size), half});
  return out;
}

std::vector<double> halved(int count, double coarsest = 1e-3) {
  std::vector<double> out;
  for (int k = 0; k < count; ++k) out.push_back(coarsest * std::pow(0.5, k));
  return out;
}

}  // namespace

TEST_CASE("a point that moves with a power of the step shows that power and its limit") {
  for (const double p : {1.0, 2.0, 3.8})
    for (const auto& sizes : {halved(3), halved(5), std::vector<double>{1.0 / 10, 1.0 / 20, 1.0 / 50},
                              std::vector<double>{1.0 / 10, 1.0 / 15, 1.0 / 40, 1.0 / 60, 1.0 / 200}}) {
      INFO("p " << p << " over " << sizes.size() << " sizes from " << sizes.front());
      const double c = 0.01 / std::pow(sizes.front(), p);
      const auto given = levels(sizes, [&](double h) { return 0.1 + c * std::pow(h, p); });
      const PointOrder order = point_order(given);
      REQUIRE(order.order);
      // Differences of numbers near 0.1 carry a round-off of 1e-17 in differences of 1e-8 and more.
      CHECK(*order.order == Approx(p).epsilon(1e-6));
      CHECK(*order.low < p);
      CHECK(*order.high > p);
      CHECK(order.told);
      CHECK(order.used == sizes.size());
      const PointLimit limit = point_limit(given, order);
      CHECK(limit.value == Approx(0.1).epsilon(1e-9));
      REQUIRE(limit.open);
      if (sizes.size() > 3)
        CHECK(*limit.open == Approx(std::abs(limit.correction)));
      else
        CHECK(*limit.open >= std::abs(limit.correction) * (1 - 1e-9));
    }
}

TEST_CASE("a limit by an order of three sizes holds the truth of any order from one on") {
  for (const double truly : {1.0, 1.5, 2.0})
    for (const double told : {1.0, 2.0, 3.0, 4.0}) {
      if (told < truly) continue;
      const auto given = levels(halved(3), [&](double h) { return 0.1 + 10 * std::pow(h, truly); });
      PointOrder order = point_order(given);
      order.order = told;
      const PointLimit limit = point_limit(given, order);
      INFO(truly << " taken for " << told);
      CHECK(std::abs(limit.value - 0.1) <= *limit.open * (1 + 1e-9));
    }
}

TEST_CASE("noise inside the intervals leaves the order in its interval and the limit within what is open") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> noise(-1, 1);
  const double half = 1e-6;
  int inside = 0, told = 0, limits = 0;
  constexpr int trials = 200;
  for (int trial = 0; trial < trials; ++trial) {
    // Differences of 3e-3, 7.5e-4: the second is moved by a quarter of a percent at most.
    auto given = levels(halved(3), [](double h) { return 0.1 + 4e3 * h * h; });
    for (PointLevel& one : given) one.value += half * noise(random), one.half = half;
    const PointOrder order = point_order(given);
    told += order.told;
    inside += order.told && *order.low <= 2 && 2 <= *order.high;
    const PointLimit limit = point_limit(given, order);
    limits += std::abs(limit.value - 0.1) <= *limit.open + half;
  }
  // The interval of three sizes holds every noise that the intervals allow; half of the last correction is more.
  CHECK(told == trials);
  CHECK(inside == trials);
  CHECK(limits == trials);
}

TEST_CASE("an order needs three sizes whose differences stand above their intervals") {
  const auto square = [](double h) { return 0.1 + 4e3 * h * h; };
  CHECK_FALSE(point_order(levels(halved(2), square)).told);
  CHECK(point_order(levels(halved(2), square)).reason == "2 sizes, three are needed");
  CHECK_FALSE(point_order(levels(halved(1), square)).order);
  // Of three differences 3e-3, 7.5e-4, 1.9e-4 the last is less than four half intervals on both sides.
  const PointOrder two = point_order(levels(halved(4), square, 3e-5));
  CHECK(two.used == 3);
  CHECK(two.order);
  const PointOrder none = point_order(levels(halved(4), square, 2e-4));
  CHECK_FALSE(none.order);
  CHECK_FALSE(none.told);
  CHECK(none.reason == "1 of 3 differences are above their intervals and of one sign, two are needed");
}

TEST_CASE("differences that change sign or grow tell no order") {
  const PointOrder alternating = point_order({{1, 0.1, 0}, {0.5, 0.2, 0}, {0.25, 0.15, 0}});
  CHECK_FALSE(alternating.told);
  CHECK_FALSE(alternating.order);
  const PointOrder growing = point_order({{1, 0.1, 0}, {0.5, 0.2, 0}, {0.25, 0.5, 0}});
  CHECK(growing.order);
  CHECK_FALSE(growing.told);
  CHECK(growing.reason == "the differences do not fall for certain");
  // Without an order the limit is the finest value and what refinement still moves.
  const PointLimit limit = point_limit({{1, 0.1, 0}, {0.5, 0.2, 0}, {0.25, 0.15, 0}}, alternating);
  CHECK(limit.value == 0.15);
  CHECK(limit.correction == 0);
  CHECK(*limit.open >= 0.05);
}

TEST_CASE("values that agree within their intervals leave open what they differ by") {
  const std::vector<PointLevel> levels = {{1, 0.1, 1e-5}, {0.5, 0.100002, 1e-5}, {0.25, 0.100001, 1e-5}};
  const PointOrder order = point_order(levels);
  CHECK_FALSE(order.told);
  const PointLimit limit = point_limit(levels, order);
  CHECK(limit.status == LimitStatus::same);
  CHECK(*limit.open == Approx(2e-6));
}

TEST_CASE("one size leaves open what refinement moves") {
  const std::vector<PointLevel> one = {{1e-3, 0.1, 1e-6}};
  const PointLimit limit = point_limit(one, point_order(one));
  CHECK(limit.value == 0.1);
  CHECK_FALSE(limit.open);
  CHECK(limit.status == LimitStatus::one);
  CHECK_THROWS_AS(point_limit({}, PointOrder()), std::invalid_argument);
  CHECK_THROWS_AS(point_order({{0, 1, 0}, {1, 1, 0}, {2, 1, 0}}), std::invalid_argument);
  CHECK_THROWS_AS(point_order({{1, 1, -1}, {2, 1, 0}, {3, 1, 0}}), std::invalid_argument);
}

TEST_CASE("units and the order of the sizes do not change an order") {
  auto given = levels(
      halved(5), [](double h) { return 0.1 + 4e3 * h * h + 1e5 * h * h * h; }, 1e-9);
  const PointOrder order = point_order(given);
  REQUIRE(order.order);
  std::swap(given[0], given[3]);
  for (PointLevel& one : given) one.size *= 7, one.value *= 1e3, one.half *= 1e3;
  const PointOrder scaled = point_order(given);
  CHECK(*scaled.order == Approx(*order.order).epsilon(1e-9));
  CHECK(scaled.told == order.told);
}

TEST_CASE("a stiffness is a size as its compliance is") {
  // Shifts −1.1e-3, −1.1e-4, −1.1e-5 m at 1e4, 1e5, 1e6 N/m: order 1 in 1/κ.
  const auto given = levels(
      {1e-4, 1e-5, 1e-6}, [](double compliance) { return 0.1 - 11 * compliance; }, 1e-7);
  const PointOrder order = point_order(given);
  REQUIRE(order.told);
  CHECK(*order.order == Approx(1).epsilon(1e-9));
  CHECK(point_limit(given, order).value == Approx(0.1).epsilon(1e-12));
}
