// Closed forms: the impact oscillator and the bar of period 3, against laws that they obey.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <ricochet/loader/catalogue.hpp>

using namespace ricochet;

namespace exact_tests {

namespace {

const ReferenceSolver& exact() {
  static Catalogue catalogue(RICOCHET_PLUGIN_DIR, {}, {});
  static Registry registry;
  static const std::unique_ptr<ReferenceSolver> solver = [] {
    REQUIRE(catalogue.require(Role::reference, "exact", registry));
    return registry.reference("exact")->make(Parameters());
  }();
  return *solver;
}

SampledMotion solved(const ReferenceProblem& problem, const SampleGrid& grid) {
  auto found = exact().solve(problem, grid);
  INFO((std::holds_alternative<Refusal>(found) ? std::get<Refusal>(found).sentence : ""));
  REQUIRE(std::holds_alternative<ReferenceMotion>(found));
  SampledMotion motion = std::get<ReferenceMotion>(std::move(found)).motion;
  CHECK(motion.tip.size() == grid.times.size());
  CHECK(motion.tip_velocity.size() == grid.times.size());
  CHECK(motion.energy.size() == grid.times.size());
  CHECK(motion.impulse.size() == grid.times.size());
  CHECK(motion.displacement.size() == grid.times.size() * grid.places.size());
  return motion;
}

std::string refusal(const ReferenceProblem& problem) {
  const auto found = exact().solve(problem, {{0, 1}, {}, {}});
  const auto* refused = std::get_if<Refusal>(&found);
  return refused ? refused->sentence : std::string();
}

std::vector<double> times(double end, int count) {
  std::vector<double> result;
  for (int i = 0; i <= count; ++i) result.push_back(end * i / count);
  return result;
}

std::function<double(double)> constant(double value) {
  return [value](double) { return value; };
}

/// Unit mass, without stops, at rest.
ReferenceProblem oscillator(double stiffness) {
  ReferenceProblem problem;
  problem.structure = "oscillator";
  problem.inertia = 1;
  problem.stiffness = stiffness;
  problem.displacement = problem.velocity = constant(0);
  problem.lower = constant(-INFINITY);
  problem.upper = constant(INFINITY);
  problem.stop_places = {0};
  problem.stops_at_tip = true;
  return problem;
}

void push(ReferenceProblem& problem, double load) {
  problem.load_zero = false;
  problem.load = [load](double, double) { return load; };
}

/// m w'' + c w' + k w = F cos(ωt + ψ) + load − m φ'' by the classical fourth-order method: u and u' at `end`.
std::array<double, 2> by_small_steps(const ReferenceProblem& problem, double end, int steps) {
  const double A = problem.support_amplitude, pulsation = problem.support_pulsation;
  const auto turn = [&](double t) { return pulsation * t + problem.support_phase; };
  const double viscosity = problem.damping_mass * problem.inertia + problem.damping_stiffness * problem.stiffness;
  const auto slope = [&](double t, std::array<double, 2> x) {
    double force = problem.force_amplitude * std::cos(problem.force_pulsation * t + problem.force_phase);
    if (problem.load) force += problem.load(0, t);
    force += problem.inertia * A * pulsation * pulsation * std::sin(turn(t));
    return std::array{x[1], (force - viscosity * x[1] - problem.stiffness * x[0]) / problem.inertia};
  };
  const auto moved = [](std::array<double, 2> x, double h, std::array<double, 2> k) {
    return std::array{x[0] + h * k[0], x[1] + h * k[1]};
  };
  std::array<double, 2> x{problem.displacement(0) - A * std::sin(turn(0)),
                          problem.velocity(0) - A * pulsation * std::cos(turn(0))};
  const double h = end / steps;
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    const auto k1 = slope(t, x), k2 = slope(t + h / 2, moved(x, h / 2, k1)), k3 = slope(t + h / 2, moved(x, h / 2, k2)),
               k4 = slope(t + h, moved(x, h, k3));
    for (int j = 0; j < 2; ++j) x[j] += h / 6 * (k1[j] + 2 * k2[j] + 2 * k3[j] + k4[j]);
  }
  return {x[0] + A * std::sin(turn(end)), x[1] + A * pulsation * std::cos(turn(end))};
}

}  // namespace

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

