// Special points of branches that are given corner by corner.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <ricochet/measure/orbits/special_points.hpp>

using namespace ricochet;

namespace {

// A branch through these values, a metre of arc between two of them.
BranchTrace branch_through(const std::vector<double>& path) {
  BranchTrace trace;
  for (std::size_t i = 0; i < path.size(); ++i) {
    BranchCorner corner;
    corner.parameter = corner.tip = path[i];
    corner.arc = static_cast<double>(i);
    corner.runs = 1;
    corner.way = i + 1 < path.size() ? (path[i + 1] < path[i] ? -1 : 1) : (path[i] < path[i - 1] ? -1 : 1);
    trace.corners.push_back(corner);
  }
  return trace;
}

std::vector<SpecialPoint> points_of(const std::vector<SpecialPoint>& points, PointKind kind) {
  std::vector<SpecialPoint> own;
  for (const SpecialPoint& point : points)
    if (point.kind == kind) own.push_back(point);
  return own;
}

PointSearch folds_from(double prominence) {
  PointSearch search;
  search.prominence = prominence;
  return search;
}

CornerRoots roots(const std::vector<std::complex<double>>& multipliers) {
  return roots_at(multipliers);
}

}  // namespace

TEST_CASE("a fold is as prominent as its branch, wherever that began") {
  // An oscillator's response: it began at 0.1, folds at 0.69 and at 0.081, and goes on.
  for (const double began : {0.1, 0.0811, 0.6}) {
    const std::vector<Turn> turns = turns_of(branch_through({began, 0.69, 0.081, 3}));
    REQUIRE(turns.size() == 2);
    // Beyond the ends of the branch it might go on: such a way is no measure where the other one is.
    CHECK(turns[0].prominence == Approx(0.609));
    CHECK(turns[1].prominence == Approx(3 - 0.081));
    CHECK(turns[1].shortest == Approx(0.609));
  }
}

TEST_CASE("the other way from the first orbit belongs to the branch") {
  const BranchTrace up = branch_through({0.1, 0.1001, 0.05, 0.3}), down = branch_through({0.1, 0.02});
  CHECK(turns_of(up)[0].shortest == Approx(0.0001));
  CHECK(turns_of(up, &down)[0].shortest == Approx(0.0501));
}

TEST_CASE("turns between two others are as prominent as the smaller way, in any order of the values") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> value(0, 1);
  for (int times = 0; times < 20; ++times) {
    std::vector<double> path = {0};
    for (int i = 0; i < 30; ++i) path.push_back(path.back() + (i % 2 == 0 ? 1 : -1) * (0.01 + value(random)));
    for (const Turn& turn : turns_of(branch_through(path))) {
      // By definition.
      const auto at = static_cast<std::ptrdiff_t>(turn.corner);
      const double sign = path[static_cast<std::size_t>(at)] > path[static_cast<std::size_t>(at - 1)] ? 1 : -1;
      double shortest = 1e9;
      for (const std::ptrdiff_t step : {-1, 1}) {
        double way = 0;
        for (std::ptrdiff_t i = at; i >= 0 && i < std::ssize(path); i += step) {
          const double fall = sign * (path[static_cast<std::size_t>(at)] - path[static_cast<std::size_t>(i)]);
          if (fall < 0) break;
          way = std::max(way, fall);
        }
        shortest = std::min(shortest, way);
      }
      CHECK(turn.shortest == Approx(shortest));
      CHECK(turn.prominence >= turn.shortest);
    }
  }
}

TEST_CASE("a fold next to a graze, where its branch ends, is listed, and what turns by less is not") {
  // COCO's impact oscillator: from 1 N down to the fold at 0.0999708 N and back to the graze at 0.1 N.
  const auto found =
      points_of(special_points(branch_through({1, 0.5, 0.0999708, 0.1}), folds_from(1e-4)), PointKind::fold);
  REQUIRE(found.size() == 1);
  CHECK(found[0].parameter == 0.0999708);
  CHECK(points_of(special_points(branch_through({1, 0.5, 0.0999708, 0.099972}), folds_from(1e-4)), PointKind::fold)
            .empty());
  CHECK(points_of(special_points(branch_through({1, 0.5, 0.49999, 0.50001, 0.2}), folds_from(1e-4)), PointKind::fold)
            .empty());
}

TEST_CASE("where stops give back speed a turn within the uncertainty of orbits is none, and intervals hold it") {
  BranchTrace trace = branch_through({1, 0.4, 0.402, 0.3, 0.9});
  for (BranchCorner& corner : trace.corners) corner.rebounds = corner.placed = 0.005;
  trace.rebounds = 0.005;
  const auto found = points_of(special_points(trace, folds_from(1e-4)), PointKind::fold);
  REQUIRE(found.size() == 1);
  CHECK(found[0].parameter == 0.3);
  CHECK(found[0].low <= 0.295);
  CHECK(found[0].high >= 0.305);
}

TEST_CASE("a branch that comes by its folds again has each once") {
  BranchTrace trace = branch_through({0.5, 0.9, 0.2, 0.9, 0.2, 0.9, 0.2, 0.5});
  CHECK(points_of(special_points(trace, folds_from(1e-4)), PointKind::fold).size() == 2);
}

