// Compliant laws that are not linear, on a mass thrown at a stop, where what they must do is known in closed form.
#include <numbers>
#include <ricochet/measure/orbits/lyapunov.hpp>

#include "tests/plugins/contact/impacts.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

// χv(1+e) = ln[(1+χv)/(1−eχv)], by halves: the right side minus the left grows with e.
double damped_restitution(double chi_v) {
  double low = 0, high = std::min(1.0, 1 / chi_v);
  for (int i = 0; i < 200; ++i) {
    const double e = 0.5 * (low + high);
    (std::log((1 + chi_v) / (1 - e * chi_v)) > chi_v * (1 + e) ? high : low) = e;
  }
  return low;
}

SceneSpec shaken_oscillator() {
  SceneSpec scene;
  scene.structure = OscillatorSpec{1, 1, 0.3, {}};
  std::get<OscillatorSpec>(scene.structure).force.amplitude = 1;
  std::get<OscillatorSpec>(scene.structure).force.pulsation = 2.2;
  scene.stops.lower = Formula(-0.1);
  scene.stops.place = StopsSpec::Place::tip;
  scene.support.pulsation = 2.2;
  return scene;
}

}  // namespace

TEST_CASE("Hertz: depth, duration and speed of an impact in closed form") {
  // δ_max = ((n+1) m v²/(2k))^(1/(n+1)), T = 2√π Γ(1+1/(n+1))/Γ(½+1/(n+1)) δ_max/v.
  const double n = 1.5, k = 1e4;
  const double deepest = std::pow((n + 1) / (2 * k), 1 / (n + 1)), r = 1 / (n + 1);
  const double lasting = 2 * std::sqrt(std::numbers::pi) * std::tgamma(1 + r) / std::tgamma(0.5 + r);
  REQUIRE(deepest == Approx(0.0274640136).epsilon(1e-9));
  REQUIRE(lasting == Approx(2.9432751843).epsilon(1e-9));
  const Choice law{"hertz", {{"stiffness", k}, {"evaluation", word("averaged")}}};
  std::vector<double> steps, errors;
  for (const double h : {1e-3, 5e-4, 2.5e-4, 1.25e-4}) {
    const Bounce b = bounce(law, h);
    // A trapezium of a motion with a corner in its third derivative: h² of the contact's own (v/δ_max)².
    const double scale = h / deepest;
    CHECK(b.deepest == Approx(deepest).epsilon(scale * scale));
    CHECK(b.contact == Approx(lasting * deepest).margin(2 * h));
    CHECK(b.speed == Approx(1).margin(scale * scale));
    CHECK(b.taken == 0);
    steps.push_back(std::log(h));
    // Where a mass is that left at 1 m/s: the duration of the contact, free of the grid of steps.
    errors.push_back(std::log(std::abs(b.place - (0.25 - 0.0123 - lasting * deepest))));
  }
  INFO("errors " << std::exp(errors[0]) << " to " << std::exp(errors.back()));
  CHECK(fitted_slope(steps, errors) == Approx(2).margin(0.3));
}

TEST_CASE("Hertz with exponent 1 is the penalty") {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-4;
  scene.stops.place = StopsSpec::Place::nodes;
  const auto evaluation = GENERATE(word("implicit"), word("averaged"), word("explicit"), word("midpoint"),
                                   word("conserving"), word("hybrid"));
  const auto tip = [&](const Choice& law) {
    Marcher beam = marcher(scene, 6, {{"consistent"}, law, {"newmark-dumont-paoli"}}, 1e-4);
    run(beam, 0.3);
    REQUIRE(beam.status(0).running);
    return beam.tip(0);
  };
  const double spring = tip({"penalty", {{"stiffness", 1e3}, {"evaluation", evaluation}}});
  const double power = tip({"hertz", {{"stiffness", 1e3}, {"exponent", 1.0}, {"evaluation", evaluation}}});
  INFO(evaluation);
  // Efforts to round-off, amplified over some impacts of the beam.
  CHECK(power == Approx(spring).margin(1e-8));
}

