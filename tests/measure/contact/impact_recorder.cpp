// Impacts of each point keep the laws of impact, and add up to what the audit counts.
#include <ricochet/measure/contact/impact_recorder.hpp>

#include "tests/allocations.hpp"
#include "tests/plugins/contact/impacts.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

struct Recorded {
  Marcher march;
  EnergyAudit audit;
  ImpactRecorder recorder;

  Recorded(Marcher made, double duration, std::size_t most = ImpactRecorder::most_impacts)
      : march(std::move(made)), audit(march), recorder(march, most) {
    march.start({&audit, &recorder});
    march.march(std::llround(duration / march.program().h) - march.step(), {&audit, &recorder});
    recorder.finish(march);
  }
  const std::vector<Impact>& impacts() const { return recorder.impacts(0); }
};

constexpr double bob = 2, spring = 200, stop = -0.02, amplitude = 0.1;

/// Let go from rest at 0.1 m, with a stop 0.02 m beyond its equilibrium.
SceneSpec bouncing() {
  SceneSpec scene;
  scene.structure = OscillatorSpec{bob, spring, 0, {}};
  scene.stops.lower = Formula(stop);
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.displacement = Formula(amplitude);
  scene.initial.velocity = Formula(0.0);
  return scene;
}

/// Of the exact motion: ½mv² = ½k(A² − d²) at each impact, and v⁺ = e v⁻.
std::vector<double> exact_speeds(double e, std::size_t count) {
  std::vector<double> speeds;
  double level = spring / bob * (amplitude * amplitude - stop * stop);
  for (std::size_t i = 0; i < count; ++i, level *= e * e) speeds.push_back(std::sqrt(level));
  return speeds;
}

/// A beam of 15 elements with stops below, at rest under a load that comes and goes; the tip lies on its stop.
SceneSpec propped_beam() {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-4;
  scene.initial = {};
  scene.stops = {};
  scene.stops.lower = Formula("x>1.4 ? 0 : -0.0003", "/scene/stops/lower", "x");
  scene.stops.place = StopsSpec::Place::positions;
  scene.stops.positions = {0.5, 1.0, 1.501};
  scene.load = Formula("-4*(1 + sin(25*t))", "/scene/load");
  return scene;
}

}  // namespace

TEST_CASE("a bouncing mass: as many impacts as the exact motion, thrown back with e, for m(1+e)v each") {
  const auto time = GENERATE(Choice{"newmark-dumont-paoli"}, Choice{"newmark-dumont-paoli", {{"beta", 0.25}}},
                             Choice{"moreau-jean"}, Choice{"paoli-schatzman"});
  const double e = GENERATE(1.0, 0.7);
  INFO(time.name << " e = " << e);
  constexpr std::size_t impacts = 4;
  for (const double h : {1e-3, 1e-4}) {
    Choice with = time;
    with.values["restitution"] = e;
    // Exact: impacts at 0.18, 0.53 … 1.24 s and 1.60 s for e = 1; at 0.18, 0.55 … 1.36 s and 1.82 s for 0.7.
    const Recorded run(marcher(bouncing(), 1, {{"consistent"}, {"signorini"}, with}, h), 1.5);
    INFO("h = " << h);
    REQUIRE(run.impacts().size() == impacts);
    CHECK(run.recorder.count(0) == run.audit.contact(0).impacts);
    const std::vector<double> exact = exact_speeds(e, impacts);
    // A sub-step changes the speed by h k|x|/m ≤ 4 h here, and an impact is found up to two steps late.
    const double slack = 12 * h;
    double impulse = 0;
    for (std::size_t i = 0; i < impacts; ++i) {
      const Impact& impact = run.impacts()[i];
      INFO("impact " << i << " at " << impact.time);
      CHECK(impact.side == StopSide::lower);
      CHECK_FALSE(impact.open_end);
      CHECK(impact.speed_in == Approx(exact[i]).margin(slack));
      CHECK(impact.speed_out == Approx(e * exact[i]).margin(slack));
      CHECK(impact.speed_out / impact.speed_in == Approx(e).margin(slack / exact[i]));
      CHECK(impact.impulse == Approx(bob * (1 + e) * exact[i]).margin(2 * bob * slack));
      CHECK(impact.peak_force * impact.duration >= impact.impulse * (1 - 1e-12));
      CHECK(impact.duration <= 3 * h * (1 + 1e-12));
      impulse += impact.impulse;
    }
    CHECK(run.impacts().front().time == Approx(run.audit.contact(0).first_impact).epsilon(1e-14));
    CHECK(impulse == Approx(run.audit.contact(0).impulse).epsilon(1e-13));
    const StopTotals& totals = run.recorder.totals(0, 0, StopSide::lower);
    CHECK(totals.impacts == static_cast<long long>(impacts));
    CHECK(totals.impulse == Approx(impulse).epsilon(1e-13));
    CHECK(totals.mean_force() <= totals.rms_force() * (1 + 1e-14));
    CHECK(totals.rms_force() <= totals.peak_force * (1 + 1e-14));
    CHECK(totals.fastest == Approx(exact.front()).margin(slack));
    CHECK(run.recorder.totals(0, 0, StopSide::upper).impacts == 0);
  }
}

