#include <dlfcn.h>
#include <suitesparse/SuiteSparse_config.h>

#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <ricochet/kernels/sparse_ldlt.hpp>

#include "tests/allocations.hpp"
#include "tests/eigen.hpp"

using namespace ricochet;

namespace sparse_ldlt_tests {
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()() { return uniform_(engine_); }
  VectorXd vector(int n) {
    return VectorXd::NullaryExpr(n, [this] { return (*this)(); });
  }
  // About `each` entries per row, both triangles, diagonally dominant: positive definite, condition below 100.
  MatrixXd spd(int n, int each) {
    MatrixXd A = MatrixXd::Zero(n, n);
    for (int k = 0; k < n * each / 2; ++k) {
      const int i = static_cast<int>(n * (1 + (*this)()) / 2), j = static_cast<int>(n * (1 + (*this)()) / 2);
      A(i, j) = A(j, i) = (*this)();
    }
    A.diagonal() = A.cwiseAbs().rowwise().sum() + VectorXd::Constant(n, 0.1);
    return A;
  }

 private:
  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

Sparse sparse(const MatrixXd& A) {
  return A.sparseView();
}

void check_solves(SparseLdlt& factors, const MatrixXd& A, Random& random) {
  const int n = static_cast<int>(A.rows());
  for (int repeat = 0; repeat < 5; ++repeat) {
    const VectorXd b = random.vector(n), expected = eigen::lu_solve(A, b);
    VectorXd x(n);
    factors.solve(b.data(), x.data());
    // Two solves of a system of condition below 1e4 (Gershgorin, and the ratio of the blocks).
    CHECK((x - expected).norm() <= 1e4 * n * epsilon * expected.norm());
  }
}

// Bending of a clamped beam by differences: band, condition n⁴.
MatrixXd biharmonic(int n) {
  MatrixXd A = MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i)
    for (const auto& [offset, value] : {std::pair{0, 6.0}, {1, -4.0}, {2, 1.0}})
      if (i + offset < n) A(i, i + offset) = A(i + offset, i) = value;
  return A;
}

long taken = 0;
void* counting_malloc(std::size_t size) {
  ++taken;
  return std::malloc(size);
}
void* counting_calloc(std::size_t count, std::size_t size) {
  ++taken;
  return std::calloc(count, size);
}
void* counting_realloc(void* memory, std::size_t size) {
  ++taken;
  return std::realloc(memory, size);
}

// Counts every allocation of SuiteSparse while it lives. Found by name, since tests do not link to SuiteSparse.
class CountingSuiteSparse {
 public:
  CountingSuiteSparse() : config_(static_cast<SuiteSparse_config_struct*>(dlsym(RTLD_DEFAULT, "SuiteSparse_config"))) {
    REQUIRE(config_ != nullptr);
    before_ = *config_;
    config_->malloc_func = counting_malloc;
    config_->calloc_func = counting_calloc;
    config_->realloc_func = counting_realloc;
  }
  ~CountingSuiteSparse() { *config_ = before_; }
  CountingSuiteSparse(const CountingSuiteSparse&) = delete;
  CountingSuiteSparse& operator=(const CountingSuiteSparse&) = delete;

 private:
  SuiteSparse_config_struct* config_;
  SuiteSparse_config_struct before_;
};

}  // namespace

TEST_CASE("positive definite systems solve like dense ones", "[sparse-ldlt]") {
  Random random(1);
  for (const int n : {1, 2, 5, 40, 150}) {
    const MatrixXd A = random.spd(n, 4);
    SparseLdlt factors;
    REQUIRE(factors.factorise(sparse(A)));
    CHECK(factors.reason().empty());
    CHECK(factors.size() == n);
    CHECK(factors.factor_entries() >= (A.triangularView<Eigen::StrictlyLower>().toDenseMatrix().array() != 0).count());
    check_solves(factors, A, random);
  }
}

TEST_CASE("quasi-definite systems need no pivoting, in either order of the blocks", "[sparse-ldlt]") {
  Random random(2);
  for (const int n : {2, 10, 60}) {
    const int k = n / 2;
    const MatrixXd E = random.spd(n, 3), F = random.spd(k, 2);
    MatrixXd B = MatrixXd::Zero(k, n);
    for (int i = 0; i < k; ++i) {
      B(i, 2 * i) = random();
      B(i, 2 * i + 1) = random();
    }
    MatrixXd A(n + k, n + k), reversed(n + k, n + k);
    A << E, B.transpose(), B, -F;
    reversed << -F, B, B.transpose(), E;
    SparseLdlt factors;
    REQUIRE(factors.factorise(sparse(A)));
    check_solves(factors, A, random);
    REQUIRE(factors.factorise(sparse(reversed)));
    check_solves(factors, reversed, random);
  }
}

TEST_CASE("a band keeps its fill", "[sparse-ldlt]") {
  const int n = 200;
  SparseLdlt factors;
  REQUIRE(factors.factorise(sparse(biharmonic(n))));
  CHECK(factors.factor_entries() == 2 * n - 3);
}