TEST_CASE("Hunt and Crossley: the restitution follows from χv alone") {
  REQUIRE(damped_restitution(0.6) == Approx(0.711950).epsilon(1e-6));
  REQUIRE(damped_restitution(2) == Approx(0.410720).epsilon(1e-6));
  const double chi = GENERATE(0.6, 2.0);
  const double n = GENERATE(1.0, 1.5, 2.0);
  const auto evaluation = GENERATE(word("implicit"), word("averaged"), word("explicit"), word("midpoint"),
                                   word("conserving"), word("hybrid"));
  const auto error = [&](double h) {
    const Bounce b = bounce(
        {"hunt-crossley", {{"stiffness", 1e4}, {"exponent", n}, {"damping", chi}, {"evaluation", evaluation}}}, h);
    // What the law reports is what the mass lost, to the order of the scheme.
    // The end of the step is later than its middle by h/2: a loss of its own, 115 h at n = 1.
    CHECK(b.taken == Approx(0.5 * (1 - b.speed * b.speed)).margin(150 * h));
    return std::abs(b.speed - damped_restitution(chi));
  };
  INFO("χv " << chi << ", n " << n << ", " << evaluation);
  // v/δ_max is 36 to 100 /s: first order at worst.
  const double coarse = error(1e-4), fine = error(2.5e-5);
  CHECK(fine < 100 * 2.5e-5);
  CHECK((fine < 0.4 * coarse || fine < 1e-5));
}

TEST_CASE("Kelvin and Voigt: the restitution in closed form, and the point is let go where the force is zero") {
  // e = exp[−(b/w)(π − atan2(2bw, w² − b²))], b = c/2m, w² = k/m − b².
  const double k = 1e4, c = 40, b = c / 2, w = std::sqrt(k - b * b);
  const double e = std::exp(-b / w * (std::numbers::pi - std::atan2(2 * b * w, w * w - b * b)));
  REQUIRE(e == Approx(0.571740).epsilon(1e-6));
  const std::string evaluation = GENERATE("averaged", "midpoint", "conserving", "hybrid");
  INFO(evaluation);
  const Choice law{"kelvin-voigt", {{"stiffness", k}, {"viscosity", c}, {"evaluation", evaluation}}};
  std::vector<double> errors;
  for (const double h : {1e-4, 2.5e-5}) {
    const Bounce one = bounce(law, h, 0.25, thrown_mass(), {"midpoint"});
    errors.push_back(std::abs(one.speed - e));
    CHECK(one.taken == Approx(0.5 * (1 - one.speed * one.speed)).margin(20 * h));
  }
  INFO(errors[0] << " and " << errors[1]);
  // First order where the step that enters feels the jump of the force: c h/m of the speed at most.
  CHECK(errors[1] < 0.5 * c * 2.5e-5);
  // In contact to the end with a force that is never negative and falls to zero before the depth does.
  class Watch final : public StepObserver {
   public:
    double least = 1, last = 0, depth = 0;
    void stage_solved(const Marcher& marcher, const StageView& view) override {
      const double p = view.effort[0][0];
      least = std::min(least, p);
      if (p > 0) last = p;
      if (p == 0 && last > 0 && depth == 0) depth = marcher.penetration(0);
    }
    void step_done(Marcher&) override {}
  } watch;
  Marcher mass = marcher(thrown_mass(), 1, {{"consistent"}, law, {"midpoint"}}, 2.5e-5);
  mass.start(&watch);
  mass.march(4000, &watch);
  CHECK(watch.least == 0);
  // Of the largest force, c v: what a step of the force's fall leaves.
  CHECK(watch.last < 0.01 * c);
  // k δ = −c δ̇ where it lets go.
  CHECK(watch.depth == Approx(c * e / k).epsilon(0.02));
}