TEST_CASE("what a stop works on a free mass is half m v² (1 + e²), rigid or springy") {
  const double v = 1, h = 1e-4;
  const auto work = [&](const Choice& law, const Choice& time) {
    const Recorded run(marcher(thrown_mass(), 1, {{"consistent"}, law, time}, h), 0.25);
    REQUIRE(run.impacts().size() == 1);
    return run.recorder.totals(0, 0, StopSide::lower).normal_work;
  };
  for (const double e : {0.0, 0.6, 1.0}) {
    INFO("e = " << e);
    // The velocity after each sub-step is what this plan's effort gives: exact.
    const Choice time{"newmark-dumont-paoli", {{"restitution", e}}};
    CHECK(work({"signorini"}, time) == Approx(0.5 * v * v * (1 + e * e)).epsilon(1e-9));
  }
  // A spring of 1e4 N/m is met for 0.03 s, 314 steps.
  CHECK(work({"penalty", {{"stiffness", 1e4}, {"evaluation", std::string("averaged")}}}, midpoint_like) ==
        Approx(v * v).epsilon(1e-3));
}

TEST_CASE("a spring stop: half a period of contact, with the force of a spring") {
  const double v = 1, stiffness_of_stop = 1e4, omega = std::sqrt(stiffness_of_stop / 1.0);
  const auto time = GENERATE(Choice{"newmark-dumont-paoli", {{"beta", 0.25}}}, Choice{"newmark"},
                             Choice{"moreau-jean", {{"theta", 0.5}}});
  INFO(time.name);
  for (const double h : {4e-4, 1e-4}) {
    INFO("h = " << h);
    const Recorded run(
        marcher(thrown_mass(), 1,
                {{"consistent"},
                 {"penalty", {{"stiffness", stiffness_of_stop}, {"evaluation", std::string("averaged")}}},
                 time},
                h),
        0.1);
    REQUIRE(run.impacts().size() == 1);
    const Impact& impact = run.impacts().front();
    // Beginning and end fall within a step; the force is flat at its peak, and found at steps.
    CHECK(impact.duration == Approx(M_PI / omega).margin(2 * h));
    CHECK(impact.peak_force == Approx(stiffness_of_stop * v / omega).epsilon(omega * h));
    CHECK(impact.impulse == Approx(2 * v).epsilon(omega * h));
    CHECK(impact.speed_in == Approx(v).epsilon(1e-9));
    CHECK(impact.speed_out == Approx(v).epsilon(omega * h));
    CHECK(impact.release_force < 2 * omega * h * impact.peak_force);
    const StopTotals& totals = run.recorder.totals(0, 0, StopSide::lower);
    CHECK(totals.contact_time == Approx(impact.duration).epsilon(1e-13));
    CHECK(totals.mean_force() * totals.contact_time == Approx(impact.impulse).epsilon(1e-13));
    // Half a sine: mean 2/π, root mean square 1/√2 of the peak.
    CHECK(totals.mean_force() / impact.peak_force == Approx(2 / M_PI).epsilon(2 * omega * h));
    CHECK(totals.rms_force() / impact.peak_force == Approx(1 / std::sqrt(2)).epsilon(2 * omega * h));
  }
}

