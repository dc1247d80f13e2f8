// Orders fitted to errors whose law is known.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <ricochet/measure/motion/orders.hpp>

using namespace ricochet;

namespace {

std::vector<OrderPoint> errors(int count, double ratio, const std::function<double(double)>& law, double floor = 0,
                               double coarsest = 0.1) {
  std::vector<OrderPoint> points;
  for (int k = 0; k < count; ++k) {
    const double size = coarsest * std::pow(ratio, -k);
    points.push_back({size, law(size), floor});
  }
  return points;
}

bool says(const OrderFit& fit, const std::string& words) {
  return fit.reason.find(words) != std::string::npos;
}

}  // namespace

TEST_CASE("a power law gives its power, and an interval that is not zero") {
  for (const double power : {0.5, 1.0, 2.0, 4.0})
    for (const double ratio : {1.5, 2.0, 10.0})
      for (const int count : {3, 5, 9}) {
        INFO("power " << power << " ratio " << ratio << " points " << count);
        const auto points = errors(count, ratio, [&](double r) { return 3 * std::pow(r, power); });
        const OrderFit fit = fit_order(points, {power});
        REQUIRE(fit.order);
        CHECK(*fit.order == Approx(power).epsilon(1e-10));  // sums of a dozen logarithms
        CHECK(*fit.constant == Approx(3).epsilon(1e-9));
        CHECK(fit.points == points.size());
        CHECK(*fit.low < power);
        CHECK(*fit.high > power);
        // The 2 % of trust over three points of ratio 1.5: 2·0.02/ln 2.25 = 0.0493.
        CHECK(*fit.high - *fit.low < 2 * 0.0495);
        CHECK(fit.verdict == OrderVerdict::confirmed);
        CHECK(fit_order(points, {power + 0.5}).verdict == OrderVerdict::refuted);
        const OrderFit faster = fit_order(points, {power - 0.4});
        CHECK(faster.verdict == (count < 5 ? OrderVerdict::undecided : OrderVerdict::refuted));
        if (count < 5) CHECK(says(faster, "faster than the declared"));
        const OrderFit silent = fit_order(points);
        CHECK(silent.verdict == OrderVerdict::undecided);
        CHECK(says(silent, "no order is declared"));
        CHECK(silent.order == fit.order);
      }
}

TEST_CASE("units and the order of the points do not matter") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> scatter(0.7, 1.3);
  auto points = errors(
      7, 2, [&](double r) { return r * scatter(random); }, 1e-4);
  const OrderFit fit = fit_order(points, {1});
  auto scaled = points;
  for (OrderPoint& p : scaled) p = {1e3 * p.size, 1e-6 * p.error, 1e-6 * p.floor};
  const OrderFit same = fit_order(scaled, {1});
  // Logarithms shifted by a constant: round-off of a few ulps of ln 10⁻⁶.
  CHECK(*same.order == Approx(*fit.order).epsilon(1e-12));
  CHECK(*same.low == Approx(*fit.low).epsilon(1e-12));
  CHECK(*same.constant == Approx(*fit.constant * 1e-6 * std::pow(1e-3, *fit.order)).epsilon(1e-10));
  CHECK(same.verdict == fit.verdict);
  auto shuffled = points;
  std::shuffle(shuffled.begin(), shuffled.end(), random);
  const OrderFit again = fit_order(shuffled, {1});
  CHECK(again.order == fit.order);
  CHECK(again.high == fit.high);
  CHECK(shuffled[again.first].size == points[fit.first].size);
  CHECK(shuffled[again.last].size == points[fit.last].size);
}

TEST_CASE("errors that scatter by half their size keep their order inside the interval") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> scatter(0.5, 1.5);
  for (const int count : {5, 8}) {
    int covered = 0, fitted = 0, refuted = 0, lower_refuted = 0;
    for (int trial = 0; trial < 400; ++trial) {
      const auto points = errors(count, 2, [&](double r) { return r * scatter(random); });
      const OrderFit fit = fit_order(points, {1});
      if (!fit.order) continue;
      ++fitted;
      covered += *fit.low <= 1 && 1 <= *fit.high;
      refuted += fit.verdict == OrderVerdict::refuted;
      lower_refuted += fit_order(points, {2}).verdict == OrderVerdict::refuted;
    }
    INFO(count << " points: covered " << covered << " refuted " << refuted << " of " << fitted);
    CHECK(fitted >= 380);
    // 95 % nominal; the search for a window and 400 draws (±2 %) may cost some.
    CHECK(covered >= 0.89 * fitted);
    CHECK(refuted <= 0.04 * fitted);
    if (count == 8) CHECK(lower_refuted >= 0.95 * fitted);
  }
}

