#include "runners/check/law_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/kernels/eigenvalues.hpp>

#include "runners/check/allocation_count.hpp"
#include "runners/check/bench.hpp"

namespace ricochet::checking {
namespace {

struct ClosedStructure {
  const char* name;
  SceneSpec scene;
  int elements;
};

std::vector<ClosedStructure> closed_structures() {
  const auto structure = [](bool beam, bool everywhere) {
    return structure_scene({.beam = beam, .stops = true, .everywhere = everywhere});
  };
  return {{"a beam with stops at its tip", structure(true, false), 4},
          {"a beam with stops at all nodes", structure(true, true), 6},
          {"a bar with stops at its end", structure(false, false), 4},
          {"a bar with stops at all nodes", structure(false, true), 6},
          {"an oscillator", oscillator_scene({.position = 1, .stop = true}), 1}};
}

// What is wrong with the matrices, or nothing.
std::string wrong_with(const SemiDiscrete& problem) {
  const Eigen::MatrixXd K = problem.stiffness, G = problem.measured();
  if (!K.allFinite() || !G.allFinite()) return "the stiffness or the measure is not finite";
  if (G.rowwise().norm().minCoeff() == 0) return "a point measures nothing";
  const double size = K.cwiseAbs().maxCoeff(), skew = (K - K.transpose()).cwiseAbs().maxCoeff();
  if (!(skew <= 1e-12 * size)) return fmt::format("the stiffness is not symmetric: {:.3g} of {:.3g}", skew, size);
  const SymmetricModes modes = symmetric_modes(K, Eigen::MatrixXd(problem.own_stiffness), EigenVectors::none);
  if (!modes.found) return "the modes of the stiffness against that of the structure are not found";
  // Shares of the structure's own stiffness that are left.
  if (!(modes.values.minCoeff() > 1e-9))
    return fmt::format(
        "the stiffness is not positive: {:.3g} of the structure's own is left in one direction, which it "
        "should have refused",
        modes.values.minCoeff());
  return {};
}

}  // namespace

Verdict changed_problem_is_sound(const Law& law) {
  if (!law.make()->changes_problem()) return not_declared("takes structure and measure as they are");
  std::string refused;
  int taken = 0;
  for (const ClosedStructure& one : closed_structures()) {
    const auto first = law.make(), other = law.make();
    auto made = discretise(one.scene, one.elements, *consistent_bench_mass(), first.get());
    if (const auto* refusal = std::get_if<Refusal>(&made)) {
      refused = refusal->sentence.text;
      if (const std::string poor = poor_refusal(refused, law.entry->manual); !poor.empty())
        return fails(fmt::format("on {}: {}", one.name, poor));
      continue;
    }
    const auto& problem = std::get<SemiDiscrete>(made);
    if (const std::string wrong = wrong_with(problem); !wrong.empty())
      return fails(fmt::format("on {}: {}", one.name, wrong));
    show_problem(*other, problem);  // throws where a second law with the same parameters makes another problem
    ++taken;
  }
  if (taken == 0) throw Refused{refused};
  return fine(fmt::format("{} of {} structures: symmetric, positive, the same twice; the others refused in a sentence",
                          taken, closed_structures().size()));
}

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
  if (law.make()->absent()) return not_applicable(no_contact_at_all);
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
        if (!(found <= outcome.residual * (1 + 1e-6) + 1e-9 * scale))
          return fails(
              fmt::format("{}: the efforts leave {:.3g} of the deepest violation {:.3g} (in units of the "
                          "measure), and the law owns up to {:.3g}",
                          where, found, deepest, outcome.residual));
        worst = std::max(worst, found / scale);
      }
  return fine(
      fmt::format("1, 3 and 10 points, one and two stops: {:.1g} of the violation is left, as reported", worst));
}

// The arrays of a bench are guarded, whatever is asked; here they are of many sizes.
Verdict solve_stays_within(const Law& law) {
  if (law.make()->absent()) return not_applicable(no_contact_at_all);
  std::mt19937 random(20261129);
  const double flexibility = flexibility_of(law);
  for (const int points : {1, 2, 3, 10}) {
    LawBench bench(law, points, lanes_of_block), alone(law, points, 1);
    bench.remember(true);
    alone.remember(true);
    for (const std::vector<int>& touched : {std::vector<int>{0, 1, 2, 3}, {3}, {0}, {0, 1, 2, 3}}) {
      DenseDelassus W = random_delassus(random, points, flexibility);
      const std::vector<LaneProblem> lanes = random_lanes(random, points, barrier_of(law));
      bench.solve(W, reach_of(law), reach_of(law), lanes, touched);
      alone.solve(W, reach_of(law), reach_of(law), lanes, {0});
    }
  }
  return fine("nothing is touched beyond those that it is given, 1 to 10 points, 1 and 4 lanes");
}

Verdict solve_allocates_nothing(const Law& law) {
  if (law.make()->absent()) return not_applicable(no_contact_at_all);
  if (!allocations_are_counted()) return not_applicable("this build of the program cannot count allocations");
  std::mt19937 random(20240613);
  const double flexibility = flexibility_of(law);
  for (const int points : {1, 3, 10})
    for (int k = 0; k < 3; ++k) {
      LawBench bench(law, points, lanes_of_block);
      DenseDelassus W = random_delassus(random, points, flexibility);
      bench.solve(W, reach_of(law), reach_of(law), random_lanes(random, points, barrier_of(law)), {0, 1, 2, 3});
      if (bench.allocations() > 0)
        return fails(fmt::format("solve() allocates {} time{} for {} point{}: size what it needs in prepare()",
                                 bench.allocations(), bench.allocations() == 1 ? "" : "s", points,
                                 points == 1 ? "" : "s"));
    }
  return fine();
}

Verdict warm_start_changes_nothing(const Law& law) {
  if (law.make()->absent()) return not_applicable(no_contact_at_all);
  std::mt19937 random(20240616);
  const double flexibility = flexibility_of(law);
  for (const int points : {1, 3, 10})
    for (int k = 0; k < 4; ++k) {
      LawBench bench(law, points, 1);
      DenseDelassus W = random_delassus(random, points, flexibility);
      LaneProblem lane = random_lanes(random, points, barrier_of(law))[static_cast<std::size_t>(k)];
      bench.solve(W, reach_of(law), reach_of(law), {lane}, {0});
      const Eigen::VectorXd cold = bench.effort(0);
      const double first = bench.outcome(0).residual;
      lane.effort = -0.5 * cold;
      lane.effort.array() += 0.003 / flexibility;
      bench.solve(W, reach_of(law), reach_of(law), {lane}, {0});
      const double gap = (W.matrix() * (bench.effort(0) - cold)).cwiseAbs().maxCoeff();
      // An iteration that stops at a tolerance stops elsewhere from another start, and says how far off it is.
      const double allowed = 1e-6 * 0.02 + 100 * (first + bench.outcome(0).residual);
      if (!(gap <= allowed))
        return fails(
            fmt::format("{} points: from another effort of the last step it finds another solution, {:.3g} m "
                        "apart in the measure",
                        points, gap));
    }
  return fine("the same solution from zero and from other efforts");
}

}  // namespace ricochet::checking