TEST_CASE("a barrier is never passed by an evaluation at the end of the step, however large the step") {
  const double D = 1e-3;
  const double h = GENERATE(1e-5, 4e-4, 1e-2);
  const Choice law{"barrier", {{"stiffness", GENERATE(10.0, 1e4)}, {"thickness", D}}};
  // Not Newmark's: stiff and at the end of the step, it throws a mass back faster than it came.
  const Choice time = GENERATE(Choice{"midpoint"}, Choice{"kane"}, Choice{"newmark-dumont-paoli"});
  SceneSpec scene = thrown_mass();
  scene.stops.upper = Formula(0.02);
  Marcher mass = marcher(scene, 1, {{"consistent"}, law, time}, h);
  const EnergyAudit audit = audited(mass, 2000 * h);
  INFO(time.name << ", h = " << h << ": " << (mass.status(0).running ? "" : text(mass.status(0).end)));
  CHECK(mass.status(0).running);
  CHECK(audit.contact(0).impacts > 0);
  CHECK(audit.contact(0).deepest_penetration == 0);
}

TEST_CASE("a step that no force holds back lands beyond a barrier, where it has none: that is said") {
  const Choice law{"barrier", {{"stiffness", 1e3}, {"thickness", 1e-3}}};
  // A step of 10 mm at 1 m/s into a barrier of 1 mm.
  Marcher mass = marcher(thrown_mass(), 1, {{"consistent"}, law, {"central-difference"}}, 1e-2);
  mass.start();
  mass.march(100);
  REQUIRE_FALSE(mass.status(0).running);
  CHECK(mass.status(0).end.failed());
  CHECK_THAT(text(mass.status(0).end), Catch::Contains("no finite force") && Catch::Contains("take a smaller step"));
}

TEST_CASE("Lankarani and Nikravesh do not deliver their own restitution, at any speed") {
  // Asks for 0.8, and gives e of χv = ¾(1 − 0.64).
  REQUIRE(damped_restitution(0.75 * 0.36) == Approx(0.847102).epsilon(1e-6));
  const double speed = GENERATE(1.0, 0.2);
  const double h = 2e-5 / speed;
  const Choice law{"lankarani-nikravesh", {{"stiffness", 1e4}, {"restitution", 0.8}, {"evaluation", word("averaged")}}};
  const Bounce b = bounce(law, h, 0.25 / speed, thrown_mass(0.0123, speed));
  CHECK(b.speed / speed == Approx(0.847102).margin(1e-4));
}

TEST_CASE("each impact has a speed of its own, and a lane takes it along") {
  // Thrown at two stops: each bounce keeps 0.847102 of what is left.
  SceneSpec scene = thrown_mass(0.02);
  scene.stops.upper = Formula(0.04);
  const Choice law{"lankarani-nikravesh", {{"stiffness", 1e4}, {"restitution", 0.8}, {"evaluation", word("averaged")}}};
  const Methods methods{{"consistent"}, law, midpoint_like};
  const double h = 2e-5;
  Marcher alone = marcher(scene, 1, methods, h);
  const EnergyAudit audit = audited(alone, 0.4);
  REQUIRE(audit.contact(0).impacts == 3);
  REQUIRE(audit.contact(0).active == 0);
  CHECK(std::abs(audit.tip_velocity(0)) == Approx(std::pow(0.847102, 3)).margin(3e-4));

  // Interrupted within contact, and taken up in another lane of another block.
  Marcher first = marcher(scene, 1, methods, h);
  run(first, 0.03);
  const LaneState state = first.lane_state(0);
  REQUIRE(state.memory.size() == 1);
  // The trapezium's closing speed at its first step beyond the stop.
  CHECK(state.memory[0] == Approx(1).margin(1e-6));
  Marcher block = marcher(scene, 1, methods, h, {}, [](const LaneSpec& lane) {
    std::vector<LaneSpec> lanes(3, lane);
    lanes[0].velocity *= 0.5;
    return lanes;
  });
  run(block, 0.011);
  block.set_clock(first.step());
  block.set_lane(2, first.program().lanes[0], state);
  first.march(4000);
  block.march(4000);
  CHECK(first.lane_state(0).slots == block.lane_state(2).slots);
  CHECK(first.lane_state(0).memory == block.lane_state(2).memory);
}