TEST_CASE("the coarse end that does not obey the law is cut") {
  // A plateau until r = 0.1, order 2 from there.
  const OrderFit flat = fit_order(errors(
                                      9, 2, [](double r) { return std::min(0.01, r * r); }, 0, 1),
                                  {2});
  CHECK(flat.verdict == OrderVerdict::confirmed);
  CHECK(flat.first >= 3);
  CHECK(flat.last == 8);
  CHECK(*flat.order == Approx(2).margin(0.01));
  CHECK(says(flat, "pre-asymptotic"));
  // Order 4 at first, 2 in the end: the fine range is what counts, although it is the shorter one.
  const auto both = errors(
      13, 2, [](double r) { return 1e-4 * r * r + std::pow(r, 4); }, 0, 1);
  const OrderFit fine = fit_order(both, {2});
  CHECK(fine.verdict == OrderVerdict::confirmed);
  CHECK(both[fine.first].size < 0.02);
}

TEST_CASE("the end where errors meet round-off is cut, said or not") {
  const auto law = [](double r) { return r * r + 1e-14 / (r * r); };
  for (const int count : {10, 14, 18}) {
    const auto points = errors(count, 2, law);
    const OrderFit fit = fit_order(points, {2});
    CHECK(fit.verdict == OrderVerdict::confirmed);
    CHECK(*fit.order == Approx(2).margin(0.01));
    CHECK(points[fit.last].size > 3e-4);  // where both terms are equal
  }
  const auto points = errors(
      14, 2, [](double r) { return r * r + 1e-6; }, 1e-6);
  const OrderFit fit = fit_order(points, {2});
  CHECK(fit.verdict == OrderVerdict::confirmed);
  CHECK(points[fit.last].error > 4e-6);  // the floor times the factor of the header
}

TEST_CASE("a floor widens the interval") {
  const auto law = [](double r) { return r; };
  const OrderFit sure = fit_order(errors(5, 2, law)), unsure = fit_order(errors(5, 2, law, 1e-3));
  CHECK(*unsure.order == Approx(*sure.order));
  CHECK(*unsure.high - *unsure.low > 2 * (*sure.high - *sure.low));
}

TEST_CASE("fewer than three usable points give no order but a reason") {
  for (const int count : {0, 1, 2}) {
    const OrderFit fit = fit_order(errors(count, 2, [](double r) { return r; }), {1});
    CHECK_FALSE(fit.order);
    CHECK_FALSE(fit.low);
    CHECK(fit.verdict == OrderVerdict::undecided);
    CHECK(says(fit, "three are needed"));
  }
  // Exact answers have no order.
  CHECK_FALSE(fit_order(errors(6, 2, [](double) { return 0.0; }), {1}).order);
  CHECK(says(fit_order(errors(6, 2, [](double) { return 0.0; }), {1}), "error floor"));
  // Absent errors do not count.
  auto absent = errors(4, 2, [](double r) { return r; });
  absent[1].error = std::numeric_limits<double>::quiet_NaN();
  absent[2].error = std::numeric_limits<double>::infinity();
  CHECK_FALSE(fit_order(absent, {1}).order);
}

TEST_CASE("another error that dominates is named") {
  OrderQuestion question{2, "step", 2e-3, "the mesh"};
  const OrderFit fit = fit_order(errors(6, 2, [](double r) { return 0.1 * r * r + 2e-3; }), question);
  CHECK_FALSE(fit.order);
  CHECK(fit.verdict == OrderVerdict::undecided);
  CHECK(says(fit, "the error of the mesh, about 0.002, dominates 6"));
  // With points above it, those are used.
  const OrderFit above = fit_order(errors(9, 2, [](double r) { return r * r + 1e-5; }), {2, "step", 1e-5, "the mesh"});
  CHECK(above.verdict == OrderVerdict::confirmed);
}

TEST_CASE("too slow refutes nothing where an unknown error may dominate") {
  // The error of one mesh, seen by a reference of the continuous problem.
  const auto law = [](double r) { return 1e-3 + 0.01 * r; };
  OrderQuestion question{1, "step", 0, "the mesh"};
  CHECK(fit_order(errors(6, 2, law), question).verdict == OrderVerdict::refuted);
  question.other_unknown = true;
  const OrderFit fit = fit_order(errors(6, 2, law), question);
  CHECK(fit.verdict == OrderVerdict::undecided);
  CHECK(says(fit, "the error of the mesh, which nothing tells, may dominate"));
  // Too fast is not its doing.
  question.declared = 0.5;
  CHECK(fit_order(errors(6, 2, [](double r) { return r * r; }), question).verdict == OrderVerdict::refuted);
}

