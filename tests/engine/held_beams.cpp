// Beams on several supports, and on none, in motion.
#include <ricochet/scene/assembly.hpp>

#include "tests/marching.hpp"
#include "tests/scene/beam_numbers.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

double at(const Marcher& made, double x) {
  return (displacement_rows(made.program().problem->space, {x}) * made.position(0))(0);
}

// Three spans that a central pulse throws against bars in the outer ones.
SceneSpec struck_spans() {
  SceneSpec scene = held_beam(3, pinned_at_each(3));
  beam_of(scene).damping.stiffness = 1e-4;
  scene.stops = {Formula(-0.001), Formula(0.001), StopsSpec::Place::positions, {0.5, 1.5, 2.5}};
  scene.load.terms = {{.force = true, .at = 1.5, .shape = Formula(), .history = Formula("20*sin(12*t)", "", "t")}};
  return scene;
}

}  // namespace

TEST_CASE("a symmetric beam moves symmetrically, whatever mass and law") {
  for (const Choice& mass : {Choice{"consistent"}, Choice{"singular"}, Choice{"lumped"}})
    for (const Choice& law : {Choice{"signorini"}, Choice{"penalty", {{"stiffness", 1e5}}}}) {
      INFO(mass.name << " " << law.name);
      const double h = 1e-4;
      Marcher made = marcher(struck_spans(), 24, {mass, law, {"newmark-dumont-paoli"}}, h);
      const EnergyAudit audit = audited(made, 0.5);
      CHECK(audit.contact(0).impacts > 0);
      // Symmetry is that of the equations; what is left is round-off, which impacts of a chaotic motion may amplify.
      for (const double x : {0.25, 0.5, 1.25}) CHECK(at(made, x) == Approx(at(made, 3 - x)).margin(1e-9));
      CHECK(std::abs(at(made, 1)) == 0);
    }
}

TEST_CASE("a beam that nothing holds flies as one: w = v t, w = ω t (x − L/2)") {
  for (const OperatorKind kind : {OperatorKind::band, OperatorKind::sparse})
    for (const char* velocity : {"2", "x-0.5"}) {
      SceneSpec scene = held_beam(1, {});
      scene.initial.velocity = Formula(velocity, "", "x");
      CompileOptions options;
      options.kind = kind;
      Marcher made = marcher(scene, 8, {{"consistent"}, {"none"}, {"newmark", {{"beta", 0.25}}}}, 1e-3, options);
      run(made, 0.5);
      const Formula exact(velocity, "", "x");
      // Rounding of K (12EI/ℓ³ against M) over 500 steps.
      for (const double x : {0.0, 0.3, 1.0}) CHECK(at(made, x) == Approx(0.5 * exact(x)).margin(1e-8));
    }
}

TEST_CASE("a pinned beam whose supports move together: the closed form of its modes") {
  // φ = A sin ωt: w_n'' + ω_n² w_n = Γ_n A ω² sin ωt with Γ_n sin(nπx), Γ_n = 4/(nπ) for odd n, from w = 0 and
  // w_t = −φ'(0) as everything is at rest.
  const double A = 1e-3, omega = 7, t = 0.4, x = 0.3;
  SceneSpec scene = held_beam(1, {pinned("a", 0), pinned("b", 1)});
  scene.support = {A, omega, 0};
  double exact = A * std::sin(omega * t);
  for (int n = 1; n < 60; n += 2) {
    const double own = std::pow(n * std::numbers::pi, 2), gamma = 4 / (n * std::numbers::pi);
    const double forced = gamma * A * omega * omega / (own * own - omega * omega);
    const double rate = -gamma * A * omega - forced * omega;
    exact += std::sin(n * std::numbers::pi * x) * (forced * std::sin(omega * t) + rate / own * std::sin(own * t));
  }
  Marcher made = marcher(scene, 40, {{"consistent"}, {"none"}, {"newmark", {{"beta", 0.25}}}}, 1e-5);
  run(made, t);
  // A velocity that the supports impose on what rests: modes of all n, 1/n³ of the sum; those above 20 h-steps are
  // late.
  CHECK(at(made, x) + made.support(0, t) == Approx(exact).margin(2e-3 * A));
}

TEST_CASE("a foundation moves with the supports: a free beam on one is an oscillator on a moving base") {
  // w'' + k_f/ρS w = −φ'' with ρS = 1, from rest.
  const double A = 1e-3, omega = 7, own = 20, t = 0.4, h = 1e-5;
  SceneSpec scene = held_beam(1, {});
  beam_of(scene).foundation = own * own;
  scene.support = {A, omega, 0};
  const double forced = A * omega * omega / (own * own - omega * omega);
  const double exact = forced * std::sin(omega * t) - (A + forced) * omega / own * std::sin(own * t);
  Marcher made = marcher(scene, 6, {{"consistent"}, {"none"}, {"newmark", {{"beta", 0.25}}}}, h);
  run(made, t);
  // The trapezoidal rule is late by (own h)²/12 of a phase of 8: 3e-8.
  for (const double x : {0.0, 0.4, 1.0}) CHECK(at(made, x) == Approx(exact).margin(1e-6 * A));
}
