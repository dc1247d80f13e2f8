// Exponents of orbits with impacts against their exact multipliers. These are products of flows and saltations along
// orbits that are found event by event. Also orbits that keep nothing of where they came from.
#include <Eigen/Eigenvalues>
#include <numbers>
#include <ricochet/measure/orbits/impact_jump.hpp>
#include <ricochet/measure/orbits/lyapunov.hpp>
#include <ricochet/measure/orbits/section_march.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace impact_exponents_tests {

namespace {

constexpr double turn = 2 * std::numbers::pi;

/// m x'' + k x = F cos(ωt + ψ) between stops that give back e.
struct Oscillator {
  double mass = 1, stiffness = 1, force = 1, omega = 1, phase = 0, restitution = 0.5;
  std::optional<double> lower, upper;

  double period() const { return turn / omega; }
  /// Where it begins, at rest and away from its stop: `Exact` dates impacts and holds nothing.
  double start() const { return upper && *upper <= 0 ? *upper - 0.5 : 0; }
  SceneSpec scene() const {
    SceneSpec made;
    made.structure = OscillatorSpec{mass, stiffness, 0, {force, omega, phase}};
    if (lower)
      made.stops.lower = Formula(*lower);
    else
      made.stops.lower.reset();
    if (upper)
      made.stops.upper = Formula(*upper);
    else
      made.stops.upper.reset();
    made.stops.place = StopsSpec::Place::tip;
    made.initial.displacement = Formula(start());
    made.initial.velocity = Formula(0.0);
    return made;
  }
};

/// The same in closed form from event to event, with the derivative of its state by what it was at the beginning.
class Exact {
 public:
  explicit Exact(const Oscillator& one) : one_(one), own_(std::sqrt(one.stiffness / one.mass)) {
    driven_ = one.force / (one.stiffness - one.mass * one.omega * one.omega);
    state[0] = one.start();
  }

  void advance(double duration) {
    const double end = time_ + duration, every = one_.period() / 2000;
    while (time_ < end - 1e-14 * end) {
      const double step = std::min(every, end - time_);
      // Only what moves outward strikes: round-off alone leaves a rebounding mass beyond its stop.
      const auto beyond = [&](double dt) {
        const Eigen::Vector2d at = flown(dt);
        return (one_.upper && at[0] > *one_.upper && at[1] > 0) || (one_.lower && at[0] < *one_.lower && at[1] < 0);
      };
      if (!beyond(step)) {
        fly(step);
        continue;
      }
      double inside = 0, outside = step;
      for (int i = 0; i < 60; ++i) (beyond((inside + outside) / 2) ? outside : inside) = (inside + outside) / 2;
      fly(outside);
      strike();
    }
  }
  void forget() { derivative.setIdentity(); }

  Eigen::Vector2d state = Eigen::Vector2d::Zero();
  Eigen::Matrix2d derivative = Eigen::Matrix2d::Identity();

 private:
  Eigen::Matrix2d flow(double dt) const {
    const double c = std::cos(own_ * dt), s = std::sin(own_ * dt);
    Eigen::Matrix2d map;
    map << c, s / own_, -s * own_, c;
    return map;
  }
  Eigen::Vector2d particular(double t) const {
    const double angle = one_.omega * t + one_.phase;
    return {driven_ * std::cos(angle), -driven_ * one_.omega * std::sin(angle)};
  }
  Eigen::Vector2d flown(double dt) const { return particular(time_ + dt) + flow(dt) * (state - particular(time_)); }
  void fly(double dt) {
    state = flown(dt);
    derivative = flow(dt) * derivative;
    time_ += dt;
  }
  void strike() {
    const double e = one_.restitution;
    const double a = (one_.force * std::cos(one_.omega * time_ + one_.phase) - one_.stiffness * state[0]) / one_.mass;
    Eigen::Matrix2d jump;
    jump << -e, 0, (1 + e) * a / state[1], -e;
    derivative = jump * derivative;
    state[1] *= -e;
  }

