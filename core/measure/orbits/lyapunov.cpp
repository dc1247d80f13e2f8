#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <random>
#include <ricochet/measure/orbits/impact_jump.hpp>
#include <ricochet/measure/orbits/lyapunov.hpp>

namespace ricochet {
namespace {

// Columns of one lane in metres: slots weighted so that velocities count over ω and accelerations over ω².
class Columns {
 public:
  Columns(const Program& program, double pulsation) : rows_(program.model->rows()) {
    for (const auto& [position, velocity] : program.plan.initial) {
      if (position != 0)
        weight_.push_back(1.0);
      else
        weight_.push_back(velocity != 0 ? 1 / (std::abs(velocity) * pulsation) : 1 / (pulsation * pulsation));
    }
  }

  double product(const LaneState& a, const LaneState& b) const {
    double sum = 0;
    const double *x = a.slots.data(), *y = b.slots.data();
    for (const double weight : weight_)
      for (int i = 0; i < rows_; ++i) sum += weight * weight * *x++ * *y++;
    return sum;
  }

 private:
  int rows_;
  std::vector<double> weight_;
};

void add(LaneState& to, double factor, const LaneState& from) {
  for (std::size_t i = 0; i < to.slots.size(); ++i) to.slots[i] += factor * from.slots[i];
  for (std::size_t i = 0; i < to.efforts.size(); ++i) to.efforts[i] += factor * from.efforts[i];
}

void scale(LaneState& state, double factor) {
  for (double& x : state.slots) x *= factor;
  for (double& x : state.efforts) x *= factor;
}

// Gram–Schmidt, twice; R, upper triangular.
void orthonormalise(std::vector<LaneState>& columns, const Columns& metric, Eigen::MatrixXd& upper) {
  const auto count = static_cast<Eigen::Index>(columns.size());
  upper.setZero(count, count);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    for (int pass = 0; pass < 2; ++pass)
      for (std::size_t j = 0; j < k; ++j) {
        const double part = metric.product(columns[j], columns[k]);
        upper(static_cast<Eigen::Index>(j), column) += part;
        add(columns[k], -part, columns[j]);
      }
    const double norm = std::sqrt(metric.product(columns[k], columns[k]));
    upper(column, column) = norm;
    if (norm > 0 && std::isfinite(norm)) scale(columns[k], 1 / norm);
  }
}

// Rounds of an orbit that repeats: whether the map of one turns the plane of two neighbouring columns.
class Rounds {
 public:
  Rounds(int period, const std::vector<LaneState>& columns) : period_(period), planes_(columns.size()) {
    if (period_ > 0 && !planes_.empty()) planes_.pop_back();
    if (period_ > 0) begin(columns);
  }

