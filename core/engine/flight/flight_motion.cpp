#include <algorithm>
#include <ricochet/algebra/flight_kernels.hpp>
#include <ricochet/engine/flight/flight_motion.hpp>

namespace ricochet {

void double_change(Eigen::MatrixXd& change, int slots, const Eigen::MatrixXd& turn) {
  const Eigen::Index drives = change.cols() - slots;
  const Eigen::MatrixXd D = change.leftCols(slots), B = change.rightCols(drives);
  change.leftCols(slots) = 2 * D + D * D;
  if (drives > 0) change.rightCols(drives) = 2 * B + D * B + B * turn;
}

FlightMotion::FlightMotion(const StepRows& rows, int powers)
    : modes_(rows.modes()), slots_(rows.slots()), width_(rows.width()), drive_(rows.drive()) {
  const int drives = drive_.count();
  const auto n = static_cast<std::size_t>(modes_);
  tables_.assign(static_cast<std::size_t>(powers), std::vector<double>(static_cast<std::size_t>(slots_ * width_) * n));
  for (int power = 0; power < powers; ++power) {
    const Eigen::MatrixXd R = drive_.change(static_cast<double>(1LL << power));
    std::vector<double>& rotation = rotations_.emplace_back();
    for (int i = 0; i < drives; ++i)
      for (int j = 0; j < drives; ++j) rotation.push_back(R(i, j));
  }
  for (int mode = 0; mode < modes_; ++mode) {
    const Eigen::MatrixXd& change = rows.change(mode);
    for (int i = 0; i < slots_; ++i)
      for (int j = 0; j < width_; ++j)
        tables_[0][static_cast<std::size_t>(i * width_ + j) * n + static_cast<std::size_t>(mode)] = change(i, j);
  }
  for (std::size_t power = 1; power < tables_.size(); ++power)
    double_table(tables_[power - 1].data(), rotations_[power - 1].data(), tables_[power].data());
  next_.resize(static_cast<std::size_t>(slots_) * n);
}

// (2), all modes at once.
void FlightMotion::double_table(const double* change, const double* turn, double* __restrict twice) const {
  const int n = modes_, drives = width_ - slots_;
  const auto entry = [&](int i, int j) { return static_cast<std::ptrdiff_t>(i * width_ + j) * n; };
  for (int i = 0; i < slots_; ++i)
    for (int j = 0; j < width_; ++j) {
      double* const out = twice + entry(i, j);
      const auto add = [&](const double* a, auto&& factor) {
        for (int m = 0; m < n; ++m) out[m] += a[m] * factor(m);
      };
      for (int k = 0; k < slots_; ++k) {
        const double* const b = change + entry(k, j);
        add(change + entry(i, k), [b](int m) { return b[m]; });
      }
      const double* const own = change + entry(i, j);
      for (int m = 0; m < n; ++m) out[m] = 2 * own[m] + out[m];
      for (int l = 0; j >= slots_ && l < drives; ++l)
        if (const double turned = turn[l * drives + j - slots_]; turned != 0)
          add(change + entry(i, slots_ + l), [turned](int) { return turned; });
    }
}

void FlightMotion::leap(int power, double* x, double* e) const {
  if (slots_ <= FlightKernels::in_place) return leap_to(power, x, e, x);
  leap_to(power, x, e, next_.data());
  std::copy(next_.begin(), next_.end(), x);
}

void FlightMotion::leap_to(int power, const double* x, double* e, double* next) const {
  const auto at = static_cast<std::size_t>(power);
  flight_kernels().leap(modes_, slots_, drive_.count(), tables_[at].data(), x, e, next);
  double turned[3] = {};
  const int drives = drive_.count();
  for (int i = 0; i < drives; ++i) {
    turned[i] = e[i];
    for (int j = 0; j < drives; ++j) turned[i] += rotations_[at][static_cast<std::size_t>(i * drives + j)] * e[j];
  }
  std::copy_n(turned, drives, e);
}

void FlightMotion::advance(long long k, double* x, double* e) const {
  for (int power = 0; k >> power != 0; ++power)
    if ((k >> power) & 1) leap(power, x, e);
}

}  // namespace ricochet
