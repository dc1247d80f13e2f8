#include "tests/marching.hpp"
#include "tests/plugins/mass/laws.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {
std::unique_ptr<MassStrategy> scaled(double factor) {
  return mass("mass-scaling", {{"factor", factor}});
}
}  // namespace

TEST_CASE("mass-scaling: nothing is added to the rigid motions of an element, β of its mass to its deformation") {
  for (const bool beam : {false, true}) {
    FiniteElementSpace one;
    one.structure = beam ? "beam" : "bar";
    one.basis = beam ? FiniteElementSpace::Basis::hermite : FiniteElementSpace::Basis::linear;
    one.dofs = beam ? 4 : 2;
    one.elements = {{0, 0.5, 3, {0, 1, beam ? 2 : -1, beam ? 3 : -1}}};
    const Eigen::MatrixXd added = dense_mass(built(*scaled(4), one)) - dense_mass(built(*scaled(0), one));
    Eigen::MatrixXd rigid(one.dofs, beam ? 2 : 1);
    if (beam)
      rigid << 1, 0, 0, 1, 1, 0.5, 0, 1;
    else
      rigid << 1, 1;
    CHECK((added * rigid).norm() <= 1e-14 * added.norm());
    if (!beam) {
      CHECK(added(0, 0) == Approx(4 * 1.5 / 2).epsilon(1e-14));  // β m_e (I − 11ᵀ/2)
      CHECK(added(0, 1) == Approx(-4 * 1.5 / 2).epsilon(1e-14));
    }
  }
  for (int elements : {1, 2, 17}) check_inertia(*scaled(4), elements, 0);
}

TEST_CASE("mass-scaling: the largest pulsation falls by √(1 + 2β), the error of the first grows 1 + 6β times") {
  const double lumped = pulsation_error(*scaled(0), unit_bar(), 32);
  CHECK(largest_pulsation(*scaled(0), unit_bar(), 64) == Approx(2).margin(1e-3));
  CHECK(largest_pulsation(*scaled(4), unit_bar(), 64) == Approx(2.0 / 3).margin(1e-3));
  for (const double beta : {4.0, 15.0}) {
    CHECK(largest_pulsation(*scaled(beta), unit_bar(), 64) == Approx(2 / std::sqrt(1 + 2 * beta)).epsilon(1e-3));
    // The next term of the error, as large as the first one squared.
    CHECK(pulsation_error(*scaled(beta), unit_bar(), 32) / lumped == Approx(1 + 6 * beta).epsilon(0.03));
  }
  CHECK(pulsation_order(*scaled(4), unit_bar(), 16) == Approx(2).margin(0.05));
  CHECK(pulsation_order(*scaled(4), unit_beam(), 20) == Approx(2).margin(0.05));
}

TEST_CASE("mass-scaling: an explicit step holds three times longer") {
  // A bar of 20 elements let go: 2/ω of the lumped mass is ℓ/c = 1/20, and √9 of that with β = 4.
  SceneSpec scene = unit_bar();
  scene.initial.displacement = Formula("0.1*(1-x)", "/scene/initial/displacement", "x");
  const auto runs = [&](double beta, double h) {
    Marcher bar = marcher(scene, 20, {{"mass-scaling", {{"factor", beta}}}, {"none"}, {"central-difference"}}, h);
    run(bar, 400 * h);
    return bar.status(0).running && std::abs(bar.tip(0)) < 1;
  };
  CHECK(runs(0, 0.049));
  CHECK_FALSE(runs(0, 0.052));
  CHECK(runs(4, 0.147));
  CHECK_FALSE(runs(4, 0.156));
}
