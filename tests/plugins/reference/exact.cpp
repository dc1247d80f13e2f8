#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/loader/catalogue.hpp>

#include "tests/plugins/reference/exact_problems.hpp"

namespace exact_tests {

TEST_CASE("flights solve the equation of motion in every regime of damping and forcing") {
  struct Regime {
    double stiffness, damping_mass, force_pulsation;
  };
  const auto [stiffness, damping_mass, force_pulsation] = GENERATE(
      Regime{4, 0, 1.3}, Regime{4, 0.2, 1.3}, Regime{4, 4, 1.3}, Regime{4, 4 * (1 - 1e-9), 1.3},
      Regime{4, 4 * (1 + 1e-9), 1.3}, Regime{4, 12, 1.3}, Regime{0, 0, 1.3}, Regime{0, 0.7, 1.3}, Regime{0, 0, 0},
      Regime{0, 0.7, 0}, Regime{0, 1e-9, 1e-3}, Regime{1e-12, 0, 1e-3}, Regime{1e-12, 5, 1e-3}, Regime{4, 0, 2},
      Regime{4, 0, 2 + 1e-9}, Regime{4, 1e-9, 2}, Regime{4, 0.01, 2.001}, Regime{4, 0, 0}, Regime{4, 4, 2});
  ReferenceProblem problem = oscillator(stiffness);
  problem.inertia = 1.5;
  problem.stiffness *= 1.5;
  problem.damping_mass = damping_mass;
  problem.damping_stiffness = 0.01;
  problem.force_amplitude = 0.8;
  problem.force_pulsation = force_pulsation;
  problem.force_phase = 0.4;
  problem.support_amplitude = 0.3;
  problem.support_pulsation = 1.7;
  problem.support_phase = 0.2;
  push(problem, -0.25);
  problem.displacement = constant(0.35);
  problem.velocity = constant(-0.5);
  INFO("k = " << stiffness << " η = " << damping_mass << " ω = " << force_pulsation);
  const auto motion = solved(problem, {times(6, 3), {}, {}});
  for (std::size_t i = 0; i < motion.tip.size(); ++i) {
    const auto [u, v] = by_small_steps(problem, 2.0 * static_cast<double>(i), 4000);
    // h⁴ of the small steps: 10⁻¹² per unit of a motion of size 5.
    CHECK(motion.tip[i] == Approx(u).margin(2e-11));
    CHECK(motion.tip_velocity[i] == Approx(v).margin(2e-11));
  }
}

TEST_CASE("a ball bounces by its laws and comes to rest in finite time") {
  const double e = GENERATE(0.5, 0.8, 0.95), gravity = 9.81, height = 0.7;
  ReferenceProblem problem = oscillator(0);
  push(problem, -gravity);
  problem.lower = constant(0);
  problem.restitution = e;
  problem.displacement = constant(height);
  const double drop = std::sqrt(2 * height / gravity), rest = drop * (1 + e) / (1 - e);
  SampleGrid grid;
  double start = drop, flight = 2 * e * drop;
  for (int n = 1; n <= 6; ++n, start += flight, flight *= e) {
    grid.times.push_back(start + 1e-9 * flight);
    grid.times.push_back(start + flight / 2);
  }
  grid.times.push_back(1.5 * rest);
  const auto motion = solved(problem, grid);
  for (std::size_t n = 1; n <= 6; ++n) {
    const double share = std::pow(e, 2.0 * static_cast<double>(n));
    // Read 10⁻⁹ of a flight after the impact.
    CHECK(motion.energy[2 * n - 2] == Approx(share * gravity * height).epsilon(1e-8));
    CHECK(motion.tip[2 * n - 1] == Approx(share * height).epsilon(1e-13));
    CHECK(motion.tip_velocity[2 * n - 1] == Approx(0).margin(1e-13));
  }
  CHECK(motion.tip.back() == 0);
  CHECK(motion.energy.back() == 0);
  // At rest at both ends of the motion: the stop gave what gravity took, through infinitely many impacts.
  CHECK(motion.impulse.back() == Approx(gravity * 1.5 * rest).epsilon(1e-13));
  REQUIRE(motion.events.size() > 20);
  CHECK(motion.events[0].begins);
  CHECK(motion.events[0].side == -1);
  CHECK(motion.events[0].velocity == Approx(-gravity * drop).epsilon(1e-14));
  double time = drop;
  for (std::size_t n = 0; n < 10; ++n, time += 2 * std::pow(e, static_cast<double>(n)) * drop)
    CHECK(motion.events[2 * n].time == Approx(time).epsilon(1e-14));
  CHECK(motion.events.back().begins);
  // Heights shrink by e² per bounce and are followed down to 10⁻¹⁵ of the first: times down to its root.
  CHECK(motion.events.back().time == Approx(rest).epsilon(1e-7 / (1 - e)));
  for (const double u : motion.tip) CHECK(u >= 0);
}

TEST_CASE("an elastic ball keeps its energy for a thousand bounces") {
  ReferenceProblem problem = oscillator(0);
  push(problem, -1);
  problem.lower = constant(0);
  problem.restitution = 1;
  problem.displacement = constant(0.5);
  // Dropped from ½ it lands at t = 1, 3, 5, …
  const auto motion = solved(problem, {times(2000, 8000), {}, {}});
  CHECK(motion.events.size() == 2000);
  for (std::size_t i = 0; i < motion.tip.size(); ++i) {
    const double t = std::remainder(0.25 * static_cast<double>(i), 2);
    // The time is a number of size 2000: 2·10⁻¹³.
    CHECK(motion.tip[i] == Approx(0.5 - t * t / 2).margin(1e-11));
  }
}

TEST_CASE("the impact oscillator returns to its period-1 orbit") {
  ReferenceProblem problem = oscillator(1);
  problem.force_amplitude = 1;
  problem.force_pulsation = 2.2;
  problem.force_phase = 2.9313971351;
  problem.upper = constant(0.1);
  problem.restitution = 0.8;
  problem.displacement = constant(0.1);
  problem.velocity = constant(-0.8 * 1.1953970360);
  const double period = 2 * M_PI / 2.2;
  const auto motion = solved(problem, {times(10.5 * period, 21), {}, {}});
  REQUIRE(motion.events.size() == 20);
  for (std::size_t n = 0; n < 10; ++n) {
    CHECK(motion.events[2 * n].side == 1);
    // The orbit is printed to ten decimals, and both of its multipliers have the size e = 0.8.
    CHECK(motion.events[2 * n].time == Approx((static_cast<double>(n) + 1) * period).margin(1e-9));
    CHECK(motion.events[2 * n].velocity == Approx(1.1953970360).margin(1e-9));
    CHECK(motion.impulse[2 * n + 3] - motion.impulse[2 * n + 1] == Approx(-1.8 * 1.1953970360).margin(1e-8));
  }
}

TEST_CASE("the chaotic impact oscillator has the Lyapunov exponent that is known") {
  ReferenceProblem problem = oscillator(1);
  problem.damping_mass = 0.1;
  problem.force_amplitude = 1;
  problem.force_pulsation = 2.8;
  problem.upper = constant(0);
  problem.restitution = 0.8;
  const double period = 2 * M_PI / 2.8, offset = 1e-7;
  const auto after = [&](std::array<double, 2> state) {
    problem.displacement = constant(state[0]);
    problem.velocity = constant(state[1]);
    const auto motion = solved(problem, {{0, period}, {}, {}});
    return std::array{motion.tip[1], motion.tip_velocity[1]};
  };
  std::array<double, 2> state{-0.3, 0.1}, direction{1, 0};
  double sum = 0;
  constexpr int transient = 100, periods = 3000;
  for (int n = 0; n < transient + periods; ++n) {
    const auto next = after(state), twin = after({state[0] + offset * direction[0], state[1] + offset * direction[1]});
    direction = {(twin[0] - next[0]) / offset, (twin[1] - next[1]) / offset};
    const double growth = std::hypot(direction[0], direction[1]);
    direction = {direction[0] / growth, direction[1] / growth};
    if (n >= transient) sum += std::log(growth);
    state = next;
  }
  // Known to 0.0008 from 300 times as many periods: the mean over 3000 scatters by √300 times that.
  CHECK(sum / (periods * period) == Approx(0.1566).margin(0.015));
}

TEST_CASE("contact with a spring lasts π/ω_d and goes v√(m/k) deep") {
  const double damping = GENERATE(0.0, 30.0);
  ReferenceProblem problem = oscillator(0);
  problem.inertia = 2;
  problem.damping_mass = damping;
  problem.upper = constant(0.3);
  problem.displacement = constant(0.3);
  problem.velocity = constant(1.7);
  problem.contact_stiffness = 5000;
  const double pulsation = std::sqrt(5000 / 2.0), damped = std::sqrt(pulsation * pulsation - damping * damping / 4);
  const double duration = M_PI / damped, speed = std::exp(-damping * duration / 2);
  SampleGrid grid{times(1.2 * duration, 1200), {}, {}};
  const auto motion = solved(problem, grid);
  REQUIRE(motion.events.size() == 2);
  CHECK(motion.events[0].time == 0);
  CHECK(motion.events[1].time == Approx(duration).epsilon(1e-13));
  CHECK(motion.impulse.back() ==
        Approx(2 * (motion.tip_velocity.back() - 1.7) + 2 * damping * (motion.tip.back() - 0.3)).epsilon(1e-13));
  if (damping == 0) {
    CHECK(*std::max_element(motion.tip.begin(), motion.tip.end()) == Approx(0.3 + 1.7 / pulsation).epsilon(1e-6));
    CHECK(motion.tip_velocity.back() == Approx(-1.7).epsilon(1e-13));
    for (const double energy : motion.energy) CHECK(energy == Approx(1.7 * 1.7).epsilon(1e-13));
  } else {
    CHECK(motion.tip_velocity[1000] == Approx(-1.7 * speed).epsilon(1e-12));
  }
}

TEST_CASE("stiffer springs tend to the elastic rigid stop") {
  ReferenceProblem problem = oscillator(1);
  problem.upper = constant(0.5);
  problem.displacement = constant(1e-3);
  problem.velocity = constant(1);
  problem.restitution = 1;
  const SampleGrid grid{times(20, 200), {}, {}};
  const auto rigid = solved(problem, grid);
  double before = 0;
  for (const double stiffness : {1e4, 1e6, 1e8, 1e10}) {
    problem.contact_stiffness = stiffness;
    const auto spring = solved(problem, grid);
    double gap = 0;
    for (std::size_t i = 0; i < grid.times.size(); ++i) gap = std::max(gap, std::abs(spring.tip[i] - rigid.tip[i]));
    // Each contact lasts π/√κ: the delay of six of them.
    CHECK(gap < 40 / std::sqrt(stiffness));
    if (before > 0) CHECK(before / gap == Approx(10).epsilon(0.3));
    before = gap;
  }
}

TEST_CASE("a mass that rests on its stop leaves it when the force turns") {
  ReferenceProblem problem = oscillator(0);
  push(problem, -3);
  problem.lower = constant(-0.2);
  problem.displacement = constant(-0.2);
  problem.force_amplitude = 5;
  problem.force_pulsation = 2;
  problem.force_phase = M_PI;
  const double lift = (M_PI - std::acos(0.6)) / 2, before = 0.9 * lift;
  const auto motion = solved(problem, {{0, before, lift + 0.2}, {}, {}});
  // It has lain there from the start, which is no impact.
  REQUIRE_FALSE(motion.events.empty());
  CHECK_FALSE(motion.events[0].begins);
  CHECK(motion.events[0].time == Approx(lift).epsilon(1e-14));
  CHECK(motion.tip[1] == -0.2);
  CHECK(motion.impulse[1] == Approx(3 * before + 2.5 * std::sin(2 * before)).epsilon(1e-13));
  CHECK(motion.tip[2] > -0.2);
  CHECK(motion.tip_velocity[2] ==
        Approx(-3 * 0.2 - 2.5 * (std::sin(2 * (lift + 0.2)) - std::sin(2 * lift))).epsilon(1e-12));
}

TEST_CASE("no impact is missed and none is invented at a grazing") {
  ReferenceProblem problem = oscillator(1);
  problem.velocity = constant(1);
  problem.restitution = 0.5;
  const SampleGrid grid{{0, 40}, {}, {}};
  problem.upper = constant(1 - 1e-12);
  CHECK(solved(problem, grid).events.size() > 0);
  problem.upper = constant(1 + 1e-12);
  CHECK(solved(problem, grid).events.empty());
}

TEST_CASE("impacts between two stops lose what restitution takes, and the stops give what momentum asks") {
  const double e = GENERATE(0.0, 0.3, 0.9, 1.0);
  ReferenceProblem problem = oscillator(0);
  problem.lower = constant(-1);
  problem.upper = constant(1);
  problem.velocity = constant(2);
  problem.restitution = e;
  const auto motion = solved(problem, {times(3, 30), {}, {}});
  double speed = 2;
  for (std::size_t n = 0; n < motion.events.size() && speed > 0; n += 2, speed *= e)
    CHECK(std::abs(motion.events[n].velocity) == Approx(speed).epsilon(1e-14));
  for (std::size_t i = 0; i < motion.tip.size(); ++i) {
    CHECK(std::abs(motion.tip[i]) <= 1 + 1e-15);
    CHECK(motion.impulse[i] == Approx(motion.tip_velocity[i] - 2).margin(1e-14));
  }
}

TEST_CASE("stops stand still while the support moves") {
  ReferenceProblem problem = oscillator(100);
  problem.damping_mass = 0.5;
  problem.support_amplitude = 0.2;
  problem.support_pulsation = 9;
  problem.lower = constant(-0.15);
  problem.upper = constant(0.1);
  problem.restitution = 0.6;
  const auto motion = solved(problem, {times(20, 4000), {0.5}, {1}});
  CHECK(motion.events.size() > 20);
  for (std::size_t i = 0; i < motion.tip.size(); ++i) {
    const double t = 20.0 * static_cast<double>(i) / 4000;
    CHECK(motion.tip[i] >= -0.15 - 1e-14);
    CHECK(motion.tip[i] <= 0.1 + 1e-14);
    const double w = motion.tip[i] - 0.2 * std::sin(9 * t), rate = motion.tip_velocity[i] - 1.8 * std::cos(9 * t);
    CHECK(motion.energy[i] == Approx(0.5 * rate * rate + 50 * w * w).epsilon(1e-12));
    CHECK(motion.displacement[i] == motion.tip[i]);
  }
}

TEST_CASE("what has no closed form is refused with the reference that applies") {
  ReferenceProblem problem = oscillator(1);
  problem.contact_nonlinear = true;
  CHECK(refusal(problem).find("self") != std::string::npos);
  problem = oscillator(1);
  problem.load_zero = problem.load_constant = false;
  CHECK(refusal(problem).find("self") != std::string::npos);
}

}  // namespace exact_tests
