// What a flight is made of: k steps at once, what bounds them, what they bring, and where there is none.
#include <random>
#include <ricochet/engine/flight/flight.hpp>
#include <ricochet/engine/flight/flight_set.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

CompileOptions flights(long long steps = 20000) {
  CompileOptions options;
  options.march = MarchWay::flights;
  options.expected_steps = steps;
  return options;
}

SceneSpec swinging(double viscosity, double amplitude) {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = viscosity;
  scene.support.amplitude = amplitude;
  scene.stops.lower = Formula(-0.5);
  scene.stops.upper = Formula(0.5);
  return scene;
}

std::string refusal_of(const SceneSpec& scene, const Methods& methods, double h, const Lanes& lanes = one_lane) {
  const auto made = compiled(problem_of(scene, 6, methods.mass, methods.contact), methods, h, flights(), lanes);
  const auto* refusal = std::get_if<Refusal>(&made);
  return refusal ? refusal->sentence.text : "";
}

// Lets flights leave out as many steps as the test says.
class Skipper final : public StepObserver {
 public:
  explicit Skipper(long long most_steps = 0) : most(most_steps) { asks_.next_shown = most + 1; }
  long long most, skipped_steps = 0, shown = 0, longest = 0;
  double low = 1e9, high = -1e9;
  void stage_solved(const Marcher&, const StageView&) override {}
  void step_done(Marcher& marcher) override {
    ++shown;
    low = std::min(low, marcher.tip(0));
    high = std::max(high, marcher.tip(0));
    asks_.next_shown = marcher.step() + most + 1;
  }
  void interval(Marcher& marcher, const StepInterval& steps) override {
    skipped_steps += steps.steps;
    longest = std::max(longest, steps.steps);
    steps.tip_extremes(low, high);
    asks_.next_shown = marcher.step() + most + 1;
  }
};

const Methods free_of_contact{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli", {{"beta", 0.25}}}};

}  // namespace

TEST_CASE("a beam that never reaches its stops is marched in a few looks") {
  const double viscosity = GENERATE(0.0, 1e-4);
  const double amplitude = GENERATE(0.0, 0.01);
  Marcher beam = marcher(swinging(viscosity, amplitude), 6, free_of_contact, 1e-5, flights(50000));
  beam.start();
  beam.march(50000 - beam.step());
  CHECK(beam.step() == 50000);
  CHECK(beam.steps_visited() < 500);
}

TEST_CASE("no flight is longer than its observer allows, and an observer that says nothing sees every step") {
  Marcher beam = marcher(swinging(0, 0.01), 6, free_of_contact, 1e-5, flights(20000));
  Skipper every;
  beam.start(&every);
  beam.march(3000, &every);
  CHECK(every.skipped_steps == 0);
  CHECK(beam.steps_visited() == 3000);
  Skipper some(37);
  beam.march(3000, &some);
  CHECK(some.longest <= 37);
  CHECK(some.skipped_steps + some.shown == 3000);
  CHECK(some.skipped_steps > 2000);
}

TEST_CASE("the extremes of the tip are those of every step, also of those that are left out") {
  const SceneSpec scene = swinging(0, 0.02);
  CompileOptions every = flights();
  every.march = MarchWay::every_step;
  every.kind = OperatorKind::modal;
  Marcher slow = marcher(scene, 6, free_of_contact, 2e-5, every),
          fast = marcher(scene, 6, free_of_contact, 2e-5, flights());
  Skipper marched, flown(1 << 30);
  slow.start(&marched);
  slow.march(20000, &marched);
  fast.start(&flown);
  fast.march(20000, &flown);
  CHECK(flown.shown < 500);
  CHECK(flown.high == Approx(marched.high).epsilon(1e-9));
  CHECK(flown.low == Approx(marched.low).epsilon(1e-9));
}

