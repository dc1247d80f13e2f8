#include "tests/marching.hpp"
#include "tests/plugins/mass/laws.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {
std::unique_ptr<MassStrategy> reciprocal(double beta) {
  return mass("reciprocal", {{"beta", beta}});
}
}  // namespace

TEST_CASE("reciprocal: an inverse as sparse as K, symmetric, positive definite") {
  for (int elements : {1, 2, 17}) check_inertia(*reciprocal(0), elements, 0);
  const auto space = make_space(working_set().structure, 9);
  const Inertia inertia = built(*reciprocal(0), space);
  REQUIRE(inertia.inverted());
  for (int j = 0; j < inertia.inverse.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(inertia.inverse, j); it; ++it)
      CHECK(std::abs(it.row() / 2 - it.col() / 2) <= 1);
  const Eigen::MatrixXd lumped = built(*mass("lumped"), space).mass;
  CHECK((dense_mass(built(*reciprocal(1), space)) - lumped).norm() <= 1e-13 * lumped.norm());
}

TEST_CASE("reciprocal: one free bar element has the consistent mass") {
  FiniteElementSpace one =
      make_space(BarSpec{.length = 3, .EA = 1, .rhoA = 2, .fixed = BarSpec::Fixed::none, .damping = {}}, 1);
  const Eigen::MatrixXd M = dense_mass(built(*reciprocal(0), one));
  CHECK(M(0, 0) == Approx(2).epsilon(1e-14));
  CHECK(M(0, 1) == Approx(1).epsilon(1e-14));
}

TEST_CASE("reciprocal: what is fixed is that of the free structure, restricted") {
  using Fixed = BarSpec::Fixed;
  const auto bar = [&](Fixed fixed) {
    return dense_mass(built(*reciprocal(0.3),
                            make_space(BarSpec{.length = 3, .EA = 1, .rhoA = 2, .fixed = fixed, .damping = {}}, 6)));
  };
  const Eigen::MatrixXd whole = bar(Fixed::none);
  CHECK((whole.bottomRightCorner(6, 6) - bar(Fixed::left)).norm() <= 1e-14 * whole.norm());
  CHECK((whole.topLeftCorner(6, 6) - bar(Fixed::right)).norm() <= 1e-14 * whole.norm());
}

TEST_CASE("reciprocal: rigid motions have the mass of the structure, point masses add theirs") {
  auto space = make_space(BarSpec{.length = 3, .EA = 1, .rhoA = 2, .fixed = BarSpec::Fixed::none, .damping = {}}, 6);
  CHECK(rigid_mass(built(*reciprocal(0), space), space)(0, 0) == Approx(6).epsilon(1e-13));
  const Eigen::MatrixXd bare = dense_mass(built(*reciprocal(0), space));
  space.point_masses = {{2, 0.7}, {3, 1e3}};
  const Inertia loaded = built(*reciprocal(0), space);
  Eigen::MatrixXd difference = dense_mass(loaded) - bare;
  difference(2, 2) -= 0.7;
  difference(3, 3) -= 1e3;
  CHECK(difference.cwiseAbs().maxCoeff() <= 1e-9);  // 1e3 kg, as an inverse of an inverse
  CHECK(dense_mass(built(*reciprocal(0), oscillator_space(2)))(0, 0) == 2);
}

TEST_CASE("reciprocal: largest pulsations and orders") {
  CHECK(largest_pulsation(*reciprocal(0), unit_bar(), 64) == Approx(std::sqrt(12)).margin(1e-3));
  CHECK(largest_pulsation(*reciprocal(0.5), unit_bar(), 64) == Approx(std::sqrt(6)).margin(1e-3));
  CHECK(pulsation_order(*reciprocal(0), unit_bar(), 16) == Approx(1.93).margin(0.01));
  CHECK(pulsation_order(*reciprocal(0.5), unit_bar(), 16) == Approx(1.94).margin(0.01));
  CHECK(largest_pulsation(*reciprocal(0), unit_beam(), 32) == Approx(34.85).margin(0.006));
  CHECK(largest_pulsation(*reciprocal(0.5), unit_beam(), 32) == Approx(25.95).margin(0.006));
  CHECK(pulsation_order(*reciprocal(0), unit_beam(), 16) == Approx(2).margin(0.01));
}