  const Oscillator& one_;
  double own_, driven_ = 0, time_ = 0;
};

/// Multipliers of the orbit that is reached from rest and repeats after so many periods.
Eigen::Vector2cd exact_multipliers(const Oscillator& one, int round) {
  Exact exact(one);
  exact.advance(200 * one.period());
  const Eigen::Vector2d before = exact.state;
  exact.forget();
  exact.advance(round * one.period());
  REQUIRE((exact.state - before).norm() < 1e-6 * before.norm());
  return exact.derivative.eigenvalues();
}

struct Measured {
  LyapunovRates rates;
  LaneState entry;
};

LyapunovPlan plan_of(const Oscillator& one, int steps, int keep, int round) {
  LyapunovPlan plan;
  plan.steps_per_period = steps;
  plan.pulsation = one.omega;
  plan.periods = keep;
  plan.discard = 10;
  plan.rounds = {round};
  return plan;
}

Program program_of(const SceneSpec& scene, const Methods& methods, double h, int tangents, int elements = 1) {
  CompileOptions options;
  options.tangents = tangents;
  options.kind = OperatorKind::band;
  options.moving_support = scene.support.amplitude != 0;
  auto program = compiled(problem_of(scene, elements, methods.mass), methods, h, options, one_lane);
  REQUIRE(std::holds_alternative<Program>(program));
  return std::move(std::get<Program>(program));
}

/// One step after the strobe that follows so many periods; the force goes on from there on a clock of one period.
LaneState state_after(const SceneSpec& scene, const Methods& methods, double h, int steps, int periods,
                      int elements = 1) {
  Marcher marcher{program_of(scene, methods, h, 0, elements)};
  marcher.start();
  marcher.march(1 + steps - marcher.step());
  for (int period = 1; period < periods; ++period) {
    marcher.set_clock(1);
    marcher.march(steps);
  }
  REQUIRE(marcher.status(0).running);
  return marcher.lane_state(0);
}

LyapunovRates rates_of(const Oscillator& one, const Methods& methods, int steps, const LyapunovPlan& plan) {
  const double h = one.period() / steps;
  const LaneState entry = state_after(one.scene(), methods, h, steps, 80);
  return lyapunov_rates(program_of(one.scene(), methods, h, 2), {entry}, plan).front();
}

Methods with(const std::string& time, double restitution) {
  return {{"consistent"}, {"signorini"}, {time, {{"restitution", restitution}}}};
}

}  // namespace

TEST_CASE(
    "exponents are those of the exact multipliers: real ones of either sign, and pairs, however long they are "
    "measured") {
  struct Known {
    Oscillator oscillator;
    int round;
    bool pair;
  };
  Oscillator one;
  one.force = 1;
  const auto at = [&](double omega, double stop, double e) {
    Oscillator made = one;
    made.omega = omega;
    made.upper = stop;
    made.restitution = e;
    return made;
  };
  // Two impacts in two periods of a mass between two stops: each column's growth swings from period to period.
  Oscillator between;
  between.mass = 0.0003361185937456267;
  between.stiffness = 1488.578099595049;
  between.force = 0.3;
  between.omega = 1570.7963267948965;
  between.phase = -0.5 * std::numbers::pi;
  between.restitution = 0.3;
  between.lower = -0.6064131049344343 / 1488.578099595049;  // from where the constant force holds it
  between.upper = 0.001016 + *between.lower;
  const auto known = GENERATE_COPY(values<Known>({{at(1.9, 0.3, 0.5), 1, false},
                                                  {at(2.4, -0.3, 0.3), 1, false},
                                                  {at(3.5, -0.3, 0.5), 1, false},
                                                  {at(1.3, 0.1, 0.3), 1, false},
                                                  {at(2.5, -0.1, 0.5), 1, true},
                                                  {at(1.5, 0.0, 0.3), 1, true},
                                                  {between, 2, false}}));
  const Oscillator& scene = known.oscillator;
  INFO("omega " << scene.omega << ", stop " << *scene.upper << ", e " << scene.restitution);
  const Eigen::Vector2cd multipliers = exact_multipliers(scene, known.round);
  REQUIRE((std::abs(multipliers[0].imag()) > 1e-6) == known.pair);
  std::vector<double> wanted;
  for (const auto& one_of : multipliers) wanted.push_back(std::log(std::abs(one_of)) / (known.round * scene.period()));
  std::sort(wanted.rbegin(), wanted.rend());
  const std::string time = GENERATE(as<std::string>(), "moreau-jean", "newmark-dumont-paoli");
  // A step places impacts to within h: at 4000 steps the orbits below are off by some 1e-3 of their size. A multiplier
  // is off by a few percent at most for that.
  constexpr int steps = 4000;
  for (const int keep : {17, 48}) {
    INFO(time << ", keep " << keep);
    const LyapunovRates rates =
        rates_of(scene, with(time, scene.restitution), steps, plan_of(scene, steps, keep, known.round));
    REQUIRE_FALSE(rates.end);
    CHECK(rates.told == 2);
    CHECK(rates.untold == 0);
    REQUIRE(rates.turning.size() == 1);
    CHECK(rates.turning[0] == (known.pair ? 1.0 : 0.0));
    const auto found = exponent_intervals(rates.rates, 2, rates.turning);
    REQUIRE(found.size() == 2);
    for (std::size_t k = 0; k < 2; ++k) {
      CAPTURE(k, wanted[k], found[k].low, found[k].value, found[k].high);
      const double slack = 0.05 / scene.period();
      CHECK(found[k].value == Approx(wanted[k]).margin(slack));
      CHECK(found[k].low <= wanted[k] + slack);
      CHECK(found[k].high >= wanted[k] - slack);
    }
  }
}

