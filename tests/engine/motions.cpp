// Supports that move by histories: as the harmonic support does, as closed forms say, and as forces of inertia.
#include <Eigen/Eigenvalues>
#include <array>
#include <numbers>
#include <ricochet/scene/history/time_history.hpp>

#include "tests/allocations.hpp"
#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

constexpr double pi = std::numbers::pi;

std::shared_ptr<const PiecewiseCubic> sine(double amplitude, double pulsation, double end) {
  TimeTable table;
  constexpr int pieces = 6000;
  for (int i = 0; i <= pieces; ++i) {
    table.times.push_back(end * i / pieces);
    table.values.push_back(amplitude * std::sin(pulsation * table.times.back()));
  }
  table.between = TimeTable::Between::cubic;
  return std::make_shared<const PiecewiseCubic>(PiecewiseCubic::interpolate(table));
}

OscillatorSpec sprung_mass(double mass, double stiffness) {
  OscillatorSpec spec;
  spec.mass = mass;
  spec.stiffness = stiffness;
  return spec;
}

SceneSpec shaken() {
  SceneSpec scene;
  scene.structure = sprung_mass(43.8e3, 3.942e7);
  TimeTable table;
  table.times = {0, 0.025, 0.05, 10};
  table.values = {0, 9.81, 0, 0};
  scene.motions = {{{}, std::make_shared<const PiecewiseCubic>(PiecewiseCubic::integrate_twice(table, 0, 0))}};
  scene.from_supports = true;
  return scene;
}

}  // namespace

// φ = A sin ωt as a table has no curvature at its ends where ωT is a multiple of π. Its spline is off by A (ωδ)⁴/77.
TEST_CASE("a tabulated motion marches as the harmonic support of the same motion, stops included") {
  const double omega = 26, end = 6 * pi / omega, h = end / 4000;
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-4;
  scene.initial = {};
  scene.initial.velocity = Formula(0.01 * omega);
  scene.stops.lower = Formula(-0.02);
  scene.stops.upper = Formula(0.03);
  const Methods methods = GENERATE(
      Methods{{"singular"}, {"signorini"}, {"newmark-dumont-paoli"}},
      Methods{{"consistent"}, {"signorini"}, {"moreau-jean"}},
      Methods{{"consistent"}, {"kelvin-voigt", {{"stiffness", 1e5}, {"viscosity", 5.0}}}, {"newmark"}},
      Methods{{"consistent"}, {"penalty", {{"stiffness", 1e5}, {"evaluation", std::string("averaged")}}}, {"newmark"}},
      Methods{
          {"consistent"}, {"penalty", {{"stiffness", 1e5}, {"evaluation", std::string("conserving")}}}, {"midpoint"}},
      Methods{{"consistent"}, {"signorini"}, {"laursen-love"}});
  INFO(methods.time.name << ", " << methods.contact.name);
  SceneSpec harmonic = scene;
  harmonic.support = {0.01, omega, 0};
  SceneSpec table = scene;
  table.support = {};
  table.motions = {{{}, sine(0.01, omega, end)}};
  Marcher a = marcher(harmonic, 6, methods, h), b = marcher(table, 6, methods, h);
  const EnergyAudit first = audited(a, end - h), second = audited(b, end - h);
  CHECK(first.contact(0).impacts > 2);
  CHECK(first.contact(0).impacts == second.contact(0).impacts);
  // Loads differ by (ωδ)²/12 of themselves, 8e-7; impacts make some hundred times of it.
  const double size = a.position(0).norm();
  CHECK((a.position(0) - b.position(0)).norm() <= 2e-4 * size);
  CHECK(b.tip(0) == Approx(a.tip(0)).margin(2e-4 * 0.03));
  const EnergyTotals &x = first.totals(0), &y = second.totals(0);
  const double scale = x.brought_in();
  CHECK(y.work_of_loads == Approx(x.work_of_loads).margin(1e-3 * scale));
  CHECK(y.work_of_contact == Approx(x.work_of_contact).margin(1e-3 * scale));
  CHECK(y.balance_residual() == Approx(x.balance_residual()).margin(1e-6 * scale));
  CHECK(b.penetration(0) == Approx(a.penetration(0)).margin(1e-6));
}

