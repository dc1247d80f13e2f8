#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace ricochet::benchmarks {

/// λ that holds |u + Wλ| ≤ gap, opposite to the side that it touches, from the last one on: projected Gauss–Seidel.
template <class Vector>
void hold_between(const Eigen::MatrixXd& W, double gap, const Vector& free, Vector& effort) {
  Vector place = free + W * effort;
  for (int sweep = 0; sweep < 10000; ++sweep) {
    double change = 0, largest = 0;
    for (int i = 0; i < place.size(); ++i) {
      const double open = place[i] - W(i, i) * effort[i];
      const double wanted = open < -gap ? (-gap - open) / W(i, i) : open > gap ? (gap - open) / W(i, i) : 0;
      const double more = wanted - effort[i];
      if (more != 0) place += W.col(i) * more;
      effort[i] = wanted;
      change = std::max(change, std::abs(more));
      largest = std::max(largest, std::abs(wanted));
    }
    if (change <= 1e-13 * largest) break;
  }
}

}  // namespace ricochet::benchmarks
