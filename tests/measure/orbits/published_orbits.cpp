// Periodic orbits of the oscillator of Shaw and Holmes (1983), m = k = F = 1 and one stop: what its closed forms say of
// period, impact speed and period doubling is what an integration of fixed steps is judged to do.
#include <numbers>
#include <ricochet/measure/orbits/judge_orbit.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace published_orbits_tests {

namespace {

struct Row {
  double sigma, restitution, omega;
  int period;
  double speed;  ///< at the impact of a 1/1 orbit, m/s; 0: not published
};

struct Found {
  Orbit orbit;
  JudgedOrbit judged;
};

/// The orbit from the scene's start to the end of the plan.
Orbit ended_orbit(const SceneSpec& scene, const Methods& methods, double h, const SectionPlan& plan) {
  const auto program = [&] { return std::get<Program>(compiled(problem_of(scene, 1, methods.mass), methods, h)); };
  const StartedOrbits started = start_orbits(program(), plan);
  Program made = program();
  Orbit orbit;
  orbit.lane = made.lanes.front();
  orbit.now = started.states.front();
  orbit.transient_periods = 1;
  SectionMarch march(std::move(made), plan);
  march.load(0, orbit);
  std::vector<Orbit> ended;
  while (ended.empty()) ended = march.period();
  return std::move(ended.front());
}

Found march_row(const Row& row, const Choice& time, int steps) {
  SceneSpec scene;
  scene.structure = OscillatorSpec{1, 1, 0, {1, row.omega, 0}};
  scene.stops.upper = Formula(row.sigma);
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.displacement = Formula(std::min(0.0, row.sigma));
  SectionPlan plan;
  plan.pulsation = row.omega;
  plan.steps_per_period = steps;
  // Far from the flips neighbours approach by e per period; nearest to them, by 5 % and more: 0.95^100 is 6e-3 of what
  // they began with.
  plan.transient = plan.at_most = 100;
  plan.keep = 32;
  const double h = 2 * std::numbers::pi / row.omega / steps;
  Choice chosen = time;
  chosen.values["restitution"] = row.restitution;
  const Methods methods{{"consistent"}, {"signorini"}, chosen};
  Found found{ended_orbit(scene, methods, h, plan), {}};
  found.judged = judge(found.orbit, plan, std::nullopt);
  return found;
}

}  // namespace

TEST_CASE("Shaw and Holmes: 1/1 orbits and flips come out with their period, at 4000 and at 16000 steps") {
  const auto time = GENERATE(Choice{"moreau-jean", {{"theta", 0.5}}}, Choice{"newmark-dumont-paoli", {{"beta", 0.25}}});
  const int steps = GENERATE(4000, 16000);
  // Published: the speeds, and period doubling at ω = 2.653347728 (σ = 0, e = 0.8), 2.454942243 (0.1, 0.8), 2.871135394
  // (−0.1, 0.8), 2.658152417 (0, 0.5).
  const std::vector<Row> rows = {{0, 0.8, 2, 1, 6.66667},    {0, 0.8, 2.3, 1, 1.21400},   {0, 0.8, 2.5, 1, 0.64535},
                                 {0, 0.8, 2.62, 1, 0.48316}, {0, 0.8, 2.645, 1, 0.45740}, {0, 0.8, 2.66, 2, 0},
                                 {0.1, 0.8, 2.44, 1, 0},     {0.1, 0.8, 2.46, 2, 0},      {-0.1, 0.8, 2.85, 1, 0},
                                 {-0.1, 0.8, 2.89, 2, 0},    {0, 0.5, 2.64, 1, 0},        {0, 0.5, 2.68, 2, 0}};
  for (const Row& row : rows) {
    const auto [orbit, judged] = march_row(row, time, steps);
    INFO(time.name << ", " << steps << " steps, σ = " << row.sigma << ", e = " << row.restitution
                   << ", ω = " << row.omega << ": " << judged.verdict.evidence);
    CHECK(judged.verdict.motion == MotionClass{Regime::periodic, row.period});
    CHECK(impacts_per_period(orbit) == 1);
    if (row.speed == 0) continue;
    double speed = 0;
    for (const ImpactPoint& impact : orbit.impacts) speed += impact.speed / static_cast<double>(orbit.impacts.size());
    // Order one: the instant is placed to a step, the force there is of order one.
    CHECK(speed == Approx(row.speed).margin(6 * 2 * std::numbers::pi / row.omega / steps));
  }
}

TEST_CASE("times of impacts follow the clock of the scene, and a transient of one period is one") {
  SectionPlan plan;
  const Row row{0, 0.8, 2.3, 1, 0};
  SceneSpec scene;
  scene.structure = OscillatorSpec{1, 1, 0, {1, row.omega, 0}};
  scene.stops.upper = Formula(0.0);
  scene.stops.place = StopsSpec::Place::tip;
  plan.pulsation = row.omega;
  plan.steps_per_period = 400;
  plan.transient = plan.at_most = 1;
  plan.keep = 16;
  const double period = 2 * std::numbers::pi / row.omega, h = period / plan.steps_per_period;
  const Methods methods{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli", {{"restitution", 0.8}}}};
  const Orbit done = ended_orbit(scene, methods, h, plan);
  CHECK(done.transient_periods == 1);
  CHECK(done.strobed.size() == 16);

  // The same motion, marched without a section.
  Marcher plain = marcher(scene, 1, methods, h);
  plain.start();
  std::vector<double> tips = {0, plain.tip(0)};
  for (int n = plain.step(); n < 18 * plan.steps_per_period; ++n) {
    plain.march(1);
    tips.push_back(plain.tip(0));
  }
  // The clock of a section turns back every period, so that times round otherwise.
  for (std::size_t k = 0; k < done.strobed.size(); ++k)
    CHECK(done.strobed[k].displacement ==
          Approx(tips[(k + 2) * static_cast<std::size_t>(plan.steps_per_period)]).margin(1e-10));
  REQUIRE_FALSE(done.impacts.empty());
  CHECK(done.impacts.front().time >= period);
  CHECK(done.impacts.front().time < 3 * period);
  for (const ImpactPoint& impact : done.impacts) {
    CHECK(std::fmod(impact.time, period) * row.omega == Approx(impact.phase).margin(1e-9));
    // Where the tip turns back.
    const auto n = static_cast<std::size_t>(std::llround(impact.time / h));
    CHECK(std::abs(tips[n]) <= 2 * h * impact.speed);
  }
}

}  // namespace published_orbits_tests
