// Forms of combinations are those of the vectors written out.
#include <limits>
#include <ricochet/kernels/quadratic_form.hpp>

#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

// What stands beyond the last row is nobody's.
Block some_block(int n, double phase) {
  Block x(n, 1);
  for (int i = 0; i < n; ++i) x.at(i, 0) = std::sin(1.3 * i + phase) + 0.2;
  for (int i = n; i < (n + 3) / 4 * 4; ++i) x.data()[i] = std::numeric_limits<double>::quiet_NaN();
  return x;
}

Eigen::Map<const Eigen::VectorXd> vector(const Block& x) {
  return {x.data(), x.rows()};
}

void check_forms(const QuadraticForm& matrix, const Eigen::MatrixXd& dense) {
  const int n = matrix.rows();
  const std::vector<double> ratio = {1, 0.5, -0.3, 2};
  const Eigen::VectorXd h = vector(some_block(n, 0.7)).eval();
  std::vector<Block> x;
  std::vector<const double*> at;
  for (int k = 0; k < CombinedForm::most_terms; ++k) x.push_back(some_block(n, 0.1 + k));
  for (const Block& one : x) at.push_back(one.data());
  const CombinedForm form(matrix), with_shape(matrix, h.data());
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(n);
  for (int count = 1; count <= CombinedForm::most_terms; ++count) {
    INFO(count << " vectors");
    sum += ratio[static_cast<std::size_t>(count - 1)] * vector(x[static_cast<std::size_t>(count - 1)]);
    Block out(n, 1);
    const CombinedForm::Value bare = form(count, at.data(), ratio.data());
    const CombinedForm::Value value = with_shape(count, at.data(), ratio.data(), out.data());
    CHECK(value.form == Approx(sum.dot(dense * sum)).epsilon(1e-12));
    CHECK(value.projection == Approx(h.dot(sum)).margin(1e-13 * n));
    CHECK(bare.form == value.form);
    CHECK(bare.projection == 0);
    CHECK((vector(out) - sum).cwiseAbs().maxCoeff() <= 1e-14);
  }
}

}  // namespace

TEST_CASE("one pass gives the form and a projection of a combination of any size, whatever the width") {
  for (int n : {1, 2, 3, 4, 5, 7, 8, 9, 11, 12, 13, 16, 31, 100})
    for (int width : {0, 1, 2, 3, 5}) {
      if (width >= n) continue;
      Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
      for (int i = 0; i < n; ++i)
        for (int s = 0; s <= width && i + s < n; ++s)
          A(i, i + s) = A(i + s, i) = s == 0 ? 3.0 * (width + 1) : std::cos(0.9 * i + s);
      INFO(n << " rows, half-bandwidth " << width);
      check_forms(QuadraticForm(SparseMatrix(A.sparseView())), A);
    }
}

TEST_CASE("one pass does so for the unit matrix, for none, and for a mass that is given by factors") {
  for (int n : {1, 4, 6, 40}) {
    INFO(n << " rows");
    const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(n, n);
    check_forms(QuadraticForm(SparseMatrix(unit.sparseView())), unit);
    check_forms(QuadraticForm(SparseMatrix(n, n)), Eigen::MatrixXd::Zero(n, n));
  }
  for (const char* velocity : {"P0", "P1"}) {
    INFO(velocity);
    const SemiDiscrete problem =
        discretised(working_set(), 7, *mass("singular", {{"velocity", std::string(velocity)}}));
    check_forms(QuadraticForm::of(problem.inertia), dense_mass(problem.inertia));
  }
}

TEST_CASE("one pass keeps the digits of a smooth shape on a fine mesh") {
  const SemiDiscrete problem = discretised(working_set(), 200, *mass("consistent"));
  const QuadraticForm K(problem.stiffness);
  Block shape(problem.dofs(), 1);
  for (int i = 0; i < shape.rows(); ++i) shape.at(i, 0) = problem.position[i];
  CHECK(CombinedForm(K)(shape.data()).form == Approx(K(shape.data())).epsilon(1e-9));
}
