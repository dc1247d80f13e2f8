// Substitution of all lanes through a sparse factor: what a dense solver finds, and each lane by itself.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <ricochet/kernels/block.hpp>
#include <ricochet/kernels/sparse_ldlt.hpp>

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
      Block b(rows, T), work(rows, T), z(kept, T);
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
