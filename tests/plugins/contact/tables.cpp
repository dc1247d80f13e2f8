// A stop whose force is a table: closed forms of straight lines, and what a loop of two tables loses.
#include "tests/plugins/contact/impacts.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;

namespace {

// Slopes of 2e3, 1e4 and 3e4 N/m. Areas up to its rows: 0, 0.025, 0.2, 0.875 J.
const ParameterTable measured = {{0, 0}, {5e-3, 10}, {1e-2, 60}, {1.5e-2, 210}};
// Slopes of 1e4 N/m in, 4e3 and 1.6e4 N/m out: they enclose 0.15 J.
const ParameterTable straight = {{0, 0}, {1e-2, 100}}, back = {{0, 0}, {5e-3, 20}, {1e-2, 100}};

Choice table(const ParameterTable& force, const std::string& evaluation, const ParameterTable& unloading = {},
             const ParameterTable& speed = {}) {
  return {"table",
          {{"depth_force", force}, {"unloading", unloading}, {"speed_force", speed}, {"evaluation", evaluation}}};
}

std::string any_evaluation() {
  return GENERATE(word("implicit"), word("averaged"), word("explicit"), word("midpoint"), word("conserving"),
                  word("hybrid"));
}

/// What a mass of 1 kg loses that the stop turns at `depth`, J: of the swing between the tables `straight` and `back`.
double loss_to(double depth) {
  // The line of 1.6e4 N/m down from (depth, 1e4 depth) meets the first line of `back` where 4e3 x = that.
  const double force = 1e4 * depth, x = (1.6e4 * depth - force) / (1.6e4 - 4e3);
  REQUIRE(x <= 5e-3);
  return 0.5 * force * depth - (0.5 * 4e3 * x * x + 0.5 * (4e3 * x + force) * (depth - x));
}

std::unique_ptr<ContactLaw> law_of(const Choice& choice) {
  auto law = make(registry().contact("table"), choice);
  const Parameters parameters = complete(registry().contact("table")->manual.parameters, choice.values);
  law->prepare(1, {&parameters, 1});
  return law;
}

}  // namespace

TEST_CASE("the energy that a table stores is its integral, beyond the last row with the last slope") {
  const auto law = law_of(table(measured, "implicit"));
  const auto stored = [&](double depth) { return law->potential({.depth = depth}); };
  CHECK(stored(-1e-3) == 0);
  CHECK(stored(0) == 0);
  CHECK(stored(2e-3) == Approx(0.5 * 2e3 * 4e-6).epsilon(1e-15));
  CHECK(stored(5e-3) == Approx(0.025).epsilon(1e-15));
  CHECK(stored(1e-2) == Approx(0.2).epsilon(1e-15));
  CHECK(stored(1.5e-2) == Approx(0.875).epsilon(1e-15));
  CHECK(stored(2.5e-2) == Approx(0.875 + 0.5 * (210 + 510) * 1e-2).epsilon(1e-15));
  // Of a stop that was loaded to 10 mm: the area under the way out.
  const auto loop = law_of(table(straight, "implicit", back));
  CHECK(loop->potential({.depth = 1e-2}) == Approx(0.35).epsilon(1e-15));
  CHECK(loop->potential({.depth = 8e-3}) == Approx(0.5 * 80 * 8e-3 - loss_to(8e-3)).epsilon(1e-14));
  // Beyond the shared row both are one: what is stored grows by the loading table's area.
  CHECK(loop->potential({.depth = 2e-2}) == Approx(0.35 + 0.5 * (100 + 200) * 1e-2).epsilon(1e-15));
}

