#include <numeric>
#include <ricochet/scene/start_force.hpp>

namespace ricochet {
namespace {

// Nothing that an effort moves.
class NoColumns final : public DelassusColumns {
 public:
  explicit NoColumns(int points) : column_(static_cast<std::size_t>(points), 0.0) {}
  const double* column(int) override { return column_.data(); }

 private:
  std::vector<double> column_;
};

}  // namespace

std::vector<double> standing_force(ContactLaw& law, const StandingPoints& at) {
  const auto lanes = static_cast<std::size_t>(at.lanes), size = static_cast<std::size_t>(at.points) * lanes;
  std::vector<double> force(size, 0.0), memory(size * static_cast<std::size_t>(law.memory_per_point()), 0.0);
  const std::vector<double> still(size, 0.0);
  std::vector<int> touched(lanes);
  std::iota(touched.begin(), touched.end(), 0);
  std::vector<LaneOutcome> outcome(lanes);
  NoColumns columns(at.points);
  ReducedProblem problem;
  problem.points = at.points;
  problem.lanes = at.lanes;
  problem.delassus = &columns;
  problem.free = problem.before = at.place;
  problem.lower = at.lower;
  problem.upper = at.upper;
  problem.rate_free = at.rate ? at.rate : still.data();
  problem.memory = at.memory ? at.memory : memory.empty() ? nullptr : memory.data();
  problem.effort = force.data();
  problem.touched = touched;
  problem.outcome = outcome.data();
  law.solve(problem);
  for (std::size_t lane = 0; lane < lanes; ++lane)
    if (!outcome[lane].converged)
      for (std::size_t i = lane; i < size; i += lanes) force[i] = 0;
  return force;
}

}  // namespace ricochet