TEST_CASE("an ill-conditioned system is still solved backward stably", "[sparse-ldlt]") {
  // Condition about 1e9: the error may be large, the residual may not.
  const int n = 400;
  const MatrixXd A = biharmonic(n);
  SparseLdlt factors;
  REQUIRE(factors.factorise(sparse(A)));
  const VectorXd b = Random(3).vector(n);
  VectorXd x(n);
  factors.solve(b.data(), x.data());
  // Five terms per row of size 16·|x|, margin of ten.
  CHECK((A * x - b).cwiseAbs().maxCoeff() <= 10 * 5 * 16 * epsilon * x.cwiseAbs().maxCoeff());
}

TEST_CASE("only the upper triangle is read, uncompressed input is taken", "[sparse-ldlt]") {
  Random random(4);
  const MatrixXd A = random.spd(30, 4);
  Sparse upper = sparse(A.triangularView<Eigen::Upper>());
  SparseLdlt factors;
  REQUIRE(factors.factorise(upper));
  check_solves(factors, A, random);

  Sparse loose = sparse(A);
  loose.reserve(Eigen::VectorXi::Constant(30, 40));
  REQUIRE_FALSE(loose.isCompressed());
  REQUIRE(factors.factorise(loose));
  check_solves(factors, A, random);
}

TEST_CASE("the solution may overwrite the right-hand side", "[sparse-ldlt]") {
  Random random(5);
  SparseLdlt factors;
  REQUIRE(factors.factorise(sparse(random.spd(20, 3))));
  const VectorXd b = random.vector(20);
  VectorXd x(20), in_place = b;
  factors.solve(b.data(), x.data());
  factors.solve(in_place.data(), in_place.data());
  CHECK(in_place == x);
}

TEST_CASE("equal matrices give bitwise equal results, a moved object goes on", "[sparse-ldlt]") {
  Random random(6);
  const Sparse A = sparse(random.spd(80, 5));
  const VectorXd b = random.vector(80);
  VectorXd x(80), y(80);
  SparseLdlt first, second;
  REQUIRE(first.factorise(A));
  first.solve(b.data(), x.data());
  SparseLdlt moved = std::move(first);
  moved.solve(b.data(), y.data());
  CHECK(x == y);
  REQUIRE(second.factorise(A));
  second.solve(b.data(), y.data());
  CHECK(x == y);
}

TEST_CASE("singular and improper matrices are refused with a reason", "[sparse-ldlt]") {
  SparseLdlt factors;
  const auto refused = [&](const MatrixXd& A, const std::string& words) {
    INFO(A);
    CHECK_FALSE(factors.factorise(sparse(A)));
    CHECK_THAT(factors.reason(), Catch::Contains(words));
    CHECK(factors.size() == 0);
    CHECK(factors.factor_entries() == 0);
  };
  REQUIRE(factors.factorise(sparse(MatrixXd::Identity(3, 3))));
  refused(MatrixXd::Ones(2, 3), "2 rows and 3 columns");
  refused(MatrixXd::Zero(3, 3), "pivot of unknown");
  refused((MatrixXd(2, 2) << 1, 1, 1, 1).finished(), "singular");
  refused((MatrixXd(2, 2) << 0, 1, 1, 0).finished(), "pivot of unknown");
  // A free beam: rigid motions in the kernel, which round-off turns into pivots that are small, not zero.
  MatrixXd beam = MatrixXd::Zero(40, 40);
  for (int i = 1; i < 39; ++i) {
    const Eigen::Vector3d curvature(1, -2, 1);
    beam.block<3, 3>(i - 1, i - 1) += 1.1 * i * curvature * curvature.transpose();
  }
  refused(beam, "singular");
  MatrixXd bad = MatrixXd::Identity(3, 3);
  bad(1, 1) = std::nan("");
  refused(bad, "unknown 1");
  bad(1, 1) = std::numeric_limits<double>::infinity();
  refused(bad, "unknown 1");
  // And the object still serves.
  CHECK(factors.factorise(sparse(MatrixXd::Identity(3, 3))));
  CHECK(factors.reason().empty());
}

TEST_CASE("no unknown at all", "[sparse-ldlt]") {
  SparseLdlt factors;
  CHECK(factors.factorise(Sparse(0, 0)));
  CHECK(factors.size() == 0);
  factors.solve(nullptr, nullptr);
}

TEST_CASE("solves allocate nothing", "[sparse-ldlt]") {
  Random random(7);
  const CountingSuiteSparse counting;
  const MatrixXd A = random.spd(120, 5);
  const VectorXd b = random.vector(120);
  VectorXd x(120);
  SparseLdlt factors;
  const long before_factorise = taken;
  REQUIRE(factors.factorise(sparse(A)));
  REQUIRE(taken > before_factorise);
  const long c_before = taken, cpp_before = allocations();
  for (int repeat = 0; repeat < 100; ++repeat) factors.solve(b.data(), x.data());
  const long c_after = taken, cpp_after = allocations();
  CHECK(c_after == c_before);
  CHECK(cpp_after == cpp_before);
}

}  // namespace sparse_ldlt_tests
