#include <ricochet/measure/orbits/reference_orbits.hpp>
#include <utility>

namespace ricochet {

ReferenceOrbits::ReferenceOrbits(Make make, double at, double parameter_metres)
    : make_(std::move(make)), scene_(make_(at)), value_(at) {
  metric_ = std::make_unique<StateMetric>(Eigen::MatrixXd(scene_.map->weights().asDiagonal()), parameter_metres);
}

ReferenceOrbits::Scene& ReferenceOrbits::at(double parameter) {
  if (parameter != value_) {
    scene_ = make_(parameter);
    value_ = parameter;
  }
  return scene_;
}

FollowedMap::Image ReferenceOrbits::march(const Eigen::VectorXd& x, double parameter, const MapClock& clock,
                                          bool derivative) {
  Scene& scene = at(parameter);
  ReferenceMap::Image made = scene.map->march(x, scene.period * clock.period / (clock.half ? 2 : 1), derivative);
  if (!made.stopped.empty()) throw Refusal{std::move(made.stopped)};
  Image out;
  out.image = clock.sign() * made.state;
  if (derivative) out.derivative = clock.sign() * made.derivative;
  out.runs = made.impacts;
  std::tie(out.tip, out.tip_velocity) = scene.map->tip(x);
  return out;
}

Eigen::VectorXd ReferenceOrbits::settle(double parameter, int periods) {
  Scene& scene = at(parameter);
  const Eigen::VectorXd start = scene.map->start();
  if (periods == 0) return start;
  ReferenceMap::Image made = scene.map->march(start, scene.period * periods, false);
  if (!made.stopped.empty()) throw Refusal{std::move(made.stopped)};
  return std::move(made.state);
}

}  // namespace ricochet
