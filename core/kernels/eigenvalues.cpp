#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <ricochet/kernels/eigenvalues.hpp>
#include <vector>

namespace ricochet {

namespace {

constexpr int options(EigenVectors vectors) {
  return vectors == EigenVectors::wanted ? Eigen::ComputeEigenvectors : Eigen::EigenvaluesOnly;
}

template <class Solver>
SymmetricModes modes_of(const Solver& solver, EigenVectors vectors) {
  SymmetricModes modes;
  modes.values = solver.eigenvalues();
  modes.found = solver.info() == Eigen::Success;
  if (vectors == EigenVectors::wanted) modes.vectors = solver.eigenvectors();
  return modes;
}

}  // namespace

SymmetricModes symmetric_modes(const Eigen::MatrixXd& A, EigenVectors vectors) {
  return modes_of(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A, options(vectors)), vectors);
}

SymmetricModes symmetric_modes(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, EigenVectors vectors) {
  return modes_of(Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(A, B, options(vectors) | Eigen::Ax_lBx),
                  vectors);
}

GeneralModes general_modes(const Eigen::MatrixXd& A, EigenVectors vectors) {
  const bool wanted = vectors == EigenVectors::wanted;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A, wanted);
  GeneralModes modes;
  modes.found = solver.info() == Eigen::Success;
  if (!modes.found) return modes;
  modes.values = solver.eigenvalues();
  if (wanted) modes.vectors = solver.eigenvectors();
  return modes;
}

Eigen::VectorXd singular_values(const Eigen::MatrixXd& A) {
  return A.jacobiSvd().singularValues();
}

Eigen::VectorXd singular_values(const Eigen::MatrixXcd& A) {
  // The real matrix of the same map has each of them twice.
  Eigen::MatrixXd map(2 * A.rows(), 2 * A.cols());
  map << A.real(), -A.imag(), A.imag(), A.real();
  const Eigen::VectorXd twice = singular_values(map);
  return twice(Eigen::seqN(0, twice.size() / 2, 2));
}

Eigen::VectorXd balance(Eigen::MatrixXd& A, double negligible) {
  const Eigen::Index n = A.rows();
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(n);
  for (bool moved = true; moved;) {
    moved = false;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double column = A.col(i).lpNorm<1>() - std::abs(A(i, i)), row = A.row(i).lpNorm<1>() - std::abs(A(i, i));
      if (std::min(column, row) <= negligible * std::max(column, row)) continue;
      const double factor = std::exp2(std::round(0.5 * std::log2(row / column)));
      if (!std::isfinite(factor) || (column * factor + row / factor) >= 0.95 * (column + row)) continue;
      scale[i] *= factor;
      A.col(i) *= factor;
      A.row(i) /= factor;
      moved = true;
    }
  }
  return scale;
}

namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double round_off_of_one = std::numeric_limits<double>::epsilon();
// Poles nearer to one another than this, of their size, coincide.
constexpr double coincide = 64 * round_off_of_one;
// Of what the terms of f are in size: what round-off leaves of their sum.
constexpr double enough = 8;
// A c of this size, of the whole, leaves its mode as it is: its square is nothing.
constexpr double nothing = 1e-100;

// The zeros of f over ascending poles, by the pole that each is nearer to and how far it is from there.
class SecularZeros {
 public:
  SecularZeros(const ArrayXd& poles, const ArrayXd& weights) : poles_(poles), weights_(weights) {
    for (Index k = 0; k + 1 < poles.size(); ++k) find(k);
  }
  Index count() const { return static_cast<Index>(nearest_.size()); }
  double value(Index k) const { return poles_[near(k)] + offset_[static_cast<std::size_t>(k)]; }
  // d_j − ν_k.
  double from(Index k, Index j) const { return poles_[j] - poles_[near(k)] - offset_[static_cast<std::size_t>(k)]; }
  ArrayXd from_all(Index k) const { return poles_ - poles_[near(k)] - offset_[static_cast<std::size_t>(k)]; }

 private:
  Index near(Index k) const { return nearest_[static_cast<std::size_t>(k)]; }

  // Between the poles k and k + 1, where f rises from −∞ to ∞. The model f ≈ a + s/(d_k − ν) + t/(d_{k+1} − ν) has the
  // slopes of the poles on both sides (Bunch, Nielsen and Sorensen, Numer. Math. 31, 1978). The zero stays within the
  // bracket.
  void find(Index k) {
    const double width = poles_[k + 1] - poles_[k];
    const bool left = sum(poles_[k], 0.5 * width) > 0;
    const double origin = left ? poles_[k] : poles_[k + 1];
    const double a = poles_[k] - origin, b = poles_[k + 1] - origin;
    double low = left ? 0 : -0.5 * width, high = left ? 0.5 * width : 0, at = 0.5 * (low + high);
    for (int iteration = 0; iteration < 100; ++iteration) {
      const ArrayXd apart = poles_ - origin - at, terms = weights_ / apart, slopes = terms / apart;
      const double below = terms.head(k + 1).sum(), above = terms.tail(terms.size() - k - 1).sum(), f = below + above;
      if (std::abs(f) <= enough * round_off_of_one * (above - below)) break;
      (f > 0 ? high : low) = at;
      const double s = slopes.head(k + 1).sum() * (a - at) * (a - at),
                   t = slopes.tail(terms.size() - k - 1).sum() * (b - at) * (b - at);
      // (rest)(a − η)(b − η) + s (b − η) + t (a − η) = 0.
      const double rest = f - s / (a - at) - t / (b - at);
      double next = root_between(rest, -(rest * (a + b) + s + t), rest * a * b + s * b + t * a, a, b);
      if (!(next > low && next < high)) next = middle(low, high);
      if (next == at || next == low || next == high) break;
      at = next;
    }
    nearest_.push_back(left ? k : k + 1);
    offset_.push_back(at);
  }

