#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/check/allocation_count.hpp"
#include "runners/check/law_checks.hpp"

namespace ricochet::checking {
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
  return fine("the same bits alone and beside others");
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

}  // namespace ricochet::checking
