// Exponents against what is known without marching: roots of the step map, decay rates, and each method of the other.
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <ricochet/measure/orbits/lyapunov.hpp>
#include <ricochet/measure/orbits/section_march.hpp>
#include <ricochet/measure/stability/step_map.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

constexpr double pulsation = 10;

SceneSpec shaken_beam(double alpha) {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = alpha;
  scene.support = {0.05, pulsation, 0};
  scene.initial.displacement = Formula(0.0);
  scene.initial.velocity = Formula(0.0);
  return scene;
}

Program program_of(const SceneSpec& scene, int elements, const Methods& methods, int steps, int lanes, int tangents) {
  CompileOptions options;
  options.tangents = tangents;
  options.moving_support = true;
  const Lanes copies = [lanes](const LaneSpec& lane) {
    return std::vector<LaneSpec>(static_cast<std::size_t>(lanes), lane);
  };
  auto program = compiled(problem_of(scene, elements, methods.mass), methods, 2 * std::numbers::pi / pulsation / steps,
                          options, copies);
  REQUIRE(std::holds_alternative<Program>(program));
  return std::move(std::get<Program>(program));
}

LyapunovPlan plan_of(int steps, int periods) {
  LyapunovPlan plan;
  plan.steps_per_period = steps;
  plan.pulsation = pulsation;
  plan.periods = periods;
  plan.discard = 20;
  return plan;
}

/// The state one step after the strobe, `periods` periods after the start.
LaneState state_after(const SceneSpec& scene, int elements, const Methods& methods, int steps, int periods) {
  Marcher beam{program_of(scene, elements, methods, steps, 1, 0)};
  beam.start();
  beam.march(static_cast<long long>(steps) * periods + 1 - beam.step());
  return beam.lane_state(0);
}

double mean(const std::vector<double>& rates) {
  double sum = 0;
  for (const double rate : rates) sum += rate / static_cast<double>(rates.size());
  return sum;
}

LinearProblem open_problem(const SemiDiscrete& problem) {
  LinearProblem linear;
  linear.mass = dense_mass(problem.inertia);
  linear.stiffness = problem.stiffness;
  linear.damping = problem.damping.stiffness * linear.stiffness + problem.damping.mass * linear.mass;
  linear.contact = Eigen::MatrixXd::Zero(0, linear.mass.rows());
  return linear;
}

}  // namespace

TEST_CASE("without contact the exponents are those of the roots of the step") {
  const auto mass = GENERATE(Choice{"consistent"}, Choice{"singular", {{"velocity", std::string("P1")}}});
  const auto time = GENERATE(Choice{"newmark-dumont-paoli"}, Choice{"newmark"},
                             Choice{"newmark-dumont-paoli", {{"beta", 0.3}}}, Choice{"moreau-jean", {{"theta", 0.6}}});
  const Methods methods{mass, {"none"}, time};
  const SceneSpec scene = shaken_beam(2e-3);
  const int steps = 200, columns = 4;
  const double h = 2 * std::numbers::pi / pulsation / steps;
  const auto problem = problem_of(scene, 4, mass);
  const auto map = step_map(open_problem(*problem), program_of(scene, 4, methods, steps, 1, 0).plan, {});
  REQUIRE(std::holds_alternative<Eigen::MatrixXd>(map));
  std::vector<double> expected;
  for (const Root& root : step_roots(std::get<Eigen::MatrixXd>(map), false))
    for (int i = 0; i < root.multiplicity; ++i) expected.push_back(std::log(std::abs(root.value)) / h);
  const auto rates = lyapunov_rates(program_of(scene, 4, methods, steps, 1, columns),
                                    {state_after(scene, 4, methods, steps, 2)}, plan_of(steps, 60));
  REQUIRE_FALSE(rates[0].end);
  CHECK(rates[0].jumps == 0);
  INFO(mass.name << ", " << time.name);
  // The sum over a complex pair is free of the turning of its plane; the columns found it to e^(−20 gap T). Double
  // roots of modulus one (Newmark on a kernel) are known to the square root of round-off, which is 3e-6 /s at this h.
  for (int k = 0; k < columns; k += 2) {
    const auto i = static_cast<std::size_t>(k);
    std::vector<double> area;
    for (std::size_t n = 0; n < rates[0].rates[i].size(); ++n)
      area.push_back(rates[0].rates[i][n] + rates[0].rates[i + 1][n]);
    CHECK(mean(area) == Approx(expected[i] + expected[i + 1]).epsilon(1e-6).margin(1e-5));
  }
}

