#include <cmath>
#include <ricochet/engine/flight/step_rows.hpp>

namespace ricochet {

Eigen::MatrixXd FlightDrive::change(double steps) const {
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(count(), count());
  if (!harmonic) return R;
  const double turn = angle * steps, half = std::sin(turn / 2), fall = -2 * half * half, rise = std::sin(turn);
  R.topLeftCorner(2, 2) << fall, rise, -rise, fall;
  return R;
}

StepRows::StepRows(const std::vector<FlightStage>& stages, int slots, const Eigen::VectorXd& mass,
                   const FlightDrive& drive)
    : slots_(slots), drive_(drive), maps_(static_cast<std::size_t>(mass.size())) {
  for (Eigen::Index mode = 0; mode < mass.size(); ++mode) {
    std::vector<StageMap>& maps = maps_[static_cast<std::size_t>(mode)];
    Eigen::MatrixXd change = Eigen::MatrixXd::Zero(slots, width());
    for (const FlightStage& stage : stages) {
      StageMap& map = maps.emplace_back(StageMap{change, Eigen::RowVectorXd::Zero(width())});
      const FoldedStage& folded = stage.folded;
      if (folded.solves()) {
        for (int j = 0; j < slots; ++j) {
          const auto at = static_cast<std::size_t>(j);
          map.unknown += (folded.mass_history[at] * mass[mode] + folded.stiffness_history[at]) * slot(map, j);
        }
        map.unknown.tail(drive_.count()) += stage.force.row(mode);
        map.unknown /= folded.mass * mass[mode] + folded.stiffness;
      }
      for (int j = 0; j < slots; ++j) {
        const Combination& update = stage.update[static_cast<std::size_t>(j)];
        change.row(j) += update.z * map.unknown;
        for (int i = 0; i < slots; ++i) {
          const double weight =
              static_cast<std::size_t>(i) < update.slots.size() ? update.slots[static_cast<std::size_t>(i)] : 0.0;
          if (const double more = weight - (i == j ? 1.0 : 0.0); more != 0) change.row(j) += more * slot(map, i);
        }
      }
    }
    maps.push_back({change, Eigen::RowVectorXd::Zero(width())});
  }
}

Eigen::RowVectorXd StepRows::slot(const StageMap& map, int j) const {
  Eigen::RowVectorXd row = map.change.row(j);
  row[j] += 1;
  return row;
}

Eigen::RowVectorXd StepRows::of(int mode, int stage, const Combination& c) const {
  const StageMap& map = maps_[static_cast<std::size_t>(mode)][static_cast<std::size_t>(stage)];
  Eigen::RowVectorXd row = c.z * map.unknown;
  for (std::size_t j = 0; j < c.slots.size(); ++j)
    if (c.slots[j] != 0) row += c.slots[j] * slot(map, static_cast<int>(j));
  return row;
}

}  // namespace ricochet