namespace {

ReferenceProblem bar(double length, double EA, double rhoA, bool fixed_right) {
  ReferenceProblem problem;
  problem.structure = "bar";
  problem.length = length;
  problem.stiffness = EA;
  problem.inertia = rhoA;
  problem.left_fixed = !fixed_right;
  problem.right_fixed = fixed_right;
  problem.displacement = problem.velocity = constant(0);
  problem.lower = constant(-INFINITY);
  problem.upper = constant(INFINITY);
  problem.stop_places = {fixed_right ? 0 : length};
  problem.stops_at_tip = true;
  return problem;
}

SampleGrid bar_grid(double length, double end, int count, int cells) {
  SampleGrid grid{times(end, count), {}, {}};
  for (int i = 0; i < cells; ++i) {
    grid.places.push_back(length * (i + 0.5) / cells);
    grid.weights.push_back(length / cells);
  }
  return grid;
}

/// ½∫ρA u_t² + ½∫EA u_x² of sample k from its fields.
double field_energy(const ReferenceProblem& problem, const SampleGrid& grid, const SampledMotion& motion,
                    std::size_t k) {
  double sum = 0;
  for (std::size_t i = 0; i < grid.places.size(); ++i) {
    const std::size_t at = k * grid.places.size() + i;
    sum += grid.weights[i] / 2 *
           (problem.inertia * std::pow(motion.velocity[at], 2) + problem.stiffness * std::pow(motion.strain[at], 2));
  }
  return sum;
}

}  // namespace

TEST_CASE("the bar of unit length bounces with period 3, energy ⅛ and stress ½") {
  ReferenceProblem problem = bar(1, 1, 1, true);
  problem.displacement = [](double x) { return (1 - x) / 2; };
  problem.lower = constant(0);
  // Fronts sit at τ and 1 − τ, between the places whenever τ is a multiple of 1/20.
  const SampleGrid grid = bar_grid(1, 9, 180, 20);
  const SampledMotion motion = solved(problem, grid);
  REQUIRE(motion.events.size() == 6);
  for (std::size_t n = 0; n < 3; ++n) {
    CHECK(motion.events[2 * n].time == Approx(1 + 3 * static_cast<double>(n)));
    CHECK(motion.events[2 * n].velocity == -0.5);
    CHECK(motion.events[2 * n + 1].time == Approx(2 + 3 * static_cast<double>(n)));
  }
  for (std::size_t k = 0; k < grid.times.size(); ++k) {
    const double t = grid.times[k];
    INFO("t = " << t);
    CHECK(motion.energy[k] == 0.125);
    CHECK(field_energy(problem, grid, motion, k) == Approx(0.125).epsilon(1e-12));
    CHECK(motion.tip[k] >= 0);
    // Momentum ∫u_t is what the stop gave and the clamp took: −u_x there.
    if (k == 0) continue;
    double clamp = 0;
    for (std::size_t j = 0; j < k; ++j) clamp += 0.05 * motion.strain[j * 20 + 19];
    double momentum = 0;
    for (std::size_t i = 0; i < 20; ++i) momentum += 0.05 * motion.velocity[k * 20 + i];
    // The strain at the last place changes up to 1/40 later than at the clamp, by at most 1.
    CHECK(momentum == Approx(motion.impulse[k] + clamp).margin(0.06));
  }
  CHECK(motion.impulse.back() == Approx(1.5).epsilon(1e-14));
  // Back where it was.
  for (std::size_t i = 0; i < 20; ++i)
    CHECK(motion.displacement[60 * 20 + i] == Approx(motion.displacement[i]).margin(1e-14));
}

TEST_CASE("the bouncing bar scales with its length, stiffness and inertia, and turns with its ends") {
  const bool right = GENERATE(true, false);
  const double sign = GENERATE(1.0, -1.0), L = 2.5, EA = 40, rhoA = 0.1, a = 0.03, unit = L / 20;
  ReferenceProblem one = bar(1, 1, 1, true), other = bar(L, EA, rhoA, right);
  one.displacement = [](double x) { return (1 - x) / 2; };
  one.lower = constant(0);
  other.displacement = [=](double x) { return sign * a * (right ? L - x : x) / L; };
  (sign > 0 ? other.lower : other.upper) = constant(0);
  const SampleGrid grid = bar_grid(1, 7, 23, 9), stretched = bar_grid(L, 7 * unit, 23, 9);
  const SampledMotion x = solved(one, grid), y = solved(other, stretched);
  REQUIRE(x.events.size() == y.events.size());
  CHECK(y.events[0].time == Approx(unit));
  CHECK(y.events[0].velocity == Approx(-sign * a / unit));
  CHECK(y.events[0].side == -sign);
  for (std::size_t k = 0; k < grid.times.size(); ++k) {
    CHECK(y.tip[k] == Approx(2 * a * sign * x.tip[k]).margin(1e-14));
    CHECK(y.tip_velocity[k] == Approx(2 * a / unit * sign * x.tip_velocity[k]).margin(1e-12));
    CHECK(y.energy[k] == Approx(0.5 * EA * a * a / L));
    CHECK(y.impulse[k] == Approx(sign * 2 * a * EA / 20 * x.impulse[k]).margin(1e-13));
    for (std::size_t i = 0; i < 9; ++i) {
      const std::size_t from = k * 9 + i, to = k * 9 + (right ? i : 8 - i);
      CHECK(y.displacement[to] == Approx(2 * a * sign * x.displacement[from]).margin(1e-14));
      CHECK(y.strain[to] == Approx((right ? 1 : -1) * 2 * a / L * sign * x.strain[from]).margin(1e-13));
      CHECK(y.velocity[to] == Approx(2 * a / unit * sign * x.velocity[from]).margin(1e-12));
    }
  }
}