TEST_CASE("exponents do not depend on the number of lanes, nor on the columns beside them") {
  const SceneSpec scene = shaken_beam(1e-3);
  const Methods methods;
  const LaneState state = state_after(scene, 4, methods, 200, 10);
  const LyapunovPlan plan = plan_of(200, 10);
  const auto one = lyapunov_rates(program_of(scene, 4, methods, 200, 1, 1), {state}, plan);
  const auto two = lyapunov_rates(program_of(scene, 4, methods, 200, 2, 3), {state, state}, plan);
  CHECK(two[0].rates == two[1].rates);
  // The first column is the same whoever stands behind it.
  CHECK(one[0].rates[0] == two[0].rates[0]);
}

TEST_CASE("tangents and twins agree") {
  // A spring behind the stop, a point without mass, and points whose mass is too small for the step: all orbits touch.
  const auto methods = GENERATE(Methods{{"singular"}, {"signorini"}, {"newmark-dumont-paoli"}},
                                Methods{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli"}},
                                Methods{{"lumped"}, {"signorini"}, {"newmark-dumont-paoli"}},
                                Methods{{"consistent"}, {"penalty", {{"stiffness", 500.0}}}, {"newmark-dumont-paoli"}});
  SceneSpec scene = shaken_beam(2e-3);
  scene.support.amplitude = 0.09;
  const int steps = 400;
  const LaneState state = state_after(scene, 4, methods, steps, 60);
  LyapunovPlan plan = plan_of(steps, 60);
  plan.keep_orbit = true;
  const auto tangent = lyapunov_rates(program_of(scene, 4, methods, steps, 1, 1), {state}, plan);
  const auto twin = twin_rates(program_of(scene, 4, methods, steps, 1, 0), {state}, tangent, plan, 1e-8);
  REQUIRE_FALSE(tangent[0].end);
  REQUIRE_FALSE(twin[0].end);
  INFO(methods.mass.name << ": " << mean(tangent[0].rates[0]) << " and " << mean(twin[0].rates[0]));
  CHECK(tangent[0].jumps == 0);
  // Contacts that begin or end a step apart between the twins leave O(h) of the rate.
  CHECK(mean(twin[0].rates[0]) == Approx(mean(tangent[0].rates[0])).epsilon(0.05).margin(0.02));
  // An orbit marched without columns is the same, hence its twin.
  const auto bare = lyapunov_rates(program_of(scene, 4, methods, steps, 1, 0), {state}, plan);
  CHECK(bare[0].rates.empty());
  CHECK(twin_rates(program_of(scene, 4, methods, steps, 1, 0), {state}, bare, plan, 1e-8)[0].rates == twin[0].rates);
  // One that is brought back to a tenth of a metre is about as far away as orbits are, though it comes nearer again.
  CHECK(twin[0].saturated == 0);
  const auto far = twin_rates(program_of(scene, 4, methods, steps, 1, 0), {state}, tangent, plan, 0.1);
  CHECK(2 * far[0].saturated > static_cast<int>(far[0].rates[0].size()));
}

TEST_CASE("the root −1 of β = ¼ on a singular mass is taken out where the plan says so") {
  SceneSpec scene = shaken_beam(2e-3);
  const int steps = 200;
  const auto largest = [&](double beta, bool without) {
    const Methods methods{{"singular"}, {"none"}, {"newmark-dumont-paoli", {{"beta", beta}}}};
    LyapunovPlan plan = plan_of(steps, 60);
    plan.without_sawtooth = without;
    const auto rates =
        lyapunov_rates(program_of(scene, 4, methods, steps, 1, 2), {state_after(scene, 4, methods, steps, 2)}, plan);
    std::vector<double> area;
    for (std::size_t n = 0; n < rates[0].rates[0].size(); ++n)
      area.push_back(0.5 * (rates[0].rates[0][n] + rates[0].rates[1][n]));
    return mean(area);
  };
  // Four kernel directions at −1 neither grow nor decay, whatever α and h.
  CHECK(largest(0.25, false) == Approx(0).margin(1e-3));
  // What is physical decays at αω₁²/2 = 0.69 /s; the two schemes differ by O(h²) of it.
  const double half = largest(0.5, false);
  CHECK(half < -0.5);
  CHECK(largest(0.25, true) == Approx(half).epsilon(0.01));
}

TEST_CASE("a lane that stops gives its cause and leaves the others alone") {
  SceneSpec scene = shaken_beam(1e-3);
  const Methods methods;
  const LaneState state = state_after(scene, 4, methods, 200, 4);
  LaneState broken = state;
  broken.slots[0] = std::numeric_limits<double>::infinity();
  const LyapunovPlan plan = plan_of(200, 5);
  const auto alone = lyapunov_rates(program_of(scene, 4, methods, 200, 2, 1), {state, state}, plan);
  const auto beside = lyapunov_rates(program_of(scene, 4, methods, 200, 2, 1), {state, broken}, plan);
  CHECK_FALSE(beside[0].end);
  CHECK(beside[0].rates == alone[0].rates);
  CHECK(beside[1].end);
  CHECK(beside[1].rates[0].empty());
}

// Exponents of tangent columns: real multipliers each by itself, a complex pair together.

namespace exponent_intervals_tests {

namespace {

using Rates = std::vector<std::vector<double>>;

/// What the columns of the linear map with these multipliers grow by, re-orthonormalised every period. A pair ρe^{±iφ}
/// in an oblique frame swings; a real multiplier does not.
Rates rates_of_pair(double growth, double angle, int periods) {
  Rates rates(2);
  double u[2] = {1, 0}, w[2] = {0, 1};
  const double shear = 1.5, c = std::cos(angle), s = std::sin(angle), rho = std::exp(growth);
  for (int k = 0; k < periods; ++k) {
    const auto map = [&](const double* x, double* y) {
      y[0] = rho * (c * x[0] - shear * s * x[1]);
      y[1] = rho * (s / shear * x[0] + c * x[1]);
    };
    double a[2], b[2];
    map(u, a);
    map(w, b);
    const double length = std::hypot(a[0], a[1]);
    u[0] = a[0] / length, u[1] = a[1] / length;
    const double along = u[0] * b[0] + u[1] * b[1];
    b[0] -= along * u[0], b[1] -= along * u[1];
    const double across = std::hypot(b[0], b[1]);
    w[0] = b[0] / across, w[1] = b[1] / across;
    rates[0].push_back(std::log(length));
    rates[1].push_back(std::log(across));
  }
  return rates;
}

std::vector<double> steady(double rate, int periods) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 1e-3);
  std::vector<double> out;
  for (int k = 0; k < periods; ++k) out.push_back(rate + noise(random));
  return out;
}

}  // namespace

