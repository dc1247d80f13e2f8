#pragma once
#include <Eigen/Core>
#include <memory>
#include <ricochet/scene/history/time_history.hpp>
#include <vector>

namespace ricochet {

/// What supports do by histories, beside the harmonic φ of all: u = w + Σ_j ψ_j φ_j(t), ψ_j the static shape of the
/// supports that move by φ_j. A stop that moves with a support sees u less the motion of that support.
struct SupportMotions {
  std::vector<std::shared_ptr<const TimeHistory>> histories;  ///< φ_j, m; r of them
  std::vector<std::vector<std::size_t>> supports;             ///< that each moves
  Eigen::MatrixXd at_points;   ///< m × r: (Hψ)_j at the contact points, less 1 where the stop moves by φ_j
  Eigen::RowVectorXd at_tip;   ///< 1 × r: (ψ_j) at the tip; zero where displacements count from the supports
  bool from_supports = false;  ///< whether displacements that are shown do
  bool carry_stops = false;    ///< whether stops move with supports

  bool empty() const { return histories.empty(); }
  /// Σ_j A_ij φ_j(t) of contact point i, m, and its rate.
  double point(int i, double t) const { return empty() ? 0.0 : sum(at_points.row(i), t, false); }
  double point_rate(int i, double t) const { return empty() ? 0.0 : sum(at_points.row(i), t, true); }
  /// Σ_j A_ij φ_j''(t), m/s².
  double point_acceleration(int i, double t) const {
    double total = 0;
    for (std::size_t j = 0; j < histories.size(); ++j)
      total += at_points(i, static_cast<Eigen::Index>(j)) * histories[j]->acceleration(t);
    return total;
  }
  /// Σ_j A_ij φ_j(t) of the tip, m, and its rate.
  double tip(double t) const { return empty() ? 0.0 : sum(at_tip, t, false); }
  double tip_rate(double t) const { return empty() ? 0.0 : sum(at_tip, t, true); }

  /// φ_j(t), r numbers, or their rates. Allocates.
  Eigen::VectorXd values(double t, bool rate) const {
    Eigen::VectorXd out(static_cast<Eigen::Index>(histories.size()));
    for (std::size_t j = 0; j < histories.size(); ++j)
      out[static_cast<Eigen::Index>(j)] = rate ? histories[j]->rate(t) : histories[j]->value(t);
    return out;
  }

  /// Σ_j a_j φ_j(t), or its rate.
  double sum(const Eigen::Ref<const Eigen::RowVectorXd, 0, Eigen::InnerStride<>>& a, double t, bool rate) const {
    double total = 0;
    for (std::size_t j = 0; j < histories.size(); ++j) {
      const double share = a[static_cast<Eigen::Index>(j)];
      if (share != 0) total += share * (rate ? histories[j]->rate(t) : histories[j]->value(t));
    }
    return total;
  }
};

}  // namespace ricochet
