#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <ricochet/loader/catalogue.hpp>

#include "tests/plugins/reference/event_driven_problems.hpp"

namespace event_driven_tests {

TEST_CASE("free damped beam: every impact, release, velocity and energy of the semi-analytic solution") {
  const double E0 = 2.0 / 3 * std::pow(length, 3) + 0.5 * 282.8125 * 0.0064 * length;
  const ReferenceProblem problem = free_problem(1e-4);
  const auto modes = GENERATE(40LL, 80LL, 160LL);
  const ReferenceMotion found = solved(problem, {{0, 0.4}, {}, {}}, {{"modes", modes}});
  const std::vector<ContactEvent> table = {{0.0487745646, -1, true, -3.85453013}, {0.0598140489, -1, false, 0},
                                           {0.1592507858, +1, true, +1.39190292}, {0.1666838954, +1, false, 0},
                                           {0.1684825520, +1, true, +0.16964822}, {0.1710816835, +1, false, 0},
                                           {0.2582968934, -1, true, -1.13119883}, {0.2697290967, -1, false, 0},
                                           {0.3645463046, +1, true, +1.16836297}, {0.3720931374, +1, false, 0}};
  // Half a unit of the last digit printed, and a little.
  for (const SampledMotion* motion : {&found.motion, &found.coarser}) {
    REQUIRE(motion->events.size() == table.size());
    for (std::size_t i = 0; i < table.size(); ++i) {
      CHECK(motion->events[i].side == table[i].side);
      CHECK(motion->events[i].begins == table[i].begins);
      CHECK(std::abs(motion->events[i].time - table[i].time) < 0.7e-10);
      CHECK(std::abs(motion->events[i].velocity - table[i].velocity) < 0.7e-8);
    }
    CHECK(std::abs(motion->tip[1] - 0.060859417359) < 0.7e-12);
    CHECK(std::abs(motion->energy[1] / problem.inertia - 1.55776753366) < 0.7e-11);
    // The formulas at t = 0 are read, not summed; the last printed digit of EI/ρS leaves 1e-12.
    CHECK(motion->energy[0] / problem.inertia == Approx(E0).epsilon(1e-10));
  }
  CHECK(found.notes.empty());
}

TEST_CASE("period-1 orbits of the forced beam, from rest") {
  struct Orbit {
    double amplitude, tip;
    std::vector<double> impacts;
  };
  const auto orbit = GENERATE(
      Orbit{0.080, -0.01991978, {1.209644, 0.213837, 0.636535, 1.045161, -1.209644, -0.213837, -0.636535, -1.045161}},
      Orbit{0.086, -0.02583080, {1.582296, 0.914187, 0.915527, -1.255223}},
      Orbit{0.099, -0.01112840, {0.748404, 1.199867, -0.748404, -1.199867}});
  const double period = 2 * pi / 10;
  // Transients are below 1e-9 after 60 periods, those at 0.086 being the longest.
  const ReferenceMotion found =
      solved(forced_problem(orbit.amplitude, 1e-4), {{0, 80 * period, 81 * period}, {}, {}}, {{"modes", 40LL}});
  const SampledMotion& motion = found.motion;
  CHECK(std::abs(motion.tip[1] - orbit.tip) < 0.7e-8);
  CHECK(std::abs(motion.tip[2] - motion.tip[1]) < 1e-9);
  std::vector<double> impacts;
  for (const ContactEvent& event : motion.events)
    if (event.begins && event.time > 80 * period) impacts.push_back(event.velocity);
  REQUIRE(impacts.size() == orbit.impacts.size());
  for (std::size_t i = 0; i < impacts.size(); ++i) CHECK(std::abs(impacts[i] - orbit.impacts[i]) < 0.7e-6);
}

TEST_CASE("the grazing amplitude of the undamped beam separates motions that touch from motions that do not") {
  ReferenceProblem problem = still_problem(0);
  const SteadyShape shape(problem);
  const double z = length * shape.wave;
  const double grazing = 0.1 * (1 + std::cos(z) * std::cosh(z)) / (std::cos(z) + std::cosh(z));
  CHECK(std::abs(z - 1.157460134878) < 1e-12);
  CHECK(std::abs(grazing - 0.0791792098) < 0.6e-10);
  const auto steady = [&](double amplitude) {
    ReferenceProblem moving = problem;
    moving.support_amplitude = amplitude;
    moving.velocity = [=](double x) { return 10 * amplitude * shape(x); };
    return moving;
  };
  const double quarter = 2 * pi / 40;
  const SampleGrid grid{{0, quarter, 2 * quarter, 3 * quarter, 50 * quarter}, {0.5, 1.2}, {}};
  const ReferenceMotion free = solved(without_stops(steady(grazing)), grid);
  for (std::size_t i = 0; i < grid.times.size(); ++i) {
    // Modes left out of the sum: about 1e-11 of the tip at 80 modes.
    CHECK(std::abs(free.motion.tip[i] - 0.1 * std::sin(10 * grid.times[i])) < 1e-10);
    for (std::size_t j = 0; j < 2; ++j)
      CHECK(std::abs(free.motion.displacement[2 * i + j] -
                     grazing * shape(grid.places[j]) * std::sin(10 * grid.times[i])) < 1e-10);
  }
  // One part in 10⁸ below and above.
  CHECK(solved(steady(grazing * (1 - 1e-8)), grid).motion.events.empty());
  const ReferenceMotion touching = solved(steady(grazing * (1 + 1e-8)), grid, {{"modes", 40LL}});
  REQUIRE_FALSE(touching.motion.events.empty());
  CHECK(std::abs(touching.motion.events[0].time - quarter) < 1e-4);
  CHECK(touching.motion.events[0].side == 1);
}

TEST_CASE("one mode alone swings, creeps or does both, as its damping says") {
  ReferenceProblem problem = without_stops(still_problem(0));
  const double omega = first_pulsation(problem);
  CHECK(omega == Approx(26.244522).epsilon(2e-8));
  // αω/2: under, exactly at and above critical; η alone; both.
  const auto [ratio, eta] = GENERATE(table<double, double>({{0, 0}, {1e-3, 0}, {1, 0}, {3, 0}, {0, 40}, {0.2, 3}}));
  problem.damping_stiffness = 2 * ratio / omega;
  problem.damping_mass = eta;
  problem.displacement = [](double x) { return 0.05 * first_mode(x); };
  problem.velocity = [](double x) { return 0.3 * first_mode(x); };
  const SampleGrid grid{spread(0.5, 20), {0.7}, {}};
  const ReferenceMotion found = solved(problem, grid);
  const double zeta = 0.5 * (problem.damping_stiffness * omega * omega + eta), y0 = 0.05, v0 = 0.3;
  const std::complex<double> split = std::sqrt(std::complex<double>(zeta * zeta - omega * omega));
  const bool critical = std::abs(split) < 1e-5 * omega;
  for (std::size_t i = 0; i < grid.times.size(); ++i) {
    const double t = grid.times[i];
    const double expected =
        critical ? std::exp(-zeta * t) * (y0 + (v0 + zeta * y0) * t)
                 : std::real(std::exp(-zeta * t) *
                             (y0 * std::cosh(split * t) + (v0 + zeta * y0) * std::sinh(split * t) / split));
    // Round-off of the quadrature of 80 modes; the critical case is within 1e-16 of the confluent formula.
    CHECK(std::abs(found.motion.tip[i] - expected) < 1e-13);
    CHECK(std::abs(found.motion.displacement[i] - expected * first_mode(0.7)) < 1e-13);
  }
}

TEST_CASE("without damping and contact the energy stays what it is at the start") {
  // The initial displacement is bent at the free end: modes left out hold 0.2 % of its energy, and keep it.
  const ReferenceProblem problem = without_stops(free_problem(0));
  const ReferenceMotion found = solved(problem, {spread(0.4, 50), {}, {}});
  for (const double energy : found.motion.energy) CHECK(energy == Approx(found.motion.energy[0]).epsilon(1e-12));
  CHECK(mentions(found.notes, "bends the beam at its free end"));
  for (const double impulse : found.motion.impulse) CHECK(impulse == 0);
}

TEST_CASE("undamped contact: slow convergence that is said, energy that never grows") {
  const ReferenceProblem problem = free_problem(0);
  const ReferenceMotion found = solved(problem, {spread(0.1, 400), {}, {}}, {{"modes", 40LL}});
  CHECK(mentions(found.notes, "converge slowly"));
  REQUIRE(found.motion.events.size() > 2);
  // Before the first impact only the start is truncated.
  CHECK(std::abs(found.motion.events[0].time - found.coarser.events[0].time) < 3e-6);
  for (std::size_t i = 1; i < found.motion.energy.size(); ++i)
    CHECK(found.motion.energy[i] <= found.motion.energy[i - 1] * (1 + 1e-12));
  // Finer modes keep more of it.
  CHECK(found.motion.energy.back() > found.coarser.energy.back());
  CHECK(found.motion.energy.back() > 0.9 * found.motion.energy[0]);
}

TEST_CASE("the tip stays between its stops, and a stop only pushes") {
  const auto forced = GENERATE(false, true);
  const ReferenceProblem problem = forced ? forced_problem(0.095, 1e-4) : free_problem(1e-4);
  const SampleGrid grid{spread(1.5, 6000), {}, {}};
  const SampledMotion motion = solved(problem, grid).motion;
  REQUIRE(motion.events.size() > 8);
  std::size_t event = 0;
  int side = 0;
  bool flown = false, held = false;
  for (std::size_t i = 1; i < grid.times.size(); ++i) {
    bool changed = false;
    for (; event < motion.events.size() && motion.events[event].time <= grid.times[i]; ++event) {
      side = motion.events[event].begins ? motion.events[event].side : 0;
      changed = true;
    }
    // The hair by which the sum of 80 modes may pass a stop after a release; 40 leave eight times as much.
    CHECK(std::abs(motion.tip[i]) <= 0.1 + 1e-8);
    if (side != 0) CHECK(motion.tip[i] == 0.1 * side);
    if (side != 0) CHECK(motion.tip_velocity[i] == 0);
    if (changed) continue;
    // Round-off of an impulse that is the difference of two momenta.
    const double push = motion.impulse[i] - motion.impulse[i - 1];
    if (side == 0) CHECK(push == 0);
    if (side != 0) CHECK(push * -side > -1e-13);
    (side == 0 ? flown : held) = true;
  }
  CHECK(flown);
  CHECK(held);
  if (!forced)
    for (std::size_t i = 1; i < grid.times.size(); ++i) CHECK(motion.energy[i] <= motion.energy[i - 1]);
}

}  // namespace event_driven_tests
