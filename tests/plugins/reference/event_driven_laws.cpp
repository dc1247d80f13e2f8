#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <ricochet/loader/catalogue.hpp>

#include "tests/plugins/reference/event_driven_problems.hpp"

namespace event_driven_tests {

TEST_CASE("impulses of the stops balance the momentum of the beam") {
  // Against the lift p = x²(3L − x)/(2L³), whose fourth derivative is zero:
  //   ∫P dt = ρS[⟨w_t,p⟩ + η⟨w,p⟩ + φ'⟨1,p⟩] + 3EI/L³ (∫w(L)dt + α[w(L)]) − t⟨f,p⟩, brackets from 0 to t.
  ReferenceProblem problem = free_problem(1e-4);
  problem.support_amplitude = 0.04;
  problem.support_pulsation = 30;
  problem.velocity = [](double x) { return 1.2 - 2 * x * x; };
  problem.damping_mass = 2;
  problem.load = [](double, double) { return -0.2; };
  problem.load_zero = false;
  SampleGrid grid{spread(0.4, 20000), {}, {}};
  const int cells = 400;
  for (int i = 0; i < cells; ++i)
    for (const double gauss : {-std::sqrt(1.0 / 12), std::sqrt(1.0 / 12)})
      grid.places.push_back((i + 0.5 + gauss) * length / cells);
  SampleGrid ends{{0, 0.4}, grid.places, {}};
  grid.places.clear();
  const SampledMotion fine = solved(problem, grid).motion;
  const SampledMotion shape = solved(problem, ends).motion;
  REQUIRE(fine.events.size() > 3);
  const auto against_lift = [&](const std::vector<double>& field, std::size_t row) {
    double sum = 0;
    for (std::size_t i = 0; i < ends.places.size(); ++i) {
      const double x = ends.places[i];
      sum += field[row * ends.places.size() + i] * x * x * (3 * length - x) / (2 * std::pow(length, 3));
    }
    return sum * length / (2 * cells);
  };
  // Displacements of w at both ends of time: u − φ.
  const double phi = 0.04 * std::sin(30 * 0.4), lift_mean = 3 * length / 8;
  double tip_integral = 0;
  for (std::size_t i = 1; i < fine.tip.size(); ++i) tip_integral += 0.5 * (fine.tip[i] + fine.tip[i - 1]) * 0.4 / 20000;
  tip_integral -= 0.04 / 30 * (1 - std::cos(30 * 0.4));
  const double expected =
      problem.inertia *
          (against_lift(shape.velocity, 1) - against_lift(shape.velocity, 0) +
           2 * (against_lift(shape.displacement, 1) - phi * lift_mean - against_lift(shape.displacement, 0))) +
      3 * problem.stiffness / std::pow(length, 3) * (tip_integral + 1e-4 * (fine.tip.back() - phi - fine.tip[0])) +
      0.4 * 0.2 * lift_mean;
  // Trapezes in t of a tip with kinks at impacts: about 3e-9 here.
  CHECK(fine.impulse.back() == Approx(expected).epsilon(3e-7));
  CHECK(fine.impulse.back() == Approx(shape.impulse.back()).epsilon(1e-12));
}

TEST_CASE("a beam that rests on its stop under its weight stays there, and weighs 3qL/8 − 3EIδ/L³") {
  const double load = 2.0, drop = GENERATE(0.0, 0.01);
  ReferenceProblem problem = still_problem(GENERATE(1e-4, 0.0));
  problem.load = [=](double, double) { return -load; };
  problem.load_zero = false;
  problem.lower = [=](double) { return -drop; };
  const double EI = problem.stiffness;
  REQUIRE(load < 72 * EI * 0.02 / std::pow(length, 4));
  const double reaction = 3 * load * length / 8 - 3 * EI * drop / std::pow(length, 3);
  REQUIRE(reaction > 0);
  problem.displacement = [=](double x) {
    const double L = length;
    return (-load * x * x * (6 * L * L - 4 * L * x + x * x) / 24 + reaction * x * x * (3 * L - x) / 6) / EI;
  };
  const ReferenceMotion found = solved(problem, {spread(2, 8), {1.0}, {}});
  // It has lain there from the start: nothing begins, and nothing ends.
  CHECK(found.motion.events.empty());
  for (std::size_t i = 0; i <= 8; ++i) {
    CHECK(std::abs(found.motion.tip[i] + drop) < 1e-12);
    CHECK(found.motion.impulse[i] == Approx(reaction * 0.25 * static_cast<double>(i)).epsilon(1e-9).margin(1e-12));
    CHECK(std::abs(found.motion.displacement[i] - problem.displacement(1.0)) < 1e-9);
  }
}

TEST_CASE("a constant load alone bends the beam as statics says") {
  ReferenceProblem problem = without_stops(still_problem(1e-2));
  problem.load = [](double x, double) { return 0.5 * x; };
  problem.load_zero = false;
  const SampledMotion motion = solved(problem, {{0, 10}, {}, {}}).motion;
  // Triangular load q x/L with q = L/2: 11qL⁴/(120EI). What is left of the start is e^{−34}.
  CHECK(motion.tip[1] == Approx(11 * 0.5 * length * std::pow(length, 4) / (120 * problem.stiffness)).epsilon(1e-9));
}

TEST_CASE("a tip held between two stops that meet never leaves them") {
  ReferenceProblem problem = forced_problem(0.05, 1e-4);
  problem.lower = problem.upper = [](double) { return 0.0; };
  const SampledMotion motion = solved(problem, {spread(1, 40), {}, {}}).motion;
  for (const double tip : motion.tip) CHECK(tip == 0);
  CHECK(*std::min_element(motion.impulse.begin(), motion.impulse.end()) < 0);
}

TEST_CASE("the motion is the mirrored one in the mirror, and scales with its scene") {
  const SampleGrid grid{spread(0.4, 8), {1.0}, {}};
  const SampledMotion motion = solved(free_problem(1e-4), grid).motion;

  ReferenceProblem mirrored = free_problem(1e-4);
  mirrored.displacement = [](double x) { return -0.04 * x * x; };
  mirrored.velocity = [](double x) { return 2 * x; };
  const SampledMotion mirror = solved(mirrored, grid).motion;
  REQUIRE(mirror.events.size() == motion.events.size());
  for (std::size_t i = 0; i < motion.events.size(); ++i) CHECK(mirror.events[i].side == -motion.events[i].side);
  for (std::size_t i = 0; i < motion.tip.size(); ++i) CHECK(std::abs(mirror.tip[i] + motion.tip[i]) < 1e-14);

  // All displacements times s, masses and stiffnesses times m, times over c.
  const auto scale = GENERATE(table<double, double, double>({{1e-6, 1, 1}, {1e5, 1, 1}, {1, 1e6, 1}, {1, 1, 1e3}}));
  const double s = std::get<0>(scale), m = std::get<1>(scale), c = std::get<2>(scale);
  ReferenceProblem scaled = free_problem(1e-4 / c);
  scaled.displacement = [=](double x) { return s * 0.04 * x * x; };
  scaled.velocity = [=](double x) { return -s * c * 2 * x; };
  scaled.lower = [=](double) { return -s * 0.1; };
  scaled.upper = [=](double) { return s * 0.1; };
  scaled.inertia *= m;
  scaled.stiffness *= m * c * c;
  SampleGrid times = grid;
  for (double& t : times.times) t /= c;
  const SampledMotion other = solved(scaled, times).motion;
  REQUIRE(other.events.size() == motion.events.size());
  // Events are isolated to 1e-12 of the displacement over the speed of the slowest impact, 0.17 m/s.
  for (std::size_t i = 0; i < motion.events.size(); ++i) {
    CHECK(std::abs(other.events[i].time * c - motion.events[i].time) < 1e-11);
    CHECK(other.events[i].velocity == Approx(s * c * motion.events[i].velocity).epsilon(1e-9));
  }
  for (std::size_t i = 0; i < motion.tip.size(); ++i) {
    CHECK(std::abs(other.tip[i] - s * motion.tip[i]) < s * 1e-11);
    CHECK(other.energy[i] == Approx(m * s * s * c * c * motion.energy[i]).epsilon(1e-9));
    CHECK(other.impulse[i] == Approx(m * s * c * motion.impulse[i]).epsilon(1e-9));
  }
}

TEST_CASE("a tip that starts on its stop") {
  ReferenceProblem problem = still_problem(1e-4);
  problem.lower = [](double) { return 0.0; };
  const double sign = GENERATE(-1.0, 1.0);
  problem.velocity = [=](double x) { return sign * x * x; };
  const SampledMotion motion = solved(problem, {spread(0.05, 100), {}, {}}).motion;
  if (sign < 0) {
    REQUIRE_FALSE(motion.events.empty());
    CHECK(motion.events[0].time == 0);
    CHECK(motion.events[0].velocity == Approx(-length * length));
    CHECK(motion.tip[1] == 0);
    CHECK(motion.impulse[1] > 0);
  } else {
    CHECK((motion.events.empty() || motion.events[0].time > 0.01));
    CHECK(motion.tip[1] > 0);
  }
}

TEST_CASE("what does not touch is linear: absent stops, absent law and stops out of reach agree") {
  const SampleGrid grid{spread(0.5, 10), {0.4, 1.1}, {}};
  ReferenceProblem out_of_reach = free_problem(1e-4), no_law = free_problem(1e-4), nowhere = free_problem(1e-4);
  out_of_reach.lower = [](double) { return -50.0; };
  out_of_reach.upper = [](double) { return 50.0; };
  no_law.contact_absent = true;
  nowhere.stops_at_tip = false;
  nowhere.stop_places = {};
  const SampledMotion expected = solved(without_stops(free_problem(1e-4)), grid).motion;
  CHECK(*std::max_element(expected.tip.begin(), expected.tip.end()) > 0.1);
  for (const ReferenceProblem& problem : {out_of_reach, no_law, nowhere}) {
    const SampledMotion motion = solved(problem, grid).motion;
    CHECK(motion.events.empty());
    for (std::size_t i = 0; i < expected.displacement.size(); ++i)
      CHECK(std::abs(motion.displacement[i] - expected.displacement[i]) < 1e-13);
  }
}

TEST_CASE("fields are those of the tip, and derive from each other") {
  // Three neighbouring places and times: w_xx and u_t by differences, of error 1e-6.
  const double d = 1e-3 * length, x = 1.1, t = 0.3, dt = 1e-5;
  const SampleGrid grid{{0, t - dt, t, t + dt}, {x - d, x, x + d, length * (1 - 1e-9)}, {}};
  for (const ReferenceProblem& problem : {free_problem(1e-4), forced_problem(0.06, 1e-4)}) {
    const SampledMotion motion = solved(problem, grid).motion;
    const auto u = [&](std::size_t time, std::size_t place) { return motion.displacement[4 * time + place]; };
    CHECK(motion.strain[4 * 2 + 1] == Approx((u(2, 0) - 2 * u(2, 1) + u(2, 2)) / (d * d)).epsilon(1e-4));
    CHECK(motion.velocity[4 * 2 + 1] == Approx((u(3, 1) - u(1, 1)) / (2 * dt)).epsilon(1e-4));
    for (std::size_t i = 1; i < 4; ++i) {
      CHECK(std::abs(u(i, 3) - motion.tip[i]) < 1e-8);
      CHECK(std::abs(motion.velocity[4 * i + 3] - motion.tip_velocity[i]) < 1e-6);
    }
    CHECK(u(0, 1) == problem.displacement(x));
  }
}

TEST_CASE("scenes without this reference are refused in a sentence") {
  using Catch::Contains;
  ReferenceProblem problem = free_problem(1e-4);
  problem.structure = "oscillator";
  CHECK_THAT(refused(problem), Contains("an oscillator"));
  problem = free_problem(1e-4);
  problem.right_fixed = true;
  CHECK_THAT(refused(problem), Contains("free at x = L"));
  problem = free_problem(1e-4);
  problem.other_beam = true;
  CHECK_THAT(refused(problem),
             Contains("supports, sections") && Contains("Use `event-driven-semi-discrete` or `self`"));
  problem = free_problem(1e-4);
  problem.stops_at_tip = false;
  problem.stop_places = {0.5, length};
  CHECK_THAT(refused(problem), Contains("at the tip only"));
  problem.stop_places = {length};
  CHECK(refused(problem).empty());
  problem = free_problem(1e-4);
  problem.contact_stiffness = 1e6;
  CHECK_THAT(refused(problem), Contains("compliant"));
  problem.contact_stiffness = 0;
  problem.contact_nonlinear = true;
  CHECK_THAT(refused(problem), Contains("compliant"));
  CHECK(refused(without_stops(problem)).empty());
  problem = free_problem(1e-4);
  problem.load_zero = problem.load_constant = false;
  problem.load = [](double, double t) { return std::sin(t); };
  CHECK_THAT(refused(problem), Contains("depends on time"));
  problem = free_problem(1e-4);
  problem.displacement = [](double x) { return 0.2 * x * x; };
  CHECK_THAT(refused(problem), Contains("beyond its stops"));
  problem.displacement = [](double x) { return 0.01 * x; };
  CHECK_THAT(refused(problem), Contains("does not follow the clamp"));
  problem.displacement = [](double) { return std::nan(""); };
  CHECK_THAT(refused(problem), Contains("not a finite number"));
  problem = forced_problem(0.05, 0);
  problem.support_pulsation = first_pulsation(problem);
  CHECK_THAT(refused(problem), Contains("undamped mode 1 of the free beam"));
  problem.damping_mass = 0.1;
  CHECK(refused(problem).empty());
  CHECK_THAT(refused(free_problem(0), {{"events", 1LL}}), Contains("chatters"));
}

TEST_CASE("what a reader should know is noted") {
  ReferenceProblem problem = free_problem(1e-4);
  const SampleGrid grid{{0, 0.1}, {}, {}};
  problem.restitution = 0.5;
  problem.projected = true;
  const ReferenceMotion found = solved(problem, grid);
  CHECK(mentions(found.notes, "restitution 0.5"));
  CHECK(mentions(found.notes, "projection"));
  CHECK(found.how.find("80 clamped–free modes") != std::string::npos);
  CHECK(mentions(solved(forced_problem(1e-3, 1e-4), {{0, 0.01}, {}, {}}).notes, "support moves") == false);
  problem = forced_problem(1e-6, 1e-4);
  problem.support_pulsation = 3e5;
  CHECK(mentions(solved(problem, {{0, 0.01}, {}, {}}).notes, "raise `modes`"));
}

}  // namespace event_driven_tests
