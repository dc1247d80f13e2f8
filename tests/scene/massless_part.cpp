#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <ricochet/scene/massless_part.hpp>

#include "tests/eigen.hpp"
#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

Eigen::VectorXd uneven_load(const SemiDiscrete& problem) {
  Eigen::VectorXd load(problem.dofs());
  for (int i = 0; i < problem.dofs(); ++i) load[i] = std::sin(0.7 * i) + 0.2 * std::cos(31.0 * i * i);
  return load;
}

std::vector<std::unique_ptr<MassStrategy>> singular_masses() {
  std::vector<std::unique_ptr<MassStrategy>> masses;
  masses.push_back(mass("singular", {{"velocity", std::string("P1")}}));
  masses.push_back(mass("singular", {{"velocity", std::string("P0")}}));
  masses.push_back(mass("lumped", {{"rotation", std::string("none")}}));
  return masses;
}

}  // namespace

TEST_CASE("the massless part answers in Ker M, and holds the load there", "[massless]") {
  // Both sides of the size where the dense basis ends.
  for (const int elements : {1, 12, 200, 201, 400}) {
    for (const auto& strategy : singular_masses()) {
      const auto problem = discretised(working_set(), elements, *strategy);
      const MasslessPart massless(problem.stiffness, problem.inertia);
      const Eigen::VectorXd load = uneven_load(problem), response = massless.response(load);
      INFO(elements << " elements");
      const Eigen::MatrixXd Z = mass_kernel(problem.inertia);
      const Eigen::VectorXd expected =
          Z * eigen::ldlt_solve(Z.transpose() * (problem.stiffness * Z), Z.transpose() * load);
      // In the norm of K, where rotations and displacements compare. S lets a part 1e-16·σM/K ≤ 1e-12 of a kernel
      // vector through.
      const auto norm = [&](const Eigen::VectorXd& x) { return std::sqrt(x.dot(problem.stiffness * x)); };
      CHECK(norm(response - expected) <= 1e-11 * norm(expected));
      CHECK(massless.energy(load) == Approx(0.5 * load.dot(expected)).epsilon(1e-11));
    }
  }
}

TEST_CASE("a load that the kernel cannot feel moves no massless part", "[massless]") {
  // Without inertia of rotations the kernel is the rotations: a force on a displacement is not felt there.
  for (const int elements : {20, 300}) {
    const auto problem = discretised(working_set(), elements, *mass("lumped", {{"rotation", std::string("none")}}));
    const MasslessPart massless(problem.stiffness, problem.inertia);
    Eigen::VectorXd load = Eigen::VectorXd::Zero(problem.dofs());
    load[elements] = 1;
    const double alone = 0.5 / problem.stiffness.coeff(elements, elements);
    CHECK(std::abs(massless.energy(load)) <= 1e-15 * alone);
    load[elements + 1] = 1;
    CHECK(massless.energy(load) > 0);
  }
}

TEST_CASE("the kernel of thousands of elements is measured without a basis of it", "[massless]") {
  for (const char* velocity : {"P1", "P0"}) {
    const auto strategy = mass("singular", {{"velocity", std::string(velocity)}});
    SceneSpec scene = working_set();
    // The seed's excess over the massless part's equilibrium is that of the element at the clamp. It is of order one in
    // its length, on either side of the size where the dense basis ends.
    std::vector<double> lengths, energies;
    for (const int elements : {50, 125, 250, 500, 1000, 2000}) {
      const auto problem = discretised(scene, elements, *strategy);
      CHECK(problem.inertia.kernel_dimension == elements);
      lengths.push_back(std::log(1.0 / elements));
      energies.push_back(std::log(problem.kernel_energy));
    }
    CHECK(fitted_slope(lengths, energies) == Approx(1).margin(0.02));
    scene.initial.projection = InitialSpec::Projection::constraint;
    const auto free = discretised(working_set(), 2000, *strategy), projected = discretised(scene, 2000, *strategy);
    // Nothing is left to take off, and no mass has moved.
    const MasslessPart massless(projected.stiffness, projected.inertia);
    CHECK(massless.energy(projected.stiffness * projected.position) <= 1e-9 * free.kernel_energy);
    const Eigen::VectorXd moved = apply_mass(free.inertia, projected.velocity - free.velocity);
    CHECK(moved.norm() <= 1e-9 * apply_mass(free.inertia, free.velocity).norm());
  }
}
