#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/checks.hpp>

#include "tests/eigen.hpp"
#include "tests/marching.hpp"
#include "tests/plugins/reference/semi_discrete_problems.hpp"

namespace event_driven_semi_discrete_tests {

TEST_CASE("one dof moves as its closed form says") {
  SECTION("forced, damped, on a moving support, between rigid stops") {
    OneDof one(90, 1.3);
    one.problem.damping_mass = 0.4;
    one.problem.damping_stiffness = 1e-3;
    one.problem.force_amplitude = 12;
    one.problem.force_pulsation = 7;
    one.problem.force_phase = 0.3;
    one.problem.support_amplitude = 0.05;
    one.problem.support_pulsation = 3;
    one.problem.support_phase = 0.7;
    push(one.problem, -2);
    one.problem.lower = constant(-0.12);
    one.problem.upper = constant(0.1);
    one.problem.displacement = constant(0.02);
    one.problem.velocity = constant(-1);
    one.problem.restitution = GENERATE(0.0, 0.6, 1.0);
    // Differences grow at impacts; the motion is followed for about ten of them.
    agree(one, 3, 1e-9);
  }
  SECTION("the same on springs") {
    OneDof one(90, 1.3);
    one.problem.damping_mass = 0.4;
    one.problem.damping_stiffness = GENERATE(0.0, 1e-3);
    one.problem.force_amplitude = 12;
    one.problem.force_pulsation = 7;
    push(one.problem, -2);
    one.problem.lower = constant(-0.12);
    one.problem.upper = constant(0.1);
    one.problem.velocity = constant(-1);
    one.problem.contact_stiffness = GENERATE(1e3, 1e6);
    agree(one, 3, 1e-9);
  }
  SECTION("a ball that comes to rest") {
    OneDof one(0);
    push(one.problem, -9.81);
    one.problem.lower = constant(0);
    one.problem.displacement = constant(0.7);
    const double e = 0.5;
    one.problem.restitution = e;
    const SampleGrid grid{times(2, 400), {}, {}};
    const auto a = found(one.whole(), grid).motion, b = found(one.whole(), grid, "exact").motion;
    // The chattering ends at bounces of 10⁻¹⁴ m here and 10⁻¹⁵ of the first there.
    for (std::size_t i = 0; i < grid.times.size(); ++i) {
      CHECK(a.tip[i] == Approx(b.tip[i]).margin(1e-12));
      CHECK(a.impulse[i] == Approx(b.impulse[i]).margin(1e-6));
    }
    CHECK(a.impulse.back() == Approx(2 * 9.81).epsilon(1e-12));
  }
}

TEST_CASE("a singular mass keeps the energy of projected data through every contact") {
  const auto velocity = GENERATE(std::string("P1"), std::string("P0"));
  const auto place = GENERATE(StopsSpec::Place::tip, StopsSpec::Place::nodes);
  SceneSpec scene = projected(working_set());
  scene.stops.place = place;
  Case beam(scene, 8, {"singular", {{"velocity", velocity}}});
  const SampleGrid grid{times(0.4, 400), {}, {}};
  const SampledMotion motion = found(beam.problem, grid).motion;
  if (velocity == "P1") CHECK(motion.energy[0] / line_density(scene) == Approx(3.542).margin(5e-4));
  CHECK(motion.events.size() > 10);
  for (std::size_t i = 0; i < grid.times.size(); ++i) {
    // Round-off of a stiffness matrix whose frequencies span 10³ (its condition number is 10⁶).
    CHECK(motion.energy[i] == Approx(motion.energy[0]).epsilon(1e-10));
    CHECK(std::abs(motion.tip[i]) <= 0.1 + 1e-14);
  }
}

TEST_CASE("stops push only while they are touched, and only away") {
  SceneSpec scene = projected(working_set());
  beam_of(scene).damping.stiffness = GENERATE(0.0, 1e-4);
  Case beam(scene, 8, {"singular"});
  const SampleGrid grid{times(0.4, 2000), {}, {}};
  const SampledMotion motion = found(beam.problem, grid).motion;
  for (std::size_t i = 1; i < grid.times.size(); ++i) {
    double touched = 0, side = 0;  // share of the interval
    for (std::size_t k = 0; k < motion.events.size(); k += 2) {
      const double from = motion.events[k].time, to = k + 1 < motion.events.size() ? motion.events[k + 1].time : 1;
      REQUIRE(motion.events[k].begins);
      const double shared = std::min(to, grid.times[i]) - std::max(from, grid.times[i - 1]);
      if (shared > 0) {
        touched += shared;
        side = motion.events[k].side;
      }
    }
    const double pushed = motion.impulse[i] - motion.impulse[i - 1];
    INFO("t = " << grid.times[i]);
    if (touched == 0) CHECK(pushed == 0);
    CHECK(-side * pushed >= 0);
    if (touched > 0.99 * (grid.times[i] - grid.times[i - 1])) CHECK(motion.tip[i] == Approx(0.1 * side).margin(1e-13));
  }
}

TEST_CASE("impulses balance momentum") {
  // c = K⁻¹Hᵀ/(H K⁻¹ Hᵀ): the tip alone works on it, cᵀKw = (stiffness of the tip)·(its displacement).
  const auto mass =
      GENERATE(Choice{"singular"}, Choice{"singular", {{"velocity", std::string("P0")}}}, Choice{"consistent"});
  const double alpha = GENERATE(0.0, 1e-4), spring = GENERATE(0.0, 1e5);
  SceneSpec scene = projected(working_set());
  beam_of(scene).damping.stiffness = alpha;
  Case beam(scene, 4, mass);
  beam.problem.contact_stiffness = spring;
  beam.problem.restitution = 0.4;
  const Eigen::VectorXd bent = eigen::ldlt_solve(beam.discrete.stiffness, beam.discrete.contact.transpose());
  const double stiffness = 1 / (beam.discrete.contact * bent)[0];
  beam.discrete.places = (beam.discrete.mass * bent * stiffness).transpose();
  beam.discrete.strains = beam.discrete.places;
  constexpr std::size_t count = 4000;
  const double end = 0.1;
  const SampledMotion motion = found(beam.problem, {times(end, count), {0.5}, {1}}).motion;
  REQUIRE(motion.events.size() >= 2);
  double bend = 0;
  for (std::size_t i = 0; i < count; ++i) bend += end / count * (motion.tip[i] + motion.tip[i + 1]) / 2;
  const double gained = motion.velocity[count] - motion.velocity[0];
  const double held = stiffness * (bend + alpha * (motion.tip[count] - motion.tip[0]));
  INFO(mass.name << " α = " << alpha << " κ = " << spring);
  // The integral of the tip by trapezoids of 25 µs, where its velocity jumps.
  CHECK(motion.impulse[count] == Approx(gained + held).epsilon(1e-5));
}

TEST_CASE("the schemes tend to it as the step is refined") {
  SceneSpec scene = projected(working_set());
  scene.stops.place = GENERATE(StopsSpec::Place::tip, StopsSpec::Place::nodes);
  const double amplitude = GENERATE(0.0, 0.05);
  scene.support.amplitude = amplitude;
  scene.support.pulsation = 30;
  if (amplitude > 0) scene.initial.velocity = Formula("1.5 - 4*x", "/scene/initial/velocity", "x");
  beam_of(scene).damping.stiffness = 1e-4;
  beam_of(scene).damping.mass = 0.3;
  scene.load = Formula(-0.2);
  const bool compliant = GENERATE(false, true);
  Case beam(scene, 6, {"singular"});
  Methods methods;
  methods.time.values = {{"beta", 0.5}};
  if (compliant) {
    methods.contact = {"penalty", {{"stiffness", 2e3}, {"evaluation", std::string("implicit")}}};
    beam.problem.contact_stiffness = 2e3;
  }
  const SampleGrid grid{times(0.2, 50), {}, {}};
  const SampledMotion exact = found(beam.problem, grid).motion;
  REQUIRE(exact.events.size() >= 4);
  std::vector<double> log_h, log_error;
  for (const double h : {1e-4, 5e-5, 2.5e-5, 1.25e-5}) {
    Marcher marched = marcher(scene, 6, methods, h);
    marched.start();
    double worst = 0;
    for (std::size_t i = 1; i < grid.times.size(); ++i) {
      marched.march(std::llround(grid.times[i] / h) - marched.step());
      worst = std::max(worst, std::abs(marched.tip(0) - exact.tip[i]));
    }
    log_h.push_back(std::log(h));
    log_error.push_back(std::log(worst));
  }
  const double order = fitted_slope(log_h, log_error);
  INFO("order " << order << ", error " << std::exp(log_error.back()));
  CHECK(order > 0.9);
  // Speeds of 4 m/s, and a step's worth of delay at each of about ten events.
  CHECK(std::exp(log_error.back()) < 60 * 1.25e-5);
}

}  // namespace event_driven_semi_discrete_tests