TEST_CASE("exponents: a complex pair is half the growth of its plane, steadier than either column") {
  const Rates rates = rates_of_pair(-0.3, 0.7, 200);
  const auto found = exponent_intervals(rates, 2);
  REQUIRE(found.size() == 2);
  for (const Interval& one : found) {
    CHECK(one.value == Approx(-0.3).epsilon(1e-9));
    CHECK(one.high - one.low < 1e-6);
  }
  CHECK(exponent_interval(rates[0]).high - exponent_interval(rates[0]).low > 1e-3);
  // One wanted: the first of the pair.
  CHECK(exponent_intervals(rates, 1).size() == 1);
  CHECK(exponent_intervals(rates, 1)[0].value == Approx(-0.3).epsilon(1e-9));
}

TEST_CASE("exponents: real multipliers stay apart, a pair may follow one") {
  Rates rates = {steady(0.4, 200)};
  for (auto& column : rates_of_pair(-0.3, 0.7, 200)) rates.push_back(std::move(column));
  const auto found = exponent_intervals(rates, 3);
  REQUIRE(found.size() == 3);
  CHECK(found[0].value == Approx(0.4).margin(1e-3));
  CHECK(found[1].value == Approx(-0.3).epsilon(1e-9));
  CHECK(found[2].value == found[1].value);
  const auto real = exponent_intervals({steady(0.4, 200), steady(-0.2, 200)}, 2);
  REQUIRE(real.size() == 2);
  CHECK(real[0].value == Approx(0.4).margin(1e-3));
  CHECK(real[1].value == Approx(-0.2).margin(1e-3));
}

TEST_CASE("exponents: of too few periods the mean alone") {
  const Interval one = exponent_interval({1.0, 2.0});
  CHECK(one.value == 1.5);
  CHECK(one.low == 1.5);
  CHECK(one.high == 1.5);
}

}  // namespace exponent_intervals_tests
