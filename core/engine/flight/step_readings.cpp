#include <ricochet/algebra/flight_kernels.hpp>
#include <ricochet/engine/flight/step_readings.hpp>

namespace ricochet {

StepReadings::StepReadings(const StepRows& rows, const FlightWatch& watch, const double* points)
    : points_(points),
      count_(static_cast<int>(watch.rows.rows())),
      modes_(rows.modes()),
      slots_(rows.slots()),
      drives_(rows.drive().count()) {
  const int width = rows.width();
  const auto n = static_cast<std::size_t>(modes_), size = static_cast<std::size_t>(width) * n;
  table_.resize((block + 1) * size);
  const Eigen::MatrixXd turn = rows.drive().change(1);
  for (int mode = 0; mode < modes_; ++mode) {
    const Eigen::MatrixXd& change = rows.change(mode);
    Eigen::RowVectorXd row = rows.of(mode, watch.stage, watch.value), more(width);
    for (std::size_t step = 0; step <= block; ++step) {
      for (int k = 0; k < width; ++k)
        table_[step * size + static_cast<std::size_t>(k) * n + static_cast<std::size_t>(mode)] = row[k];
      more.noalias() = row.head(slots_).lazyProduct(change);
      if (drives_ > 0) more.tail(drives_) += row.tail(drives_).lazyProduct(turn);
      row += more;
    }
  }
  Eigen::MatrixXd drive = watch.drive;
  for (int step = 0; step <= block; ++step) {
    for (Eigen::Index i = 0; i < count_; ++i)
      for (int k = 0; k < drives_; ++k) drive_.push_back(drive(i, k));
    drive += drive * turn.eval();
  }
}

void StepReadings::modes(int step, const double* x, const double* e, double* out) const {
  const std::size_t size = static_cast<std::size_t>(slots_ + drives_) * static_cast<std::size_t>(modes_);
  flight_kernels().row(modes_, slots_, drives_, table_.data() + static_cast<std::size_t>(step) * size, x, e, out);
}

double StepReadings::value(int point, int step, const double* modes, const double* e) const {
  double sum =
      flight_kernels().dot(modes_, points_ + static_cast<std::size_t>(point) * static_cast<std::size_t>(modes_), modes);
  const double* own = drive_.data() + static_cast<std::size_t>((step * count_ + point) * drives_);
  for (int k = 0; k < drives_; ++k) sum += own[k] * e[k];
  return sum;
}

}  // namespace ricochet
