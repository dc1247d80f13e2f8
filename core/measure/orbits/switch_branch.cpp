#include <algorithm>
#include <cmath>
#include <ricochet/kernels/eigenvalues.hpp>
#include <ricochet/measure/orbits/multipliers.hpp>
#include <ricochet/measure/orbits/special_points.hpp>

namespace ricochet {

using Eigen::VectorXd;

namespace {

std::vector<std::complex<double>> massless(const PeriodicMap& map, const MapClock& clock) {
  return after_steps(map.massless_roots(), clock.steps(), clock.sign());
}
std::vector<std::complex<double>> massless(const SteppedMap&, const MapClock&) {
  return {};
}

// The vector of the real multiplier nearest to −1, `without` these; nothing where all are complex.
std::optional<VectorXd> critical_vector(const Eigen::MatrixXd& derivative,
                                        const std::vector<std::complex<double>>& without) {
  constexpr double same = 1e-6;
  const GeneralModes modes = general_modes(derivative);
  if (!modes.found) return std::nullopt;
  Eigen::Index nearest = -1;
  for (Eigen::Index i = 0; i < modes.values.size(); ++i)
    if (modes.values[i].imag() == 0 &&
        std::none_of(without.begin(), without.end(),
                     [&](const auto& one) { return std::abs(one - modes.values[i]) < same; }) &&
        (nearest < 0 || std::abs(modes.values[i].real() + 1) < std::abs(modes.values[nearest].real() + 1)))
      nearest = i;
  if (nearest < 0) return std::nullopt;
  return VectorXd(modes.vectors.col(nearest).real());
}

/// How far two orbits have to be apart to be two, m: farther than impacts that rebound are placed.
double told_apart(const PeriodicMap&, const MapMarch&) {
  return 0;
}
double told_apart(const SteppedMap&, const FollowedMap::Image& image) {
  return unresolved * image.rebounds;
}

VectorXd at_strobe(PeriodicMap&, const VectorXd& x, double, const MapClock&) {
  return x;
}
VectorXd at_strobe(SteppedMap& map, const VectorXd& x, double parameter, const MapClock& clock) {
  return map.moved(x, parameter, clock, 0);
}

}  // namespace

Eigen::MatrixXd derivative_at(PeriodicMap& map, const ShotOrbit& orbit, const MapClock& clock) {
  return map.derivative(orbit.sets, clock);
}

Eigen::MatrixXd derivative_at(SteppedMap& map, const ShotOrbit& orbit, const MapClock& clock) {
  return map.march(orbit.x, orbit.parameter, clock, true).derivative;
}

template <class Map>
std::optional<SwitchedOrbit> switch_branch(Map& map, const MapClock& clock, const SpecialPoint& point, double scale,
                                           double tolerance, const std::function<ShotOrbit(double parameter)>& x_at) {
  constexpr double least_width = 1e-5, same_orbit = 1e-6;  // of the scale
  MapClock doubled = clock;
  if (clock.half)
    doubled.half = false;
  else
    doubled.period *= 2;
  const double width = std::max({point.high - point.low, least_width * scale / map.metric().parameter_metres()});
  for (const double widths : {1.0, 2.0, 4.0})
    for (const double side : {1.0, -1.0}) {
      const double parameter = point.parameter + side * widths * width;
      ShotOrbit own = x_at(parameter);
      if (!own.found) continue;
      const QuietOrbit quiet = quiet_orbit(map, own.x, parameter, clock);
      own.x = quiet.x;
      doubled.begins = quiet.clock.begins;
      auto v = critical_vector(derivative_at(map, own, quiet.clock), massless(map, clock));
      if (!v) continue;
      *v /= map.metric().size(*v);
      // Where impacts rebound an orbit of a small amplitude is not told from the one that it leaves.
      const double told = told_apart(map, map.march(own.x, parameter, quiet.clock)),
                   apart = std::max(same_orbit * scale, told);
      for (const double amplitude : {1e-3, 3e-3, 1e-2, 3e-2, 0.1})
        for (const double way : {1.0, -1.0}) {
          if (amplitude > 1e-2 && told == 0) continue;
          ShotOrbit other = shoot(map, own.x + way * amplitude * scale * *v, parameter, doubled, tolerance);
          if (!other.found) continue;
          const auto once = map.march(other.x, parameter, quiet.clock);
          if (once.end || map.metric().size(once.image - other.x) < apart) continue;
          other.x = at_strobe(map, other.x, parameter, doubled);
          doubled.begins = 0;
          return SwitchedOrbit{std::move(other), doubled};
        }
    }
  return std::nullopt;
}

template std::optional<SwitchedOrbit> switch_branch(PeriodicMap&, const MapClock&, const SpecialPoint&, double, double,
                                                    const std::function<ShotOrbit(double)>&);
template std::optional<SwitchedOrbit> switch_branch(SteppedMap&, const MapClock&, const SpecialPoint&, double, double,
                                                    const std::function<ShotOrbit(double)>&);

}  // namespace ricochet
