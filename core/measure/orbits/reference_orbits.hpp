#pragma once
#include <functional>
#include <memory>
#include <ricochet/contract/reference.hpp>
#include <ricochet/measure/orbits/stepped_map.hpp>

namespace ricochet {

/// P(x, λ) of a reference: without steps and mesh. Where the reference has no state the march throws its Refusal. Of a
/// clock the period and `half` count.
class ReferenceOrbits final : public FollowedMap {
 public:
  struct Scene {
    std::unique_ptr<ReferenceMap> map;
    double period = 0;  ///< of the forcing, s
  };
  /// Throws Refusal where the scene is refused at a value.
  using Make = std::function<Scene(double parameter)>;

  ReferenceOrbits(Make make, double at, double parameter_metres);

  int size() const override { return scene_.map->size(); }
  const StateMetric& metric() const override { return *metric_; }
  Image march(const Eigen::VectorXd& x, double parameter, const MapClock& clock, bool derivative = false) override;
  /// Displacement and velocity of the tip, as ReferenceMap has them.
  std::pair<double, double> tip(const Eigen::VectorXd& x, double parameter) { return at(parameter).map->tip(x); }
  /// The state after so many periods from the scene's initial state.
  Eigen::VectorXd settle(double parameter, int periods);

 private:
  Scene& at(double parameter);

  Make make_;
  Scene scene_;  // of the last value
  double value_;
  std::unique_ptr<StateMetric> metric_;
};

}  // namespace ricochet
