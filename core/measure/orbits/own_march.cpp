#include <algorithm>
#include <ricochet/measure/orbits/own_march.hpp>
#include <ricochet/measure/orbits/stepped_map.hpp>

namespace ricochet {
namespace {

template <class Read>
OwnMarch march_of(Marcher& marcher, const Read& read, const StateMetric& metric, const Eigen::VectorXd& x,
                  const MapClock& clock, int periods) {
  OwnMarch own;
  for (int n = 0; n < periods && !own.end; ++n) {
    if (n > 0) marcher.set_clock(clock.begins);
    marcher.march(static_cast<long long>(clock.period) * clock.steps_per_period);
    own.end = marcher.status(0).end;
    if (own.end) break;
    const Eigen::VectorXd left = read(marcher.lane_state(0)) - x;
    own.displacement = std::max(own.displacement, metric.displacement(left));
    own.velocity = std::max(own.velocity, metric.velocity(left));
  }
  return own;
}

}  // namespace

OwnMarch own_march(PeriodicMap& map, const Eigen::VectorXd& x, double parameter, const MapClock& clock, int periods) {
  Marcher& marcher = map.begin(x, parameter);
  return march_of(
      marcher, [&](const LaneState& state) { return map.vector().read(state); }, map.metric(), x, clock, periods);
}

OwnMarch own_march(SteppedMap& map, const Eigen::VectorXd& orbit, double parameter, const MapClock& told, int periods) {
  const auto [x, clock] = quiet_orbit(map, orbit, parameter, told);
  auto [marcher, group] = map.begin(x, parameter, 0, clock.begins);
  const int own_group = group;
  return march_of(
      marcher, [&](const LaneState& state) { return map.read(state, own_group); }, map.metric(), x, clock, periods);
}

}  // namespace ricochet
