#pragma once
#include "linear_structure.hpp"

namespace ricochet::reference {

/// The modes of (M, K) that keep E w = 0: M-normalised shapes with their λ, and the massless ones, K-normalised. All
/// are K- and M-orthogonal. Found as M x = μ K x, which keeps the digits of the slow ones.
struct Pencil {
  Eigen::MatrixXd shapes;    ///< n × r
  Eigen::VectorXd squares;   ///< λ, r
  Eigen::MatrixXd massless;  ///< n × k
};

/// `stiffness`: K, of the structure or with springs on it; `closed`: E.
Pencil pencil(const LinearStructure& structure, const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& closed);

}  // namespace ricochet::reference