namespace {

// The same mass, formed.
class Formed final : public MassStrategy {
 public:
  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    Inertia inertia;
    inertia.mass = dense_mass(built(*mass("reciprocal"), space)).sparseView();
    return inertia;
  }
};

double tip_after(const std::shared_ptr<const SemiDiscrete>& problem, const Methods& methods, double h, double duration,
                 OperatorKind kind) {
  CompileOptions options;
  options.kind = kind;
  auto program = compiled(problem, methods, h, options);
  REQUIRE(std::holds_alternative<Program>(program));
  Marcher marched(std::move(std::get<Program>(program)));
  const EnergyAudit audit = audited(marched, duration);
  CHECK(audit.contact(0).impacts > 0);
  return marched.tip(0) + 1e-3 * audit.energy(0).kinetic;
}

}  // namespace

TEST_CASE("reciprocal: marches as the matrix that it is the inverse of, explicit or not, under any operator") {
  SceneSpec beam = working_set();
  beam_of(beam).damping = {1e-6, 0.3};
  beam.stops.place = StopsSpec::Place::nodes;
  beam.support.amplitude = 0.01;
  beam.load = Formula("0.1*x*sin(3*t)", "/scene/load");
  const auto time = GENERATE(Choice{"newmark-dumont-paoli"}, Choice{"moreau-jean", {{"theta", 0.6}}},
                             Choice{"cd-lagrange"}, Choice{"carpenter-taylor-katona"});
  INFO(time.name);
  // Its S has C in it, and K with stiffness-proportional damping: undamped it is a product.
  if (time.name == "carpenter-taylor-katona") beam_of(beam).damping = {};
  const Methods methods{{"reciprocal"}, {"signorini"}, time};
  const double h = 1e-5, duration = 0.055;
  const double formed = tip_after(std::make_shared<const SemiDiscrete>(discretised(beam, 6, Formed())), methods, h,
                                  duration, OperatorKind::band);
  for (const OperatorKind kind : {OperatorKind::band, OperatorKind::modal, OperatorKind::sparse})
    // Round-off, amplified by impacts.
    CHECK(tip_after(problem_of(beam, 6, {"reciprocal"}), methods, h, duration, kind) == Approx(formed).margin(1e-9));
}

TEST_CASE("reciprocal: a bar without a clamp marches too, its stiffness is singular") {
  SceneSpec scene;
  scene.structure = BarSpec{.length = 1, .EA = 1e4, .rhoA = 1, .fixed = BarSpec::Fixed::none, .damping = {}};
  scene.stops.lower = Formula(0.0);
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.displacement = Formula(0.01);
  scene.initial.velocity = Formula(-1.0);
  for (const char* time : {"newmark-dumont-paoli", "carpenter-taylor-katona"}) {
    const Methods methods{{"reciprocal"}, {"signorini"}, {time}};
    const double formed = tip_after(std::make_shared<const SemiDiscrete>(discretised(scene, 12, Formed())), methods,
                                    1e-5, 0.03, OperatorKind::band);
    CHECK(tip_after(problem_of(scene, 12, {"reciprocal"}), methods, 1e-5, 0.03, OperatorKind::band) ==
          Approx(formed).margin(1e-10));
  }
}

TEST_CASE("reciprocal: an explicit step is said to be a product") {
  auto program = compiled(problem_of(working_set(), 6, {"reciprocal"}),
                          {{"reciprocal"}, {"signorini"}, {"cd-lagrange"}}, 1e-5, {.kind = OperatorKind::band});
  REQUIRE(std::holds_alternative<Program>(program));
  const Program& made = std::get<Program>(program);
  CHECK(made.kind == OperatorKind::band);
  CHECK(std::any_of(made.left_out.begin(), made.left_out.end(), [](const LeftOut& left) {
    return left.reason.find("a stage is a product with it") != std::string::npos;
  }));
}
