#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/loader/catalogue.hpp>

#include "tests/plugins/reference/exact_problems.hpp"

namespace exact_tests {

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