TEST_CASE("the tip is told after each step that is left out, with contact and without") {
  class Teller final : public StepObserver {
   public:
    explicit Teller(bool flies = false) { asks_.next_shown = flies ? never : 0; }
    long long skipped_steps = 0;
    std::vector<double> tips;
    void stage_solved(const Marcher&, const StageView&) override {}
    void step_done(Marcher& marcher) override { tips.push_back(marcher.tip(0)); }
    void interval(Marcher&, const StepInterval& steps) override {
      skipped_steps += steps.steps;
      steps.each_tip([&](double tip) { tips.push_back(tip); });
    }
  };
  SceneSpec scene = swinging(1e-4, 0.02);
  scene.load = Formula("10*x", "/scene/load");
  scene.stops.lower = Formula(-0.05);
  scene.stops.upper = Formula(0.05);
  scene.initial.displacement = Formula("0.01*x^2", "/scene/initial/displacement", "x");
  const Methods methods{{"singular"},
                        GENERATE(Choice{"signorini"}, Choice{"penalty", {{"stiffness", 1e4}}}),
                        {"newmark-dumont-paoli", {{"beta", 0.5}}}};
  CompileOptions every = flights();
  every.march = MarchWay::every_step;
  every.kind = OperatorKind::modal;
  Marcher slow = marcher(scene, 6, methods, 2e-5, every), fast = marcher(scene, 6, methods, 2e-5, flights());
  Teller marched, flown(true);
  slow.start(&marched);
  slow.march(15000, &marched);
  fast.start(&flown);
  fast.march(15000, &flown);
  REQUIRE(flown.tips.size() == marched.tips.size());
  CHECK(flown.skipped_steps > 10000);
  double apart = 0;
  for (std::size_t i = 0; i < flown.tips.size(); ++i)
    apart = std::max(apart, std::abs(flown.tips[i] - marched.tips[i]));
  CHECK(apart < 1e-9);
}

TEST_CASE("an integration by flights keeps its results when it stops in between, and goes on from a state") {
  // Flights end where somebody reads: where they end must not matter beyond round-off.
  const SceneSpec scene = swinging(1e-4, 0.02);
  Marcher whole = marcher(scene, 6, free_of_contact, 2e-5, flights()),
          parts = marcher(scene, 6, free_of_contact, 2e-5, flights());
  whole.start();
  whole.march(12345);
  parts.start();
  for (long long left = 12345, part = 1; left > 0; part = 3 * part + 1) left -= parts.march(std::min(left, part));
  CHECK(whole.step() == parts.step());
  CHECK((whole.position(0) - parts.position(0)).norm() < 1e-11 * whole.position(0).norm());
  // The same calls give bitwise equal results.
  Marcher again = marcher(scene, 6, free_of_contact, 2e-5, flights());
  again.start();
  again.march(12345);
  CHECK((whole.position(0) - again.position(0)).norm() == 0);
}

TEST_CASE("what cannot fly says why") {
  SceneSpec scene = swinging(0, 0);
  CHECK(refusal_of(scene, free_of_contact, 1e-5).empty());
  // Beyond the step limit a mode grows.
  CHECK_THAT(refusal_of(scene, {{"consistent"}, {"signorini"}, {"newmark-dumont-paoli", {{"beta", 0.0}}}}, 1e-3),
             Catch::Contains("a mode grows by itself"));
  CHECK_THAT(refusal_of(scene, free_of_contact, 1e-5,
                        [](const LaneSpec& lane) {
                          return std::vector<LaneSpec>{lane, lane};
                        }),
             Catch::Contains("several lanes"));
  scene.load = Formula("0.1*sin(3*t)^2", "/scene/load");
  CHECK_THAT(refusal_of(scene, free_of_contact, 1e-5), Catch::Contains("the load depends on time otherwise"));
  scene.load = Formula("0.1*sin(3*t)", "/scene/load");
  CHECK(refusal_of(scene, free_of_contact, 1e-5).empty());
  scene.support.amplitude = 0.02;
  CHECK_THAT(refusal_of(scene, free_of_contact, 1e-5), Catch::Contains("and the support moves"));
  scene.support.amplitude = 0;
  scene.load = Formula("0.1*x", "/scene/load");
  CHECK(refusal_of(scene, free_of_contact, 1e-5).empty());
}

