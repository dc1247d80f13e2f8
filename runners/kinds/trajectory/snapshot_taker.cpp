#include "runners/kinds/trajectory/snapshot_taker.hpp"

#include <algorithm>
#include <cmath>
#include <ricochet/engine/flight/flight.hpp>
#include <ricochet/scene/supports.hpp>

namespace ricochet {
namespace {

constexpr double largest_count = 32767;

double unit_of(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest / largest_count;
}

std::vector<std::int16_t> counted(const std::vector<double>& values, double unit) {
  std::vector<std::int16_t> counts;
  for (const double value : values)
    counts.push_back(static_cast<std::int16_t>(unit > 0 ? std::lround(value / unit) : 0));
  return counts;
}

}  // namespace

int snapshots_asked(const Json& settings) {
  return settings.is_object() ? settings.value("snapshots", 0) : 0;
}

SnapshotTaker::SnapshotTaker(const SceneSpec& scene, const Marcher& marcher, long long steps, int count)
    : SnapshotTaker(scene, marcher, LaneSpec(marcher.program().lanes[0]), marcher.program().problem->position, steps,
                    count) {}

SnapshotTaker::SnapshotTaker(const SceneSpec& scene, const Marcher& marcher, const LaneSpec& lane,
                             const Eigen::VectorXd& position, long long steps, int count)
    : steps_(steps), count_(std::min<long long>(count, steps)) {
  if (count_ <= 0) return;
  const SemiDiscrete& problem = *marcher.program().problem;
  DrawnRows drawn = drawn_rows(scene, problem);
  shape_ = std::move(drawn.shape);
  shape_.along = problem.space.basis == FiniteElementSpace::Basis::linear && !problem.space.elements.empty();
  at_ = problem.on_unknowns(std::move(drawn.rows));
  by_support_ = std::move(drawn.by_clamp);
  const std::vector<Snapshots::Stop> stops = std::move(shape_.stops);
  shape_.stops.clear();
  const int points = marcher.program().contact ? problem.points() : 0;
  group_ = std::max(1, (points + Snapshots::most_places - 1) / Snapshots::most_places);
  for (int first = 0; first < points; first += group_) {
    const int last = std::min(points, first + group_) - 1;
    const auto middle = static_cast<std::size_t>((first + last) / 2);
    shape_.point.push_back(problem.contact_x[middle]);
    if (middle < stops.size()) shape_.stops.push_back(stops[middle]);
    shape_.lower.push_back(lane.lower.segment(first, last - first + 1).maxCoeff());
    shape_.upper.push_back(lane.upper.segment(first, last - first + 1).minCoeff());
  }
  given_.assign(static_cast<std::size_t>(points), 0);
  // Displacements are drawn as the stops see them.
  if (!problem.motions.empty() && !problem.motions.carry_stops) {
    const std::vector<std::vector<std::size_t>>& moved = problem.motions.supports;
    shares_ = of_motions(problem.motions, drawn.on_supports);
    shares_.conservativeResize(shares_.rows() + 1, Eigen::NoChange);
    // The clamp is the first support, which moves by one motion at most.
    for (std::size_t k = 0; k < moved.size(); ++k)
      shares_.bottomRows(1)(0, static_cast<Eigen::Index>(k)) =
          std::count(moved[k].begin(), moved[k].end(), 0U) > 0 ? 1 : 0;
  }
  take(problem, position, marcher.support(0, 0), 0);
  asks_.next_shown = step_of(next_);
}

void SnapshotTaker::stage_solved(const Marcher& marcher, const StageView& view) {
  if (given_.empty() || !view.effort || (view.contact_lanes & 1u) == 0) return;
  const double weight = view.program->momentum;
  if (weight == 0) return;
  for (std::size_t j = 0; j < given_.size(); ++j)
    given_[j] += weight * view.effort[0][j * static_cast<std::size_t>(marcher.width())];
  any_given_ = true;
}

void SnapshotTaker::step_done(Marcher& marcher) {
  if (next_ > count_ || marcher.step() < step_of(next_) || !marcher.status(0).running) return;
  take(*marcher.program().problem, marcher.position(0), marcher.support(0, marcher.time()), marcher.time());
  while (next_ <= count_ && step_of(next_) <= marcher.step()) ++next_;
  asks_.next_shown = next_ > count_ ? never : step_of(next_);
}

void SnapshotTaker::interval(Marcher& marcher, const StepInterval& steps) {
  if (steps.closed.empty() || given_.empty()) return;
  const std::vector<StageProgram>& stages = marcher.program().stages;
  steps.each_stage([&](int stage, std::span<const double> efforts, std::span<const double>) {
    const double weight = stages[static_cast<std::size_t>(stage)].momentum;
    for (std::size_t i = 0; i < efforts.size(); ++i)
      given_[static_cast<std::size_t>(steps.closed[i].point)] += weight * efforts[i];
    any_given_ = any_given_ || weight != 0;
  });
}

void SnapshotTaker::take(const SemiDiscrete& problem, const Eigen::VectorXd& position, double support, double time) {
  Eigen::VectorXd u = at_ * position + support * by_support_;
  if (shares_.rows() > 0) {
    const Eigen::VectorXd lift = shares_ * problem.motions.values(time, false);
    u += lift.head(u.size());
    support += lift[u.size()];
  }
  if (!u.allFinite()) return;
  const double since = t_.empty() ? 0 : time - t_.back();
  const auto points = shape_.point.size();
  for (std::size_t g = 0; any_given_ && since > 0 && g < points; ++g) {
    double largest = 0;
    const std::size_t first = g * static_cast<std::size_t>(group_),
                      end = std::min(first + static_cast<std::size_t>(group_), given_.size());
    for (std::size_t j = first; j < end; ++j)
      if (std::abs(given_[j]) > std::abs(largest)) largest = given_[j];
    if (largest == 0) continue;
    pushed_.push_back(static_cast<std::uint32_t>(t_.size() * points + g));
    force_.push_back(largest / since);
  }
  if (any_given_) std::fill(given_.begin(), given_.end(), 0.0);
  any_given_ = false;
  t_.push_back(time);
  clamp_.push_back(support);
  displacement_.insert(displacement_.end(), u.begin(), u.end());
}

Snapshots SnapshotTaker::finish() const {
  Snapshots out = shape_;
  out.t = t_;
  out.clamp = clamp_;
  out.metres = unit_of(displacement_);
  out.displacement = counted(displacement_, out.metres);
  out.newtons = unit_of(force_);
  out.pushed = pushed_;
  out.force = counted(force_, out.newtons);
  return out;
}

}  // namespace ricochet
