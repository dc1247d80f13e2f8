#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <limits>

#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double energy(const SemiDiscrete& p) {
  return 0.5 * p.position.dot(p.stiffness * p.position) + 0.5 * p.velocity.dot(apply_mass(p.inertia, p.velocity));
}

double line_density(const SemiDiscrete& p) {
  return p.space.elements[0].line_density;
}

Eigen::VectorXd kernel_part(const SemiDiscrete& p, const Eigen::VectorXd& force) {
  return mass_kernel(p.inertia).transpose() * force;
}

}  // namespace

TEST_CASE("a mass strategy sees the dofs at which stops stand") {
  class Seen final : public MassStrategy {
   public:
    mutable std::vector<int> dofs;
    InertiaOrRefusal build(const FiniteElementSpace& space) const override {
      dofs = space.contact_dofs;
      Inertia inertia;
      inertia.mass = consistent_mass(space);
      return inertia;
    }
  } strategy;
  SceneSpec scene = working_set();
  const auto seen = [&] {
    const SemiDiscrete p = discretised(scene, 3, strategy);
    // The columns of H that are not zero.
    std::vector<int> columns;
    const Eigen::MatrixXd H = Eigen::MatrixXd(p.contact).cwiseAbs();
    for (int j = 0; j < p.dofs(); ++j)
      if (H.rows() > 0 && H.col(j).maxCoeff() > 0) columns.push_back(j);
    CHECK(strategy.dofs == columns);
    CHECK(p.space.contact_dofs == columns);
    return columns;
  };
  CHECK(seen() == std::vector<int>{4});
  scene.stops.place = StopsSpec::Place::nodes;
  CHECK(seen() == std::vector<int>{0, 2, 4});
  scene.stops.place = StopsSpec::Place::positions;
  scene.stops.positions = {0.7, 1.501};  // inside the second element, and at its neighbour's end
  CHECK(seen() == std::vector<int>{0, 1, 2, 3, 4});
  scene.stops.lower.reset();
  scene.stops.upper.reset();
  CHECK(seen().empty());
  CHECK(make_space(scene.structure, 3).contact_dofs.empty());
}

TEST_CASE("stops at nodes, at the tip, at positions, on one side, nowhere") {
  SceneSpec scene = working_set();
  const auto strategy = mass("consistent");
  {
    const auto p = discretised(scene, 10, *strategy);
    REQUIRE(p.points() == 1);
    CHECK(p.contact_x == std::vector<double>{1.501});
    CHECK((p.contact * p.position)(0) == Approx(0.04 * 1.501 * 1.501).epsilon(1e-15));
    CHECK(Eigen::MatrixXd(p.tip) == Eigen::MatrixXd(p.contact));
  }
  scene.stops.place = StopsSpec::Place::nodes;
  scene.stops.lower = Formula("-0.1-0.01*x", "", "x");
  scene.stops.upper.reset();
  {
    const auto p = discretised(scene, 10, *strategy);
    REQUIRE(p.points() == 10);
    CHECK(p.contact.nonZeros() == 10);
    for (int i = 0; i < 10; ++i) {
      CHECK(p.contact.coeff(i, 2 * i) == 1);
      CHECK(p.lower[i] == Approx(-0.1 - 0.01 * p.contact_x[i]).epsilon(1e-15));
      CHECK(p.upper[i] == infinity);
    }
  }
  scene.stops.place = StopsSpec::Place::positions;
  scene.stops.positions = {0.2, 1.501 / 2};
  {
    const auto p = discretised(scene, 10, *strategy);
    REQUIRE(p.points() == 2);
    CHECK(p.contact.row(0).nonZeros() == 4);
    CHECK(p.contact.row(1).nonZeros() == 1);
    CHECK((p.contact * p.position)(0) == Approx(0.04 * 0.04).epsilon(1e-13));  // x² is in the space
  }
  scene.stops.lower.reset();
  CHECK(discretised(scene, 10, *strategy).points() == 0);
}

