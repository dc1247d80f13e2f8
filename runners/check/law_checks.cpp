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
  if (skew > 1e-12 * size) return fmt::format("the stiffness is not symmetric: {:.3g} of {:.3g}", skew, size);
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
      refused = refusal->sentence;
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

namespace {

constexpr int block = 4;

bool absent(const Law& law) {
  return law.make()->absent();
}
Verdict no_contact_at_all() {
  return not_applicable("the law is the absence of contact");
}

// A barrier is only asked before its stop.
bool is_barrier(const Law& law) {
  LawBench bench(law, 1, 1);
  return checking::is_barrier(bench);
}

std::vector<LaneProblem> random_lanes(const Law& law, std::mt19937& random, int points) {
  std::vector<LaneProblem> lanes;
  const bool barrier = is_barrier(law);
  const double layer = LawBench(law, 1, 1).layer();
  for (int l = 0; l < block; ++l) {
    LaneProblem lane = random_lane(random, points, l % 2 == 1);
    if (barrier)
      for (int i = 0; i < points; ++i) lane.before[i] = lane.free[i] = lane.lower[i] - layer * (0.2 + 0.15 * (i % 5));
    lanes.push_back(std::move(lane));
  }
  return lanes;
}

const std::vector<int> all_lanes = {0, 1, 2, 3};

double reach_of(const Law& law) {
  return is_barrier(law) ? 0.0 : 1.0;
}

}  // namespace

Verdict solve_allocates_nothing(const Law& law) {
  if (absent(law)) return no_contact_at_all();
  if (!allocations_are_counted()) return not_applicable("this build of the program cannot count allocations");
  std::mt19937 random(20240613);
  const double flexibility = flexibility_of(law);
  for (const int points : {1, 3, 10})
    for (int k = 0; k < 3; ++k) {
      LawBench bench(law, points, block);
      DenseDelassus W = random_delassus(random, points, flexibility);
      bench.solve(W, reach_of(law), reach_of(law), random_lanes(law, random, points), all_lanes);
      if (bench.allocations() > 0)
        return fails(fmt::format("solve() allocates {} time{} for {} point{}: size what it needs in prepare()",
                                 bench.allocations(), bench.allocations() == 1 ? "" : "s", points,
                                 points == 1 ? "" : "s"));
    }
  return fine();
}

Verdict lanes_are_independent(const Law& law) {
  if (absent(law)) return no_contact_at_all();
  std::mt19937 random(20240614);
  const double flexibility = flexibility_of(law);
  for (const int points : {1, 3, 10}) {
    DenseDelassus W = random_delassus(random, points, flexibility);
    const std::vector<LaneProblem> lanes = random_lanes(law, random, points);
    LawBench together(law, points, block), alone(law, points, 1), partly(law, points, block);
    together.solve(W, reach_of(law), reach_of(law), lanes, all_lanes);
    for (int l = 0; l < block; ++l) {
      const auto at = static_cast<std::size_t>(l);
      alone.solve(W, reach_of(law), reach_of(law), {lanes[at]}, {0});
      partly.solve(W, reach_of(law), reach_of(law), lanes, {l});
      const Eigen::VectorXd p = together.effort(l);
      if (p != alone.effort(0) || p != partly.effort(l))
        return fails(
            fmt::format("{} points: lane {} of {} gets {:.17g} N at its first point, and {:.17g} N when it is "
                        "solved alone: lanes must not know of each other",
                        points, l, block, p[0], p != alone.effort(0) ? alone.effort(0)[0] : partly.effort(l)[0]));
    }
  }
  return fine("bitwise equal alone and beside others");
}

