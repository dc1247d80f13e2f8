#include <catch2/catch.hpp>
#include <stdexcept>

#include "tests/eigen.hpp"
#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;

TEST_CASE("the kernel basis is annihilated by M and has full rank") {
  for (int elements : {1, 8, 120}) {
    for (const auto& strategy :
         {mass("singular", {{"velocity", std::string("P1")}}), mass("singular", {{"velocity", std::string("P0")}}),
          mass("lumped", {{"rotation", std::string("none")}})}) {
      const auto inertia = built(*strategy, make_space(working_set().structure, elements));
      const Eigen::MatrixXd Z = mass_kernel(inertia);
      REQUIRE(Z.rows() == 2 * elements);
      REQUIRE(Z.cols() == elements);
      for (Eigen::Index j = 0; j < Z.cols(); ++j) {
        // Against the same sums without cancellation: a few ulps.
        const double size = (dense_mass(inertia).cwiseAbs() * Z.col(j).cwiseAbs()).norm();
        CHECK(apply_mass(inertia, Z.col(j)).norm() <= 1e-11 * size);
      }
      CHECK(eigen::rank(Z) == elements);
    }
  }
}

TEST_CASE("a regular mass has an empty kernel") {
  const auto inertia = built(*mass("consistent"), make_space(working_set().structure, 4));
  CHECK(mass_kernel(inertia).cols() == 0);
  CHECK(mass_kernel(inertia).rows() == 8);
}

TEST_CASE("a strategy that declares a wrong kernel is found out") {
  auto inertia = built(*mass("singular"), make_space(working_set().structure, 4));
  inertia.kernel_dimension = 3;
  CHECK_THROWS_AS(mass_kernel(inertia), std::logic_error);
}

TEST_CASE("apply_mass through the factors is the product with the full matrix") {
  const auto inertia = built(*mass("singular"), make_space(working_set().structure, 9));
  REQUIRE(inertia.factored());
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(18, -1, 2).array().sin();
  const Eigen::VectorXd reference = dense_mass(inertia) * x;
  CHECK((apply_mass(inertia, x) - reference).norm() <= 1e-13 * reference.norm());
}
