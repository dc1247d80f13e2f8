#pragma once
#include <ricochet/kernels/block.hpp>
#include <ricochet/kernels/lane_kernels.hpp>
#include <ricochet/kernels/sparse_ldlt.hpp>
#include <vector>

namespace ricochet {

/// A sparse factor as SparseStep reads it: blocks of columns of L (supernodes, Ashcraft and Grimes 1989). A column
/// joins those before it where the zeros that it brings are few.
class SparseSubstitution {
 public:
  SparseSubstitution() = default;
  /// `order`: the unknown of each row of the matrix that was factorised. Those from `known` on have no right-hand side,
  /// those from `wanted` on no place in z.
  SparseSubstitution(const SparseLdlt& ldlt, const std::vector<int>& order, int known, int wanted);
  int rows() const { return static_cast<int>(inverse_.size()); }
  /// Without the blocks of lanes.
  SparseStep step() const { return step_from(from_); }
  /// The same where unknowns from `wanted` on have no right-hand side.
  SparseStep step_of_wanted() const { return step_from(to_); }
  /// Numbers of the factor that a step reads, twice.
  std::size_t entries() const { return value_.size(); }

 private:
  SparseStep step_from(const std::vector<int>& from) const;
  void add_block(const SparseLdlt& ldlt, int first, int end);

  std::vector<int> column_{0}, below_{0}, index_, from_, to_;
  std::vector<double, CacheLineAllocator<double>> value_;
  std::vector<double> inverse_;
};

}  // namespace ricochet
