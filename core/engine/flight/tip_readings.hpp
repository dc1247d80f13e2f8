#pragma once
#include <ricochet/algebra/flight_kernels.hpp>
#include <ricochet/engine/flight/flight_motion.hpp>

namespace ricochet {

/// The tip after each of many steps: of `block` steps by rows over the state before them, r, r A, r A², …, and a leap.
class TipReadings {
 public:
  /// `points`: the tip's row over the modes of `rows`; `drive`: what e adds where a step begins, after it.
  TipReadings(const StepRows& rows, const Eigen::RowVectorXd& points, const Eigen::RowVectorXd& drive);

  /// `see`(displacement) after each of `steps` steps from (x, e) on, which become the state at the last block's end.
  template <class See>
  void each(const FlightMotion& motion, long long steps, double* x, double* e, See&& see) const {
    const FlightKernels& kernels = flight_kernels();
    for (long long first = 0; first < steps; first += block) {
      const auto count = static_cast<std::size_t>(std::min<long long>(block, steps - first));
      for (std::size_t i = 0; i < count; ++i) {
        double value = kernels.dot(size_, weights_.data() + i * static_cast<std::size_t>(size_), x);
        for (int k = 0; k < drives_; ++k)
          value += drive_[i * static_cast<std::size_t>(drives_) + static_cast<std::size_t>(k)] * e[k];
        see(value);
      }
      motion.leap(power, x, e);
    }
  }

 private:
  static constexpr int power = 3, block = 1 << power;
  int size_, drives_;
  std::vector<double> weights_, drive_;  // of each step of a block: slots × modes, drives
};

}  // namespace ricochet