TEST_CASE("the initial state is absolute: the support's position and velocity are taken off") {
  SceneSpec scene = working_set();
  scene.support = {0.02, 10, 0.5};
  const auto p = discretised(scene, 6, *mass("consistent"));
  const auto x = p.space.elements[2].left + p.space.elements[2].length;
  CHECK(p.position[4] == Approx(0.04 * x * x - 0.02 * std::sin(0.5)).epsilon(1e-14));
  CHECK(p.position[5] == Approx(0.08 * x).epsilon(1e-11));  // slope by a stencil
  CHECK(p.velocity[4] == Approx(-2 * x - 0.2 * std::cos(0.5)).epsilon(1e-14));
  CHECK(p.velocity[5] == Approx(-2).epsilon(1e-11));
  REQUIRE(p.notes.size() == 3);  // displacement, velocity and rate of slope at the clamp are not the formulas'
  CHECK_THAT(p.notes[0], Contains("the initial displacement at the clamp is 0 m; the clamp imposes 0.00958851 m"));
}

TEST_CASE("energy of the seed's initial state tends to (2/3)L³ + ½k²·0.0064·L, with order 1") {
  // The rate of slope −2 at the clamp cannot be kept: an O(ℓ³) part of the kinetic energy, and nothing of the elastic
  // one.
  const double L = 1.501, exact = 2.0 / 3 * L * L * L + 0.5 * 282.8125 * 0.0064 * L;
  CHECK(exact == Approx(3.612908).margin(5e-7));  // the digits printed
  std::vector<double> lengths, errors;
  for (int elements : {10, 20, 40}) {
    const auto p = discretised(working_set(), elements, *mass("consistent"));
    lengths.push_back(std::log(L / elements));
    errors.push_back(std::log(std::abs(energy(p) / line_density(p) - exact)));
  }
  CHECK(fitted_slope(lengths, errors) == Approx(3).margin(0.1));
}

TEST_CASE("projection: on 8 elements with P1 velocities the seed's energy becomes 3.542 per ρS") {
  SceneSpec scene = working_set();
  const auto strategy = mass("singular");
  const auto free = discretised(scene, 8, *strategy);
  scene.initial.projection = InitialSpec::Projection::constraint;
  const auto p = discretised(scene, 8, *strategy);
  CHECK(energy(p) / line_density(p) == Approx(3.542).margin(5e-4));  // the digits printed
  // Differences of two sums of some 3 J/(kg/m).
  CHECK(p.projection_energy == Approx(energy(p) - energy(free)).margin(1e-12));
  CHECK(free.projection_energy == 0);
  // Without load the excess over the massless part's equilibrium is what projection takes, and then it is gone.
  CHECK(free.kernel_energy == Approx(-p.projection_energy).epsilon(1e-9));
  CHECK(p.kernel_energy == 0);
  CHECK(discretised(scene, 8, *mass("consistent")).kernel_energy == 0);
  CHECK_THAT(p.notes.back(), StartsWith("projection of the initial state on the constraint of the singular mass"));
}