// code_aster, SDLL06: a mass on a spring whose base follows a triangle of acceleration; relative displacements.
TEST_CASE("a base that follows an acceleration in straight pieces moves a mass as the closed form says") {
  const double h = 1e-5, m = 43.8e3, k = 3.942e7, w = std::sqrt(k / m);
  Marcher made = marcher(shaken(), 1, {{"consistent"}, {"none"}, {"newmark", {{"beta", 1.0 / 12}}}}, h);
  made.start();
  // −a(t) = −s t, +2 s (t − t₁), −s (t − t₂) from these times on; a ramp moves u'' + w²u = r t by r (t − sin wt/w)/w².
  const double s = 9.81 / 0.025;
  const auto exact = [&](double t) {
    double u = 0;
    for (const auto& [from, slope] : {std::pair{0.0, -s}, std::pair{0.025, 2 * s}, std::pair{0.05, -s}})
      if (t > from) u += slope * ((t - from) - std::sin(w * (t - from)) / w) / (w * w);
    return u;
  };
  const std::array<std::pair<double, double>, 4> printed{
      {{0.01, -6.510633e-5}, {0.03, -1.6793173e-3}, {0.05, -5.3160395e-3}, {0.075, -7.7793738e-3}}};
  for (const auto& [t, u] : printed) {
    made.march(std::llround(t / h) - made.step());
    CHECK(made.position(0)[0] == Approx(exact(t)).epsilon(1e-6));
    // Printed with four to eight digits.
    CHECK(exact(t) == Approx(u).epsilon(1e-6));
    // The frame is that of the supports.
    CHECK(made.tip(0) == made.position(0)[0]);
  }
}

TEST_CASE("without stops, relative motion is that of a force −m a(t), absolute motion adds the support's") {
  SceneSpec scene = shaken();
  scene.from_supports = false;
  const Methods methods{{"consistent"}, {"none"}, {"newmark"}};
  Marcher moved = marcher(scene, 1, methods, 1e-4);
  SceneSpec pushed;
  pushed.structure = scene.structure;
  pushed.load.terms.push_back(
      {true, std::nullopt, Formula(),
       Formula([motion = scene.motions[0].history](double t) { return -43.8e3 * motion->acceleration(t); }, "f", "")});
  Marcher forced = marcher(pushed, 1, methods, 1e-4);
  run(moved, 0.2);
  run(forced, 0.2);
  CHECK(moved.position(0)[0] == Approx(forced.position(0)[0]).epsilon(1e-12));
  const double lift = scene.motions[0].history->value(0.2);
  CHECK(moved.tip(0) == Approx(forced.tip(0) + lift).epsilon(1e-12));
}

TEST_CASE("stops that move with the supports see the displacement from these") {
  SceneSpec scene = shaken();
  std::get<OscillatorSpec>(scene.structure).damping = 1e4;
  scene.stops.lower = Formula(-4e-3);
  scene.stops.upper = Formula(4e-3);
  scene.stops.place = StopsSpec::Place::tip;
  const Methods methods{{"consistent"}, {"penalty", {{"stiffness", 1e8}}}, {"newmark"}};
  scene.stops.moves_with = "base";
  Marcher carried = marcher(scene, 1, methods, 1e-5);
  scene.stops.moves_with = "";
  // Far away of stops that stay behind: the base leaves them.
  Marcher left = marcher(scene, 1, methods, 1e-5);
  const EnergyAudit one = audited(carried, 0.2), other = audited(left, 0.2);
  CHECK(one.contact(0).impacts >= 2);
  CHECK(std::abs(carried.position(0)[0]) < 4.3e-3);
  // The base leaves the stop behind: two springs in series share the way, but for the vibration.
  const double way = scene.motions[0].history->value(0.2) - 4e-3;
  CHECK(left.position(0)[0] == Approx(-way * 1e8 / (1e8 + 3.942e7)).epsilon(0.1));
}

