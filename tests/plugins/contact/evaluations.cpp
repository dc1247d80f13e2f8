// Where in a step a compliant law takes its force, and what that does to the energy. An undamped mass on a spring
// bounces between two stops, 100 steps to a swing.
#include "tests/plugins/contact/impacts.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

SceneSpec bouncing_mass() {
  SceneSpec scene;
  scene.structure = OscillatorSpec{1, 40, 0, {}};
  scene.stops.lower = Formula(-0.1);
  scene.stops.upper = Formula(0.12);
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.displacement = Formula(0.01);
  scene.initial.velocity = Formula(2.0);
  return scene;
}

/// Laws of one stiffness or another, all of which store 2 J within some hundredths of a metre.
Choice law_of(const std::string& name, const std::string& evaluation) {
  std::map<std::string, std::map<std::string, ParameterValue>> values = {
      {"penalty", {{"stiffness", 1e4}}},
      {"hertz", {{"stiffness", 1e5}}},
      {"layer", {{"stiffness", 1e4}, {"thickness", 0.01}}},
      {"barrier", {{"stiffness", 1e3}, {"thickness", 0.03}}},
      {"exponential", {{"force", 30.0}, {"length", 0.01}, {"reach", 5.0}}},
      {"hunt-crossley", {{"stiffness", 1e5}, {"damping", 0.05}}},
      {"kelvin-voigt", {{"stiffness", 1e4}, {"viscosity", 3.0}}},
      {"lankarani-nikravesh", {{"stiffness", 1e5}, {"restitution", 0.95}}},
      {"elasto-plastic", {{"stiffness", 1e4}, {"yield_force", 50.0}, {"hardening", 0.3}}},
      {"table",
       {{"depth_force", ParameterTable{{0, 0}, {0.01, 50}, {0.02, 200}}},
        {"unloading", ParameterTable{{0, 0}, {0.015, 60}, {0.02, 200}}}}}};
  Choice choice{name, values.at(name)};
  choice.values["evaluation"] = evaluation;
  return choice;
}

const Choice midpoint{"midpoint"};

constexpr double fine = 2.5e-4;
constexpr int fine_steps = 20000;

struct Run {
  double drift, gain, change, deepest;
  long contacts;
};

Run bounced(const Choice& law, const Choice& time, bool losses = false, double h = 2e-3, int steps = 5000) {
  Marcher mass = marcher(bouncing_mass(), 1, {{"consistent"}, law, time}, h);
  EnergyDrift kept(mass, losses);
  mass.start(&kept);
  mass.march(steps, &kept);
  INFO(law.name << " with " << time.name);
  REQUIRE(mass.status(0).running);
  return {kept.drift, kept.gain, kept.change, kept.deepest, kept.audit().contact(0).impacts};
}

}  // namespace

TEST_CASE("conserving laws keep the energy of the scheme and of the stops, whatever the law and the step") {
  const std::string name = GENERATE("penalty", "hertz", "layer", "barrier", "exponential");
  const Choice time = GENERATE(Choice{"midpoint"}, Choice{"kane"}, Choice{"newmark-dumont-paoli", {{"beta", 0.5}}});
  const Run run = bounced(law_of(name, "conserving"), time);
  INFO(name << " with " << time.name << ": drift " << run.drift << ", held " << run.deepest << ", impacts "
            << run.contacts);
  CHECK(run.contacts > 50);
  CHECK(run.deepest > 0.3);
  // Round-off of 5000 steps, a few units in the last place of the energy each: ½k δ² and its like for Hertz' powers.
  CHECK(run.drift < 5000 * 1e-15);
}

TEST_CASE("conserving laws that damp lose what they report, to round-off") {
  const std::string name = GENERATE("hunt-crossley", "kelvin-voigt", "lankarani-nikravesh", "elasto-plastic", "table");
  const Run run = bounced(law_of(name, "conserving"), midpoint, true);
  const Run alone = bounced(law_of(name, "conserving"), midpoint);
  INFO(name << ": drift " << run.drift << ", without the losses " << alone.change);
  CHECK(alone.change < -0.3);
  CHECK(alone.gain < 1e-12);
  CHECK(run.drift < 5000 * 1e-15);
}

