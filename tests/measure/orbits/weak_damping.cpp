// Oscillators that hit springs and lose a per mille of their energy per period: a window of a hundred periods sees them
// neither settled nor leave. Areas of their phase plane shrink by e^{−2ζω₀T}, so none is quasi-periodic.
#include <numbers>
#include <ricochet/measure/orbits/judge_orbit.hpp>
#include <ricochet/measure/orbits/lyapunov.hpp>
#include <ricochet/measure/orbits/section_march.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace weak_damping_tests {

namespace {

/// x'' + 2ζx' + x = F cos ωt between springs of 100 N/m at ±1 m, or above the upper one alone.
struct Oscillator {
  double zeta, force, omega;
  bool both;
  double position, velocity;

  double period() const { return 2 * std::numbers::pi / omega; }
  SceneSpec scene() const {
    SceneSpec made;
    made.structure = OscillatorSpec{1, 1, 2 * zeta, {force, omega, 0}};
    made.stops.upper = Formula(1.0);
    made.stops.lower.reset();
    if (both) made.stops.lower = Formula(-1.0);
    made.stops.place = StopsSpec::Place::tip;
    made.initial.displacement = Formula(position);
    made.initial.velocity = Formula(velocity);
    return made;
  }
  Program program(int steps, int tangents) const {
    static const Methods methods{
        {"consistent"}, {"penalty", {{"stiffness", 100.0}}}, {"newmark", {{"beta", 0.25}, {"gamma", 0.5}}}};
    CompileOptions options;
    options.kind = OperatorKind::band;
    options.tangents = tangents;
    auto made = compiled(problem_of(scene(), 1, methods.mass), methods, period() / steps, options, one_lane);
    REQUIRE(std::holds_alternative<Program>(made));
    return std::move(std::get<Program>(made));
  }
};

struct Judged {
  OrbitExponents exponents;
  RegimeVerdict verdict;
};

constexpr int steps = 400, kept = 100;

/// From the initial state, after so many periods, with its exponents.
Judged judged(const Oscillator& one, int transient) {
  SectionPlan plan;
  plan.pulsation = one.omega;
  plan.steps_per_period = steps;
  plan.transient = plan.at_most = transient;
  plan.keep = kept;
  StartedOrbits started = start_orbits(one.program(steps, 0), plan);
  REQUIRE_FALSE(started.ends[0]);
  Program program = one.program(steps, 0);
  Orbit orbit;
  orbit.lane = program.lanes[0];
  orbit.now = started.states[0];
  orbit.transient_periods = 1;
  SectionMarch march(std::move(program), plan);
  march.load(0, orbit);
  std::vector<Orbit> done;
  while (done.empty()) done = march.period();
  LyapunovPlan measure;
  measure.steps_per_period = steps;
  measure.pulsation = one.omega;
  measure.periods = kept;
  measure.rounds = {orbit_period(done[0], plan).recurrence.period};
  Judged out;
  out.exponents =
      exponents_of([&](int columns) { return one.program(steps, columns); }, {done[0].entry}, measure, 1, 2)[0];
  REQUIRE(out.exponents.values.size() == 1);
  out.verdict = judge(done[0], plan, out.exponents.values[0]).verdict;
  return out;
}

}  // namespace

TEST_CASE("a weakly damped oscillator is no torus and no chaos while it settles, and periodic once it has") {
  const auto one = GENERATE(
      // Its exponent seems zero, and ranges shrink.
      Oscillator{0.001, 0.02, 0.9, false, 0.2, -1.2}, Oscillator{0.001, 0.02, 1.7, false, 0.2, -1.2},
      Oscillator{0.001, 0.02, 2.2, false, 0.2, -1.2}, Oscillator{0.001, 0.2, 2.2, true, 0.9, 0.7},
      // It seems above zero, K tells a regular orbit.
      Oscillator{0.0005, 0.2, 0.75, true, 0.9, 0.7},
      // K does not, and ranges shrink.
      Oscillator{0.002, 0.02, 1.35, true, 0.2, -1.2});
  const Judged early = judged(one, 20);
  INFO("ζ = " << one.zeta << ", ω = " << one.omega << ": " << early.verdict.evidence);
  CHECK(early.verdict.motion.regime == Regime::undecided);
  // Deviations are e^{−ζω₀T 4000} times smaller then: e^{−9} at most.
  const Judged late = judged(one, 4000);
  INFO("then: " << late.verdict.evidence);
  CHECK((late.verdict.motion.repeats() || late.verdict.motion.regime == Regime::no_contact));
  CHECK(late.exponents.values[0].high < 0);
}

TEST_CASE("the same oscillator without damping is quasi-periodic") {
  for (const double omega : {2.2, 2.8}) {
    const Judged found = judged({0, 0.02, omega, false, 0.2, -1.2}, 20);
    INFO("ω = " << omega << ": " << found.verdict.evidence);
    CHECK(found.verdict.motion.regime == Regime::quasi_periodic);
  }
}

}  // namespace weak_damping_tests