TEST_CASE("a restitution that a stop has of its own has the exponents of the same one in the scheme") {
  Oscillator one;
  one.omega = 1.9;
  one.upper = 0.3;
  constexpr int steps = 2000;
  const double h = one.period() / steps;
  SceneSpec own = one.scene();
  NamedStop wall{.name = "wall", .at = {}, .to = {}, .lower = {}, .upper = *one.upper};
  wall.at.x = 0;
  own.stops.named = {wall};
  for (const std::string time : {"moreau-jean", "nonsmooth-generalised-alpha"})
    for (const double e : {0.5, 0.0}) {
      INFO(time << ", e = " << e);
      own.stops.named[0].own.restitution = e;
      const auto rates = [&](const Methods& methods) {
        const LaneState entry = state_after(own, methods, h, steps, 40);
        const Program program = program_of(own, methods, h, 2);
        CHECK(thrown_points(program, 0.1)[0] == (e > 0.1));
        return lyapunov_rates(program_of(own, methods, h, 2), {entry}, plan_of(one, steps, 12, 1)).front();
      };
      const LyapunovRates alone = rates(with(time, 0.9 - e)), all = rates(with(time, e));
      CHECK(all.jumps > 0);
      CHECK(alone.jumps == all.jumps);
      CHECK(alone.told == all.told);
      CHECK(alone.rates == all.rates);
    }
}

TEST_CASE("an oscillator that chatters to rest keeps nothing of its past: superstable") {
  // Driven slowly, it is pressed on its stop for a third of a period: rest is reached at any step.
  Oscillator one;
  one.omega = 0.4;
  one.restitution = 0.6;
  one.upper = 0.3;
  const std::string time = GENERATE(as<std::string>(), "moreau-jean", "newmark-dumont-paoli", "paoli-schatzman");
  INFO(time);
  constexpr int steps = 4000;
  const double h = one.period() / steps;
  const Methods methods = with(time, one.restitution);
  const LaneState entry = state_after(one.scene(), methods, h, steps, 20);
  const auto rates = lyapunov_rates(program_of(one.scene(), methods, h, 2), {entry}, plan_of(one, steps, 12, 1));
  CHECK(rates[0].told == 0);
  // Two runs nearby say the same: how far apart they began is gone. A scheme at velocity level remembers where within a
  // step's way the point came to rest; one at position level nothing.
  const auto after = [&](double offset) {
    Marcher marcher{program_of(one.scene(), methods, h, 0)};
    LaneState begun = entry;
    for (double& slot : begun.slots) slot *= 1 - offset;
    marcher.set_lane(0, LaneSpec(marcher.program().lanes[0]), begun);
    for (int period = 0; period < 2; ++period) {
      marcher.set_clock(1);
      marcher.march(steps);
    }
    return marcher.position(0)[0];
  };
  const double plain = after(0), way = time == "moreau-jean" ? h : 1e-9;
  for (const double offset : {1e-2, 1e-4}) CHECK(std::abs(after(offset) - plain) < way);
}