TEST_CASE("conserving springs give back to the scheme's energy what they took, to round-off") {
  const auto law = GENERATE(Choice{"penalty", {{"stiffness", 3e3}, {"evaluation", std::string("conserving")}}},
                            Choice{"hertz", {{"stiffness", 3e4}, {"evaluation", std::string("conserving")}}});
  const double beta = GENERATE(0.25, 0.5);
  SceneSpec scene = working_set();
  scene.stops.place = StopsSpec::Place::nodes;
  Marcher beam = marcher(scene, 8, {{"consistent"}, law, {"newmark-dumont-paoli", {{"beta", beta}}}}, 2e-4);
  EnergyDrift kept(beam);
  beam.start(&kept);
  beam.march(2500, &kept);
  REQUIRE(beam.status(0).running);
  INFO(law.name << ", β = " << beta);
  CHECK(kept.deepest > 0.1);
  // 2500 steps of round-off; the force itself is known to 1e-14 of its terms.
  CHECK(kept.drift < 1e-12 * 2500 / 50);
  // Bouncing of one mass.
  const Bounce b = bounce(law, 1e-3, 0.4);
  CHECK(b.speed == Approx(1).epsilon(1e-12));
}

TEST_CASE("a layer acts before the stop, and penetration is measured at the stop") {
  // v √(m/k) = 0.01 m of compression, D = 0.004 m of it before the stop.
  const double k = 1e4, D = GENERATE(0.004, 0.02), compression = 0.01, height = 0.0333;
  const Choice law{"layer", {{"stiffness", k}, {"thickness", D}, {"evaluation", word("averaged")}}};
  const double h = 1e-5;
  Marcher mass = marcher(thrown_mass(height), 1, {{"consistent"}, law, midpoint_like}, h);
  const EnergyAudit audit = audited(mass, 0.1);
  REQUIRE(mass.status(0).running);
  CHECK(audit.contact(0).first_impact == Approx(height - D).margin(2 * h));
  CHECK(audit.contact(0).deepest_penetration == Approx(std::max(0.0, compression - D)).margin(1e-6));
  CHECK(audit.contact(0).first_release - audit.contact(0).first_impact ==
        Approx(std::numbers::pi * compression).margin(3 * h));
  CHECK(audit.energy(0).common() == Approx(0.5).epsilon(1e-5));
  // At the stop itself the layer holds ½ k D².
  CHECK(mass.law().potential({}) == Approx(0.5 * k * D * D));
  CHECK(mass.law().potential({.depth = -D}) == 0);
}

TEST_CASE("tangents of nonlinear laws are the derivative of the step, by all three slopes") {
  const auto law = GENERATE(Choice{"hunt-crossley", {{"stiffness", 300.0}, {"damping", 0.4}}},
                            Choice{"hertz", {{"stiffness", 300.0}}});
  const auto evaluation = GENERATE(word("implicit"), word("averaged"), word("explicit"), word("midpoint"),
                                   word("conserving"), word("hybrid"));
  const auto place = GENERATE(StopsSpec::Place::tip, StopsSpec::Place::nodes);
  Choice choice = law;
  choice.values["evaluation"] = evaluation;
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-4;
  scene.stops.place = place;
  CompileOptions options;
  options.tangents = 1;
  const auto three = [](const LaneSpec& lane) { return std::vector<LaneSpec>(3, lane); };
  Marcher beam = marcher(scene, 4, {{"consistent"}, choice, {"newmark-dumont-paoli"}}, 1e-4, options, three);
  beam.start();
  const LaneState base = beam.lane_state(0);
  const auto shifted = [](LaneState state, const LaneState& way, double by) {
    for (std::size_t i = 0; i < state.slots.size(); ++i) state.slots[i] += by * way.slots[i];
    return state;
  };
  LaneState way = base;
  std::fill(way.efforts.begin(), way.efforts.end(), 0.0);
  const double offset = 1e-5;
  beam.set_tangent(0, 0, way);
  beam.set_lane(1, beam.program().lanes[0], shifted(base, way, offset));
  beam.set_lane(2, beam.program().lanes[0], shifted(base, way, -offset));
  EnergyAudit audit(beam);
  // Into the first contact and out of it, with free flight behind.
  beam.march(1500, &audit);
  REQUIRE(audit.contact(0).contact_steps > 100);
  const LaneState tangent = beam.tangent(0, 0), ahead = beam.lane_state(1), behind = beam.lane_state(2);
  double wrong = 0, size = 0;
  for (std::size_t i = 0; i < tangent.slots.size(); ++i) {
    const double difference = (ahead.slots[i] - behind.slots[i]) / (2 * offset);
    wrong += std::pow(tangent.slots[i] - difference, 2);
    size += difference * difference;
  }
  INFO(law.name << ", " << evaluation << ", relative error " << std::sqrt(wrong / size));
  // offset² from the curvature, round-off over the offset, and steps at the edge of contact, where slopes are small.
  CHECK(std::sqrt(wrong / size) < 1e-6);
}

