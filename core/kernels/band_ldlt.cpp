#include <algorithm>
#include <cmath>
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

}  // namespace ricochet
