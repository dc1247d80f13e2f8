#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <limits>
#include <random>
#include <ricochet/kernels/quadratic_form.hpp>

#include "tests/eigen.hpp"
#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

std::vector<double> some_vector(int n, double phase) {
  std::vector<double> x;
  for (int i = 0; i < n; ++i) x.push_back(std::sin(1.3 * i + phase) + 0.2);
  return x;
}

double dense(const Eigen::MatrixXd& A, const std::vector<double>& x, const std::vector<double>& y) {
  const Eigen::Map<const Eigen::VectorXd> a(x.data(), A.rows()), b(y.data(), A.rows());
  return a.dot(A * b);
}

}  // namespace

TEST_CASE("a quadratic form equals its dense matrix, for stiffness and every mass") {
  const auto name = GENERATE(std::string("consistent"), std::string("lumped"), std::string("P1"), std::string("P0"),
                             std::string("reciprocal"));
  const bool singular = name[0] == 'P';
  const auto strategy = singular ? mass("singular", {{"velocity", name}}) : mass(name);
  const SemiDiscrete problem = discretised(working_set(), 7, *strategy);
  const auto x = some_vector(problem.dofs(), 0.1), y = some_vector(problem.dofs(), 0.7);
  const QuadraticForm M = QuadraticForm::of(problem.inertia), K(problem.stiffness);
  // Sums of some dozens of terms of one size.
  CHECK(M(x.data()) == Approx(dense(dense_mass(problem.inertia), x, x)).epsilon(1e-12));
  CHECK(M(x.data(), y.data()) == Approx(dense(dense_mass(problem.inertia), x, y)).epsilon(1e-12));
  CHECK(K(x.data()) == Approx(dense(problem.stiffness, x, x)).epsilon(1e-12));
  CHECK(K(x.data(), y.data()) == Approx(dense(problem.stiffness, x, y)).epsilon(1e-12));
  CHECK(K(x.data(), y.data()) == Approx(K(y.data(), x.data())).epsilon(1e-12));
}

TEST_CASE("the elastic energy of a smooth shape keeps its digits on a fine mesh") {
  // u = 0.04 x² has the constant curvature 0.08: E = ½ EI 0.08² L, interpolated exactly. Entries of K q are 10⁶ times
  // larger.
  const SceneSpec scene = working_set();
  const SemiDiscrete problem = discretised(scene, 200, *mass("consistent"));
  const auto& beam = std::get<BeamSpec>(scene.structure);
  const double EI = section_properties(beam.section, beam.young, beam.density).EI;
  const double exact = 0.5 * EI * 0.08 * 0.08 * beam.length;
  const QuadraticForm K(problem.stiffness);
  CHECK(0.5 * K(problem.position.data()) == Approx(exact).epsilon(1e-7));
  // Evaluation noise: a relative change of 1e-15 of one nodal value must not show beyond what it does to the energy.
  Eigen::VectorXd nudged = problem.position;
  nudged[100] *= 1 + 1e-15;
  CHECK(std::abs(K(nudged.data()) - K(problem.position.data())) <= 1e-9 * exact);
}

TEST_CASE("the inverse form is that of the dense matrix, bordered or not") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> entry(-1, 1);
  const int n = 9, r = 4;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n), G = Eigen::MatrixXd::Zero(r, n);
  for (int i = 0; i < n; ++i) {
    A(i, i) = 4;
    for (int j = std::max(0, i - 2); j < i; ++j) A(i, j) = A(j, i) = entry(random);
  }
  for (int j = 0; j < r; ++j)
    for (int i = 2 * j; i < std::min(n, 2 * j + 3); ++i) G(j, i) = entry(random);
  const Eigen::MatrixXd Cv = 0.5 * Eigen::MatrixXd::Identity(r, r);
  const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(n, [&] { return entry(random); });
  QuasiDefinite plain{A.sparseView(), {}, {}}, bordered{A.sparseView(), G.sparseView(), Cv.sparseView()};
  CHECK(*InverseForm(plain)(b) == Approx(b.dot(eigen::ldlt_solve(A, b))).epsilon(1e-12));
  const Eigen::MatrixXd whole = A + 2 * G.transpose() * G;
  CHECK(*InverseForm(bordered)(b) == Approx(b.dot(eigen::ldlt_solve(whole, b))).epsilon(1e-12));
  CHECK(*InverseForm(plain)(Eigen::VectorXd::Zero(n)) == 0.0);
  plain.A = Eigen::SparseMatrix<double>(n, n);
  CHECK_FALSE(InverseForm(plain)(b));
}

TEST_CASE("with its border first, a quasi-definite matrix needs no stiffness") {
  const int n = 6;
  Eigen::MatrixXd C = 3 * Eigen::MatrixXd::Identity(n, n);
  for (int i = 1; i < n; ++i) C(i, i - 1) = C(i - 1, i) = 0.7;
  const Eigen::MatrixXd G = 1.5 * Eigen::MatrixXd::Identity(n, n);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, -1, 2);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
  for (const double stiffness : {0.0, 1e-9, 40.0}) {
    INFO("stiffness " << stiffness);
    for (int i = 0; i + 1 < n; ++i) K.block(i, i, 2, 2) += stiffness * (Eigen::Matrix2d() << 1, -1, -1, 1).finished();
    QuasiDefinite matrix{K.sparseView(), G.sparseView(), C.sparseView(), true};
    const Eigen::MatrixXd whole = K + G.transpose() * eigen::inverse(C) * G;
    const auto found = InverseForm(matrix)(b);
    REQUIRE(found);
    CHECK(*found == Approx(b.dot(eigen::ldlt_solve(whole, b))).epsilon(1e-13));
    matrix.border_first = false;
    if (stiffness == 0) CHECK_FALSE(InverseForm(matrix)(b));
  }
}

// Forms of combinations are those of the vectors written out.

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