TEST_CASE("tangents and twins of nonlinear laws agree, and a law without slopes has no tangents") {
  const auto law = GENERATE(
      Choice{"hunt-crossley", {{"stiffness", 300.0}, {"damping", 0.4}, {"evaluation", std::string("implicit")}}},
      Choice{"hunt-crossley", {{"stiffness", 300.0}, {"damping", 0.4}, {"evaluation", std::string("averaged")}}},
      Choice{"hunt-crossley", {{"stiffness", 300.0}, {"damping", 0.4}, {"evaluation", std::string("explicit")}}},
      Choice{"layer", {{"stiffness", 100.0}, {"thickness", 0.05}}});
  const int steps = 400, periods = 200;
  const double pulsation = 2.2, h = 2 * std::numbers::pi / pulsation / steps;
  const SceneSpec scene = shaken_oscillator();
  const auto program = [&](int tangents, const Choice& choice) {
    CompileOptions options;
    options.tangents = tangents;
    return compiled(problem_of(scene, 1, {"consistent"}), {{"consistent"}, choice, {"newmark-dumont-paoli"}}, h,
                    options);
  };
  const auto ready = [&](int tangents) { return std::move(std::get<Program>(program(tangents, law))); };
  Marcher start{ready(0)};
  start.start();
  start.march(static_cast<long long>(steps) * 100 + 1 - start.step());
  const std::vector<LaneState> states = {start.lane_state(0)};
  LyapunovPlan plan;
  plan.steps_per_period = steps;
  plan.pulsation = pulsation;
  plan.discard = 20;
  plan.periods = periods;
  plan.keep_orbit = true;
  const auto tangent = lyapunov_rates(ready(1), states, plan);
  const auto twin = twin_rates(ready(0), states, tangent, plan, 1e-8);
  REQUIRE_FALSE(tangent[0].end);
  REQUIRE_FALSE(twin[0].end);
  const auto mean = [](const std::vector<double>& rates) {
    double sum = 0;
    for (const double rate : rates) sum += rate / static_cast<double>(rates.size());
    return sum;
  };
  INFO(law.name << ": " << mean(tangent[0].rates[0]) << " and " << mean(twin[0].rates[0]));
  // Without contact the exponent would be −c/(2m) = −0.15: the stop is in it.
  CHECK(std::abs(mean(tangent[0].rates[0]) + 0.15) > 0.01);
  CHECK(mean(twin[0].rates[0]) == Approx(mean(tangent[0].rates[0])).epsilon(0.01).margin(2e-3));

  const auto refused = program(1, {"lankarani-nikravesh", {{"stiffness", 300.0}, {"restitution", 0.8}}});
  REQUIRE(std::holds_alternative<Refusal>(refused));
  CHECK(std::get<Refusal>(refused).sentence.text.find("twins") != std::string::npos);
}
