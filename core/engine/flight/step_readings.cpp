#include <ricochet/algebra/flight_kernels.hpp>
#include <ricochet/engine/flight/step_readings.hpp>

namespace ricochet {

StepReadings::StepReadings(const StepRows& rows, const FlightWatch& watch, int point)
    : size_(rows.slots() * rows.modes()), drives_(rows.drive().count()) {
  const int modes = rows.modes(), slots = rows.slots();
  weights_.resize(static_cast<std::size_t>((block + 1) * size_));
  drive_.assign(static_cast<std::size_t>((block + 1) * drives_), 0.0);
  const auto add_drive = [&](int step, const auto& more) {
    for (int k = 0; k < drives_; ++k) drive_[static_cast<std::size_t>(step * drives_ + k)] += more[k];
  };
  const Eigen::MatrixXd turn = rows.drive().change(1);
  Eigen::RowVectorXd own, more(rows.width());
  for (int mode = 0; mode < modes; ++mode) {
    const Eigen::MatrixXd& change = rows.change(mode);
    own = watch.rows(point, mode) * rows.of(mode, watch.stage, watch.value);
    for (int step = 0; step <= block; ++step) {
      for (int j = 0; j < slots; ++j) weights_[static_cast<std::size_t>(step * size_ + j * modes + mode)] = own[j];
      add_drive(step, own.tail(drives_));
      more.noalias() = own.head(slots).lazyProduct(change);
      if (drives_ > 0) more.tail(drives_) += own.tail(drives_).lazyProduct(turn);
      own += more;
    }
  }
  Eigen::RowVectorXd drive = watch.drive.row(point);
  for (int step = 0; step <= block; ++step) {
    add_drive(step, drive);
    drive += drive * turn;
  }
}

double StepReadings::operator()(int step, const double* x, const double* e) const {
  double sum = flight_kernels().dot(size_, weights_.data() + static_cast<std::size_t>(step * size_), x);
  for (int k = 0; k < drives_; ++k) sum += drive_[static_cast<std::size_t>(step * drives_ + k)] * e[k];
  return sum;
}

}  // namespace ricochet
