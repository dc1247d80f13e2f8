// A stop that yields, against closed forms, and what its set is to impacts after it.
#include "tests/plugins/contact/impacts.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

constexpr double own_stiffness = 1e4, own_yield = 50;  // N/m, N: yields from 5 mm on

Choice yielding(double hardening, const std::string& evaluation, double force = own_yield) {
  return {"elasto-plastic",
          {{"stiffness", own_stiffness}, {"yield_force", force}, {"hardening", hardening}, {"evaluation", evaluation}}};
}

/// The work that a set takes, J.
double work_of(double set, double hardening) {
  return own_yield * set + 0.5 * hardening * own_stiffness / (1 - hardening) * set * set;
}

/// Sets of a lane, m: of the lower stop, of the upper one.
std::vector<double> sets_of(const Marcher& marcher, int lane = 0) {
  return marcher.lane_state(lane).memory;
}

/// Between two stops, thrown at the lower one.
SceneSpec between_stops(double speed = 2) {
  SceneSpec scene = thrown_mass(0.0123, speed);
  scene.stops.upper = Formula(0.03);
  return scene;
}

}  // namespace

TEST_CASE("a stop that yields: set, depth, rebound and loss of one impact in closed form") {
  // ½mv² − F²/2k = F a + ½ηk a² beyond the yield depth F/k; s = (1−η) a; off with ½mv² = (F + ηk a)²/2k.
  const double hardening = GENERATE(0.0, 0.25, 0.9), speed = GENERATE(1.0, 2.0);
  const auto evaluation = GENERATE(word("averaged"), word("midpoint"), word("conserving"), word("hybrid"));
  const double left = 0.5 * speed * speed - 0.5 * own_yield * own_yield / own_stiffness;
  const double beyond =
      2 * left / (own_yield + std::sqrt(own_yield * own_yield + 2 * hardening * own_stiffness * left));
  const double set = (1 - hardening) * beyond,
               rebound = (own_yield + hardening * own_stiffness * beyond) / std::sqrt(own_stiffness);
  REQUIRE(0.5 * speed * speed - 0.5 * rebound * rebound == Approx(work_of(set, hardening)).epsilon(1e-12));
  constexpr double h = 1e-5;
  Marcher mass =
      marcher(thrown_mass(0.0123, speed), 1, {{"consistent"}, yielding(hardening, evaluation), {"midpoint"}}, h);
  const EnergyAudit audit = audited(mass, 0.1);
  INFO("η " << hardening << ", v " << speed << ", " << evaluation << ": set " << sets_of(mass)[0] << " of " << set
            << ", speed " << audit.tip_velocity(0) << " of " << rebound);
  REQUIRE(audit.contact(0).impacts == 1);
  REQUIRE(audit.contact(0).active == 0);
  // A contact lasts some 2000 steps; where it begins and ends the force errs in one of them: h √(k/m) = 1e-3 of a
  // step's.
  CHECK(sets_of(mass)[0] == Approx(set).epsilon(1e-3));
  CHECK(sets_of(mass)[1] == 0);
  CHECK(audit.contact(0).deepest_penetration == Approx(own_yield / own_stiffness + beyond).epsilon(1e-3));
  CHECK(audit.tip_velocity(0) == Approx(rebound).epsilon(1e-3));
  CHECK(audit.energy(0).contact == 0);
  CHECK(audit.lost_at_stops(0) == Approx(work_of(set, hardening)).epsilon(2e-3));
  CHECK(audit.totals(0).work_of_law == Approx(work_of(set, hardening)).epsilon(2e-3));
}