  /// One more period: its R, and the columns after it.
  void add(const Eigen::MatrixXd& upper, const std::vector<LaneState>& columns, const Columns& metric) {
    if (period_ <= 0) return;
    for (std::size_t k = 0; k < planes_.size(); ++k) {
      Eigen::Matrix2d& map = planes_[k].map;
      const auto first = static_cast<Eigen::Index>(k);
      map = (upper.block<2, 2>(first, first) * map).eval();
      if (const double size = map.cwiseAbs().maxCoeff(); size > 0) map /= size;
    }
    if (++periods_ < period_) return;
    ++rounds_;
    for (std::size_t k = 0; k < planes_.size(); ++k) {
      Eigen::Matrix2d turned;
      for (std::size_t i = 0; i < 2; ++i)
        for (std::size_t j = 0; j < 2; ++j)
          turned(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
              metric.product(start_[k + i], columns[k + j]);
      const Eigen::Matrix2d map = turned * planes_[k].map;
      const double half = (map(0, 0) - map(1, 1)) / 2;
      planes_[k].turned += half * half + map(0, 1) * map(1, 0) < 0;
    }
    begin(columns);
  }

  std::vector<double> turning() const {
    std::vector<double> shares;
    if (rounds_ > 0)
      for (const Plane& plane : planes_) shares.push_back(static_cast<double>(plane.turned) / rounds_);
    return shares;
  }

 private:
  struct Plane {
    Eigen::Matrix2d map;
    int turned = 0;
  };
  void begin(const std::vector<LaneState>& columns) {
    start_ = columns;
    periods_ = 0;
    for (Plane& plane : planes_) plane.map.setIdentity();
  }

  int period_, periods_ = 0, rounds_ = 0;
  std::vector<Plane> planes_;
  std::vector<LaneState> start_;
};

// A growth over whole rounds of an orbit that repeats: a part of a round has a growth of its own.
void keep_whole_rounds(std::vector<std::vector<double>>& rates, int round) {
  for (auto& series : rates) {
    const std::size_t size = series.size(), period = static_cast<std::size_t>(std::max(round, 1));
    if (size >= period) series.resize(size - size % period);
  }
}

LaneState random_column(const LaneState& like, std::mt19937_64& random) {
  LaneState column = like;
  std::normal_distribution<double> normal;
  for (double& x : column.slots) x = normal(random);
  std::fill(column.efforts.begin(), column.efforts.end(), 0.0);
  return column;
}

// Tangents of a block, period by period.
class TangentRun {
 public:
  TangentRun(Program program, const std::vector<LaneState>& states, const LyapunovPlan& plan)
      : plan_(plan),
        marcher_(std::move(program)),
        metric_(marcher_.program(), plan.pulsation),
        period_(plan.steps_per_period * marcher_.program().h),
        columns_(states.size()),
        untold_(states.size(), 0),
        found_(states.size()) {
    marcher_.set_clock(plan_.strobe + 1);
    for (std::size_t lane = 0; lane < states.size(); ++lane) {
      std::mt19937_64 random(plan.seed);
      marcher_.set_lane(static_cast<int>(lane), LaneSpec(marcher_.program().lanes[lane]), states[lane]);
      for (int k = 0; k < count(); ++k) columns_[lane].push_back(random_column(states[lane], random));
      orthonormalise(columns_[lane], metric_, upper_);
      store(lane);
      found_[lane].rates.resize(static_cast<std::size_t>(count()));
      rounds_.emplace_back(plan.round(lane), columns_[lane]);
    }
  }

  std::vector<LyapunovRates> rates() {
    ImpactJump jump(marcher_);
    StepObserver* observer = jump.needed() ? &jump : nullptr;
    for (int n = -plan_.discard; n < plan_.periods && marcher_.any_running(); ++n) {
      marcher_.march(plan_.steps_per_period - 1, observer);
      std::vector<std::vector<LaneState>> before(columns_.size());
      if (plan_.without_sawtooth)
        for (std::size_t lane = 0; lane < before.size(); ++lane) before[lane] = tangents(lane);
      marcher_.march(1, observer);
      marcher_.set_clock(plan_.strobe + 1);
      for (std::size_t lane = 0; lane < columns_.size(); ++lane) end_period(n, lane, before[lane], jump);
    }
    for (std::size_t lane = 0; lane < columns_.size(); ++lane) {
      const int number = static_cast<int>(lane);
      found_[lane].jumps = jump.applied(number);
      found_[lane].told = std::clamp(2 * marcher_.program().model->rows() - jump.lost(number), 0, count());
      found_[lane].untold = jump.untold(number) - untold_[lane];
      found_[lane].turning = rounds_[lane].turning();
      keep_whole_rounds(found_[lane].rates, plan_.round(lane));
    }
    return std::move(found_);
  }