TEST_CASE("a point that is always closed hides no impact of another") {
  const double duration = 0.5;
  const auto time = GENERATE(Choice{"newmark-dumont-paoli"}, Choice{"moreau-jean", {{"restitution", 0.0}}},
                             Choice{"bathe"}, Choice{"midpoint"});
  INFO(time.name);
  const Recorded run(marcher(propped_beam(), 15, {{"consistent"}, {"penalty", {{"stiffness", 1e5}}}, time}, 1e-4),
                     duration);
  REQUIRE(run.march.status(0).running);
  long long counted = 0, listed = 0;
  double impulse = 0, contact_time = 0;
  for (int point = 0; point < 3; ++point) {
    const StopTotals& totals = run.recorder.totals(0, point, StopSide::lower);
    counted += totals.impacts;
    impulse += totals.impulse;
    contact_time += totals.contact_time;
  }
  double durations = 0;
  for (const Impact& impact : run.impacts()) {
    ++listed;
    durations += impact.duration;
  }
  const StopTotals &middle = run.recorder.totals(0, 1, StopSide::lower),
                   &tip = run.recorder.totals(0, 2, StopSide::lower);
  CHECK(middle.impacts > 2);
  CHECK(counted == run.recorder.count(0));
  CHECK(counted == listed);
  CHECK(counted == run.audit.contact(0).impacts);
  CHECK(impulse == Approx(run.audit.contact(0).impulse).epsilon(1e-12));
  // The tip lies on its stop from the start: that contact is no impact.
  double tip_hits = 0;
  for (const Impact& impact : run.impacts())
    if (impact.point == 2) tip_hits += impact.duration;
  CHECK(tip.contact_time > tip_hits + 1e-4);
  CHECK(durations - tip_hits == Approx(contact_time - tip.contact_time).epsilon(1e-12));
  CHECK(tip.contact_time > 0.3 * duration);
  // What is counted where nothing was closed before misses them.
  CHECK(run.audit.contact(0).spells < counted);
  // Rows come in the order in which contact began; the times of a step are those of its sub-steps.
  CHECK(std::is_sorted(run.impacts().begin(), run.impacts().end(),
                       [](const Impact& a, const Impact& b) { return a.time < b.time; }));
}

TEST_CASE("whatever the stages of a scheme, impacts and their impulses add up to what the audit counts") {
  const auto time =
      GENERATE(Choice{"laursen-love"}, Choice{"contact-stabilised-newmark"}, Choice{"kane"}, Choice{"noh-bathe"},
               Choice{"nonsmooth-generalised-alpha"}, Choice{"cd-lagrange"}, Choice{"paoli-schatzman"},
               Choice{"carpenter-taylor-katona"}, Choice{"moreau-jean", {{"restitution", 0.5}}});
  INFO(time.name);
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-6;
  scene.stops.place = StopsSpec::Place::nodes;
  scene.stops.lower = Formula("-0.05*x", "/scene/stops/lower", "x");
  const Recorded run(marcher(scene, 4, {{"lumped"}, {"signorini"}, time}, 2e-5), 0.2);
  REQUIRE(run.march.status(0).running);
  double impulse = 0, durations = 0, contact_time = 0;
  for (const Impact& impact : run.impacts()) {
    impulse += impact.impulse;
    durations += impact.duration;
    CHECK(impact.peak_force * impact.duration >= impact.impulse * (1 - 1e-12));
  }
  for (int point = 0; point < run.march.program().problem->points(); ++point)
    for (const StopSide side : {StopSide::lower, StopSide::upper})
      contact_time += run.recorder.totals(0, point, side).contact_time;
  CHECK(run.recorder.count(0) > 0);
  CHECK(run.recorder.count(0) == run.audit.contact(0).impacts);
  CHECK(static_cast<long long>(run.impacts().size()) == run.recorder.count(0));
  CHECK(impulse == Approx(run.audit.contact(0).impulse).epsilon(1e-12));
  CHECK(durations == Approx(contact_time).epsilon(1e-12));
}

TEST_CASE("what is pressed on its stop at t = 0 is in contact from the start, and hits nothing") {
  // Under a load that goes on: contact for as long as it lasts.
  SceneSpec scene = thrown_mass(0.0, 0.0);
  scene.load = Formula("-5", "/scene/load");
  for (const Choice& time : {Choice{"newmark-dumont-paoli"}, Choice{"moreau-jean", {{"restitution", 0.0}}}}) {
    INFO(time.name);
    const Recorded run(marcher(scene, 1, {{"consistent"}, {"signorini"}, time}, 1e-3), 0.5);
    CHECK(run.impacts().empty());
    CHECK(run.recorder.count(0) == 0);
    const ContactTotals& contact = run.audit.contact(0);
    CHECK(contact.impacts == 0);
    CHECK(contact.first_impact < 0);
    CHECK(contact.spells == 1);
    const StopTotals& totals = run.recorder.totals(0, 0, StopSide::lower);
    CHECK(totals.impacts == 0);
    CHECK(totals.fastest == 0);
    CHECK(totals.contact_time == Approx(0.5).margin(2e-3));
    CHECK(totals.impulse == Approx(5 * 0.5).margin(5 * 2e-3));
    CHECK(totals.impulse == Approx(contact.impulse).epsilon(1e-12));
    CHECK(totals.peak_force == Approx(5).epsilon(1e-9));
    CHECK(std::abs(totals.normal_work) < 1e-9);
  }
}