TEST_CASE("tables that would not fit into memory are refused with how much there is, and marched without where free") {
  const SceneSpec scene = swinging(1e-4, 0.02);
  CompileOptions small = flights(1000000);
  small.memory = 1e4;
  const auto problem = problem_of(scene, 6, free_of_contact.mass, free_of_contact.contact);
  const auto refused = compiled(problem, free_of_contact, 1e-6, small);
  REQUIRE(std::holds_alternative<Refusal>(refused));
  CHECK_THAT(std::get<Refusal>(refused).sentence.text, Catch::Contains("MB of memory, and there are 0.01 MB"));
  small.march = MarchWay::automatic;
  const auto marched = compiled(problem, free_of_contact, 1e-6, small);
  REQUIRE(std::holds_alternative<Program>(marched));
  CHECK_FALSE(std::get<Program>(marched).flight);
  CHECK_THAT(std::get<Program>(marched).every_step_because, Catch::Contains("MB of memory"));
  CHECK(flight_bytes(12, 2, 6, 1000000) < 64e6);
  CHECK(flight_bytes(1000, 2, 500, 1000000) < 1e9);
}

TEST_CASE("what is chosen automatically flies where steps are many, and marches where they are few") {
  const SceneSpec scene = swinging(1e-4, 0.02);
  CompileOptions options;
  options.march = MarchWay::automatic;
  options.expected_steps = 1000000;
  CHECK(marcher(scene, 6, free_of_contact, 1e-6, options).program().flight);
  options.expected_steps = 200;
  CHECK_FALSE(marcher(scene, 6, free_of_contact, 1e-3, options).program().flight);
}

TEST_CASE("every value that a bound promises to hold stays within it") {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const Methods methods{{"consistent"},
                        {"signorini"},
                        GENERATE(Choice{"newmark-dumont-paoli"}, Choice{"bathe"}, Choice{"hht-alpha"},
                                 Choice{"cd-lagrange"}, Choice{"sdirk"})};
  const auto made = compiled(problem_of(swinging(1e-4, 0.02), 4, methods.mass), methods, 2e-5, flights());
  REQUIRE(std::holds_alternative<Program>(made));
  FlightSet set(std::get<Program>(made), 0, {}, 12);
  REQUIRE(set.cause().empty());
  const std::size_t numbers = static_cast<std::size_t>(set.modes()) * std::get<Program>(made).plan.slots.size();
  std::vector<double> x(numbers);
  int tight = 0;
  for (int draw = 0; draw < 20; ++draw) {
    for (double& value : x) value = 1e-3 * normal(random);
    double e[3] = {0.02 * std::sin(draw), 0.02 * std::cos(draw), 1};
    const long long k = 1LL << (draw % 8);
    set.tip().each->set_state(x.data(), e);
    const FlightBound::Range range = set.tip().each->range(0, 0, k);
    double low = 1e9, high = -1e9;
    for (long long i = 0; i <= k; ++i) {
      double value = 0;
      set.tip().each->values(0, x.data(), e, &value);
      low = std::min(low, value);
      high = std::max(high, value);
      set.motion().leap(0, x.data(), e);
    }
    CHECK(low >= range.low);
    CHECK(high <= range.high);
    tight += high - low > 0.01 * (range.high - range.low);
  }
  // And it says something.
  CHECK(tight > 10);
}