 private:
  int count() const { return marcher_.tangents(); }
  void store(std::size_t lane) {
    for (int k = 0; k < count(); ++k)
      marcher_.set_tangent(static_cast<int>(lane), k, columns_[lane][static_cast<std::size_t>(k)]);
  }
  std::vector<LaneState> tangents(std::size_t lane) const {
    std::vector<LaneState> columns;
    for (int k = 0; k < count(); ++k) columns.push_back(marcher_.tangent(static_cast<int>(lane), k));
    return columns;
  }
  // `before`: the columns a step earlier, where a mode that alternates is averaged out.
  void end_period(int n, std::size_t lane, const std::vector<LaneState>& before, ImpactJump& jump) {
    const LaneStatus& status = marcher_.status(static_cast<int>(lane));
    if (!status.running) {
      found_[lane].end = status.end;
      return;
    }
    if (plan_.keep_orbit) found_[lane].orbit.push_back(marcher_.lane_state(static_cast<int>(lane)));
    columns_[lane] = tangents(lane);
    for (std::size_t k = 0; k < before.size(); ++k) {
      add(columns_[lane][k], 1, before[k]);
      scale(columns_[lane][k], 0.5);
    }
    orthonormalise(columns_[lane], metric_, upper_);
    store(lane);
    jump.columns_replaced();
    if (n == -1) {
      rounds_[lane] = Rounds(plan_.round(lane), columns_[lane]);
      untold_[lane] = jump.untold(static_cast<int>(lane));
    }
    if (n < 0) return;
    for (int k = 0; k < count(); ++k)
      found_[lane].rates[static_cast<std::size_t>(k)].push_back(std::log(upper_(k, k)) / period_);
    rounds_[lane].add(upper_, columns_[lane], metric_);
  }

  const LyapunovPlan& plan_;
  Marcher marcher_;
  const Columns metric_;
  const double period_;
  std::vector<std::vector<LaneState>> columns_;  // of each lane
  std::vector<Rounds> rounds_;
  std::vector<int> untold_;  // before the measured periods
  Eigen::MatrixXd upper_;
  std::vector<LyapunovRates> found_;
};

}  // namespace

std::vector<LyapunovRates> lyapunov_rates(Program program, const std::vector<LaneState>& states,
                                          const LyapunovPlan& plan) {
  return TangentRun(std::move(program), states, plan).rates();
}

std::vector<LyapunovRates> twin_rates(Program program, const std::vector<LaneState>& states,
                                      const std::vector<LyapunovRates>& orbits, const LyapunovPlan& plan,
                                      double offset) {
  Marcher marcher(std::move(program));
  const int origin = plan.strobe + 1;
  const double period = plan.steps_per_period * marcher.program().h;
  constexpr double far = 1e-2;  // of the orbit's own size
  const Columns metric(marcher.program(), plan.pulsation);
  std::vector<LyapunovRates> found(states.size());
  Eigen::MatrixXd upper;
  marcher.set_clock(origin);
  const auto place_twin = [&](std::size_t i, std::vector<LaneState>& direction, const LaneState& orbit) {
    LaneState twin = orbit;
    add(twin, offset, direction.front());
    marcher.set_lane(static_cast<int>(i), LaneSpec(marcher.program().lanes[i]), twin);
  };
  for (std::size_t i = 0; i < states.size(); ++i) {
    std::mt19937_64 random(plan.seed);
    std::vector<LaneState> direction{random_column(states[i], random)};
    orthonormalise(direction, metric, upper);
    place_twin(i, direction, states[i]);
    found[i].rates.resize(1);
  }
  for (int n = -plan.discard; n < plan.periods && marcher.any_running(); ++n) {
    marcher.march(plan.steps_per_period);
    marcher.set_clock(origin);
    const auto done = static_cast<std::size_t>(n + plan.discard);
    for (std::size_t i = 0; i < states.size(); ++i) {
      if (found[i].end) continue;
      found[i].end = marcher.status(static_cast<int>(i)).end;
      if (done >= orbits[i].orbit.size()) found[i].end = orbits[i].end;
      if (found[i].end) {
        marcher.freeze(static_cast<int>(i), found[i].end);
        continue;
      }
      const LaneState& orbit = orbits[i].orbit.at(done);
      std::vector<LaneState> direction{marcher.lane_state(static_cast<int>(i))};
      add(direction.front(), -1, orbit);
      orthonormalise(direction, metric, upper);
      const double growth = std::log(upper(0, 0));
      if (!std::isfinite(growth)) {
        found[i].end = {.cause = EndCause::twin_met};
        continue;
      }
      place_twin(i, direction, orbit);
      if (n < 0) continue;
      found[i].rates[0].push_back((growth - std::log(offset)) / period);
      found[i].saturated += growth > std::log(far * std::sqrt(metric.product(orbit, orbit)));
    }
  }
  for (std::size_t i = 0; i < found.size(); ++i) keep_whole_rounds(found[i].rates, plan.round(i));
  return found;
}

}  // namespace ricochet
