#pragma once
#include <ricochet/engine/energy_scale.hpp>
#include <vector>

namespace ricochet {

/// Energies (J) beyond which lanes count as diverged: a multiple of what the scene's own data mention; infinite where
/// the program is not bounded.
class EnergyBounds {
 public:
  static constexpr double factor = 1e9;  ///< of EnergyScale

  explicit EnergyBounds(const Program& program);

  /// `stored`: by the law in the lane's initial state, J.
  void place(int lane, const LaneSpec& spec, double stored);
  /// A lane's own, whoever marches beside it; infinite where the scene mentions no energy.
  double of(int lane) const;
  /// Whether an energy at time t is beyond it; looks again at a load that depends on time before it says so.
  bool passed(int lane, double energy, double t);

 private:
  double known(int lane) const;

  EnergyScale scale_;
  bool bounded_;
  bool load_varies_;           // with time
  std::vector<double> lanes_;  // without the load
  double load_ = 0, load_known_until_ = 0;
};

}  // namespace ricochet