TEST_CASE("steps are clear up to the first in which a point reaches its stop") {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const Methods methods{
      {GENERATE("consistent", "singular")},
      {"signorini"},
      GENERATE(Choice{"newmark-dumont-paoli", {{"beta", 0.5}}}, Choice{"bathe"}, Choice{"hht-alpha"})};
  const double amplitude = GENERATE(0.0, 0.02);
  SceneSpec scene = swinging(1e-5, amplitude);
  scene.stops.place = StopsSpec::Place::nodes;
  const auto made = compiled(problem_of(scene, 4, methods.mass), methods, 2e-5, flights());
  REQUIRE(std::holds_alternative<Program>(made));
  FlightSet set(std::get<Program>(made), 0, {}, 12);
  REQUIRE(set.cause().empty());
  FlightBound& bound = set.bound();
  std::vector<double> x(static_cast<std::size_t>(set.modes()) * std::get<Program>(made).plan.slots.size());
  int reached = 0;
  for (int draw = 0; draw < 30; ++draw) {
    // Slow modes, which are the last, reach far. The second slot is the change of a step or the velocity.
    const double moves = methods.time.name == "newmark-dumont-paoli" ? 1e-3 : 50;
    for (int i = 0; i < static_cast<int>(x.size()); ++i) {
      const int slot = i / set.modes(), mode = i % set.modes();
      x[static_cast<std::size_t>(i)] = 2 * normal(random) * std::pow(0.2, set.modes() - 1 - mode) *
                                       (slot == 0   ? 1
                                        : slot == 1 ? moves
                                                    : 0);
    }
    double e[3] = {amplitude * std::sin(draw), amplitude * std::cos(draw), 1};
    constexpr long long most = 3000;
    long long pace = 16;
    const long long clear = set.clear_steps().count(x, e, most, pace);
    long long known = -1;
    for (bool inside = true; inside && known < most;) {
      for (int w = 0; w < bound.watches(); ++w) {
        const FlightWatch& watch = bound.watch(w);
        std::vector<double> values(watch.lower.size());
        bound.values(w, x.data(), e, values.data());
        for (std::size_t i = 0; i < values.size(); ++i)
          inside = inside && values[i] > watch.lower[i] && values[i] < watch.upper[i];
      }
      if (inside) ++known;
      set.motion().leap(0, x.data(), e);
    }
    CHECK(clear == known);
    reached += known < most && known > 10;
  }
  CHECK(reached > 0);
}

TEST_CASE("many steps at once are these steps one by one") {
  const Methods methods{
      {"consistent"},
      {"signorini"},
      GENERATE(Choice{"newmark-dumont-paoli"}, Choice{"bathe"}, Choice{"moreau-jean", {{"theta", 0.6}}})};
  const auto made = compiled(problem_of(swinging(1e-4, 0.02), 4, methods.mass), methods, 2e-5, flights());
  FlightSet set(std::get<Program>(made), 0, {}, 12);
  const std::size_t numbers = static_cast<std::size_t>(set.modes()) * std::get<Program>(made).plan.slots.size();
  std::vector<double> once(numbers, 1e-3), one_by_one = once;
  double e[3] = {0.012, 0.016, 1}, f[3] = {0.012, 0.016, 1};
  FlightSums sums, single;
  for (int power = 0; power < 10; ++power) {
    set.works().add(power, once.data(), e, sums);
    set.motion().leap(power, once.data(), e);
  }
  for (int k = 0; k < 1023; ++k) {
    set.works().add(0, one_by_one.data(), f, single);
    set.motion().leap(0, one_by_one.data(), f);
  }
  double apart = 0, size = 0;
  for (std::size_t i = 0; i < numbers; ++i) {
    apart = std::max(apart, std::abs(once[i] - one_by_one[i]));
    size = std::max(size, std::abs(once[i]));
  }
  CHECK(apart < 1e-11 * size);
  CHECK(e[0] == Approx(f[0]));
  CHECK(sums.loads == Approx(single.loads).epsilon(1e-9));
  CHECK(sums.damping == Approx(single.damping).epsilon(1e-9));
  CHECK(sums.scheme == Approx(single.scheme).epsilon(1e-9).margin(1e-18));
}
