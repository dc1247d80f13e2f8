#include <algorithm>
#include <cmath>
#include <ricochet/contact_solvers/box_problem.hpp>
#include <ricochet/engine/energy_bounds.hpp>
#include <ricochet/engine/flight/lane_flight.hpp>
#include <ricochet/engine/march_loads.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/kernels/flight_kernels.hpp>

/// \file
/// What others read of an integration.
namespace ricochet {

bool Marcher::any_running() const {
  return std::any_of(status_.begin(), status_.end(), [](const LaneStatus& status) { return status.running; });
}

double Marcher::support(int lane, double t) const {
  if (!program_.support) return 0;
  const LaneSpec& spec = program_.lanes[static_cast<std::size_t>(lane)];
  if (t == clamp_.time())
    if (const auto known = clamp_.plain(spec.amplitude)) return *known;
  return spec.amplitude * std::sin(program_.problem->support.pulsation * t + spec.phase);
}

double Marcher::support_rate(int lane, double t) const {
  const LaneSpec& spec = program_.lanes[static_cast<std::size_t>(lane)];
  const double omega = program_.problem->support.pulsation;
  return spec.amplitude * omega * std::cos(omega * t + spec.phase);
}

double Marcher::support_levels(int lane, double t, const Levels& levels) const {
  double sum = 0;
  for (const Level& level : levels) sum += level.weight * support(lane, t + level.at * program_.h);
  return sum;
}

double Marcher::lift_levels(int lane, int point, double t, const Levels& levels) const {
  double sum = support_levels(lane, t, levels);
  for (const Level& level : levels) sum += level.weight * motions().point(point, t + level.at * program_.h);
  return sum;
}

const double* Marcher::distributed_load(const Levels& levels, double t) {
  return load_window_ ? load_window_->sum(levels, t) : nullptr;
}

double Marcher::energy_bound(int lane) const {
  return energy_bounds_->of(lane);
}

bool Marcher::beyond_bound(int lane, double energy) {
  return energy_bounds_->passed(lane, energy, time());
}

std::array<bool, 2> Marcher::pushed_by(int lane) const {
  std::array<bool, 2> sides = {false, false};
  for (std::size_t k = stage_states_.size(); k-- > 0;) {
    const StageState& stage = *stage_states_[k];
    if (!stage.delassus) continue;
    for (int i = 0; i < lower_.rows(); ++i) {
      sides[0] = sides[0] || stage.effort[0].at(i, lane) > 0;
      sides[1] = sides[1] || stage.effort[0].at(i, lane) < 0;
    }
    if (program_.stages[k].opens_instant) break;
  }
  return sides;
}

Eigen::VectorXd Marcher::position(int lane) const {
  Eigen::VectorXd q(program_.model->rows());
  for (int i = 0; i < q.size(); ++i) q[i] = blocks_[0].at(i, lane);
  return program_.model->to_nodal(q);
}

double Marcher::tip(int lane) const {
  const RowMatrix& row = program_.model->tip();
  double sum = support(lane, time()) + motions().tip(time());
  for (std::size_t e = 0; e < row.index.size(); ++e) sum += row.value[e] * blocks_[0].at(row.index[e], lane);
  return sum;
}

double Marcher::stored(int lane, const double* places) const {
  const LaneSpec& spec = program_.lanes[static_cast<std::size_t>(lane)];
  double sum = 0;
  each_side(circles_, spec.lower, spec.upper, places, [&](int point, int side, double depth) {
    const int set = program_.law_set(point, lane);
    if (depth <= -program_.law->layer(set)) return;
    StopState state{.depth = depth, .set = set, .side = side};
    if (memory_.rows() > 0)
      state.memory = {memory_.data() + point * program_.width + lane, lower_.rows() * program_.width};
    sum += program_.law->potential(state);
  });
  return sum;
}

// `see`(point) of each that is beyond its stop, or within round-off of it, by the reduced problem of the law: y = y° +
// W p. False where this is not what the step did, or would cost as much as the whole measure.
template <class See>
bool Marcher::may_be_beyond(See&& see) const {
  constexpr double round_off = 1e-9;  // of the places: far more than W and z lose
  constexpr std::size_t few = 8;
  const StageState& state = *stage_states_.back();
  const StageProgram& program = program_.stages.back();
  const int points = lower_.rows();
  if (stage_states_.size() != 1 || state.touched_lanes == 0 || state.impulse || program.effort.size() != 1 ||
      program.effort[0] != 1 || pushing_.size() > few || points > BoxSolver::many)
    return false;
  const double* columns[few] = {};
  double efforts[few] = {};
  for (std::size_t k = 0; k < pushing_.size(); ++k) {
    columns[k] = state.delassus->column(pushing_[k]);
    efforts[k] = program.reach * state.effort[0].at(pushing_[k], 0);
  }
  const double *free = state.free.data(), *lower = lower_.data(), *upper = upper_.data();
  const double largest = Eigen::Map<const Eigen::ArrayXd>(free, points).abs().maxCoeff();
  constexpr int some = 16;
  for (int first = 0; first < points; first += some) {
    const int count = std::min(some, points - first);
    double place[some], near[some], gap[some];
    for (int i = 0; i < count; ++i) {
      place[i] = free[first + i];
      near[i] = round_off * largest;
    }
    for (std::size_t k = 0; k < pushing_.size(); ++k)
      for (int i = 0; i < count; ++i) {
        const double more = efforts[k] * columns[k][first + i];
        place[i] += more;
        near[i] += round_off * std::abs(more);
      }
    for (int i = 0; i < count; ++i) {
      const double below = place[i] - lower[first + i], above = upper[first + i] - place[i];
      gap[i] = (below < above ? below : above) - near[i];
    }
    for (int i = 0; i < count; ++i)
      if (!(gap[i] > 0)) see(first + i);
  }
  return true;
}

double Marcher::penetration(int lane, bool law_saw_end) const {
  if (!program_.contact) return 0;
  const RowMatrix& rows = program_.model->contact();
  const LaneSpec& spec = program_.lanes[static_cast<std::size_t>(lane)];
  const double *lower = spec.lower.data(), *upper = spec.upper.data(), *q = slots_[0];
  const double phi = support(lane, time());
  double deepest = 0;
  double along = 0;  // u₁ of a circle
  const auto see = [&](int j, double relative) {
    const double place = relative + phi + motions().point(j, time());
    if (circles_.holds(j)) {
      if (circles_.first(j)) {
        along = place;
        return;
      }
      const StopCircle circle = StopCircle::of(spec.lower, spec.upper, j - 1);
      deepest = std::max(deepest, circle.distance(along, place) - circle.radius);
      return;
    }
    deepest = std::max(deepest, std::max(lower[j] - place, place - upper[j]));
  };
  const int n = program_.model->rows();
  const auto dense_row = [&](int j) { return rows.value.data() + static_cast<std::ptrdiff_t>(j) * n; };
  if (program_.width == 1 && law_saw_end && !circles_.any()) {
    const bool told = may_be_beyond([&](int j) {
      see(j, program_.flight ? flight_kernels().dot(n, dense_row(j), q) : program_.model->times(rows, j, q));
    });
    if (told) return deepest;
  }
  if (program_.width == 1 && (program_.flight || !program_.model->modal())) {
    constexpr int some = 16;
    constexpr double one = 1;
    double places[some];
    for (int first = 0; first < rows.rows(); first += some) {
      const int count = std::min(some, rows.rows() - first);
      if (program_.flight)  // the rows of one lane are dense where flights leave out steps
        flight_kernels().dots(n, count, dense_row(first), q, places);
      else
        kernels_.measure({count, rows.start.data() + first, rows.index.data(), rows.value.data()}, 1, &q, &one, nullptr,
                         places);
      for (int j = 0; j < count; ++j) see(first + j, places[j]);
    }
    return deepest;
  }
  for (int j = 0; j < rows.rows(); ++j) {
    double relative = 0;
    if (program_.width == 1)
      relative = program_.model->times(rows, j, q);
    else
      for (int e = rows.start[static_cast<std::size_t>(j)]; e < rows.start[static_cast<std::size_t>(j) + 1]; ++e)
        relative +=
            rows.value[static_cast<std::size_t>(e)] * blocks_[0].at(rows.index[static_cast<std::size_t>(e)], lane);
    see(j, relative);
  }
  return deepest;
}

int Marcher::delassus_columns() const {
  int columns = 0;
  for (const auto& state : stage_states_)
    if (state->impulse)
      columns += state->impulse->computed();
    else if (state->delassus)
      columns += state->delassus->computed();
  return columns;
}

}  // namespace ricochet