TEST_CASE("a table of two rows is the penalty, one with a row between them too") {
  const auto evaluation = any_evaluation();
  const auto tip = [&](const Choice& law) { return bounce(law, 1e-4); };
  const Bounce spring = tip({"penalty", {{"stiffness", 1e4}, {"evaluation", evaluation}}});
  INFO(evaluation);
  for (const ParameterTable& one : {straight, ParameterTable{{0, 0}, {2.5e-3, 25}, {1e-2, 100}}}) {
    const Bounce here = tip(table(one, evaluation));
    // Round-off of some 300 steps in contact; the dates are those of whole steps.
    CHECK(here.contact == spring.contact);
    CHECK(here.speed == Approx(spring.speed).epsilon(1e-12));
    CHECK(here.place == Approx(spring.place).epsilon(1e-12));
    CHECK(here.deepest == Approx(spring.deepest).epsilon(1e-12));
  }
  const auto slopes = law_of(table(straight, evaluation))->linear_slopes(0);
  REQUIRE(slopes);
  CHECK(slopes->stiffness + slopes->before == Approx(1e4).epsilon(1e-15));
  CHECK_FALSE(law_of(table(measured, evaluation))->linear_slopes(0));
  CHECK_FALSE(law_of(table(straight, evaluation, back))->linear_slopes(0));
}

TEST_CASE("a beam between stops at all nodes: a table of two rows is the penalty") {
  const auto evaluation = any_evaluation();
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-4;
  scene.stops.place = StopsSpec::Place::nodes;
  const auto tip = [&](const Choice& law) {
    Marcher beam = marcher(scene, 6, {{"consistent"}, law, {"newmark-dumont-paoli"}}, 1e-4);
    run(beam, 0.3);
    REQUIRE(beam.status(0).running);
    return beam.tip(0);
  };
  INFO(evaluation);
  // Efforts to round-off, amplified over some impacts of the beam.
  CHECK(tip(table({{0, 0}, {0.1, 100}}, evaluation)) ==
        Approx(tip({"penalty", {{"stiffness", 1e3}, {"evaluation", evaluation}}})).margin(1e-8));
}

TEST_CASE("tables of two rows of depth and of speed are kelvin-voigt") {
  const auto evaluation = any_evaluation();
  const Bounce spring =
      bounce({"kelvin-voigt", {{"stiffness", 1e4}, {"viscosity", 40.0}, {"evaluation", evaluation}}}, 1e-4);
  const Bounce here = bounce(table(straight, evaluation, {}, {{0, 0}, {0.2, 8}}), 1e-4);
  INFO(evaluation);
  CHECK(here.speed == Approx(spring.speed).epsilon(1e-11));
  CHECK(here.deepest == Approx(spring.deepest).epsilon(1e-11));
  CHECK(here.taken == Approx(spring.taken).epsilon(1e-11));
}

TEST_CASE("a mass rests on a table where its force is the weight") {
  const auto [force, depth] =
      GENERATE(Catch::Generators::table<double, double>({{4, 2e-3}, {35, 7.5e-3}, {60, 1e-2}, {300, 1.8e-2}}));
  const auto evaluation = any_evaluation();
  const bool loop = GENERATE(false, true);
  SceneSpec scene = thrown_mass(-depth, 0);
  scene.load = Formula(-force);
  const ParameterTable unloading = {{0, 0}, {1e-2, 20}, {1.5e-2, 210}};
  Marcher mass = marcher(
      scene, 1, {{"consistent"}, table(measured, evaluation, loop ? unloading : ParameterTable{}), {"midpoint"}}, 1e-4);
  const EnergyAudit audit = audited(mass, 0.1);
  REQUIRE(mass.status(0).running);
  INFO(evaluation << ", " << force << " N, loop " << loop);
  CHECK(mass.tip(0) == Approx(-depth).epsilon(1e-12));
  CHECK(audit.contact(0).force == Approx(force).epsilon(1e-11));
}

