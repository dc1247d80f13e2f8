#include <cholmod.h>

#include <cmath>
#include <limits>
#include <memory>
#include <ricochet/contract/fingerprint.hpp>
#include <ricochet/kernels/floating_point.hpp>
#include <ricochet/kernels/sparse_ldlt.hpp>

namespace ricochet {

namespace {

struct Common : cholmod_common {
  Common() {
    cholmod_start(this);
    print = 0;
    supernodal = CHOLMOD_SIMPLICIAL;
    final_ll = 0;
    nmethods = 2;
    method[0].ordering = CHOLMOD_NATURAL;
    method[1].ordering = CHOLMOD_AMD;
  }
  ~Common() { cholmod_finish(this); }
  Common(const Common&) = delete;
  Common& operator=(const Common&) = delete;
};

// A view of a compressed Eigen matrix, of which CHOLMOD reads the upper triangle and writes nothing.
cholmod_sparse view_of(const Eigen::SparseMatrix<double>& A) {
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(A.rows());
  view.nzmax = static_cast<std::size_t>(A.nonZeros());
  view.p = const_cast<int*>(A.outerIndexPtr());
  view.i = const_cast<int*>(A.innerIndexPtr());
  view.x = const_cast<double*>(A.valuePtr());
  view.stype = 1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = view.packed = 1;
  return view;
}

}  // namespace

bool SparseLdlt::refuse(std::string sentence) {
  size_ = 0;
  reason_ = std::move(sentence);
  return false;
}

bool SparseLdlt::factorise(const Eigen::SparseMatrix<double>& A) {
  if (!A.isCompressed()) {
    Eigen::SparseMatrix<double> compressed = A;
    compressed.makeCompressed();
    return factorise(compressed);
  }
  reason_.clear();
  if (A.rows() != A.cols())
    return refuse("the matrix has " + std::to_string(A.rows()) + " rows and " + std::to_string(A.cols()) +
                  " columns: a square one was expected");
  size_ = static_cast<int>(A.rows());
  if (size_ == 0) return true;

  Common common;
  const auto release = [&](cholmod_factor* f) { cholmod_free_factor(&f, &common); };
  cholmod_sparse view = view_of(A);
  const std::unique_ptr<cholmod_factor, decltype(release)> factor(cholmod_analyze(&view, &common), release);
  const bool done = factor && cholmod_factorize(&view, factor.get(), &common) != 0;
  if (common.status == CHOLMOD_OUT_OF_MEMORY || common.status == CHOLMOD_TOO_LARGE)
    return refuse("the factors need more memory than there is");
  if (!done) return refuse("CHOLMOD ended with its error " + std::to_string(common.status));
  const auto* order = static_cast<const int*>(factor->Perm);
  order_.assign(order, order + size_);
  if (common.status == CHOLMOD_NOT_POSDEF) return refuse_pivot(static_cast<int>(factor->minor));

  const auto* start = static_cast<const int*>(factor->p);
  const auto* count = static_cast<const int*>(factor->nz);
  const auto* row = static_cast<const int*>(factor->i);
  const auto* value = static_cast<const double*>(factor->x);
  start_.assign(1, 0);
  row_.clear();
  value_.clear();
  pivot_.clear();
  work_.assign(static_cast<std::size_t>(size_), 0.0);
  for (int j = 0; j < size_; ++j) {
    // The diagonal of a column comes first, and holds D.
    const double pivot = value[start[j]], terms = work_[j] + std::abs(A.coeff(order[j], order[j]));
    if (!std::isfinite(pivot) || std::abs(pivot) <= 16 * std::numeric_limits<double>::epsilon() * terms)
      return refuse_pivot(j);
    pivot_.push_back(pivot);
    for (int k = start[j] + 1; k < start[j] + count[j]; ++k) {
      row_.push_back(row[k]);
      value_.push_back(value[k]);
      work_[row[k]] += value[k] * value[k] * std::abs(pivot);
    }
    start_.push_back(static_cast<int>(row_.size()));
  }
  return true;
}

bool SparseLdlt::refuse_pivot(int step) {
  return refuse("the pivot of unknown " + std::to_string(order_[step]) +
                " (counted from 0) is zero, lost in round-off or not finite: the matrix is singular, or neither "
                "positive nor quasi-definite");
}

void SparseLdlt::solve(const double* b, double* x) {
  for (int j = 0; j < size_; ++j) work_[j] = b[order_[j]];
  for (int j = 0; j < size_; ++j) {
    const double w = work_[j];
    for (int k = start_[j]; k < start_[j + 1]; ++k) work_[row_[k]] -= value_[k] * w;
  }
  for (int j = size_ - 1; j >= 0; --j) {
    double w = work_[j] / pivot_[j];
    for (int k = start_[j]; k < start_[j + 1]; ++k) w -= value_[k] * work_[row_[k]];
    work_[j] = w;
  }
  for (int j = 0; j < size_; ++j) x[order_[j]] = work_[j];
}

SparseFill sparse_fill(const Eigen::SparseMatrix<double>& A) {
  Eigen::SparseMatrix<double> compressed;
  if (!A.isCompressed()) {
    compressed = A;
    compressed.makeCompressed();
  }
  Common common;
  cholmod_sparse view = view_of(A.isCompressed() ? A : compressed);
  cholmod_factor* factor = cholmod_analyze(&view, &common);
  if (!factor) return {infinity, infinity};
  cholmod_free_factor(&factor, &common);
  return {common.lnz - static_cast<double>(A.rows()), common.fl};
}

QuasiDefinite weighted_system(double k, const SparseMatrix& stiffness, double m, const Inertia& inertia) {
  QuasiDefinite matrix;
  if (inertia.assembled() && same_places(stiffness, inertia.mass)) {
    matrix.A = stiffness;
    matrix.A.coeffs() = k * stiffness.coeffs() + m * inertia.mass.coeffs();
    return matrix;
  }
  matrix.A = k * stiffness;
  if (inertia.assembled()) {
    matrix.A += m * inertia.mass;
  } else if (m != 0) {
    const MassFactors factors = mass_factors(inertia);
    matrix.G = std::sqrt(m) * factors.coupling;
    matrix.Cv = factors.velocity_mass;
    matrix.border_first = inertia.inverted();
  }
  return matrix;
}

}  // namespace ricochet
