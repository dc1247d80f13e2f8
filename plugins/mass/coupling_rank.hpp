#pragma once
#include <Eigen/SparseQR>
#include <ricochet/contract/plugin.hpp>

namespace ricochet {

/// Rank of B, its rows and columns scaled to length 1 first so that the threshold has no unit.
inline int coupling_rank(const SparseMatrix& coupling) {
  SparseMatrix scaled = coupling.transpose();
  for (int side = 0; side < 2; ++side) {
    for (Eigen::Index j = 0; j < scaled.cols(); ++j) {
      const double norm = scaled.col(j).norm();
      if (norm > 0) scaled.col(j) /= norm;
    }
    scaled = SparseMatrix(scaled.transpose());
  }
  scaled.makeCompressed();
  Eigen::SparseQR<SparseMatrix, Eigen::COLAMDOrdering<int>> qr;
  qr.setPivotThreshold(1e-9);
  qr.compute(scaled);
  return static_cast<int>(qr.rank());
}

}  // namespace ricochet