TEST_CASE("an impact turns where the table has taken its energy, and gives it back") {
  const double depth = GENERATE(3e-3, 8e-3, 1.2e-2, 2e-2);
  const double energy = law_of(table(measured, "implicit"))->potential({.depth = depth});
  const double speed = std::sqrt(2 * energy);
  constexpr double h = 1e-5;
  Marcher mass =
      marcher(thrown_mass(0.0123, speed), 1, {{"consistent"}, table(measured, "conserving"), {"midpoint"}}, h);
  EnergyDrift kept(mass);
  mass.start(&kept);
  mass.march(static_cast<long long>(0.4 / h), &kept);
  INFO("depth " << depth << ", speed " << speed);
  CHECK(kept.audit().contact(0).impacts == 1);
  CHECK(kept.drift < 1e-12);
  CHECK(kept.audit().tip_velocity(0) == Approx(speed).epsilon(1e-12));
  // The depth at whole steps: the way of one step from the turn is ½ (p/m) h².
  CHECK(kept.audit().contact(0).deepest_penetration == Approx(depth).epsilon(1e-5));
}

TEST_CASE("a swing loses what the way in and the way out enclose, in closed form") {
  const auto evaluation = GENERATE(word("averaged"), word("midpoint"), word("conserving"), word("hybrid"));
  const double depth = GENERATE(4e-3, 7e-3, 1e-2, 1.7e-2);
  const double speed = std::sqrt(1e4) * depth;  // straight in
  const double loss = depth < 1e-2 ? loss_to(depth) : 0.15;
  Marcher mass =
      marcher(thrown_mass(1e-3, speed), 1, {{"consistent"}, table(straight, evaluation, back), {"midpoint"}}, 1e-5);
  const EnergyAudit audit = audited(mass, 0.1);
  INFO(evaluation << ", depth " << depth << ": lost " << audit.lost_at_stops(0) << " of " << loss);
  REQUIRE(audit.contact(0).impacts == 1);
  CHECK(audit.contact(0).active == 0);
  // In the steps where the contact begins, turns and ends the force errs by some h √(κ/m) = 1e-3 of a step's.
  CHECK(audit.contact(0).deepest_penetration == Approx(depth).epsilon(1e-3));
  CHECK(audit.lost_at_stops(0) == Approx(loss).epsilon(5e-3));
  CHECK(audit.totals(0).work_of_law == Approx(loss).epsilon(5e-3));
  CHECK(audit.tip_velocity(0) == Approx(std::sqrt(speed * speed - 2 * loss)).epsilon(5e-3));
  CHECK(audit.energy(0).contact == 0);
}

TEST_CASE("evaluated conserving a loop loses what the law reports, and never gains, whatever the step") {
  const double h = GENERATE(1e-4, 2e-3);
  const ParameterTable speed = GENERATE(ParameterTable{}, ParameterTable{{0, 0}, {0.5, 4}, {3, 6}});
  SceneSpec scene = thrown_mass(0.0123, 2);
  scene.structure = OscillatorSpec{1, 40, 0, {}};
  scene.stops.upper = Formula(0.03);
  const Choice law = table(measured, "conserving", {{0, 0}, {9e-3, 10}, {1.5e-2, 210}}, speed);
  Marcher mass = marcher(scene, 1, {{"consistent"}, law, {"midpoint"}}, h);
  EnergyDrift kept(mass, true), alone(mass);
  mass.start(&kept);
  mass.march(static_cast<long long>(0.5 / h), &kept);
  Marcher again = marcher(scene, 1, {{"consistent"}, law, {"midpoint"}}, h);
  again.start(&alone);
  again.march(static_cast<long long>(0.5 / h), &alone);
  REQUIRE(mass.status(0).running);
  INFO("h " << h << ": drift " << kept.drift << ", change " << alone.change << ", gain " << alone.gain);
  CHECK(kept.audit().contact(0).impacts > 2);
  CHECK(alone.change < -0.3);
  // Round-off of each step, a few units in the last place of the energy.
  CHECK(kept.drift < 5000 * 1e-15);
  CHECK(alone.gain < 1e-12);
  CHECK(std::abs(kept.audit().totals(0).balance_residual()) < 1e-10);
}

