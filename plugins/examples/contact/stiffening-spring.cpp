// A contact law in one file: springs that stiffen as they are pressed. Put your force, its slope and its energy in
// place of the three functions. The rest holds for any force that grows with the depth, linearly or ever faster.
#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

/// The force of one point at depth δ ≥ 0 beyond its stop:
///
///     f(δ) = κ δ (1 + δ/s),     f'(δ) = κ (1 + 2δ/s),     ∫f = κ δ² (1/2 + δ/(3s))
struct Spring {
  double stiffness = 0, depth = 0;  // κ, N/m; s, m
  double force(double d) const { return stiffness * d * (1 + d / depth); }
  double slope(double d) const { return stiffness * (1 + 2 * d / depth); }
  double energy(double d) const { return stiffness * d * d * (0.5 + d / (3 * depth)); }
};

/// The depth that is left of δ° when the spring answers through the compliance a = reach·W_ii (m/N) of its point,
/// δ + a f(δ) = δ°. Newton's iterates fall from δ° to the solution because f is convex: the first that does not fall is
/// there.
double depth_left(const Spring& spring, double a, double free_depth) {
  constexpr int most = 200;
  double depth = free_depth;
  for (int k = 0; k < most; ++k) {
    const double next = depth - (depth + a * spring.force(depth) - free_depth) / (1 + a * spring.slope(depth));
    if (!(next < depth)) break;
    depth = next;
  }
  return depth;
}

class Law final : public ContactLaw {
 public:
  // Which measure of the scheme the law reads. Not overridden: the impact measure, the law is rigid.
  std::optional<Evaluation> reads() const override { return Evaluation::implicit_end; }

  // Called before anything else, with the parameters of each lane: everything is allocated here.
  void prepare(int points, std::span<const Parameters> lanes) override {
    springs_.clear();
    for (const Parameters& lane : lanes) springs_.push_back({lane.real("stiffness"), lane.real("depth")});
    measure_.resize(static_cast<std::size_t>(points));
    slopes_.assign(static_cast<std::size_t>(points) * lanes.size(), 0.0);
  }

  // Called at each stage, with the lanes where something is to be done; the others are left alone. No allocation here.
  void solve(ReducedProblem& problem) override {
    for (const int lane : problem.touched) problem.outcome[lane] = solve_lane(problem.lane(lane), lane);
  }

  // Energy that a side of a point gives back from this depth beyond its stop, J. A law that keeps numbers of its points
  // finds them in at.memory.
  double potential(const StopState& at) const override { return spring(at.set).energy(std::max(at.depth, 0.0)); }
  // f' at the last solve, for tangents and exponents; of a law that cannot say it, offers_slopes() is false.
  bool offers_slopes() const override { return true; }
  ContactSlopes slopes(int point, int lane) const override {
    return {.stiffness = slopes_[static_cast<std::size_t>(point) * springs_.size() + static_cast<std::size_t>(lane)]};
  }
  std::string how_solved() const override { return "Newton's method point by point, Gauss–Seidel over the points"; }
  // Not overridden here: linear_slopes(), of a law that is linear; reads_rate(), for a law that damps; closed_form().
  // Nor are layer(), for a law that acts before the stop, and memory_per_point(), for one that remembers.

 private:
  const Spring& spring(int lane) const { return springs_[static_cast<std::size_t>(lane)]; }

  /// One lane. In each sweep every point answers to the measure that the others leave it,
  ///     measure_i = free_i + reach·Σ_j W_ij p_j,
  /// p > 0 where it lies below its lower stop, p < 0 above the upper one. W is symmetric and semidefinite and f grows,
  /// so each answer lowers one convex energy, and the sweeps converge.
  LaneOutcome solve_lane(const LaneProblem& problem, int lane) {
    constexpr int most_sweeps = 10000;
    // Of the deepest point before its spring pushes, and of the round-off of the measures.
    constexpr double tolerance = 1e-13, round_off = std::numeric_limits<double>::epsilon();
    const auto points = static_cast<std::size_t>(problem.points), lanes = springs_.size();
    // Efforts begin with those of the last step (in `effort`); the free measure is that of p = 0.
    for (std::size_t i = 0; i < points; ++i) measure_[i] = problem.free[i];
    for (std::size_t i = 0; i < points; ++i) move_others(problem, i, problem.effort[i]);
    LaneOutcome outcome;
    double change = 0, deepest = 0, size = 0;
    const auto settled = [&] {
      return points == 1 || change <= tolerance * deepest + 8 * static_cast<double>(points + 1) * round_off * size;
    };
    do {
      change = 0;
      for (std::size_t i = 0; i < points; ++i) {
        double& effort = problem.effort[i];
        const double lower = problem.lower[i], upper = problem.upper[i];
        if (effort == 0 && measure_[i] >= lower && measure_[i] <= upper) continue;
        // The first time that a column is asked for costs one solve with S: only of points that are touched.
        const double own = problem.reach > 0 ? problem.reach * problem.delassus->column(static_cast<int>(i))[i] : 0.0;
        const double alone = measure_[i] - own * effort;
        const double below = lower - alone, above = alone - upper, free_depth = std::max(below, above);
        const double depth = free_depth > 0 ? depth_left(spring(lane), own, free_depth) : 0.0;
        const double found = depth > 0 ? std::copysign(spring(lane).force(depth), below - above) : 0.0;
        slopes_[i * lanes + static_cast<std::size_t>(lane)] = spring(lane).slope(depth);
        move_others(problem, i, found - effort);
        change = std::max(change, own * std::abs(found - effort));
        deepest = std::max(deepest, free_depth);
        size = std::max(size, std::abs(alone));
        effort = found;
      }
      ++outcome.iterations;
    } while (!settled() && outcome.iterations < most_sweeps);
    outcome.converged = settled();
    outcome.residual = points == 1 ? 0.0 : change;  // m
    return outcome;
  }

  void move_others(const LaneProblem& problem, std::size_t i, double effort) {
    if (effort == 0 || !(problem.reach > 0)) return;
    const double* column = problem.delassus->column(static_cast<int>(i));
    for (std::size_t j = 0; j < measure_.size(); ++j) measure_[j] += problem.reach * column[j] * effort;
  }

  std::vector<Spring> springs_;  // per lane
  std::vector<double> measure_;  // per point, of the lane being solved
  std::vector<double> slopes_;   // per point and lane
};

void register_all(Registry& registry) {
  // Key, unit, default (none: the study must give it), range, meaning.
  ParameterSpec stiffness = real_parameter("stiffness", "N/m", std::nullopt, {.low = 0, .low_open = true},
                                           "κ, stiffness of the spring of each contact point at the first touch");
  ParameterSpec depth = real_parameter("depth", "m", 1e-3, {.low = 0, .low_open = true},
                                       "s, depth at which the force is twice that of a linear spring");
  // They may differ between trajectories that are marched together.
  stiffness.per_lane = depth.per_lane = true;
  registry.add_contact({.name = "stiffening-spring",
                        .summary = "springs behind the stops that stiffen as they are pressed",
                        .text = R"(A point that passes a stop by δ is pushed back with κ δ (1 + δ/s), found at the
          end of the step. For s → ∞ it is the penalty of stiffness κ. The stiffness is per contact point.)",
                        .source = "—",
                        .parameters = {stiffness, depth}},
                       [](const Parameters&) { return std::make_unique<Law>(); });
}

}  // namespace

// Role, name ('-' written '_'), and the function above.
RICOCHET_PLUGIN(contact, stiffening_spring, register_all)
