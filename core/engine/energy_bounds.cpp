#include <algorithm>
#include <ricochet/algebra/infinity.hpp>
#include <ricochet/engine/energy_bounds.hpp>

namespace ricochet {

EnergyBounds::EnergyBounds(const Program& program)

    : scale_(*program.problem),
      bounded_(program.bounded),
      load_varies_(program.load && !program.load_constant),
      lanes_(program.lanes.size()) {
  if (program.load) load_ = factor * scale_.of_load(0);
}

void EnergyBounds::place(int lane, const LaneSpec& spec, double stored) {
  lanes_[static_cast<std::size_t>(lane)] = bounded_ ? factor * std::max(scale_.of_lane(spec), stored) : infinity;
}

double EnergyBounds::known(int lane) const {
  return std::max(lanes_[static_cast<std::size_t>(lane)], load_);
}

double EnergyBounds::of(int lane) const {
  const double bound = known(lane);
  return bound == 0 ? infinity : bound;
}

bool EnergyBounds::passed(int lane, double energy, double t) {
  // A load that depends on time may have grown since the start.
  if (load_varies_ && t > load_known_until_ && energy > known(lane)) {
    load_known_until_ = 2 * t;
    load_ = std::max(load_, factor * scale_.of_load(load_known_until_));
  }
  return energy > of(lane);
}

}  // namespace ricochet
