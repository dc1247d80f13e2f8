#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <cstring>
#include <list>
#include <mutex>
#include <ricochet/contract/errors.hpp>
#include <ricochet/kernels/dense_solvers.hpp>
#include <ricochet/kernels/eigenvalues.hpp>
#include <ricochet/kernels/sparse_ldlt.hpp>
#include <ricochet/scene/basis/modal_basis.hpp>

namespace ricochet {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double negligible = 1e-12;

/// K⁻¹ of loads that no mode carries, by a factor of the diagonally scaled K + σM.
class ElasticSolve {
 public:
  ElasticSolve(const SparseMatrix& stiffness, const SparseMatrix& mass, double shift)
      : stiffness_(stiffness), shift_(shift) {
    const SparseMatrix shifted = stiffness + shift * mass;
    scale_ = shifted.diagonal();
    for (double& one : scale_) one = one > 0 ? 1 / std::sqrt(one) : 1.0;
    if (!ldlt_.factorise(SparseMatrix(scale_.asDiagonal() * shifted * scale_.asDiagonal())))
      throw InputError("/mesh/modes", "the stiffness of the structure has no factor: " + ldlt_.reason());
  }

  VectorXd operator()(const VectorXd& load) {
    VectorXd x = once(load);
    // K x = load where the factor is that of K + σM: x ← x + (K + σM)⁻¹(load − K x), by σ/(σ + ω²) each time. Without a
    // shift it is the one refinement that takes round-off of the factor away.
    constexpr int most = 200;
    for (int k = 0; k < (shift_ == 0 ? 1 : most); ++k) {
      const VectorXd step = once(load - stiffness_ * x);
      x += step;
      if (step.norm() <= 1e-15 * x.norm()) break;
    }
    return x;
  }

 private:
  VectorXd once(const VectorXd& load) {
    VectorXd x = scale_.asDiagonal() * load;
    ldlt_.solve(x.data(), x.data());
    return scale_.asDiagonal() * x;
  }

  const SparseMatrix& stiffness_;
  double shift_;
  VectorXd scale_;
  SparseLdlt ldlt_;
};

// V Λ Vᵀ of the rows of R that count; V has a zero row for the others.
struct Directions {
  MatrixXd vectors;
  VectorXd values;
};

Directions directions(const MatrixXd& R, const VectorXd& flexibility) {
  std::vector<Index> kept;
  for (Index i = 0; i < R.rows(); ++i)
    if (R(i, i) > negligible * flexibility[i]) kept.push_back(i);
  Directions out{MatrixXd::Zero(R.rows(), 0), {}};
  if (kept.empty()) return out;
  const SymmetricModes found = symmetric_modes(MatrixXd(R(kept, kept)));
  const Index all = found.values.size();
  const Index many = (found.values.array() > negligible * found.values[all - 1]).count();
  out.values = found.values.tail(many).reverse();
  out.vectors = MatrixXd::Zero(R.rows(), many);
  out.vectors(kept, Eigen::all) = found.vectors.rightCols(many).rowwise().reverse();
  return out;
}

}  // namespace

ModalBasis modal_basis(const SparseMatrix& stiffness, const SparseMatrix& mass, const SparseRows& contact,
                       bool definite, const BasisSpec& asked) {
  BasisSpec spec = asked;
  const auto n = static_cast<int>(stiffness.rows());
  if (spec.modes > n)
    throw InputError("/mesh/modes", fmt::format("{} modes; the structure has {} degrees of freedom", spec.modes, n));
  if (spec.modes == 0) spec.modes = semidefinite_rank(mass);
  LowestModes modes = lowest_modes(stiffness, mass, spec.modes, definite);
  if (!modes.found && modes.with_mass < spec.modes)
    throw InputError("/mesh/modes",
                     fmt::format("{} modes; {} of the structure have mass", spec.modes, modes.with_mass));
  if (!modes.found)
    throw InputError("/mesh/modes", fmt::format("the {} slowest modes were not found: the iteration did not converge; "
                                                "expected fewer modes",
                                                spec.modes));
  ModalBasis out;
  out.modes = spec.modes;
  out.squares = modes.squares;
  const MatrixXd at_modes = contact * modes.shapes;
  const Index points = contact.rows();
  MatrixXd statics = MatrixXd::Zero(n, points);
  out.left_out = out.flexibility = VectorXd::Zero(points);
  if (points > 0 && spec.modes < n) {
    const MatrixXd weighed = mass * modes.shapes;
    ElasticSolve solve(stiffness, mass, modes.shift);
    for (Index i = 0; i < points; ++i) {
      statics.col(i) = solve(VectorXd(contact.row(i).transpose()) - weighed * at_modes.row(i).transpose());
      statics.col(i) -= modes.shapes * (weighed.transpose() * statics.col(i));
    }
  }
  const MatrixXd moved = contact * statics, R = (moved + moved.transpose()) / 2;
  out.left_out = R.diagonal();
  out.flexibility = R.diagonal();
  for (Index k = 0; k < out.squares.size(); ++k)
    if (out.squares[k] > 0) out.flexibility += at_modes.col(k).cwiseAbs2() / out.squares[k];
  const Directions kept = spec.residual ? directions(R, out.flexibility) : Directions{MatrixXd::Zero(points, 0), {}};
  const Index beside = kept.values.size(), all = spec.modes + beside;
  const MatrixXd residual = statics * kept.vectors * kept.values.cwiseInverse().asDiagonal();
  out.shapes.resize(n, all);
  out.shapes << modes.shapes, residual;
  out.stiffness.resize(all);
  out.stiffness << modes.squares, kept.values.cwiseInverse();
  out.at_points.resize(points, all);
  out.at_points << at_modes, kept.vectors;
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < spec.modes; ++k) entries.emplace_back(k, k, 1.0);
  MatrixXd heavy = residual.transpose() * (mass * residual);
  for (Index i = 0; i < beside; ++i)
    for (Index j = 0; j < beside; ++j)
      entries.emplace_back(spec.modes + static_cast<int>(i), spec.modes + static_cast<int>(j),
                           (heavy(i, j) + heavy(j, i)) / 2);
  out.mass.resize(all, all);
  out.mass.setFromTriplets(entries.begin(), entries.end());
  return out;
}