TEST_CASE("motions allocate nothing while marching") {
  SceneSpec scene = shaken();
  scene.stops.upper = Formula(1e-3);
  scene.stops.place = StopsSpec::Place::tip;
  Marcher made = marcher(scene, 1, {{"consistent"}, {"penalty", {{"stiffness", 1e8}}}, {"newmark"}}, 1e-4);
  made.start();
  made.march(100);
  const long before = allocations();
  made.march(900);
  CHECK(allocations() == before);
}

TEST_CASE("motions and stops name supports that there are") {
  SceneSpec scene = shaken();
  scene.motions[0].supports = {"bsae"};
  CHECK_THROWS_WITH(problem_of(scene, 1, {"consistent"}),
                    Catch::Contains("no support \"bsae\"; did you mean \"base\"?"));
  scene.motions[0].supports = {"base"};
  scene.motions.push_back(scene.motions[0]);
  CHECK_THROWS_WITH(problem_of(scene, 1, {"consistent"}), Catch::Contains("motions/0 moves the support \"base\" too"));
  scene = shaken();
  scene.support.amplitude = 1;
  CHECK_THROWS_WITH(problem_of(scene, 1, {"consistent"}), Catch::Contains("support and motions stand together"));
  scene = {};
  scene.structure = sprung_mass(1, 1);
  scene.stops.upper = Formula(1.0);
  scene.stops.moves_with = "base";
  CHECK_THROWS_WITH(problem_of(scene, 1, {"consistent"}), Catch::Contains("no support moves by motions"));
}

// Over a whole period 2/Δf of the load, in the stationary state, the mean square of u is Σ S(f) |H(f)|² Δf exactly.
TEST_CASE("the response to a random load has the root mean square of its spectrum, whatever the seed") {
  const double m = 2, w = 2 * pi * 10, zeta = 0.02, h = 1e-3;
  SpectrumSpec spectrum;
  spectrum.density = [](double) { return 4.0; };
  spectrum.from = 1;
  spectrum.to = 50;
  spectrum.lines = 980;
  double exact = 0;
  for (int i = 0; i < spectrum.lines; ++i) {
    const double omega = 2 * pi * (1 + (i + 0.5) * 0.05), real = m * (w * w - omega * omega),
                 imaginary = 2 * m * zeta * w * omega;
    exact += 4 * 0.05 / (real * real + imaginary * imaginary);
  }
  CHECK(std::sqrt(exact) == Approx(5.012995e-3).epsilon(1e-6));
  for (const std::uint64_t seed : {1, 2, 3}) {
    spectrum.seed = seed;
    const auto load = std::make_shared<const RandomLoad>(spectrum);
    SceneSpec scene;
    scene.structure = sprung_mass(m, m * w * w);
    std::get<OscillatorSpec>(scene.structure).damping = 2 * m * zeta * w;
    scene.load.terms.push_back(
        {true, std::nullopt, Formula(), Formula([load](double t) { return load->value(t); }, "F", "")});
    Marcher made = marcher(scene, 1, {{"consistent"}, {"none"}, {"newmark"}}, h);
    run(made, 40);
    double squares = 0;
    constexpr int steps = 40000;
    for (int i = 0; i < steps; ++i) {
      made.march(1);
      squares += made.position(0)[0] * made.position(0)[0];
    }
    // Newmark lowers the frequency by (ωh)²/24, 1.6e-4; a transient of e^{−50} is left.
    CHECK(std::sqrt(squares / steps) == Approx(std::sqrt(exact)).epsilon(1e-3));
  }
}

