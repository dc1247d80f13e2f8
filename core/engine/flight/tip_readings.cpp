#include <ricochet/engine/flight/tip_readings.hpp>

namespace ricochet {

using Eigen::RowVectorXd;

TipReadings::TipReadings(const StepRows& rows, const RowVectorXd& points, const RowVectorXd& drive)
    : size_(rows.slots() * rows.modes()), drives_(rows.drive().count()) {
  const int slots = rows.slots(), modes = rows.modes();
  const Eigen::MatrixXd turn = rows.drive().change(1);
  weights_.resize(static_cast<std::size_t>(block * size_));
  drive_.assign(static_cast<std::size_t>(block * drives_), 0.0);
  const auto add_drive = [&](int step, const RowVectorXd& row) {
    for (int k = 0; k < drives_; ++k) drive_[static_cast<std::size_t>(step * drives_ + k)] += row[k];
  };
  Combination position;
  position.slots = {1};
  for (int mode = 0; mode < modes; ++mode) {
    RowVectorXd row = points[mode] * rows.of(mode, rows.stages(), position);
    for (int step = 0; step < block; ++step) {
      for (int j = 0; j < slots; ++j) weights_[static_cast<std::size_t>(step * size_ + j * modes + mode)] = row[j];
      add_drive(step, row.tail(drives_));
      RowVectorXd next = row;
      next += row.head(slots) * rows.change(mode);
      if (drives_ > 0) next.tail(drives_) += row.tail(drives_) * turn;
      row = next;
    }
  }
  RowVectorXd own = drive;
  for (int step = 0; step < block; ++step) {
    add_drive(step, own);
    own += own * turn.eval();
  }
}

}  // namespace ricochet