TEST_CASE("stages that go back in time: memory goes on once a step, and an impact is one") {
  // sdirk of order 3 asks at 0.79 h, then at 0.21 h. The set takes F a + ½ηk a², the mass comes back once.
  const double hardening = GENERATE(0.0, 0.25);
  const double left = 0.5 * 4 - 0.5 * own_yield * own_yield / own_stiffness;
  const double beyond =
      2 * left / (own_yield + std::sqrt(own_yield * own_yield + 2 * hardening * own_stiffness * left));
  const double lost = work_of((1 - hardening) * beyond, hardening);
  for (const double h : {4e-5, 1e-5}) {
    INFO("η " << hardening << ", h " << h);
    const auto after = [&](const Choice& time) {
      Marcher mass = marcher(
          thrown_mass(0.0123, 2), 1,
          {{"consistent"},
           {"elasto-plastic", {{"stiffness", own_stiffness}, {"yield_force", own_yield}, {"hardening", hardening}}},
           time},
          h);
      return audited(mass, 0.1);
    };
    const EnergyAudit audit = after({"sdirk", {{"order", 3LL}}}), other = after({"newmark"});
    CHECK(audit.contact(0).impacts == 1);
    CHECK(audit.totals(0).work_of_law == Approx(lost).epsilon(5e-3));
    CHECK(audit.contact(0).impulse == Approx(other.contact(0).impulse).epsilon(5e-3));
    CHECK(static_cast<double>(audit.contact(0).contact_steps) ==
          Approx(static_cast<double>(other.contact(0).contact_steps)).margin(2));
  }
}

TEST_CASE("evaluated conserving, what is lost is the work of the sets, whatever the step") {
  const double hardening = GENERATE(0.0, 0.3), h = GENERATE(1e-4, 2e-3);
  Marcher mass = marcher(between_stops(), 1, {{"consistent"}, yielding(hardening, "conserving"), {"midpoint"}}, h);
  EnergyDrift kept(mass, true);
  mass.start(&kept);
  mass.march(static_cast<long long>(0.5 / h), &kept);
  REQUIRE(mass.status(0).running);
  const std::vector<double> sets = sets_of(mass);
  const double work = work_of(sets[0], hardening) + work_of(sets[1], hardening);
  INFO("η " << hardening << ", h " << h << ": sets " << sets[0] << " and " << sets[1] << ", drift " << kept.drift);
  CHECK(kept.audit().contact(0).impacts > 2);
  CHECK(work > 0.5);  // of 2 J
  CHECK(kept.change < 1e-12);
  // Round-off of each step: the set is known to 1e-16 of the depth, the force to k times that.
  CHECK(kept.drift < 1e-12);
  CHECK(kept.audit().totals(0).work_of_law == Approx(work).epsilon(1e-11));
  CHECK(kept.audit().lost_at_stops(0) == Approx(work).epsilon(1e-11));
  CHECK(std::abs(kept.audit().totals(0).balance_residual()) < 1e-10);
}

TEST_CASE("a stop that never yields is the penalty, and so is one that hardens fully but for 1e-15") {
  const auto evaluation = GENERATE(word("implicit"), word("averaged"), word("explicit"), word("midpoint"),
                                   word("conserving"), word("hybrid"));
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-4;
  scene.stops.place = StopsSpec::Place::nodes;
  const auto tip = [&](const Choice& law) {
    Marcher beam = marcher(scene, 6, {{"consistent"}, law, {"newmark-dumont-paoli"}}, 1e-4);
    run(beam, 0.3);
    REQUIRE(beam.status(0).running);
    return beam.tip(0);
  };
  const double spring = tip({"penalty", {{"stiffness", 1e3}, {"evaluation", evaluation}}});
  INFO(evaluation);
  // Efforts to round-off, amplified over some impacts of the beam.
  for (const auto& [force, hardening] : {std::pair{1e30, 0.0}, {1.0, 1 - 1e-15}})
    CHECK(tip({"elasto-plastic",
               {{"stiffness", 1e3}, {"yield_force", force}, {"hardening", hardening}, {"evaluation", evaluation}}}) ==
          Approx(spring).margin(1e-8));
}