TEST_CASE("projection satisfies Zᵀ(Kq − F) = 0 and its rate, keeps momentum, and is done once and for all") {
  for (const char* velocity : {"P1", "P0"}) {
    for (double alpha : {0.0, 1e-4}) {
      SceneSpec scene = working_set();
      scene.stops = {};
      beam_of(scene).damping = {alpha, 0.3};
      scene.support = {0.02, 10, 0.7};
      scene.load = Formula("3*x*(1 + sin(20*t))", "");
      const auto strategy = mass("singular", {{"velocity", std::string(velocity)}});
      const auto free = discretised(scene, 12, *strategy);
      scene.initial.projection = InitialSpec::Projection::constraint;
      const auto p = discretised(scene, 12, *strategy);

      Eigen::VectorXd load(p.dofs()), rate(p.dofs());
      p.load->assemble(0, load.data());
      const double A = 0.02, w = 10, psi = 0.7;
      load += A * w * w * std::sin(psi) * p.support_shape;
      DistributedLoad(Formula("60*x", ""), p.space).assemble(0, rate.data());
      rate += A * w * w * w * std::cos(psi) * p.support_shape;
      if (alpha > 0) rate.setZero();

      // ‖K‖‖q‖ is where the residual's round-off comes from.
      const double stiff = Eigen::MatrixXd(p.stiffness).norm();
      const double unit = stiff * p.position.norm() * mass_kernel(p.inertia).norm();
      CHECK(kernel_part(p, p.stiffness * p.position - load).norm() <= 1e-13 * unit);
      // The rate of the load comes from differences: 1e-16·|F|/2e-5 s.
      const double differences = 1e-10 * load.norm() * mass_kernel(p.inertia).norm();
      const double unit_rate = stiff * p.velocity.norm() * mass_kernel(p.inertia).norm();
      CHECK(kernel_part(p, p.stiffness * p.velocity - rate).norm() <= 1e-13 * unit_rate + differences);

      const Eigen::VectorXd momentum = apply_mass(p.inertia, free.velocity);
      // Velocities of the kernel are of order 10 m/s, annihilated by M up to round-off.
      CHECK((apply_mass(p.inertia, p.velocity) - momentum).norm() <= 1e-11 * momentum.norm());
    }
  }
}

TEST_CASE("a state already on the constraint is left where it is") {
  // The static shape under a uniform load satisfies Kq = F, so also its part on any kernel.
  SceneSpec scene = unit_beam();
  scene.stops = {};
  scene.load = Formula(1.0);
  scene.initial.displacement = Formula("x^2*(6 - 4*x + x^2)/24", "", "x");
  scene.initial.projection = InitialSpec::Projection::constraint;
  const auto p = discretised(scene, 10, *mass("singular"));
  CHECK(std::abs(p.projection_energy) <= 1e-12 * energy(p));
  CHECK(p.position[18] == Approx(1.0 / 8).epsilon(1e-10));  // stencil slopes times the condition number of K
}

TEST_CASE("projection of a regular mass does nothing and says so") {
  SceneSpec scene = working_set();
  const auto free = discretised(scene, 8, *mass("consistent"));
  scene.initial.projection = InitialSpec::Projection::constraint;
  const auto p = discretised(scene, 8, *mass("consistent"));
  CHECK(p.position == free.position);
  CHECK(p.velocity == free.velocity);
  CHECK(p.projection_energy == 0);
  CHECK(p.notes.back() == "projection of the initial state: nothing to do, the mass is regular");
}

TEST_CASE("a projection that carries the state through a stop is refused") {
  SceneSpec scene = working_set();
  scene.initial.projection = InitialSpec::Projection::constraint;
  scene.stops.lower = Formula(0.0901);  // the tip starts at 0.09012, and its massless part gives way
  CHECK_THAT(input_error([&] { discretise(scene, 8, *mass("singular")); }),
             StartsWith("/scene/initial/projection: the projected initial displacement is ") &&
                 Contains("at x = 1.501 m, beyond the lower stop at 0.0901 m"));
}

TEST_CASE("a strategy that does not apply is a refusal, not an error") {
  struct Never : MassStrategy {
    InertiaOrRefusal build(const FiniteElementSpace&) const override { return Refusal{"not here: use another"}; }
  };
  const auto result = discretise(working_set(), 4, Never());
  REQUIRE(std::holds_alternative<Refusal>(result));
  CHECK(std::get<Refusal>(result).sentence.text == "not here: use another");
}

TEST_CASE("damping, support and load are handed on") {
  SceneSpec scene = working_set();
  CHECK_FALSE(discretised(scene, 4, *mass("consistent")).damped());
  beam_of(scene).damping.stiffness = 1e-4;
  scene.support.amplitude = 0.05;
  const auto p = discretised(scene, 4, *mass("consistent"));
  CHECK(p.damped());
  CHECK(p.damping.stiffness == 1e-4);
  CHECK(p.support.amplitude == 0.05);
  CHECK(p.load->absent());
}