TEST_CASE("the hybrid evaluation never gives energy where the law is linear, and little where it is not") {
  for (const char* name : {"penalty", "layer"}) {
    const Run linear = bounced(law_of(name, "hybrid"), midpoint);
    INFO(name << ": gain " << linear.gain << ", change " << linear.change);
    CHECK(linear.gain < 1e-12);
    CHECK(linear.change < 0);
  }
  // The midpoint rule of the work ∫Φ dδ errs by Φ''(Δδ)³/24: to one sign here, in the step of a swing of some 80 steps.
  const Run hertz = bounced(law_of("hertz", "hybrid"), midpoint, false, fine, fine_steps);
  INFO("hertz: gain " << hertz.gain << ", change " << hertz.change);
  CHECK(hertz.gain > 1e-9);
  CHECK(hertz.gain < 1e-4);
}

TEST_CASE("midpoint evaluations give and take energy step by step, implicit ones take it") {
  const std::string name = GENERATE("penalty", "hertz", "exponential");
  const Run middle = bounced(law_of(name, "midpoint"), midpoint, false, fine, fine_steps);
  const Run end = bounced(law_of(name, "implicit"), midpoint, false, fine, fine_steps);
  INFO(name << ": midpoint gain " << middle.gain << ", change " << middle.change << "; implicit gain " << end.gain
            << ", change " << end.change);
  CHECK(middle.gain > 1e-7);
  CHECK(middle.gain < 2e-3);
  // What is given at one end of a contact is taken at the other.
  CHECK(std::abs(middle.change) < 2e-3);
  CHECK(end.change < -0.03);
}

TEST_CASE("within contact midpoint, hybrid and conserving springs are one, and where the scheme averages alike") {
  // Pressed all along: a mass on its stop under its own spring.
  SceneSpec scene = bouncing_mass();
  scene.stops.lower = Formula(0.05);
  scene.stops.upper.reset();
  scene.initial.displacement = Formula(0.05);
  scene.initial.velocity = Formula(0.0);
  const auto place = [&](const char* evaluation) {
    Marcher mass = marcher(scene, 1, {{"consistent"}, law_of("penalty", evaluation), midpoint}, 1e-3);
    mass.start();
    mass.march(1, nullptr);
    LaneState state = mass.lane_state(0);
    state.slots = {0.045, 0.0};  // 5 mm beyond its stop
    mass.set_lane(0, mass.program().lanes[0], state);
    mass.march(7);  // a quarter of a swing of the spring takes 15
    return mass.tip(0);
  };
  const double conserving = place("conserving");
  CHECK(place("midpoint") == Approx(conserving).epsilon(1e-13));
  CHECK(place("hybrid") == Approx(conserving).epsilon(1e-13));
  CHECK(place("averaged") == Approx(conserving).epsilon(1e-13));
  CHECK(std::abs(place("implicit") - conserving) > 1e-6);
}

TEST_CASE("a point that begins a step beyond its stop gets its energy back, pushed before or not") {
  // Within the layer at the start, leaving so fast that it is out of it after one step.
  SceneSpec scene = bouncing_mass();
  scene.stops.upper.reset();
  scene.initial.displacement = Formula(-0.095);
  scene.initial.velocity = Formula(6.0);
  Marcher mass = marcher(scene, 1, {{"consistent"}, law_of("layer", "conserving"), midpoint}, 2e-3);
  const double before = 0.5 * 36 + 20 * 0.095 * 0.095 + mass.law().potential({.depth = -0.005});
  REQUIRE(mass.law().potential({.depth = -0.005}) > 0.1);
  EnergyDrift kept(mass);
  mass.start(&kept);
  mass.march(1, &kept);
  CHECK(kept.audit().energy(0).contact == 0);
  CHECK(kept.audit().energy(0).scheme == Approx(before).epsilon(1e-13));
}

TEST_CASE("the words of evaluation are one list for all laws of the depth, and a scheme without the measure says so") {
  const std::vector<std::string> words = {"implicit", "averaged", "explicit", "midpoint", "conserving", "hybrid"};
  int laws = 0;
  for (const std::string& name : registry().names(Role::contact))
    for (const ParameterSpec& spec : registry().manual(Role::contact, name)->parameters) {
      if (spec.key != "evaluation") continue;
      INFO(name);
      CHECK(spec.words == words);
      ++laws;
    }
  CHECK(laws >= 8);
  for (const char* evaluation : {"midpoint", "hybrid", "conserving"}) {
    const Methods methods{{"consistent"}, law_of("penalty", evaluation), {"central-difference"}};
    auto program = compiled(problem_of(bouncing_mass(), 1, methods.mass), methods, 1e-4);
    if (const auto* refusal = std::get_if<Refusal>(&program))
      CHECK(refusal->sentence.text.find("before the step") != std::string::npos);
  }
}
