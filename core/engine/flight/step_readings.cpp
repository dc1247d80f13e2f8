#include <ricochet/algebra/flight_kernels.hpp>
#include <ricochet/engine/flight/step_readings.hpp>

namespace ricochet {

StepReadings::StepReadings(const StepRows& rows, const FlightWatch& watch, int point)
    : size_(rows.slots() * rows.modes()),
      drives_(rows.drive().count()),
      weights_(static_cast<std::size_t>(rows_read * size_)),
      drive_(static_cast<std::size_t>(rows_read * drives_)) {
  const int modes = rows.modes(), slots = rows.slots();
  const Eigen::MatrixXd turn = rows.drive().change(1);
  const auto add_drive = [&](int at, const auto& more) {
    for (int k = 0; k < drives_; ++k) drive_[static_cast<std::size_t>(at * drives_ + k)] += more[k];
  };
  // `own` at each step, and its differences: `differ`() is what it changes by from step to step.
  const auto put_all = [&](const Eigen::RowVectorXd& own, auto&& put, auto&& differ) {
    Eigen::RowVectorXd now = own;
    for (int step = 0; step <= block; ++step) {
      put(step, now);
      now += differ(now);
    }
    now = own;
    for (int order = 0; order < differences_read; ++order) {
      put(differences_from + order, now);
      now = differ(now);
    }
  };
  Eigen::RowVectorXd change(rows.width());
  for (int mode = 0; mode < modes; ++mode)
    put_all(
        watch.rows(point, mode) * rows.of(mode, watch.stage, watch.value),
        [&](int at, const Eigen::RowVectorXd& own) {
          for (int j = 0; j < slots; ++j) weights_[static_cast<std::size_t>(at * size_ + j * modes + mode)] = own[j];
          add_drive(at, own.tail(drives_));
        },
        [&](const Eigen::RowVectorXd& own) -> const Eigen::RowVectorXd& {
          change.noalias() = own.head(slots).lazyProduct(rows.change(mode));
          if (drives_ > 0) change.tail(drives_) += own.tail(drives_).lazyProduct(turn);
          return change;
        });
  put_all(watch.drive.row(point), add_drive,
          [&](const Eigen::RowVectorXd& own) -> Eigen::RowVectorXd { return own * turn; });
}

double StepReadings::operator()(int step, const double* x, const double* e) const {
  double value;
  read(step, 1, x, e, &value);
  return value;
}

void StepReadings::read(int first, int count, const double* x, const double* e, double* out) const {
  flight_kernels().dots(size_, count, weights_.data() + static_cast<std::ptrdiff_t>(first) * size_, x, out);
  for (int row = 0; row < count; ++row)
    for (int k = 0; k < drives_; ++k) out[row] += drive_[static_cast<std::size_t>((first + row) * drives_ + k)] * e[k];
}

}  // namespace ricochet
