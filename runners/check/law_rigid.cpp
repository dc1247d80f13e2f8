#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/check/law_checks.hpp"

namespace ricochet::checking {
namespace {

// How far efforts and measures are from lower ≤ y ⊥ p ≤ upper, in units of y.
double residual(const Eigen::MatrixXd& W, double reach, const LaneProblem& lane, const Eigen::VectorXd& p) {
  const Eigen::VectorXd y = lane.free + reach * (W * p);
  double worst = 0;
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    worst = std::max({worst, lane.lower[i] - y[i], y[i] - lane.upper[i]});
    const double own = reach * W(i, i) * std::abs(p[i]);
    if (p[i] > 0) worst = std::max(worst, std::min(own, y[i] - lane.lower[i]));
    if (p[i] < 0) worst = std::max(worst, std::min(own, lane.upper[i] - y[i]));
  }
  return worst;
}

double depth_of(const LaneProblem& lane) {
  double deepest = 0;
  for (Eigen::Index i = 0; i < lane.free.size(); ++i)
    deepest = std::max({deepest, lane.lower[i] - lane.free[i], lane.free[i] - lane.upper[i]});
  return deepest;
}

}  // namespace

Verdict complementarity_holds(const Law& law) {
  if (law.make()->absent()) return not_applicable("the law is the absence of contact");
  if (law.make()->reads()) return not_applicable("a compliant law");
  std::mt19937 random(20240611);
  double worst = 0;
  for (const int points : {1, 3, 10})
    for (const bool two_sided : {false, true})
      for (int k = 0; k < 12; ++k) {
        LawBench bench(law, points, 1);
        DenseDelassus W = random_delassus(random, points, 1e-4);
        const double reach = k % 2 ? 1.0 : 0.25;
        LaneProblem lane = random_lane(random, points, two_sided);
        if (k == 5) lane.free = lane.lower;
        bench.solve(W, reach, 0, {lane}, {0});
        const LaneOutcome& outcome = bench.outcome(0);
        const Eigen::VectorXd p = bench.effort(0);
        const std::string where = fmt::format("{} point{}, {}", points, points == 1 ? "" : "s",
                                              two_sided ? "stops on both sides" : "a lower stop");
        if (!p.allFinite()) return fails(where + ": an effort is not finite");
        if (!outcome.converged) return fails(where + ": says that it did not converge");
        if (outcome.iterations < 0 || !(outcome.residual >= 0))
          return fails(where + ": reports a negative count of iterations or a residual that is no number ≥ 0");
        const double deepest = depth_of(lane), found = residual(W.matrix(), reach, lane, p);
        const double scale = std::max(deepest, 1e-6);
        if (found > outcome.residual * (1 + 1e-6) + 1e-9 * scale)
          return fails(
              fmt::format("{}: the efforts leave {:.3g} of the deepest violation {:.3g} (in units of the "
                          "measure), and the law owns up to {:.3g}",
                          where, found, deepest, outcome.residual));
        worst = std::max(worst, found / scale);
      }
  return fine(
      fmt::format("1, 3 and 10 points, one and two stops: {:.1g} of the violation is left, as reported", worst));
}

}  // namespace ricochet::checking