TEST_CASE("a range that the finest points leave refutes nothing") {
  // Falls by 2, then wanders.
  const double tail[] = {1e-4, 4e-4, 9e-5};
  int at = 0;
  const auto points = errors(8, 2, [&](double r) { return r > 4e-3 ? r * r : tail[at++]; });
  const OrderFit fit = fit_order(points, {1});
  CHECK(*fit.order == Approx(2).margin(0.01));
  CHECK(fit.verdict == OrderVerdict::undecided);
  CHECK(says(fit, "do not follow"));
}

TEST_CASE("errors that stop falling are no order, errors that never fall are") {
  // Two points above a plateau that nobody announced.
  const OrderFit plateau = fit_order(errors(8, 2, [](double r) { return std::max(std::pow(r, 4), 2e-6); }), {4});
  CHECK(plateau.verdict == OrderVerdict::undecided);
  CHECK(says(plateau, "stops falling at 2e-06"));
  const OrderFit never = fit_order(errors(6, 2, [](double) { return 0.3; }), {1});
  CHECK(never.verdict == OrderVerdict::refuted);
  CHECK(*never.order == Approx(0).margin(1e-12));
  CHECK(says(never, "does not fall"));
  const OrderFit grows = fit_order(errors(6, 2, [](double r) { return 1 / r; }), {1});
  CHECK(grows.verdict == OrderVerdict::refuted);
}

TEST_CASE("an error on its way through zero is left out") {
  const auto points = errors(8, 2, [](double r) { return std::abs(r - 0.1 / 16.0 * 1.02 * (r < 0.01 && r > 0.005)); });
  REQUIRE(points[4].error < 0.03 * points[5].error * 2);
  const OrderFit fit = fit_order(points, {1});
  CHECK(fit.left_out == std::vector<std::size_t>{4});
  CHECK(fit.points == 7);
  CHECK(*fit.order == Approx(1).epsilon(1e-10));
  CHECK(fit.verdict == OrderVerdict::confirmed);
}

TEST_CASE("an order on its way to the declared one is not refuted") {
  for (const int count : {4, 5, 6, 8, 12}) {
    INFO(count);
    const OrderFit fit = fit_order(errors(
                                       count, 2, [](double r) { return r * r * (1 + 10 * r); }, 0, 0.5),
                                   {2});
    CHECK(fit.verdict != OrderVerdict::refuted);
    if (count == 12) CHECK(fit.verdict == OrderVerdict::confirmed);
  }
}

TEST_CASE("three grids of one ratio give Richardson's limit and Roache's index") {
  for (const double power : {1.0, 2.0, 3.5}) {
    const auto f = [&](double h) { return 7 - 2 * std::pow(h, power); };
    const auto grids = grid_convergence(f(0.4), f(0.2), f(0.1), 2);
    REQUIRE(grids);
    CHECK(grids->order == Approx(power).epsilon(1e-10));
    CHECK(grids->extrapolated == Approx(7).epsilon(1e-12));
    CHECK(grids->index == Approx(1.25 * std::abs(f(0.1) - 7)).epsilon(1e-10));
  }
  CHECK_FALSE(grid_convergence(1, 1.1, 1.05, 2));  // oscillates
  CHECK_FALSE(grid_convergence(1, 2, 4, 2));       // diverges
  CHECK_FALSE(grid_convergence(1, 1, 1, 2));       // nothing to extrapolate
  CHECK_FALSE(grid_convergence(4, 2, 1, 1));
  // In a fit: of the values where they are given, of the errors where not.
  auto points = errors(5, 2, [](double r) { return 2 * r * r; });
  const double finest = points.back().error;
  CHECK(*fit_order(points).gci == Approx(1.25 * finest).epsilon(1e-9));
  for (OrderPoint& p : points) p.value = 7 - 5 * p.error;
  CHECK(*fit_order(points).gci == Approx(1.25 * 5 * finest).epsilon(1e-9));
  points[3].size *= 1.1;
  CHECK_FALSE(fit_order(points).gci);
}

TEST_CASE("repeated sizes are one point") {
  auto points = errors(4, 2, [](double r) { return 2 * r; });
  const auto half = errors(4, 2, [](double r) { return 0.5 * r; });
  points.insert(points.end(), half.begin(), half.end());
  const OrderFit fit = fit_order(points, {1});
  CHECK(fit.points == 4);
  CHECK(*fit.constant == Approx(1).epsilon(1e-10));
}

TEST_CASE("what is no error is refused") {
  CHECK_THROWS_AS(fit_order({{0, 1}, {1, 1}, {2, 1}}), std::invalid_argument);
  CHECK_THROWS_AS(fit_order({{1, -1}}), std::invalid_argument);
  CHECK_THROWS_AS(fit_order({{1, 1, -1}}), std::invalid_argument);
}