TEST_CASE("a set is a larger gap: what follows is the motion before a stop that stands so far behind") {
  const auto evaluation = GENERATE(word("implicit"), word("explicit"), word("conserving"));
  constexpr double set = 0.003, h = 1e-4;
  const double side = GENERATE(1.0, -1.0);
  const auto thrown = [&](double gap) {
    SceneSpec scene = thrown_mass(side * 0.0123, side);
    scene.stops = {};
    (side > 0 ? scene.stops.lower : scene.stops.upper) = Formula(-side * gap);
    scene.stops.place = StopsSpec::Place::tip;
    return scene;
  };
  const auto place = [&](const Choice& law, double gap, const std::vector<double>& sets) {
    Marcher mass = marcher(thrown(gap), 1, {{"consistent"}, law, {"midpoint"}}, h);
    mass.start();
    LaneState state = mass.lane_state(0);
    state.memory = sets;
    mass.set_lane(0, mass.program().lanes[0], state);
    mass.march(700);
    return mass.tip(0);
  };
  const double behind = place({"penalty", {{"stiffness", own_stiffness}, {"evaluation", evaluation}}}, set, {});
  const std::vector<double> sets = side > 0 ? std::vector{set, 0.0} : std::vector{0.0, set};
  INFO(evaluation << ", side " << side);
  REQUIRE(side * behind > 0.01);
  CHECK(place(yielding(0, evaluation, 1e9), 0, sets) == Approx(behind).epsilon(1e-12));
  // A set of the other stop is none of this one's.
  CHECK(std::abs(place(yielding(0, evaluation, 1e9), 0, {sets[1], sets[0]}) - behind) > 1e-4);
}

TEST_CASE("a second impact as fast as the first sets a hardened stop no further") {
  constexpr double h = 1e-5, hardening = 0.5;
  Marcher mass = marcher(thrown_mass(), 1, {{"consistent"}, yielding(hardening, "conserving"), {"midpoint"}}, h);
  run(mass, 0.1);
  const double first = sets_of(mass)[0];
  REQUIRE(first > 0);
  // Thrown again, at what the stop holds without yielding: the speed at which it came off.
  LaneState state = mass.lane_state(0);
  state.slots[1] = -state.slots[1];
  mass.set_lane(0, mass.program().lanes[0], state);
  const EnergyAudit audit(mass);
  mass.march(15000);
  CHECK(sets_of(mass)[0] == Approx(first).epsilon(1e-6));
}

TEST_CASE("stops that yield: lanes are those of each alone, and a run is taken up where it was left") {
  const auto evaluation = GENERATE(word("implicit"), word("conserving"));
  const Methods methods{{"consistent"}, yielding(0.2, evaluation), {"midpoint"}};
  constexpr double h = 2e-5;
  const std::vector<double> speeds = {1, 0.4, 1.7};
  Marcher block = marcher(between_stops(), 1, methods, h, {}, [&](const LaneSpec& lane) {
    std::vector<LaneSpec> lanes(3, lane);
    for (std::size_t l = 0; l < lanes.size(); ++l) lanes[l].velocity *= speeds[l];
    return lanes;
  });
  run(block, 0.05);
  for (std::size_t l = 0; l < speeds.size(); ++l) {
    const auto one = [&](const LaneSpec& lane) {
      std::vector<LaneSpec> lanes(1, lane);
      lanes[0].velocity *= speeds[l];
      return lanes;
    };
    Marcher alone = marcher(between_stops(), 1, methods, h, {}, one);
    run(alone, 0.02);
    Marcher again = marcher(between_stops(), 1, methods, h, {}, one);
    again.set_clock(alone.step());
    again.set_lane(0, alone.program().lanes[0], alone.lane_state(0));
    again.march(block.step() - alone.step());
    const LaneState beside = block.lane_state(static_cast<int>(l)), own = again.lane_state(0);
    INFO("speed " << 2 * speeds[l] << ", " << evaluation);
    CHECK(beside.memory == own.memory);
    CHECK(beside.slots == own.slots);
    CHECK(own.memory[0] + own.memory[1] > 0);
  }
}
