#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <ricochet/kernels/band_ldlt.hpp>

namespace ricochet {

int half_bandwidth(const SparseMatrix& matrix) {
  int width = 0;
  for (int j = 0; j < matrix.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(matrix, j); it; ++it)
      if (it.value() != 0) width = std::max(width, std::abs(static_cast<int>(it.row()) - j));
  return width;
}

std::vector<double> band_storage(const SparseMatrix& matrix, int half_width, bool by_diagonals) {
  const auto rows = static_cast<std::size_t>(matrix.rows()), stride = static_cast<std::size_t>(2 * half_width + 1);
  // Vector loads of the by-diagonals form may read a few entries past the end.
  std::vector<double> band(rows * stride + 8, 0.0);
  for (int j = 0; j < matrix.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(matrix, j); it; ++it) {
      if (it.value() == 0) continue;
      const auto i = static_cast<std::size_t>(it.row());
      const auto s = static_cast<std::size_t>(j - static_cast<int>(it.row()) + half_width);
      band[by_diagonals ? s * rows + i : i * stride + s] = it.value();
    }
  return band;
}

SparseMatrix QuasiDefinite::assemble(std::vector<int>& order) const {
  const int n = static_cast<int>(A.rows()), border = static_cast<int>(G.rows());
  std::vector<double> place(static_cast<std::size_t>(n + border), 0.0);
  std::vector<double> largest(static_cast<std::size_t>(border), 0.0);
  for (int i = 0; i < n; ++i) place[static_cast<std::size_t>(i)] = i;
  for (int j = 0; j < G.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(G, j); it; ++it) {
      double& so_far = largest[static_cast<std::size_t>(it.row())];
      if (std::abs(it.value()) <= so_far) continue;
      so_far = std::abs(it.value());
      place[static_cast<std::size_t>(n + it.row())] = border_first ? j - 0.5 : j + 0.5;
    }
  order.resize(static_cast<std::size_t>(n + border));
  std::iota(order.begin(), order.end(), 0);
  if (border == 0) return A;
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return place[static_cast<std::size_t>(a)] < place[static_cast<std::size_t>(b)];
  });
  std::vector<int> row_of(order.size());
  for (std::size_t r = 0; r < order.size(); ++r) row_of[static_cast<std::size_t>(order[r])] = static_cast<int>(r);

  std::vector<Eigen::Triplet<double>> triplets;
  const auto put = [&](int i, int j, double value) {
    triplets.emplace_back(row_of[static_cast<std::size_t>(i)], row_of[static_cast<std::size_t>(j)], value);
  };
  const auto each = [](const SparseMatrix& matrix, auto&& visit) {
    for (int j = 0; j < matrix.outerSize(); ++j)
      for (SparseMatrix::InnerIterator it(matrix, j); it; ++it) visit(static_cast<int>(it.row()), j, it.value());
  };
  each(A, put);
  each(G, [&](int i, int j, double value) {
    put(n + i, j, value);
    put(j, n + i, value);
  });
  each(Cv, [&](int i, int j, double value) { put(n + i, n + j, -value); });
  SparseMatrix whole(n + border, n + border);
  whole.setFromTriplets(triplets.begin(), triplets.end());
  return whole;
}

std::optional<std::string> BandLdlt::factorise(const QuasiDefinite& matrix) {
  const SparseMatrix whole = matrix.assemble(order_);
  const int dofs = static_cast<int>(matrix.A.rows());
  rows_ = static_cast<int>(whole.rows());
  width_ = half_bandwidth(whole);
  natural_ = matrix.G.rows() == 0;
  const int w = width_, stride = 2 * w + 1;
  const std::vector<double> band = band_storage(whole, w, false);
  factor_.assign(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(stride), 0.0);
  const auto entry = [&](int i, int s) -> double& {
    return factor_[static_cast<std::size_t>(i) * static_cast<std::size_t>(stride) + static_cast<std::size_t>(s)];
  };
  std::vector<double> pivot(static_cast<std::size_t>(rows_));
  double largest = 0;
  for (int i = 0; i < rows_; ++i) {
    // L_ij D_j = A_ij − Σ_{k<j} L_ik D_k L_jk over the band.
    double d = band[static_cast<std::size_t>(i * stride + w)];
    const double scale = std::abs(d);
    for (int j = std::max(0, i - w); j < i; ++j) {
      double sum = band[static_cast<std::size_t>(i * stride + w + j - i)];
      for (int k = std::max(0, i - w); k < j; ++k)
        if (j - k <= w) sum -= entry(i, k - i + w) * pivot[static_cast<std::size_t>(k)] * entry(j, k - j + w);
      entry(i, j - i + w) = sum / pivot[static_cast<std::size_t>(j)];
    }
    for (int k = std::max(0, i - w); k < i; ++k)
      d -= entry(i, k - i + w) * entry(i, k - i + w) * pivot[static_cast<std::size_t>(k)];
    const bool is_dof = order_[static_cast<std::size_t>(i)] < dofs;
    largest = std::max(largest, scale);
    // A pivot this small against its own diagonal is cancellation: nothing is left of it.
    if (!std::isfinite(d) || std::abs(d) <= 1e-15 * scale || (is_dof ? d <= 0 : d >= 0))
      return "the matrix of the step is singular (pivot " + std::to_string(i + 1) + " of " + std::to_string(rows_) +
             ")";
    pivot[static_cast<std::size_t>(i)] = d;
    entry(i, 2 * w) = 1 / d;
  }
  for (int i = 0; i < rows_; ++i)
    for (int s = 1; s <= w && i + s < rows_; ++s) entry(i, w + s - 1) = entry(i + s, w - s);
  return std::nullopt;
}

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