VectorXd in_basis(const ModalBasis& basis, const SparseMatrix& mass, const SparseRows& contact,
                  const VectorXd& displacement) {
  if (!basis.parts.empty()) {
    VectorXd all = VectorXd::Zero(basis.dofs());
    for (const ModalBasis::Part& part : basis.parts) {
      const VectorXd own =
          in_basis(*part.basis, part.mass, part.contact, displacement.segment(part.first, part.basis->shapes.rows()));
      for (Index k = 0; k < own.size(); ++k) all[part.where[static_cast<std::size_t>(k)]] = own[k];
    }
    return all;
  }
  const auto phi = basis.shapes.leftCols(basis.modes);
  VectorXd out(basis.dofs());
  out.head(basis.modes) = phi.transpose() * (mass * displacement);
  out.tail(basis.dofs() - basis.modes) =
      basis.at_points.rightCols(basis.dofs() - basis.modes).transpose() *
      (contact * displacement - basis.at_points.leftCols(basis.modes) * out.head(basis.modes));
  return out;
}

VectorXd in_basis_by_least_squares(const ModalBasis& basis, const VectorXd& displacement) {
  return least_squares(basis.shapes, displacement);
}

namespace {

constexpr std::size_t most_bytes = 128U << 20U;

template <class Matrix>
std::size_t bytes_of(const Matrix& matrix) {
  const auto entries = static_cast<std::size_t>(matrix.nonZeros()),
             outer = static_cast<std::size_t>(matrix.outerSize());
  return entries * (sizeof(double) + sizeof(int)) + outer * sizeof(int);
}

template <class Value>
bool same_bits(const Value* a, const Value* b, Eigen::Index count) {
  return count == 0 || std::memcmp(a, b, static_cast<std::size_t>(count) * sizeof(Value)) == 0;
}

/// The same entries in the same places, to the last bit. Both are compressed.
template <class Matrix>
bool identical(const Matrix& a, const Matrix& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && a.nonZeros() == b.nonZeros() &&
         same_bits(a.outerIndexPtr(), b.outerIndexPtr(), a.outerSize()) &&
         same_bits(a.innerIndexPtr(), b.innerIndexPtr(), a.nonZeros()) &&
         same_bits(a.valuePtr(), b.valuePtr(), a.nonZeros());
}

template <class Matrix>
Matrix compressed(const Matrix& matrix) {
  Matrix out = matrix;
  out.makeCompressed();
  return out;
}

struct SharedBasis {
  SparseMatrix stiffness, mass;
  SparseRows contact;
  bool definite = true;
  BasisSpec spec;
  std::shared_ptr<const ModalBasis> basis;

  std::size_t bytes() const {
    return bytes_of(stiffness) + bytes_of(mass) + bytes_of(contact) + bytes_of(basis->mass) +
           static_cast<std::size_t>(basis->shapes.size() + basis->at_points.size()) * sizeof(double);
  }
};

struct BasisCache {
  std::mutex mutex;
  std::list<SharedBasis> kept;  // used last first
  long long made = 0;
};

BasisCache& cache() {
  static BasisCache one;
  return one;
}

}  // namespace

std::shared_ptr<const ModalBasis> shared_basis(const SparseMatrix& stiffness, const SparseMatrix& mass,
                                               const SparseRows& contact, bool definite, const BasisSpec& spec) {
  BasisCache& all = cache();
  const std::lock_guard lock(all.mutex);
  SharedBasis asked{compressed(stiffness), compressed(mass), compressed(contact), definite, spec, nullptr};
  for (auto one = all.kept.begin(); one != all.kept.end(); ++one)
    if (one->definite == definite && one->spec == spec && identical(one->stiffness, asked.stiffness) &&
        identical(one->mass, asked.mass) && identical(one->contact, asked.contact)) {
      all.kept.splice(all.kept.begin(), all.kept, one);
      return one->basis;
    }
  asked.basis = std::make_shared<const ModalBasis>(modal_basis(stiffness, mass, contact, definite, spec));
  ++all.made;
  all.kept.push_front(std::move(asked));
  std::size_t bytes = 0;
  for (auto one = all.kept.begin(); one != all.kept.end();) {
    bytes += one->bytes();
    one = bytes > most_bytes && one != all.kept.begin() ? all.kept.erase(one) : std::next(one);
  }
  return all.kept.front().basis;
}

BasisCount basis_count() {
  BasisCache& all = cache();
  const std::lock_guard lock(all.mutex);
  return {all.made, all.kept.size()};
}

}  // namespace ricochet
