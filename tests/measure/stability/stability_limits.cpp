#include <fmt/format.h>

#include <ricochet/measure/stability/stability.hpp>
#include <ricochet/measure/stability/step_map.hpp>
#include <ricochet/measure/stability/structure_physics.hpp>

#include "tests/amplification_roots.hpp"
#include "tests/marching.hpp"
#include "tests/measure/stability/marched_steps.hpp"

namespace stability_tests {

TEST_CASE("central differences need h below 0.0334014 ℓ² √(ρS/EI)") {
  const SceneSpec scene = working_set();
  const double wave = std::sqrt(282.8125);  // √(EI/ρS) of the working set
  for (const int elements : {10, 40}) {
    const auto problem = problem_of(scene, elements, {"consistent"});
    const auto predicted = predictor(problem, {"signorini"});
    const double length = 1.501 / elements, exact = 0.0334014193 * length * length / wave;
    const StepLimit limit = open_limit(predicted, dumont_paoli(0), decades(1e-8, 1e-3));
    REQUIRE(limit.step);
    // The constant is that of a long beam; 10 elements miss it by 1.6e-6. Bisection adds 1e-6.
    CHECK(*limit.step == Approx(exact).epsilon(5e-6));
    CHECK(limit.beyond->mode == "mode " + std::to_string(2 * elements) + " of " + std::to_string(2 * elements) + " (" +
                                    fmt::format("{:.4g}", last_pulsation(*problem)) + " rad/s)");
    CHECK(limit.beyond->root.real() < -1);
    CHECK_FALSE(limit.below_range);
    // Unconditionally stable schemes have none.
    CHECK_FALSE(open_limit(predicted, dumont_paoli(0.25), decades(1e-8, 1e-3)).step);
    // A range that begins beyond the limit still finds it.
    const StepLimit below = open_limit(predicted, dumont_paoli(0), decades(1e-2, 1e-1));
    REQUIRE(below.step);
    CHECK(below.below_range);
    CHECK(*below.step == Approx(exact).epsilon(5e-6));
  }
}

TEST_CASE("each scheme's limit is what it declares, over the largest pulsation of the structure") {
  const auto problem = problem_of(working_set(), 6, {"consistent"});
  const auto predicted = predictor(problem, {"signorini"});
  for (const double beta : {0.0, 0.1, 0.2}) {
    for (const Choice& time : {dumont_paoli(beta), Choice{"newmark", {{"beta", beta}}}}) {
      const double declared = *plan(time, 1e-5).facts.stability_limit;
      const StepLimit limit = open_limit(predicted, time, decades(1e-6, 1e-2));
      REQUIRE(limit.step);
      // Bisection to 1e-6.
      CHECK(*limit.step == Approx(declared / last_pulsation(*problem)).epsilon(3e-6));
    }
  }
}

TEST_CASE("a point mass on an explicit spring is stable up to 2√(m/(k(1−4β)+κ))") {
  const double m = 2, k = 3e4;
  for (const double beta : {0.0, 0.25, 0.5})
    for (const double stiffness : {1e5, 1e9}) {
      const auto predicted = predictor(point_mass(m, k), penalty(stiffness, "explicit"));
      const StepLimit limit = closed_limit(predicted, dumont_paoli(beta), decades(1e-7, 1));
      REQUIRE(limit.step);
      CHECK(*limit.step == Approx(2 * std::sqrt(m / (k * (1 - 4 * beta) + stiffness))).epsilon(3e-6));
      CHECK(limit.beyond->contact == "the contact point");
    }
  // Averaged over the levels of K q the spring only adds to k, and β = ¼ has no limit.
  for (const double stiffness : {1e5, 1e9, 1e14}) {
    const auto predicted = predictor(point_mass(m, k), penalty(stiffness, "averaged"));
    CHECK_FALSE(closed_limit(predicted, dumont_paoli(0.25), decades(1e-7, 1)).step);
    const StepLimit limit = closed_limit(predicted, dumont_paoli(0.1), decades(1e-8, 1));
    REQUIRE(limit.step);
    CHECK(*limit.step == Approx(2 * std::sqrt(m / ((k + stiffness) * (1 - 4 * 0.1)))).epsilon(3e-6));
    // At the end of the step it damps.
    CHECK_FALSE(
        closed_limit(predictor(point_mass(m, k), penalty(stiffness, "implicit")), dumont_paoli(0.25), decades(1e-7, 1))
            .step);
  }
}

TEST_CASE("limits scale with the units of the problem") {
  // Length × a, mass × b, time × c of every datum: the limit is × c.
  const double a = 1e3, b = 1e-4, c = 1e-2;
  SceneSpec scene = unit_beam(), scaled = unit_beam();
  auto& beam = beam_of(scaled);
  beam.length *= a;
  beam.section.EI *= b * a * a * a / (c * c);
  beam.section.rhoS *= b / a;
  scaled.stops.lower = Formula(-0.1 * a);
  scaled.stops.upper = Formula(0.1 * a);
  const double stiffness = 500;
  const auto limit = [&](const SceneSpec& one, double spring, double time) {
    const auto predicted = predictor(problem_of(one, 5, {"consistent"}), penalty(spring, "explicit"));
    return closed_limit(predicted, dumont_paoli(0.25), decades(1e-5 * time, 10 * time)).step;
  };
  const auto here = limit(scene, stiffness, 1), there = limit(scaled, stiffness * b / (c * c), c);
  REQUIRE(here);
  REQUIRE(there);
  CHECK(*there == Approx(c * *here).epsilon(5e-6));
}

TEST_CASE("marginal roots are named, with where they live") {
  const double h = 1e-5;
  const auto marginal = [&](const Choice& mass, double alpha, const Choice& time, const Choice& contact, bool open) {
    const auto problem = problem_of(damped_scene(alpha), 6, mass);
    const auto predicted = predictor(problem, contact);
    const StepPlan step = plan(time, h);
    return known(open ? predicted.open(step, h) : predicted.worst_closed(step, h));
  };
  const Choice singular{"singular", {{"velocity", std::string("P1")}}}, consistent{"consistent"}, rigid{"signorini"};

  // β = ¼ on the kernel of a singular mass: double, hence linear growth; with viscosity one root stays at −1.
  const StepSpectrum quarter = marginal(singular, 0, dumont_paoli(0.25), rigid, true);
  CHECK(quarter.marginal == "double root −1 on the kernel of the mass (6 times): grows linearly");
  CHECK(quarter.grows_linearly);
  CHECK(quarter.stable());
  const StepSpectrum sawtooth = marginal(singular, 1e-4, dumont_paoli(0.25), rigid, true);
  CHECK(sawtooth.marginal == "root −1 on the kernel of the mass (6 times)");
  CHECK_FALSE(sawtooth.grows_linearly);
  // ¼ < β ≤ ½: on the unit circle without viscosity, inside with.
  CHECK_THAT(marginal(singular, 0, dumont_paoli(0.5), rigid, true).marginal, Contains("roots ±i on the kernel"));
  CHECK_THAT(marginal(singular, 0, dumont_paoli(0.3), rigid, true).marginal, Contains("roots of modulus 1 at ±13"));
  CHECK(marginal(singular, 1e-4, dumont_paoli(0.5), rigid, true).marginal.empty());
  // Newmark's accelerations: its own kernel, and the same recursion at a point that is held.
  CHECK_THAT(marginal(singular, 0, {"newmark", {}}, rigid, true).marginal, Contains("double root −1 on the kernel"));
  const StepSpectrum held = marginal(consistent, 0, {"newmark", {}}, rigid, false);
  CHECK(held.marginal == "double root −1 on the held points: grows linearly");
  CHECK(marginal(consistent, 0, {"newmark", {{"beta", 0.4}, {"gamma", 0.6}}}, rigid, false).marginal.empty());
  // q_{n+1} + e q_{n−1} = 0 at the point: roots ±i√e.
  CHECK(marginal(consistent, 0, dumont_paoli(0.5, 1), rigid, false).marginal == "roots ±i on the held points");
  CHECK(marginal(consistent, 0, dumont_paoli(0.5, 0.9), rigid, false).marginal.empty());
  CHECK(marginal(consistent, 0, {"moreau-jean", {}}, rigid, false).marginal == "root +1 on the held points");
  // A regular mass has nothing of the kind: its undamped modes are the motion itself.
  for (const double beta : {0.0, 0.25, 0.5})
    for (const double alpha : {0.0, 1e-4})
      if (beta > 0) CHECK(marginal(consistent, alpha, dumont_paoli(beta), rigid, true).marginal.empty());
}

TEST_CASE("a spring stiffens the step of the structure as the theory of one mode says") {
  // One dof of the beam's kind: κ added to k where the spring is averaged as K is.
  const double m = 1, k = 100, stiffness = 700, h = 0.03;
  const StepPlan step = plan(dumont_paoli(0.3), h);
  const auto predicted = predictor(point_mass(m, k), penalty(stiffness, "averaged"));
  const auto alone = amplification_roots(step, m, 0, k + stiffness);
  const StepSpectrum closed = known(predicted.closed(step, h, predicted.sets()[0]));
  CHECK(closed.radius == Approx(std::abs(alone[0])).epsilon(1e-9));
  CHECK(std::abs(std::arg(closed.root)) == Approx(std::abs(std::arg(alone[0]))).epsilon(1e-7));
}

TEST_CASE("free structures have steps too") {
  // A mass without spring moves on: the double root +1 is the motion and not a flaw.
  for (const double k : {0.0, 1e3})
    for (const Choice& time : {dumont_paoli(0.25), Choice{"newmark", {}}, Choice{"moreau-jean", {}}}) {
      const double h = 1e-3;
      const auto predicted = predictor(point_mass(2, k), {"signorini"});
      const StepSpectrum open = known(predicted.open(plan(time, h), h));
      INFO(time.name << " k " << k);
      CHECK(open.radius == Approx(1).epsilon(1e-12));
      CHECK(open.marginal.empty());
      CHECK(predicted.first_pulsation() == Approx(std::sqrt(k / 2)));
      CHECK_NOTHROW(known(predicted.worst_closed(plan(time, h), h)));
    }
}

TEST_CASE("a bar that nothing holds keeps its step, one mode of it drifting") {
  SceneSpec scene;
  BarSpec bar;
  bar.fixed = BarSpec::Fixed::none;
  scene.structure = bar;
  scene.stops.lower = Formula(-0.1);
  scene.stops.place = StopsSpec::Place::tip;
  const int elements = 8;
  const auto problem = problem_of(scene, elements, {"consistent"});
  const auto predicted = predictor(problem, {"signorini"});
  CHECK(predicted.first_pulsation() == 0);
  // Consistent linear elements: λ_max = 12 EA/(ρA ℓ²).
  CHECK(last_pulsation(*problem) == Approx(std::sqrt(12.0) * elements).epsilon(1e-10));
  const double h = 1e-3;
  for (const Choice& time : {dumont_paoli(0.25), Choice{"newmark", {}}, Choice{"moreau-jean", {}}}) {
    const StepSpectrum open = known(predicted.open(plan(time, h), h));
    CHECK(open.radius == Approx(1).epsilon(1e-10));
    CHECK(open.marginal.empty());
    CHECK(known(predicted.worst_closed(plan(time, h), h)).stable());
  }
  const StepLimit limit = open_limit(predicted, dumont_paoli(0), decades(1e-4, 1));
  REQUIRE(limit.step);
  CHECK(*limit.step == Approx(2 / (std::sqrt(12.0) * elements)).epsilon(3e-6));
}

TEST_CASE("closed sets: each point and all of them, or what says why not") {
  SceneSpec scene = working_set();
  scene.stops.place = StopsSpec::Place::nodes;
  const auto few = predictor(problem_of(scene, 6, {"consistent"}), {"signorini"});
  REQUIRE(few.sets().size() == 7);
  CHECK(few.sets().front().name == "x = 1.501 m");
  CHECK(few.sets().back().name == "all 6 points");
  const auto many = predictor(problem_of(scene, 40, {"consistent"}), {"signorini"});
  CHECK(many.sets().size() == 3);
  CHECK(predictor(problem_of(scene, 6, {"consistent"}), {"none"}).sets().empty());
  scene.stops.place = StopsSpec::Place::tip;
  const auto large = predictor(problem_of(scene, 90, {"consistent"}), {"signorini"});
  CHECK(large.sets().empty());
  REQUIRE(large.notes().size() == 1);
  CHECK_THAT(large.notes()[0], Contains("180 dofs"));
  // No effort moves the position of an explicit step: it is no measure, which is said.
  const double h = 1e-6;
  const auto explicit_newmark = few.worst_closed(plan({"newmark", {{"beta", 0.0}}}, h), h);
  REQUIRE(std::holds_alternative<Refusal>(explicit_newmark));
  CHECK_THAT(std::get<Refusal>(explicit_newmark).sentence.text, Contains("no impact measure"));
}

}  // namespace stability_tests
