#pragma once
#include <Eigen/SparseCore>
#include <cstddef>
#include <cstdint>

namespace ricochet {

/// 128 bits of all that a matrix consists of: equal for the same entries in the same places, to the last bit.
struct Fingerprint {
  std::uint64_t first = 1469598103934665603U, second = 7809847782465536322U;
  bool operator==(const Fingerprint&) const = default;
};

/// Of a compressed matrix.
Fingerprint fingerprint(const Eigen::SparseMatrix<double>& matrix);
/// Of its size and places alone.
Fingerprint pattern_fingerprint(const Eigen::SparseMatrix<double>& matrix);

/// Whether two compressed matrices hold entries in the same places.
bool same_places(const Eigen::SparseMatrix<double>& a, const Eigen::SparseMatrix<double>& b);

}  // namespace ricochet