TEST_CASE("a bar that touches nothing moves in its modes") {
  const bool right = GENERATE(true, false);
  const double L = 1.7, c = 3, wave = 2.5 * M_PI / L, amplitude = 0.02, speed = 0.4;
  ReferenceProblem problem = bar(L, 9, 1, right);
  const auto shape = [=](double x) { return std::cos(wave * (right ? x : L - x)); };
  problem.displacement = [=](double x) { return amplitude * shape(x); };
  problem.velocity = [=](double x) { return speed * shape(x); };
  const SampleGrid grid = bar_grid(L, 11, 50, 200);
  const SampledMotion motion = solved(problem, grid);
  const double pulsation = c * wave;
  for (std::size_t k = 0; k < grid.times.size(); ++k) {
    const double turn = pulsation * grid.times[k];
    const double now = amplitude * std::cos(turn) + speed / pulsation * std::sin(turn);
    CHECK(motion.tip[k] == Approx(now).margin(1e-12));
    CHECK(motion.tip_velocity[k] ==
          Approx(speed * std::cos(turn) - amplitude * pulsation * std::sin(turn)).margin(1e-11));
    const std::size_t some = k * 200 + 60;
    CHECK(motion.displacement[some] == Approx(now * shape(grid.places[60])).margin(1e-12));
    // 200 midpoints of a squared sine: its own mean, to round-off.
    CHECK(field_energy(problem, grid, motion, k) == Approx(motion.energy[k]).epsilon(1e-10));
    CHECK(motion.impulse[k] == 0);
  }
}

TEST_CASE("a free bar drifts and vibrates") {
  ReferenceProblem problem = bar(2, 4, 1, true);
  problem.right_fixed = false;
  problem.contact_absent = true;
  problem.displacement = [](double x) { return 0.1 + 0.02 * std::cos(M_PI * x / 2); };
  problem.velocity = [](double x) { return 0.3 + 0.05 * std::cos(M_PI * x); };
  const SampleGrid grid = bar_grid(2, 25, 77, 10);
  const SampledMotion motion = solved(problem, grid);
  for (std::size_t k = 0; k < grid.times.size(); ++k) {
    const double t = grid.times[k];
    CHECK(motion.tip[k] ==
          Approx(0.1 + 0.3 * t + 0.02 * std::cos(M_PI * t) + 0.05 / (2 * M_PI) * std::sin(2 * M_PI * t)).margin(1e-12));
  }
}

TEST_CASE("bars without a closed form are refused with the reference that applies") {
  const auto bouncing = [] {
    ReferenceProblem problem = bar(1, 1, 1, true);
    problem.displacement = [](double x) { return (1 - x) / 2; };
    problem.lower = constant(0);
    return problem;
  };
  CHECK(refusal(bouncing()).empty());
  const auto says = [&](const auto& change, const std::string& words) {
    ReferenceProblem problem = bouncing();
    change(problem);
    const std::string sentence = refusal(problem);
    INFO(sentence);
    CHECK(sentence.find(words) != std::string::npos);
    CHECK(sentence.find("event-driven-semi-discrete") != std::string::npos);
  };
  says([](auto& p) { p.damping_stiffness = 1e-5; }, "damped");
  says([](auto& p) { p.load_zero = false; }, "loaded");
  says([](auto& p) { p.support_amplitude = 0.1; }, "support");
  says([](auto& p) { p.contact_stiffness = 1e5; }, "compliant");
  says([](auto& p) { p.lower = constant(-0.1); }, "not at 0");
  says([](auto& p) { p.upper = constant(0.4); }, "in its way");
  says([](auto& p) { p.velocity = constant(0.1); }, "initial state");
  says([](auto& p) { p.displacement = [](double x) { return (1 - x * x) / 2; }; }, "initial state");
  says([](auto& p) { p.stops_at_tip = false; }, "only free end");
  says([](auto& p) { p.structure = "beam"; }, "beam");
  says(
      [](auto& p) {
        p.contact_absent = true;
        p.displacement = [](double x) { return std::abs(x - 0.3) < 0.1 ? 0.1 : 0; };
      },
      "smooth");
  says(
      [](auto& p) {
        p.contact_absent = true;
        p.displacement = [](double x) { return 1 + x; };
      },
      "fixed end");
}

}  // namespace exact_tests