TEST_CASE("a multiplier that was one of a pair a corner before passes −1 where the product of 1 + μ does") {
  // c = 0.9077 = μ₁ μ₂; the trace goes on linearly: 1 + trace + c = 0 at −1.9077.
  for (const double step : {0.05, 0.2, 0.7}) {
    BranchTrace trace = branch_through({0, 1, 2, 3});
    for (BranchCorner& corner : trace.corners) {
      const double sum = -1.9077 - step * (corner.parameter - 1.3), det = 0.9077;
      const std::complex<double> root = std::sqrt(std::complex<double>(sum * sum / 4 - det));
      std::vector<std::complex<double>> both = {sum / 2 + root, sum / 2 - root};
      corner.raw = corner.smooth = roots(both);
    }
    const auto flips = points_of(special_points(trace, {}), PointKind::flip);
    REQUIRE(flips.size() == 1);
    CHECK(flips[0].parameter == Approx(1.3));
    CHECK(flips[0].low < 1.3);
    CHECK(flips[0].high > 1.3);
    CHECK(flips[0].multiplier == std::complex<double>(-1));
  }
}

TEST_CASE("of crossings that flicker the one stands for them after which the count stays") {
  // It is lost at 10.5 for good; between 30 and 33 it comes back for short whiles.
  std::vector<double> path;
  for (int i = 0; i < 60; ++i) path.push_back(i);
  BranchTrace trace = branch_through(path);
  for (BranchCorner& corner : trace.corners) {
    const double at = corner.parameter;
    const bool outside = at > 10.5 && at != 30 && at != 32;
    corner.arc *= 1e-4;
    corner.raw = corner.smooth = roots({outside ? -1.1 : -0.9, 0.5});
  }
  PointSearch search;
  search.half = true;
  const auto found = points_of(special_points(trace, search), PointKind::symmetry);
  REQUIRE(found.size() == 1);
  CHECK(found[0].parameter == Approx(10.5));
  CHECK(found[0].low <= 11);
  CHECK(found[0].high >= 33);
}

TEST_CASE("a multiplier that jumps over −1 with a contact and back beside it is no point") {
  BranchTrace trace = branch_through({0, 1, 2, 3, 4, 5});
  for (BranchCorner& corner : trace.corners) {
    corner.arc *= 1e-4;
    const bool more = corner.parameter == 2 || corner.parameter == 3;
    corner.runs = more ? 2 : 1;
    corner.raw = corner.smooth = roots({more ? -5 : -0.5, 0.1});
  }
  CHECK(points_of(special_points(trace, {}), PointKind::flip).empty());
  for (BranchCorner& corner : trace.corners)
    if (corner.parameter > 3) corner.raw = corner.smooth = roots({-4, 0.1}), corner.runs = 2;
  const auto flips = points_of(special_points(trace, {}), PointKind::flip);
  REQUIRE(flips.size() == 1);
  CHECK(flips[0].parameter == 2);
  CHECK_FALSE(flips[0].multiplier);
}

TEST_CASE("two crossings far apart along the branch are two points, however few pieces lie between them") {
  std::vector<double> path;
  for (int i = 0; i < 30; ++i) path.push_back(i);
  for (const double arc : {1e-2, 1e-3, 3e-4}) {  // of a piece; the gap is 0.1
    INFO(arc);
    BranchTrace trace = branch_through(path);
    for (BranchCorner& corner : trace.corners) {
      corner.arc *= arc;
      const bool outside = corner.parameter > 8.5 && corner.parameter < 24.5;
      corner.raw = corner.smooth = roots({outside ? -1.2 : -0.8, 0.5});
    }
    const auto flips = points_of(special_points(trace, {}), PointKind::flip);
    REQUIRE(flips.size() == 2);
    CHECK(flips[0].parameter == Approx(8.5));
    CHECK(flips[0].high < 12);
    CHECK(flips[1].parameter == Approx(24.5));
    CHECK(flips[1].low > 20);
  }
}

TEST_CASE("contacts are known to round-off, those that change at once are one, and a permanent one opens") {
  BranchTrace trace = branch_through({0.1, 0.225, 0.225, 0.3, 0.4});
  const int runs[] = {0, 1, 2, 2, 2};
  for (std::size_t i = 0; i < trace.corners.size(); ++i) {
    trace.corners[i].runs = runs[i];
    if (i > 0) trace.corners[i].change = {static_cast<long long>(i), 0, true, true};
    trace.corners[i].residual = 1e-15;
  }
  auto contacts = points_of(special_points(trace, {}), PointKind::contact);
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].parameter == 0.225);
  CHECK(contacts[0].high - contacts[0].low < 1e-11);
  CHECK(contacts[0].runs_before == 0);
  CHECK(contacts[0].runs_after == 2);
  CHECK(contacts[0].note == "first contact; 2 contacts change at once");
  // Closed all the time, then all the time but for a step: one run before and after.
  for (std::size_t i = 0; i < trace.corners.size(); ++i) {
    trace.corners[i].runs = 1;
    trace.corners[i].held = i < 3 ? 1 : 0;
    trace.corners[i].change.closes = false;
  }
  contacts = points_of(special_points(trace, {}), PointKind::contact);
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].parameter == 0.3);
  CHECK(contacts[0].note == "a permanent contact opens");
}