Verdict untouched_lanes_are_left_alone(const Law& law) {
  if (absent(law)) return no_contact_at_all();
  std::mt19937 random(20240615);
  const double flexibility = flexibility_of(law);
  for (const int points : {1, 3}) {
    LawBench bench(law, points, block);
    DenseDelassus W = random_delassus(random, points, flexibility);
    std::vector<LaneProblem> lanes = random_lanes(law, random, points);
    for (const int l : {0, 2}) lanes[static_cast<std::size_t>(l)].effort.setConstant(7.25 + l);
    bench.solve(W, reach_of(law), reach_of(law), lanes, {1, 3});
    for (const int l : {0, 2}) {
      if (bench.effort(l) != lanes[static_cast<std::size_t>(l)].effort)
        return fails(fmt::format("writes the effort of lane {}, which is not in `touched` (1 and 3 of 4 are)", l));
      const LaneOutcome& outcome = bench.outcome(l);
      if (!outcome.converged || outcome.iterations != 0 || outcome.residual != 0 || outcome.dissipation != 0)
        return fails(fmt::format("writes the outcome of lane {}, which is not in `touched` (1 and 3 of 4 are)", l));
    }
  }
  return fine();
}

Verdict warm_start_changes_nothing(const Law& law) {
  if (absent(law)) return no_contact_at_all();
  std::mt19937 random(20240616);
  const double flexibility = flexibility_of(law);
  for (const int points : {1, 3, 10})
    for (int k = 0; k < 4; ++k) {
      LawBench bench(law, points, 1);
      DenseDelassus W = random_delassus(random, points, flexibility);
      LaneProblem lane = random_lanes(law, random, points)[static_cast<std::size_t>(k)];
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

namespace {

constexpr int points = 3, lanes = 2;

std::vector<Parameters> copies(const Law& law) {
  return std::vector<Parameters>(static_cast<std::size_t>(points * lanes), law.set.values);
}

std::vector<LaneProblem> apart_lanes(std::mt19937& random) {
  std::vector<LaneProblem> out;
  for (int l = 0; l < lanes; ++l) out.push_back(random_lane(random, points, l == 1));
  return out;
}

}  // namespace

Verdict points_have_own_sets(const Law& law) {
  LawBench together(law, points, lanes);
  if (together.law().absent() || !together.law().per_point()) return not_declared("one set of parameters per lane");
  if (together.law().changes_problem()) return fails("has a set for each point, and changes the problem by one");
  LawBench single(law, 1, 1);
  if (is_barrier(single)) return fine("it has no force beyond its stop, where this is asked");
  std::mt19937 random(20261126);
  DenseDelassus W = random_delassus(random, points, flexibility_of(law));
  const std::vector<LaneProblem> problems = apart_lanes(random);
  LawBench apart(law, points, lanes);
  apart.law().prepare_points(points, lanes, copies(law));
  for (LawBench* bench : {&together, &apart}) bench->solve(W, 1, 1, problems, {0, 1});
  for (int l = 0; l < lanes; ++l)
    if (together.effort(l) != apart.effort(l))
      return fails("equal sets for all points give other efforts than one set for the lane");
  const std::string key = together.law().parameter_of(ParameterRole::stiffness);
  if (key.empty()) return fine("equal sets give bitwise equal efforts");
  // Where no effort moves a measure, each point is alone with its set.
  constexpr int changed = 1;
  std::vector<Parameters> sets = copies(law);
  Law stiffer = law;
  stiffer.set.values.set(key, 3 * law.set.values.real(key));
  for (int l = 0; l < lanes; ++l) sets[static_cast<std::size_t>(changed * lanes + l)] = stiffer.set.values;
  LawBench one(law, points, lanes), other(stiffer, points, lanes);
  apart.law().prepare_points(points, lanes, sets);
  for (LawBench* bench : {&one, &other, &apart}) bench->solve(W, 0, 0, problems, {0, 1});
  for (int l = 0; l < lanes; ++l)
    for (int i = 0; i < points; ++i)
      if (apart.effort(l)[i] != (i == changed ? other : one).effort(l)[i])
        return fails(fmt::format("the set of point {} of lane {} is not the one that it is given", i, l));
  return fine("each point has its own");
}

}  // namespace ricochet::checking
