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

// Gram–Schmidt, twice; ln R_kk of each column.
void orthonormalise(std::vector<LaneState>& columns, const Columns& metric, std::vector<double>& growth) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    for (int pass = 0; pass < 2; ++pass)
      for (std::size_t j = 0; j < k; ++j) add(columns[k], -metric.product(columns[j], columns[k]), columns[j]);
    const double norm = std::sqrt(metric.product(columns[k], columns[k]));
    growth[k] = std::log(norm);
    if (norm > 0 && std::isfinite(norm)) scale(columns[k], 1 / norm);
  }
}

LaneState random_column(const LaneState& like, std::mt19937_64& random) {
  LaneState column = like;
  std::normal_distribution<double> normal;
  for (double& x : column.slots) x = normal(random);
  std::fill(column.efforts.begin(), column.efforts.end(), 0.0);
  return column;
}

}  // namespace

std::vector<LyapunovRates> lyapunov_rates(Program program, const std::vector<LaneState>& states,
                                          const LyapunovPlan& plan) {
  Marcher marcher(std::move(program));
  const int origin = plan.strobe + 1, count = marcher.tangents();
  const double period = plan.steps_per_period * marcher.program().h;
  const Columns metric(marcher.program(), plan.pulsation);
  std::vector<LyapunovRates> found(states.size());
  std::vector<std::vector<LaneState>> columns(states.size());
  std::vector<double> growth(static_cast<std::size_t>(count));
  marcher.set_clock(origin);
  const auto store = [&](int lane) {
    for (int k = 0; k < count; ++k)
      marcher.set_tangent(lane, k, columns[static_cast<std::size_t>(lane)][static_cast<std::size_t>(k)]);
  };
  const auto fetch = [&](int lane) {
    for (int k = 0; k < count; ++k)
      columns[static_cast<std::size_t>(lane)][static_cast<std::size_t>(k)] = marcher.tangent(lane, k);
  };
  for (std::size_t lane = 0; lane < states.size(); ++lane) {
    std::mt19937_64 random(plan.seed);
    marcher.set_lane(static_cast<int>(lane), LaneSpec(marcher.program().lanes[lane]), states[lane]);
    for (int k = 0; k < count; ++k) columns[lane].push_back(random_column(states[lane], random));
    orthonormalise(columns[lane], metric, growth);
    store(static_cast<int>(lane));
    found[lane].rates.resize(static_cast<std::size_t>(count));
  }
  ImpactJump jump(marcher);
  StepObserver* observer = jump.needed() ? &jump : nullptr;
  for (int n = -plan.discard; n < plan.periods && marcher.any_running(); ++n) {
    marcher.march(plan.steps_per_period - 1, observer);
    std::vector<std::vector<LaneState>> before(states.size());
    if (plan.without_sawtooth)
      for (std::size_t lane = 0; lane < states.size(); ++lane)
        for (int k = 0; k < count; ++k) before[lane].push_back(marcher.tangent(static_cast<int>(lane), k));
    marcher.march(1, observer);
    marcher.set_clock(origin);
    for (std::size_t lane = 0; lane < states.size(); ++lane) {
      const LaneStatus& status = marcher.status(static_cast<int>(lane));
      if (!status.running) {
        found[lane].end = status.end;
        continue;
      }
      if (plan.keep_orbit) found[lane].orbit.push_back(marcher.lane_state(static_cast<int>(lane)));
      fetch(static_cast<int>(lane));
      if (plan.without_sawtooth)
        for (std::size_t k = 0; k < columns[lane].size(); ++k) {
          add(columns[lane][k], 1, before[lane][k]);
          scale(columns[lane][k], 0.5);
        }
      orthonormalise(columns[lane], metric, growth);
      store(static_cast<int>(lane));
      jump.columns_replaced();
      if (n < 0) continue;
      for (std::size_t k = 0; k < growth.size(); ++k) found[lane].rates[k].push_back(growth[k] / period);
    }
  }
  for (std::size_t lane = 0; lane < states.size(); ++lane) found[lane].jumps = jump.applied(static_cast<int>(lane));
  return found;
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
  std::vector<double> growth(1);
  marcher.set_clock(origin);
  const auto place_twin = [&](std::size_t i, std::vector<LaneState>& direction, const LaneState& orbit) {
    LaneState twin = orbit;
    add(twin, offset, direction.front());
    marcher.set_lane(static_cast<int>(i), LaneSpec(marcher.program().lanes[i]), twin);
  };
  for (std::size_t i = 0; i < states.size(); ++i) {
    std::mt19937_64 random(plan.seed);
    std::vector<LaneState> direction{random_column(states[i], random)};
    orthonormalise(direction, metric, growth);
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
      orthonormalise(direction, metric, growth);
      if (!std::isfinite(growth[0])) {
        found[i].end = {.cause = EndCause::twin_met};
        continue;
      }
      place_twin(i, direction, orbit);
      if (n < 0) continue;
      found[i].rates[0].push_back((growth[0] - std::log(offset)) / period);
      found[i].saturated += growth[0] > std::log(far * std::sqrt(metric.product(orbit, orbit)));
    }
  }
  return found;
}

}  // namespace ricochet
