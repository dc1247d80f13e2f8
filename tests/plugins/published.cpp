// What others published of their computations, and this program's answer to each. See studies/findings/published.md.
#include <ricochet/measure/contact/impact_recorder.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

/// The largest force at the only contact point, and when it acts.
struct LargestForce final : StepObserver {
  double force = 0, time = 0;
  void stage_solved(const Marcher&, const StageView& view) override {
    if (!view.effort || std::abs(view.effort[0][0]) <= force) return;
    force = std::abs(view.effort[0][0]);
    time = view.to;
  }
  void step_done(Marcher&) override {}
};

Choice spring_stop(double stiffness) {
  return {"penalty", {{"stiffness", stiffness}, {"evaluation", std::string("averaged")}}};
}

}  // namespace

TEST_CASE("code_aster SDND101: force, instants, duration and impulse of shocks on a spring") {
  SceneSpec scene;
  scene.structure = OscillatorSpec{100, 1e4, 0, {}};
  scene.stops.upper = Formula(0.0);
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.velocity = Formula(1.0);
  const double h = 1e-5, omega = std::sqrt(1.01e6 / 100), pi = std::acos(-1.0);
  const Methods methods{{"consistent"}, spring_stop(1e6), {"newmark", {{"beta", 0.25}}}};
  const auto run = [&](double duration) {
    Marcher march = marcher(scene, 1, methods, h);
    LargestForce largest;
    ImpactRecorder recorder(march);
    march.start({&largest, &recorder});
    march.march(std::llround(duration / h) - march.step(), {&largest, &recorder});
    recorder.finish(march);
    return std::pair(largest, recorder.impacts(0));
  };
  // Printed to four digits; the force itself to order (ωh)², its instant to a step.
  const auto [first, one] = run(0.1);
  CHECK(first.force == Approx(1e6 / omega).epsilon((omega * h) * (omega * h)));
  CHECK(first.force == Approx(9950).margin(0.5));
  CHECK(first.time == Approx(0.01563).margin(5e-6 + h));
  const auto [both, shocks] = run(0.45);
  REQUIRE(shocks.size() == 2);
  const Impact& second = shocks[1];
  CHECK(second.time + second.duration / 2 == Approx(0.361).margin(5e-4));
  CHECK(second.time == Approx(pi / omega + pi / 10).margin(2 * h));
  CHECK(second.duration == Approx(0.03126).margin(5e-6 + 2 * h));
  CHECK(second.impulse == Approx(2 * 1e6 / (omega * omega)).epsilon(1e-5));
  // The published impulse is 1.5e-4 above the closed form 2Kv/ω²: its last two digits are the other program's.
  CHECK(second.impulse == Approx(198.05).epsilon(2e-4));
}

TEST_CASE("code_aster SDNL104 A: a cantilever that a force presses on a spring stop") {
  BeamSpec beam;
  beam.length = 1;
  beam.young = 1e10;
  beam.density = 1e6;
  beam.section.type = Section::Type::circle;
  beam.section.diameter = 0.2;
  SceneSpec scene;
  scene.structure = beam;
  scene.stops.lower = Formula(-1e-4);
  scene.stops.place = StopsSpec::Place::tip;
  scene.load.terms.push_back({true, 1.0, {}, Formula(-1e3)});
  // Its scheme is this one, its step 1e-4 s: the numbers are those of that step, and agree as far as they are printed.
  const double h = 1e-4;
  CompileOptions options;
  options.kind = OperatorKind::band;
  Marcher march = marcher(scene, 10, {{"consistent"}, spring_stop(1e8), {"newmark", {{"beta", 0.25}}}}, h, options);
  march.start();
  const auto to = [&](double t) { march.march(std::llround(t / h) - march.step()); };
  // Slots q, v, a; dof 18 is the displacement of the tip.
  const auto slot = [&](int j, int dof) { return march.slot(j)[static_cast<std::ptrdiff_t>(dof) * march.width()]; };
  to(0.1315);
  CHECK(march.tip(0) == Approx(-1.85334e-6).margin(1e-11));
  to(0.1566);
  CHECK(slot(1, 18) == Approx(-4.63284e-3).margin(1e-8));
  to(0.16);
  Eigen::VectorXd v(20);
  for (int i = 0; i < 20; ++i) v[i] = slot(1, i);
  CHECK(0.5 * v.dot(dense_mass(march.program().problem->inertia) * v) == Approx(0.05140814).margin(2e-7));
}

TEST_CASE("Siconos BouncingBallTS: the same positions, bounce after bounce, until it rests") {
  constexpr double e = 0.9, h = 5e-3, g = 9.81;
  SceneSpec scene;
  scene.structure = OscillatorSpec{1, 0, 0, {}};
  scene.stops.lower = Formula(0.0);
  scene.stops.place = StopsSpec::Place::tip;
  scene.load = Formula(-g);
  scene.initial.displacement = Formula(1.0);
  Marcher ball =
      marcher(scene, 1, {{"consistent"}, {"signorini"}, {"moreau-jean", {{"theta", 0.5}, {"restitution", e}}}}, h);
  ball.start();
  // That program's step: on an active point, foreseen below the ground half a step ahead, v⁺ + e v⁻ ≥ 0.
  double q = 1, v = 0, apart = 0, bounces = 0;
  while (ball.step() < 2000) {
    double after = v - h * g;
    if (q + h / 2 * v <= 0 && after < -e * v) {
      after = -e * v;
      bounces += v < 0;
    }
    q += h / 2 * (v + after);
    v = after;
    ball.march(1);
    // Chattering ends at 19√(2/g) = 8.6 s; the interval between bounces falls below a step at 5.6 s.
    if (ball.time() < 5) apart = std::max(apart, std::abs(ball.tip(0) - q));
  }
  CHECK(bounces > 20);
  CHECK(apart < 1e-12);
  // At rest both lie within the last step's fall, gh²; where, the end of the chattering leaves open.
  CHECK(std::abs(ball.tip(0) - q) < g * h * h);
}
