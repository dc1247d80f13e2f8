#include <algorithm>
#include <cstddef>
#include <ricochet/kernels/node_band.hpp>

namespace ricochet {
namespace {

using Row = std::ptrdiff_t;

// Entries (i, j) of a factor and of its transpose; zero beyond the band.
class Factor {
 public:
  explicit Factor(const BandLdlt& ldlt) : w_(ldlt.half_width()), rows_(ldlt.rows()), from_(ldlt.factor()) {}
  double lower(Row i, Row j) const { return j < 0 || i - j > w_ ? 0.0 : from_[i * (2 * w_ + 1) + w_ + j - i]; }
  double column(Row i, Row j) const {
    return j >= rows_ || j - i > w_ ? 0.0 : from_[i * (2 * w_ + 1) + w_ + j - i - 1];
  }
  double inverse(Row i) const { return from_[i * (2 * w_ + 1) + 2 * w_]; }
  // Whether rows of node a have no entry left of the node before.
  bool couples_neighbours(int per) const {
    for (Row i = 0; i < rows_; ++i)
      for (Row j = std::max<Row>(0, i - w_); j < (i / per - 1) * per; ++j)
        if (lower(i, j) != 0) return false;
    return true;
  }

 private:
  Row w_, rows_;
  const double* from_;
};

bool couples_neighbours(const SparseMatrix& K) {
  for (int j = 0; j < K.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(K, j); it; ++it)
      if (it.value() != 0 && std::abs(static_cast<int>(it.row()) / 2 - j / 2) > 1) return false;
  return true;
}

// w, r, t of one node after the other.
bool interleaved(const std::vector<int>& order, int dofs) {
  for (int row = 0; row < static_cast<int>(order.size()); ++row) {
    const int a = row / 3, unknown = order[static_cast<std::size_t>(row)];
    if (unknown != (row % 3 == 0 ? 2 * a : row % 3 == 1 ? dofs + a : 2 * a + 1)) return false;
  }
  return true;
}

}  // namespace

NodeBand::NodeBand(const SparseMatrix& K, const double* shape, const BandLdlt& ldlt) {
  const int dofs = static_cast<int>(K.rows()), nodes = dofs / 2;
  const bool border = !ldlt.natural();
  const int per = border ? 3 : 2;
  if (nodes == 0 || dofs != 2 * nodes || ldlt.rows() != per * nodes) return;
  if (border && !interleaved(ldlt.order(), dofs)) return;
  const Factor factor(ldlt);
  if (!couples_neighbours(K) || !factor.couples_neighbours(per)) return;
  nodes_ = nodes;
  border_ = border;
  const std::vector<double> band = band_storage(K, 3, false);
  diagonals_ = band_storage(K, 3, true);
  // Vectors of four may read beyond the end.
  shape_.assign(shape, shape + dofs);
  shape_.resize(static_cast<std::size_t>(dofs) + 4, 0.0);
  down_.reserve(static_cast<std::size_t>(nodes * node_down_stride(border)));
  up_.reserve(static_cast<std::size_t>(nodes * node_up_stride(border)));
  for (int a = 0; a < nodes; ++a) {
    for (int i = 2 * a; i < 2 * a + 2; ++i)
      for (int j = 2 * a - 2; j < 2 * a + 4; ++j) down_.push_back(band[static_cast<std::size_t>(7 * i + j - i + 3)]);
    for (int i = 2 * a; i < 2 * a + 2; ++i) down_.push_back(shape[i]);
    const Row first = static_cast<Row>(per) * a;
    for (Row i = first; i < first + per; ++i)
      for (Row j = first - per; j < i; ++j) down_.push_back(factor.lower(i, j));
    for (Row i = first + per - 1; i >= first; --i) {
      up_.push_back(factor.inverse(i));
      for (Row j = first + 2 * per - 1; j > i; --j) up_.push_back(factor.column(i, j));
    }
  }
}

bool NodeBand::place_points(const LaneRows& H) {
  point_.assign(static_cast<std::size_t>(nodes_), -1);
  value_.assign(static_cast<std::size_t>(nodes_), 0.0);
  for (int i = 0; i < H.rows; ++i) {
    const int e = H.start[i];
    const bool alone = H.start[i + 1] == e + 1 && H.index[e] % 2 == 0;
    if (!alone || point_[static_cast<std::size_t>(H.index[e] / 2)] >= 0) {
      point_.clear();
      return false;
    }
    point_[static_cast<std::size_t>(H.index[e] / 2)] = i;
    value_[static_cast<std::size_t>(H.index[e] / 2)] = H.value[e];
  }
  everywhere_ = H.rows == nodes_;
  for (int a = 0; a < nodes_ && everywhere_; ++a) everywhere_ = point_[static_cast<std::size_t>(a)] == a;
  return true;
}

NodeStep NodeBand::step() const {
  NodeStep step;
  step.nodes = nodes_;
  step.border = border_;
  step.down = down_.data();
  step.up = up_.data();
  step.point = point_.data();
  step.value = value_.data();
  step.everywhere = everywhere_;
  step.K = diagonals_.data();
  step.shape = shape_.data();
  return step;
}

}  // namespace ricochet