namespace {

/// A steam generator tube on four plates 1 m apart (structures of a study, example of a tube between plates).
SceneSpec tube_on_plates() {
  BeamSpec beam;
  beam.length = 3;
  beam.young = 2e11;
  beam.density = 8470;
  beam.section.type = Section::Type::tube;
  beam.section.outer_diameter = 0.01905;
  beam.section.wall = 0.00109;
  beam.damping = {4.566e-5, 7.95};
  beam.supports.emplace();
  for (int i = 0; i < 4; ++i)
    beam.supports->push_back({"plate" + std::to_string(i + 1), static_cast<double>(i), BeamSupport::Type::pinned});
  SceneSpec scene;
  scene.structure = beam;
  return scene;
}

std::shared_ptr<const PiecewiseCubic> shock() {
  TimeTable table;
  table.times = {0, 0.01, 0.02, 0.035, 0.05, 1};
  table.values = {0, 3, -2, 2.5, 0, 0};
  return std::make_shared<const PiecewiseCubic>(PiecewiseCubic::integrate_twice(table, 0, 0));
}

}  // namespace

TEST_CASE("a tube on four plates: frequencies, static modes, and what all of them sum to") {
  const auto problem = problem_of(tube_on_plates(), 48, {"consistent"});
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(Eigen::MatrixXd(problem->stiffness),
                                                                        dense_mass(problem->inertia));
  // Three spans of 1 m on pins, EI and ρS of the section; 16 elements a span leave 1e-6 of them.
  const std::array<double, 3> frequencies{48.5572, 62.2268, 90.8641};
  for (int k = 0; k < 3; ++k)
    CHECK(std::sqrt(modes.eigenvalues()[k]) / (2 * pi) ==
          Approx(frequencies[static_cast<std::size_t>(k)]).epsilon(2e-6));
  const Eigen::MatrixXd shapes = support_shapes(*problem, {0, 0.5, 1, 1.7, 3});
  CHECK(shapes(1, 1) == Approx(0.725).epsilon(1e-10));
  CHECK(shapes(2, 1) == Approx(1).epsilon(1e-12));
  CHECK(std::abs(shapes(2, 0)) < 1e-12);
  for (int i = 0; i < shapes.rows(); ++i) CHECK(shapes.row(i).sum() == Approx(1).epsilon(1e-10));
  CHECK((problem->support_loads.rowwise().sum() - problem->support_shape).norm() <=
        1e-10 * problem->support_shape.norm());
}

TEST_CASE("supports that move apart by one and the same history move a beam as all together do") {
  SceneSpec together = tube_on_plates();
  together.stops.lower = Formula(-1e-5);
  together.stops.upper = Formula(1e-5);
  together.stops.place = StopsSpec::Place::positions;
  together.stops.positions = {0.5, 1.5};
  together.stops.moves_with = "plate2";
  together.motions = {{{}, shock()}};
  SceneSpec apart = together;
  apart.motions = {{{"plate1", "plate3"}, shock()}, {{"plate2", "plate4"}, shock()}};
  const Methods methods{{"consistent"}, {"penalty", {{"stiffness", 5e5}}}, {"newmark"}};
  Marcher a = marcher(together, 12, methods, 2e-5), b = marcher(apart, 12, methods, 2e-5);
  const EnergyAudit first = audited(a, 0.1), second = audited(b, 0.1);
  CHECK(first.contact(0).impacts > 3);
  CHECK(first.contact(0).impacts == second.contact(0).impacts);
  // Round-off of static modes, some 1e-12, and what impacts make of it.
  CHECK((a.position(0) - b.position(0)).norm() <= 1e-8 * a.position(0).norm());
  CHECK(b.tip(0) == Approx(a.tip(0)).epsilon(1e-9));
  // The tip is shown absolute, in the middle of a span: with its motion less that of the plates.
  together.from_supports = true;
  Marcher relative = marcher(together, 12, methods, 2e-5);
  audited(relative, 0.1);
  CHECK(a.tip(0) - relative.tip(0) == Approx(shock()->value(0.1)).epsilon(1e-9));
}