TEST_CASE("without rebound, a mass that sticks keeps nothing, one that leaves at once keeps when it came") {
  Oscillator one;
  one.restitution = 0;
  one.upper = 0.3;
  const std::string time = GENERATE(as<std::string>(), "moreau-jean", "newmark-dumont-paoli");
  INFO(time);
  constexpr int steps = 4000;
  SECTION("leaves at once: one multiplier is zero, the other is sin(T) a/v") {
    one.omega = 1.9;
    const Eigen::Vector2cd multipliers = exact_multipliers(one, 1);
    const double largest = std::max(std::abs(multipliers[0]), std::abs(multipliers[1]));
    REQUIRE(std::min(std::abs(multipliers[0]), std::abs(multipliers[1])) < 1e-12);
    REQUIRE(largest > 0.01);
    const LyapunovRates rates = rates_of(one, with(time, 0), steps, plan_of(one, steps, 20, 1));
    CHECK(rates.told == 1);
    CHECK(rates.untold == 0);
    const auto found = exponent_intervals({rates.rates[0]}, 1, rates.turning);
    CHECK(found[0].value == Approx(std::log(largest) / one.period()).margin(0.03 / one.period()));
  }
  SECTION("sticks: the load presses it on its stop where it lands") {
    one.omega = 0.5;
    CHECK(rates_of(one, with(time, 0), steps, plan_of(one, steps, 20, 1)).told == 0);
  }
}

TEST_CASE("a structure keeps what its resting point does not hold: the columns are the derivative of the motion") {
  // One element: the tip's displacement and rotation. The tip is thrown at its stop, pressed there by the load, and let
  // go again.
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 2e-3;
  scene.stops.place = StopsSpec::Place::tip;
  scene.stops.lower.reset();
  scene.stops.upper = Formula(0.02);
  scene.support = {0.05, 10, 0};
  scene.initial.displacement = Formula(0.0);
  scene.initial.velocity = Formula(0.0);
  constexpr int steps = 160000;
  const double h = turn / 10 / steps, restitution = GENERATE(0.4, 0.0);
  INFO("e = " << restitution);
  const Methods methods = with("newmark-dumont-paoli", restitution);
  Marcher marcher{program_of(scene, methods, h, 1)}, twin{program_of(scene, methods, h, 0)};
  const LaneState begun = [&] {
    Marcher first{program_of(scene, methods, h, 0)};
    first.start();
    first.march(10 - first.step());
    return first.lane_state(0);
  }();
  // Larger than a step's way, so that impacts move by steps; small enough to be a derivative to some percent.
  constexpr double offset = 2e-4;
  LaneState direction = begun, beside = begun;
  std::fill(direction.slots.begin(), direction.slots.end(), 0.0);
  std::fill(direction.efforts.begin(), direction.efforts.end(), 0.0);
  const int rows = marcher.program().model->rows();
  REQUIRE(rows == 2);
  for (int i = 0; i < rows; ++i) direction.slots[static_cast<std::size_t>(i)] = i == 0 ? 1 : 2;
  for (std::size_t i = 0; i < direction.slots.size(); ++i) beside.slots[i] += offset * direction.slots[i];
  marcher.set_lane(0, LaneSpec(marcher.program().lanes[0]), begun);
  twin.set_lane(0, LaneSpec(twin.program().lanes[0]), beside);
  marcher.set_tangent(0, 0, direction);
  marcher.set_clock(10);
  twin.set_clock(10);
  ImpactJump jump(marcher);
  REQUIRE(jump.needed());
  int rested = 0;
  for (int part = 0; part < 40; ++part) {
    marcher.march(steps / 40, &jump);
    twin.march(steps / 40);
    rested = std::max(rested, jump.lost(0));
    const bool closed = marcher.pushed_by(0)[1] || twin.pushed_by(0)[1];
    if (closed || rested == 0 || restitution == 0) continue;
    const Eigen::VectorXd difference = (twin.position(0) - marcher.position(0)) / offset;
    const LaneState column = marcher.tangent(0, 0);
    for (int i = 0; i < rows; ++i) {
      CAPTURE(part, i, difference[0], difference[1], column.slots[0], column.slots[1]);
      CHECK(column.slots[static_cast<std::size_t>(i)] == Approx(difference[i]).margin(0.05 * difference.norm() + 1e-4));
    }
  }
  CHECK(rested == 2);
  // A structure that sticks where it lands, e = 0, is not told.
  CHECK((jump.untold(0) > 0) == (restitution == 0));
}

}  // namespace impact_exponents_tests