TEST_CASE("a small swing between the tables goes along the steepest slope, and loses nothing") {
  // Pressed to 8 mm, then the load falls: the mass swings about the depth where the line of κ has the load.
  SceneSpec scene = thrown_mass(-8e-3, 0);
  scene.load = Formula(-70);
  constexpr double h = 1e-4, steepest = 1.6e4;
  Marcher mass = marcher(scene, 1, {{"consistent"}, table(straight, "conserving", back), {"midpoint"}}, h);
  mass.start();
  LaneState state = mass.lane_state(0);
  state.memory = {80 - steepest * 8e-3, 0};
  mass.set_lane(0, mass.program().lanes[0], state);
  EnergyAudit audit(mass);
  double high = -1, low = 1;
  for (int step = 0; step < 2000; ++step) {
    mass.march(1, &audit);
    high = std::max(high, mass.tip(0));
    low = std::min(low, mass.tip(0));
  }
  CHECK(audit.totals(0).work_of_law == 0);
  CHECK(low == Approx(-8e-3).epsilon(1e-6));
  // 10 N of 80 too much: back by twice 10 N/κ. Its turn lies within a step of 1/40 of a period: (π/40)²/2.
  CHECK(high == Approx(-8e-3 + 2 * 10 / steepest).margin(4e-6));
  CHECK(mass.lane_state(0).memory[0] == Approx(80 - steepest * 8e-3).epsilon(1e-12));
}

TEST_CASE("stops of two tables: lanes are those of each alone, and a run is taken up where it was left") {
  const auto evaluation = GENERATE(word("implicit"), word("conserving"));
  const Methods methods{{"consistent"}, table(straight, evaluation, back), {"midpoint"}};
  SceneSpec scene = thrown_mass(0.0123, 2);
  scene.stops.upper = Formula(0.03);
  constexpr double h = 2e-5;
  const std::vector<double> speeds = {1, 0.4, 1.7};
  const auto thrown = [&](std::vector<double> factors) {
    return [factors](const LaneSpec& lane) {
      std::vector<LaneSpec> lanes(factors.size(), lane);
      for (std::size_t l = 0; l < lanes.size(); ++l) lanes[l].velocity *= factors[l];
      return lanes;
    };
  };
  Marcher block = marcher(scene, 1, methods, h, {}, thrown(speeds));
  // While some are in contact.
  run(block, 0.0135);
  for (std::size_t l = 0; l < speeds.size(); ++l) {
    Marcher alone = marcher(scene, 1, methods, h, {}, thrown({speeds[l]}));
    run(alone, 0.01);
    Marcher again = marcher(scene, 1, methods, h, {}, thrown({speeds[l]}));
    again.set_clock(alone.step());
    again.set_lane(0, alone.program().lanes[0], alone.lane_state(0));
    again.march(block.step() - alone.step());
    INFO("speed " << 2 * speeds[l] << ", " << evaluation);
    CHECK(block.lane_state(static_cast<int>(l)).memory == again.lane_state(0).memory);
    CHECK(block.lane_state(static_cast<int>(l)).slots == again.lane_state(0).slots);
  }
  CHECK(block.lane_state(0).memory[0] < 0);
}

TEST_CASE("tables of a loop that would make energy are refused, with the place") {
  const auto refused = [](const ParameterTable& unloading) {
    try {
      law_of(table(measured, "implicit", unloading));
    } catch (const InputError& error) {
      return error.pointer() + ": " + error.what();
    }
    return std::string();
  };
  CHECK_THAT(refused({{0, 0}, {1.4e-2, 210}}),
             Contains("/unloading/1: unloading ends at [0.014, 210], loading at [0.015, 210]"));
  CHECK_THAT(refused({{0, 0}, {5e-3, 11}, {1.5e-2, 210}}),
             Contains("/unloading/1: at a depth of 0.005 m unloading gives 11 N and loading 10 N"));
  // Between its rows it is above a row of the loading table.
  CHECK_THAT(refused({{0, 0}, {1.5e-2, 210}}), Contains("/unloading: at a depth of 0.005 m unloading gives 70 N"));
  CHECK(refused(measured).empty());
}
