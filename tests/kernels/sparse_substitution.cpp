// Substitution of all lanes through a sparse factor: what a dense solver finds, and each lane by itself.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <ricochet/kernels/block.hpp>
#include <ricochet/kernels/sparse_ldlt.hpp>
#include <ricochet/kernels/sparse_substitution.hpp>

#include "tests/instruction_sets.hpp"

using namespace ricochet;
using ricochet::testing::instruction_sets;

namespace {

constexpr int rows = 23, kept = 19;  // the last unknowns are a border's

Eigen::MatrixXd quasi_definite() {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(rows, rows);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < i; ++j)
      if ((i * 7 + j * 3) % 5 == 0) A(i, j) = A(j, i) = std::sin(1.0 + i + 2.0 * j);
  for (int i = 0; i < rows; ++i) A(i, i) = (i < kept ? 1 : -1) * (1 + A.row(i).cwiseAbs().sum());
  return A;
}

double right_hand_side(int i, int lane) {
  return std::cos(0.7 * i + 1.9 * lane);
}

}  // namespace

TEST_CASE("all lanes are substituted through a sparse factor as a dense solver would, each as if alone") {
  const Eigen::MatrixXd A = quasi_definite();
  SparseLdlt ldlt;
  REQUIRE(ldlt.factorise(A.sparseView()));
  // Rows of the matrix are unknowns in another order.
  std::vector<int> order(rows);
  std::iota(order.begin(), order.end(), 0);
  std::swap(order[2], order[20]);
  std::swap(order[5], order[11]);
  const bool border_known = GENERATE(false, true);
  const SparseSubstitution through(ldlt, order, border_known ? rows : kept, kept);
  REQUIRE(through.rows() == rows);
  std::vector<Eigen::VectorXd> alone;
  for (const InstructionSet set : instruction_sets()) {
    if (set != InstructionSet::avx512) alone.clear();
    for (const int T : {1, 2, 4, 8, 16, 32}) {
      INFO(T << " lanes");
      Block b(rows, T), work(rows + 1, T), z(kept, T);
      for (int i = 0; i < rows; ++i)
        for (int l = 0; l < T; ++l) b.at(i, l) = right_hand_side(i, l);
      SparseStep step = through.step();
      step.b = b.data();
      step.work = work.data();
      step.z = z.data();
      lane_kernels(T, set).sparse_step(step);
      for (int l = 0; l < T; ++l) {
        Eigen::VectorXd permuted(rows), found(kept);
        for (int r = 0; r < rows; ++r) {
          const int unknown = order[static_cast<std::size_t>(r)];
          permuted[r] = unknown < kept || border_known ? right_hand_side(unknown, l) : 0.0;
        }
        const Eigen::VectorXd solution = A.fullPivLu().solve(permuted);
        for (int r = 0; r < rows; ++r)
          if (const int unknown = order[static_cast<std::size_t>(r)]; unknown < kept)
            CHECK(z.at(unknown, l) == Approx(solution[r]).margin(1e-14));
        for (int i = 0; i < kept; ++i) found[i] = z.at(i, l);
        // Whatever the number of lanes, and the width of the vectors.
        if (static_cast<int>(alone.size()) <= l) alone.push_back(found);
        CHECK(found == alone[static_cast<std::size_t>(l)]);
      }
    }
  }
}

TEST_CASE("blocks of columns of any width solve, and take few zeros in") {
  // Three dofs a node on a grid: wide supernodes, narrow ones and rests of both.
  constexpr int side = 9, per = 3, n = per * side * side;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  for (int a = 0; a < side * side; ++a)
    for (int b = 0; b < side * side; ++b) {
      if (std::abs(a / side - b / side) > 1 || std::abs(a % side - b % side) > 1) continue;
      for (int k = 0; k < per * per; ++k) A(per * a + k / per, per * b + k % per) = std::cos(1.0 + k * k);
    }
  A = (A + A.transpose()).eval() / 2;
  for (int i = 0; i < n; ++i) A(i, i) = 1 + A.row(i).cwiseAbs().sum();
  SparseLdlt ldlt;
  REQUIRE(ldlt.factorise(A.sparseView()));
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  const SparseSubstitution through(ldlt, order, n, n);
  CHECK(static_cast<double>(through.entries()) < 1.4 * static_cast<double>(ldlt.factor_entries()));
  const Eigen::VectorXd expected = Eigen::VectorXd::LinSpaced(n, -1, 2);
  const Eigen::VectorXd right = A * expected;
  for (const InstructionSet set : instruction_sets())
    for (const int T : {1, 4, 16}) {
      Block b(n, T), work(n + 1, T), z(n, T);
      for (int i = 0; i < n; ++i)
        for (int l = 0; l < T; ++l) b.at(i, l) = (l + 1) * right[i];
      SparseStep step = through.step();
      step.b = b.data();
      step.work = work.data();
      step.z = z.data();
      lane_kernels(T, set).sparse_step(step);
      for (int i = 0; i < n; ++i)
        for (int l = 0; l < T; ++l) CHECK(z.at(i, l) == Approx((l + 1) * expected[i]).margin(1e-12));
    }
}

TEST_CASE("a product by rows is that of the matrix, a lane whatever stands beside it") {
  const std::vector<int> start{0, 3, 3, 10, 11}, index{4, 0, 2, 0, 1, 2, 3, 4, 5, 6, 3};
  std::vector<double> value;
  for (std::size_t e = 0; e < index.size(); ++e) value.push_back(std::sin(1.0 + static_cast<double>(e)));
  const LaneRows matrix{4, start.data(), index.data(), value.data()};
  for (const InstructionSet set : instruction_sets()) {
    std::vector<double> alone;
    for (const int T : {1, 2, 4, 8, 16, 32}) {
      Block x(7, T), y(4, T);
      for (int i = 0; i < 7; ++i)
        for (int l = 0; l < T; ++l) x.at(i, l) = right_hand_side(i, l % 2);
      lane_kernels(T, set).row_product(matrix, false, x.data(), y.data());
      Block twice = y;
      lane_kernels(T, set).row_product(matrix, true, x.data(), twice.data());
      for (int i = 0; i < 4; ++i) {
        double sum = 0;
        for (int e = start[static_cast<std::size_t>(i)]; e < start[static_cast<std::size_t>(i) + 1]; ++e)
          sum += value[static_cast<std::size_t>(e)] * right_hand_side(index[static_cast<std::size_t>(e)], 0);
        CHECK(y.at(i, 0) == Approx(sum).margin(1e-15));
        CHECK(twice.at(i, 0) == 2 * y.at(i, 0));
        if (T == 1) alone.push_back(y.at(i, 0));
        for (int l = 0; l < T; l += 2) CHECK(y.at(i, l) == alone[static_cast<std::size_t>(i)]);
      }
    }
  }
}