  double sum(double origin, double at) const { return (weights_ / (poles_ - origin - at)).sum(); }

  // Of q x² + p x + r, the one between a and b.
  static double root_between(double q, double p, double r, double a, double b) {
    const double root = std::sqrt(std::max(p * p - 4 * q * r, 0.0)), half = -0.5 * (p + std::copysign(root, p));
    const double one = q != 0 ? half / q : a, other = half != 0 ? r / half : 0.0;
    return one > a && one < b && !(other > a && other < b) ? one : other;
  }

  // Of a bracket that begins at its pole: by its size.
  static double middle(double low, double high) {
    if (low == 0) return high * 0x1p-4;
    if (high == 0) return low * 0x1p-4;
    return std::sqrt(low * high) * (low < 0 ? -1 : 1);
  }

  const ArrayXd& poles_;
  const ArrayXd& weights_;
  std::vector<Index> nearest_;
  std::vector<double> offset_;
};

// The turn that leaves everything of (c_i, c_j) in c_j: columns i and j of `basis` with it.
void turn(VectorXd& c, MatrixXd& basis, Index i, Index j) {
  const double size = std::hypot(c[i], c[j]), cosine = c[j] / size, sine = c[i] / size;
  const VectorXd first = basis.col(i);
  basis.col(i) = cosine * first - sine * basis.col(j);
  basis.col(j) = sine * first + cosine * basis.col(j);
  c[i] = 0;
  c[j] = size;
}

// One row more, over columns `basis` of ascending masses; `plain`: they are those of the unit matrix.
void constrain(ConstrainedModes& modes, const Eigen::RowVectorXd& row, bool plain) {
  VectorXd& mass = modes.mass;
  MatrixXd& basis = modes.basis;
  const Index n = mass.size();
  VectorXd c = plain ? VectorXd(row.transpose()) : VectorXd((row * basis).transpose());
  const double least = nothing * c.norm();
  std::vector<Index> seen, kept;  // columns that the row sees, and those that stay
  for (Index j = 0; j < n; ++j) {
    if (!(std::abs(c[j]) > least)) {
      kept.push_back(j);
      continue;
    }
    if (!seen.empty() && mass[j] - mass[seen.back()] <= coincide * mass[j]) {
      turn(c, basis, seen.back(), j);
      plain = false;
      kept.push_back(seen.back());
      seen.pop_back();
    }
    seen.push_back(j);
  }
  const ArrayXd poles = mass(seen).array(), weights = c(seen).array().square();
  const SecularZeros zeros(poles, weights);
  const Index count = zeros.count();
  // c of which the zeros are exact: each zero beside the pole on its far side.
  ArrayXd exact(count + 1);
  for (Index i = 0; i <= count; ++i) {
    double square = 1;
    for (Index k = 0; k < count; ++k) square *= -zeros.from(k, i) / (poles[k < i ? k : k + 1] - poles[i]);
    exact[i] = std::copysign(std::sqrt(square), c[seen[static_cast<std::size_t>(i)]]);
  }
  MatrixXd vectors(count + 1, count);
  VectorXd found(count);
  for (Index k = 0; k < count; ++k) {
    found[k] = zeros.value(k);
    vectors.col(k) = (exact / zeros.from_all(k)).matrix().normalized();
  }
  MatrixXd moved = MatrixXd::Zero(basis.rows(), count);
  if (plain && count > 0)
    for (Index k = 0; k <= count; ++k) moved.row(seen[static_cast<std::size_t>(k)]) = vectors.row(k);
  else if (count > 0)
    moved = basis(Eigen::all, seen) * vectors;
  const MatrixXd left = basis(Eigen::all, kept);
  const VectorXd left_mass = mass(kept);
  mass.resize(n - 1);
  basis.resize(basis.rows(), n - 1);
  for (Index at = 0, k = 0, l = 0; at < n - 1; ++at) {
    const bool next_moved = l == left_mass.size() || (k < count && found[k] < left_mass[l]);
    mass[at] = next_moved ? found[k] : left_mass[l];
    if (next_moved)
      basis.col(at) = moved.col(k++);
    else
      basis.col(at) = left.col(l++);
  }
}

}  // namespace

ConstrainedModes constrained_modes(const VectorXd& mass, const MatrixXd& rows) {
  const Index n = mass.size();
  std::vector<Index> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return mass[a] < mass[b]; });
  const MatrixXd sorted = rows(Eigen::all, order);
  ConstrainedModes modes{mass(order), MatrixXd::Identity(n, n)};
  for (Index i = 0; i < rows.rows(); ++i) constrain(modes, sorted.row(i), i == 0);
  const MatrixXd basis = std::move(modes.basis);
  modes.basis.resize(basis.rows(), basis.cols());
  for (Index i = 0; i < n; ++i) modes.basis.row(order[static_cast<std::size_t>(i)]) = basis.row(i);
  return modes;
}

}  // namespace ricochet
