// What a person writes who has read a page about Newmark and one about CHOLMOD: S factorised once, the columns of S⁻¹
// at the stops kept, contact by projected Gauss–Seidel. No audit, no record.
#include "tests/benchmarks/fair_plate.hpp"

#include <Spectra/SymGEigsShiftSolver.h>

#include <Eigen/CholmodSupport>
#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>

#include "tests/benchmarks/held_bytes.hpp"
#include "tests/benchmarks/hold_between.hpp"
#include "tests/benchmarks/thread_clock.hpp"

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using ricochet::benchmarks::FairFactor;
using ricochet::benchmarks::FairResult;
using ricochet::benchmarks::FairScene;
using ricochet::benchmarks::held_bytes;
using ricochet::benchmarks::hold_between;
using ricochet::benchmarks::thread_nanoseconds;
using Sparse = Eigen::SparseMatrix<double>;

Sparse matrix(int n, const int* start, const int* row, const double* value) {
  return Eigen::Map<const Sparse>(n, n, start[n], start, row, value);
}

// λ with |u + Wλ| ≤ gap, λ opposite to the side that it touches.
class Contact {
 public:
  Contact(MatrixXd flexibility, double gap)
      : W_(std::move(flexibility)), gap_(gap), effort(VectorXd::Zero(W_.rows())) {}
  bool solve(const VectorXd& free) {
    if ((free.array().abs() <= gap_).all()) {
      effort.setZero();
      return false;
    }
    hold_between(W_, gap_, free, effort);
    return true;
  }

 private:
  MatrixXd W_;
  double gap_;

 public:
  VectorXd effort;
};

template <class Factor>
FairResult march(const FairScene& scene, long long steps) {
  const double held = held_bytes();
  const Sparse K = matrix(scene.n, scene.stiffness_start, scene.stiffness_row, scene.stiffness),
               M = matrix(scene.n, scene.mass_start, scene.mass_row, scene.mass);
  const double h = scene.h;
  FairResult out;
  const double begun = thread_nanoseconds();
  const Sparse S = M / (h * h) + scene.damping / (2 * h) * K + 0.5 * K, now = 2 / (h * h) * M,
               past = scene.damping / (2 * h) * K - 0.5 * K - M / (h * h);
  Factor factor;
  factor.compute(S);
  MatrixXd pushes = MatrixXd::Zero(scene.n, scene.points);
  for (int i = 0; i < scene.points; ++i) pushes(scene.point[i], i) = 1;
  const MatrixXd moved = factor.solve(pushes);
  Contact contact(moved(Eigen::Map<const Eigen::VectorXi>(scene.point, scene.points), Eigen::all), scene.gap);
  out.setup_seconds = 1e-9 * (thread_nanoseconds() - begun);
  VectorXd before = VectorXd::Zero(scene.n), u = before, next(scene.n), b(scene.n), at(scene.points);
  out.bytes = held_bytes() - held;
  const double marched = thread_nanoseconds();
  for (long long k = 1; k < steps; ++k) {
    b.noalias() = now * u;
    b.noalias() += past * before;
    const auto t = static_cast<double>(k);
    b[scene.loaded] +=
        0.5 * scene.force * (std::sin(scene.pulsation * (t + 1) * h) + std::sin(scene.pulsation * (t - 1) * h));
    next = factor.solve(b);
    for (int i = 0; i < scene.points; ++i) at[i] = next[scene.point[i]];
    if (contact.solve(at)) {
      next.noalias() += moved * contact.effort;
      out.impulse += h * contact.effort.lpNorm<1>();
      ++out.pushed;
    }
    before.swap(u);
    u.swap(next);
  }
  out.step_seconds = 1e-9 * (thread_nanoseconds() - marched) / static_cast<double>(steps - 1);
  out.end = u[scene.loaded];
  return out;
}

class Solve {
 public:
  using Scalar = double;
  explicit Solve(const Sparse& K) : size_(K.rows()) { factor_.compute(K); }
  Eigen::Index rows() const { return size_; }
  Eigen::Index cols() const { return size_; }
  void set_shift(const double&) {}
  void perform_op(const double* in, double* out) const {
    Eigen::Map<VectorXd>(out, size_) = factor_.solve(Eigen::Map<const VectorXd>(in, size_));
  }

 private:
  Eigen::Index size_;
  Eigen::CholmodSupernodalLLT<Sparse> factor_;
};

class Product {
 public:
  using Scalar = double;
  explicit Product(const Sparse& M) : M_(M) {}
  Eigen::Index rows() const { return M_.rows(); }
  Eigen::Index cols() const { return M_.rows(); }
  void perform_op(const double* in, double* out) const {
    Eigen::Map<VectorXd>(out, rows()).noalias() = M_ * Eigen::Map<const VectorXd>(in, rows());
  }

 private:
  const Sparse& M_;
};

}  // namespace

FairResult ricochet_fair_march(const FairScene& scene, FairFactor factor, long long steps) {
  switch (factor) {
    case FairFactor::eigen:
      return march<Eigen::SimplicialLLT<Sparse>>(scene, steps);
    case FairFactor::cholmod_simplicial:
      return march<Eigen::CholmodSimplicialLLT<Sparse>>(scene, steps);
    default:
      return march<Eigen::CholmodSupernodalLLT<Sparse>>(scene, steps);
  }
}

double ricochet_fair_modes(const FairScene& scene, int count, double* squares) {
  const Sparse K = matrix(scene.n, scene.stiffness_start, scene.stiffness_row, scene.stiffness),
               M = matrix(scene.n, scene.mass_start, scene.mass_row, scene.mass);
  const double begun = thread_nanoseconds();
  Solve solve(K);
  Product product(M);
  Spectra::SymGEigsShiftSolver<Solve, Product, Spectra::GEigsMode::ShiftInvert> solver(
      solve, product, count, std::min(scene.n, 2 * count + 20), 0.0);
  solver.init();
  solver.compute(Spectra::SortRule::LargestMagn, 1000, 1e-10);
  const VectorXd found = solver.eigenvalues();
  const MatrixXd shapes = solver.eigenvectors();
  const double seconds = 1e-9 * (thread_nanoseconds() - begun);
  for (int k = 0; k < count; ++k) squares[k] = found[k];
  std::sort(squares, squares + count);
  return shapes.allFinite() ? seconds : -1;
}
