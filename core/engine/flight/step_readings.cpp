#include <ricochet/algebra/flight_kernels.hpp>
#include <ricochet/engine/flight/step_readings.hpp>

namespace ricochet {

namespace {

constexpr int differences_read = 4;

}  // namespace

StepReadings::StepReadings(const StepRows& rows, const FlightWatch& watch, int point)
    : size_(rows.slots() * rows.modes()), drives_(rows.drive().count()) {
  const int modes = rows.modes(), slots = rows.slots();
  const auto room = [](std::vector<double>& table, int count) { table.assign(static_cast<std::size_t>(count), 0.0); };
  room(weights_, (block + 1) * size_);
  room(drive_, (block + 1) * drives_);
  room(difference_weights_, differences_read * size_);
  room(difference_drive_, differences_read * drives_);
  const Eigen::MatrixXd turn = rows.drive().change(1);
  // A row becomes that of its change from step to step.
  Eigen::RowVectorXd own, change(rows.width());
  const auto differ = [&](const Eigen::MatrixXd& step) {
    change.noalias() = own.head(slots).lazyProduct(step);
    if (drives_ > 0) change.tail(drives_) += own.tail(drives_).lazyProduct(turn);
  };
  const auto put = [&](std::vector<double>& weights, std::vector<double>& drive, int at, int mode) {
    for (int j = 0; j < slots; ++j) weights[static_cast<std::size_t>(at * size_ + j * modes + mode)] = own[j];
    for (int k = 0; k < drives_; ++k) drive[static_cast<std::size_t>(at * drives_ + k)] += own[slots + k];
  };
  for (int mode = 0; mode < modes; ++mode) {
    const Eigen::MatrixXd& step_change = rows.change(mode);
    const Eigen::RowVectorXd first = watch.rows(point, mode) * rows.of(mode, watch.stage, watch.value);
    own = first;
    for (int step = 0; step <= block; ++step) {
      put(weights_, drive_, step, mode);
      differ(step_change);
      own += change;
    }
    own = first;
    for (int order = 0; order < differences_read; ++order) {
      put(difference_weights_, difference_drive_, order, mode);
      differ(step_change);
      own = change;
    }
  }
  const auto add_drive = [&](std::vector<double>& drive, int at, const Eigen::RowVectorXd& more) {
    for (int k = 0; k < drives_; ++k) drive[static_cast<std::size_t>(at * drives_ + k)] += more[k];
  };
  Eigen::RowVectorXd drive = watch.drive.row(point);
  for (int step = 0; step <= block; ++step) {
    add_drive(drive_, step, drive);
    drive += drive * turn;
  }
  drive = watch.drive.row(point);
  for (int order = 0; order < differences_read; ++order) {
    add_drive(difference_drive_, order, drive);
    drive = (drive * turn).eval();
  }
}

double StepReadings::operator()(int step, const double* x, const double* e) const {
  double sum = flight_kernels().dot(size_, weights_.data() + static_cast<std::size_t>(step * size_), x);
  for (int k = 0; k < drives_; ++k) sum += drive_[static_cast<std::size_t>(step * drives_ + k)] * e[k];
  return sum;
}

void StepReadings::first(int steps, const double* x, const double* e, double* out) const {
  flight_kernels().dots(size_, steps, weights_.data(), x, out);
  for (int step = 0; step < steps; ++step)
    for (int k = 0; k < drives_; ++k) out[step] += drive_[static_cast<std::size_t>(step * drives_ + k)] * e[k];
}

void StepReadings::differences(const double* x, const double* e, double out[4]) const {
  flight_kernels().dots(size_, differences_read, difference_weights_.data(), x, out);
  for (int order = 0; order < differences_read; ++order)
    for (int k = 0; k < drives_; ++k)
      out[order] += difference_drive_[static_cast<std::size_t>(order * drives_ + k)] * e[k];
}

}  // namespace ricochet