TEST_CASE("forces of opposite stops do not cancel") {
  // A beam bent to a parabola and held there: its tip from below, its middle from above.
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-3;
  scene.initial.velocity = Formula("0", "/scene/initial/velocity", "x");
  scene.stops.lower = Formula("x>1 ? 0.04*x^2 : -1", "/scene/stops/lower", "x");
  scene.stops.upper = Formula("x>1 ? 1 : 0.04*x^2", "/scene/stops/upper", "x");
  scene.stops.place = StopsSpec::Place::positions;
  scene.stops.positions = {0.7505, 1.501};
  Recorded run(marcher(scene, 8, {{"consistent"}, {"penalty", {{"stiffness", 1e5}}}, {"newmark-dumont-paoli"}}, 1e-4),
               0.5);
  const double middle = run.recorder.totals(0, 0, StopSide::upper).impulse,
               tip = run.recorder.totals(0, 1, StopSide::lower).impulse;
  CHECK(middle > 0);
  CHECK(tip > 0);
  CHECK(middle + tip == Approx(run.audit.contact(0).impulse).epsilon(1e-12));
  REQUIRE(run.audit.contact(0).active == 2);
  const double now = run.recorder.force(0);
  CHECK(now > 1.1 * std::abs(run.audit.contact(0).force));
  for (const Impact& impact : run.impacts()) CHECK((impact.side == StopSide::upper) == (impact.point == 0));
  CHECK(run.recorder.take_peak(0) >= now / 2);
  CHECK(run.recorder.take_peak(0) == 0);  // nothing since it was asked
}

TEST_CASE("both stops of one point are told apart") {
  SceneSpec scene = bouncing();
  scene.stops.upper = Formula(0.09);
  scene.initial.displacement = Formula(0.0);
  scene.initial.velocity = Formula(2.0);
  const Recorded run(
      marcher(scene, 1, {{"consistent"}, {"signorini"}, {"newmark-dumont-paoli", {{"restitution", 1.0}}}}, 1e-4), 1);
  REQUIRE(run.impacts().size() > 8);
  for (std::size_t i = 0; i < run.impacts().size(); ++i)
    CHECK(run.impacts()[i].side == (i % 2 == 0 ? StopSide::upper : StopSide::lower));
  CHECK(run.recorder.totals(0, 0, StopSide::upper).impacts + run.recorder.totals(0, 0, StopSide::lower).impacts ==
        run.recorder.count(0));
}

TEST_CASE("a list that is full ends, and the totals go on, nothing is allocated by a step") {
  const Methods methods{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli", {{"restitution", 1.0}}}};
  const Recorded all(marcher(bouncing(), 1, methods, 1e-3), 1.5);
  const Recorded cut(marcher(bouncing(), 1, methods, 1e-3), 1.5, 2);
  CHECK(cut.impacts().size() == 2);
  CHECK(cut.recorder.count(0) == all.recorder.count(0));
  CHECK(cut.recorder.totals(0, 0, StopSide::lower).impulse == all.recorder.totals(0, 0, StopSide::lower).impulse);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(cut.impacts()[i].impulse == all.impacts()[i].impulse);
    CHECK(cut.impacts()[i].speed_out == all.impacts()[i].speed_out);
  }
  Marcher march = marcher(bouncing(), 1, methods, 1e-3);
  ImpactRecorder recorder(march);
  march.start(&recorder);
  const long before = allocations();
  march.march(1500, &recorder);
  const long after = allocations();  // the macros below allocate
  CHECK(recorder.count(0) == 4);
  CHECK(after == before);
}

TEST_CASE("impacts of a lane do not depend on the other lanes of its block") {
  const Methods methods{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli", {{"restitution", 0.7}}}};
  const auto placed = [](double height) {
    return [height](const LaneSpec& lane) {
      LaneSpec moved = lane;
      moved.position[0] = height;
      return std::vector{moved};
    };
  };
  const auto both = [&](const LaneSpec& lane) {
    return std::vector{placed(0.1)(lane).front(), placed(0.06)(lane).front()};
  };
  Marcher pair = marcher(bouncing(), 1, methods, 1e-3, {}, both);
  ImpactRecorder together(pair);
  pair.start(&together);
  pair.march(1500, &together);
  for (const int lane : {0, 1}) {
    Marcher alone = marcher(bouncing(), 1, methods, 1e-3, {}, placed(lane == 0 ? 0.1 : 0.06));
    ImpactRecorder single(alone);
    alone.start(&single);
    alone.march(1500, &single);
    INFO("lane " << lane);
    REQUIRE(single.impacts(0).size() > 2);
    REQUIRE(together.impacts(lane).size() == single.impacts(0).size());
    for (std::size_t i = 0; i < single.impacts(0).size(); ++i) {
      const Impact &a = single.impacts(0)[i], &b = together.impacts(lane)[i];
      CHECK(a.time == b.time);
      CHECK(a.speed_in == b.speed_in);
      CHECK(a.speed_out == b.speed_out);
      CHECK(a.impulse == b.impulse);
    }
  }
}
