#include <Spectra/SymGEigsShiftSolver.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <ricochet/kernels/eigenvalues.hpp>
#include <ricochet/kernels/lane_kernels.hpp>
#include <ricochet/kernels/sparse_factor.hpp>
#include <ricochet/scene/basis/modal_basis.hpp>
#include <vector>

namespace ricochet {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Beams of so many dofs are small problems. Of wider matrices few modes are cheaper by Lanczos.
bool dense_pays(const SparseMatrix& K, int count) {
  constexpr int most_dense = 1000, most_wide = 200;
  const bool few = 5 * count < K.rows();
  return K.rows() <= (few && half_bandwidth(K) > narrow_band ? most_wide : most_dense);
}

/// μ descending and φ with φᵀ(K + σM)φ = 1.
struct Slowest {
  VectorXd mu;
  MatrixXd shapes;
  int with_mass = 0;
  bool found = false;
};

Slowest dense(const SparseMatrix& K, const SparseMatrix& M, double shift, int count) {
  Slowest out;
  const SymmetricModes modes = symmetric_modes(MatrixXd(M), MatrixXd(K + shift * M));
  if (!modes.found) return out;
  const Index n = modes.values.size();
  constexpr double massless = 1e-13;
  const double least = massless * modes.values[n - 1];
  out.with_mass = static_cast<int>((modes.values.array() > least).count());
  if (count > out.with_mass) return out;
  out.mu = modes.values.tail(count).reverse();
  out.shapes = modes.vectors.rightCols(count).rowwise().reverse();
  out.found = true;
  return out;
}

// What Spectra asks of (K + σM)⁻¹; its shift is −σ, which the factor holds already.
class ShiftedSolve {
 public:
  using Scalar = double;
  ShiftedSolve(const SparseMatrix& shifted)
      : size_(shifted.rows()), factor_(SparseFactor::of(shifted)), work_(static_cast<int>(size_) + 1, 1) {}
  Index rows() const { return size_; }
  Index cols() const { return size_; }
  void set_shift(const double&) {}
  void perform_op(const double* in, double* out) const { factor_->solve(in, out, work_.data()); }
  bool ready() const { return factor_ != nullptr; }

 private:
  Index size_;
  std::shared_ptr<const SparseFactor> factor_;
  mutable Block work_;
};

class MassProduct {
 public:
  using Scalar = double;
  MassProduct(const SparseMatrix& mass) : mass_(mass) { mass_.makeCompressed(); }
  Index rows() const { return mass_.rows(); }
  Index cols() const { return mass_.rows(); }
  // Its columns are its rows.
  void perform_op(const double* in, double* out) const {
    lane_kernels(1).row_product(
        {static_cast<int>(rows()), mass_.outerIndexPtr(), mass_.innerIndexPtr(), mass_.valuePtr()}, false, in, out);
  }

 private:
  SparseMatrix mass_;
};

Slowest by_lanczos(const SparseMatrix& K, const SparseMatrix& M, double shift, int count) {
  using Solver = Spectra::SymGEigsShiftSolver<ShiftedSolve, MassProduct, Spectra::GEigsMode::ShiftInvert>;
  Slowest out;
  out.with_mass = static_cast<int>(K.rows());
  const SparseMatrix shifted = shift == 0 ? K : K + shift * M;
  ShiftedSolve solve(shifted);
  MassProduct product(M);
  const int space = std::min(static_cast<int>(K.rows()), 2 * count + 20);
  if (!solve.ready() || count >= space) return out;
  Solver solver(solve, product, count, space, -shift);
  solver.init();
  constexpr int most_restarts = 1000;
  constexpr double tolerance = 1e-12;
  solver.compute(Spectra::SortRule::LargestMagn, most_restarts, tolerance, Spectra::SortRule::SmallestAlge);
  if (solver.info() != Spectra::CompInfo::Successful) return out;
  // In the space that was found, once more, whatever the tolerance: products of these modes are then round-off.
  const MatrixXd found = solver.eigenvectors();
  const SymmetricModes inside = symmetric_modes(found.transpose() * (M * found), found.transpose() * (shifted * found));
  if (!inside.found || !(inside.values[0] > 0)) return out;
  out.mu = inside.values.reverse();
  out.shapes = found * inside.vectors.rowwise().reverse();
  out.found = true;
  return out;
}

double first_shift(const SparseMatrix& K, const SparseMatrix& M) {
  constexpr double small = 1e-6;
  std::vector<double> ratios;
  const VectorXd stiff = K.diagonal(), heavy = M.diagonal();
  for (Index i = 0; i < heavy.size(); ++i)
    if (heavy[i] > 0 && stiff[i] > 0) ratios.push_back(stiff[i] / heavy[i]);
  if (ratios.empty()) return 1;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return small * *middle;
}

LowestModes shifted_modes(const SparseMatrix& K, const SparseMatrix& M, int count, double shift, double rigid) {
  LowestModes out;
  out.shift = shift;
  Slowest found = dense_pays(K, count) ? dense(K, M, shift, count) : by_lanczos(K, M, shift, count);
  out.with_mass = found.with_mass;
  if (!found.found) return out;
  out.found = true;
  out.squares = found.mu.cwiseInverse();
  for (Index k = 0; k < out.squares.size(); ++k)
    out.squares[k] = shift > 0 && std::abs(1 - shift * found.mu[k]) < rigid ? 0 : out.squares[k] - shift;
  out.shapes = found.shapes * found.mu.cwiseSqrt().cwiseInverse().asDiagonal();
  return out;
}

}  // namespace

LowestModes lowest_modes(const SparseMatrix& stiffness, const SparseMatrix& mass, int count, bool definite) {
  if (definite) return shifted_modes(stiffness, mass, count, 0, rigid_mode);
  return shifted_modes(stiffness, mass, count, elastic_shift(stiffness, mass, 0), rigid_mode);
}

double elastic_shift(const SparseMatrix& stiffness, const SparseMatrix& mass, int massless) {
  // More modes than can be rigid (six of a body), until one is elastic.
  const double small = first_shift(stiffness, mass);
  constexpr double round_off = 1e-9;  // of 1 − σμ of a rigid motion, σ far above the slow modes
  const int most = static_cast<int>(stiffness.rows()) - massless;
  for (int looked = std::min(most, 7);; looked = std::min(most, 2 * looked)) {
    const LowestModes modes = shifted_modes(stiffness, mass, looked, small, round_off);
    if (!modes.found) return small;
    for (const double square : modes.squares)
      if (square > 0) return square;
    if (looked == most) return small;
  }
}

}  // namespace ricochet
