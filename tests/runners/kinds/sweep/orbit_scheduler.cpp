// Marching of sets of orbits: what they are does not depend on how they were marched.
#include "runners/kinds/sweep/orbit_scheduler.hpp"

#include "runners/kinds/sweep/orbit_checkpoints.hpp"
#include "runners/kinds/sweep/orbit_rows.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/kinds/trajectory/trajectory.hpp"
#include "tests/runners/kinds/sweep/sweep_case.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;

namespace {

/// The scenes of a sweep at rest at its values, and tasks upon them.
class Sweep {
 public:
  explicit Sweep(const Json& text) : opened_(opened_sweep(text)), scenes(opened_.first(), *opened_.registry) {
    const std::string pointer = opened_.first().settings.at("parameter").at("pointer");
    for (const double value : parameter_values(opened_.first().settings)) scenes.add(pointer, value, false);
    options.section = section_plan(opened_.first(), scenes);
    options.interval = 1e9;
  }

  OrbitTask task(int scene, int after = -1) const { return {scene, scenes[scene].lane, after, -1}; }
  /// None: the scheduler marches itself.
  std::unique_ptr<BlockThreads> workers(int count) const {
    return count > 0 ? std::make_unique<BlockThreads>(opened_.first(), *opened_.registry, count) : nullptr;
  }

 private:
  OpenedSweep opened_;

 public:
  ForcedScenes scenes;
  ScheduleOptions options;
};

/// Single orbits at every scene, then a chain up through them.
void add_all(OrbitScheduler& scheduler, const Sweep& sweep) {
  for (int i = 0; i < sweep.scenes.count(); ++i) scheduler.add(sweep.task(i));
  int last = -1;
  for (int i = 0; i < sweep.scenes.count(); ++i) last = scheduler.add(sweep.task(i, last));
}

/// Every orbit as bytes, in the order of the tasks.
std::vector<std::string> bytes_of(const OrbitScheduler& scheduler) {
  std::vector<std::string> all;
  for (int i = 0; i < scheduler.count(); ++i)
    all.push_back(scheduler.finished(i) ? to_bytes(MarchedOrbits{{scheduler.orbit(i)}, {}}) : "");
  return all;
}

/// "" where they are the same; else the first field that differs, and of which orbit.
std::string difference(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  const auto same = [](const LaneState& x, const LaneState& y) {
    return x.slots == y.slots && x.efforts == y.efforts && x.fastest == y.fastest;
  };
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b.at(i)) continue;
    if (a[i].empty() || b[i].empty()) return "finished";
    const Orbit x = marched_orbits(a[i]).finished[0], y = marched_orbits(b[i]).finished[0];
    std::string text;
    if (x.stage != y.stage || !(x.end == y.end))
      text += " end (" + ricochet::text(x.end) + " | " + ricochet::text(y.end) + ")";
    if (x.transient_periods != y.transient_periods) text += " transient";
    if (x.stopped_period != y.stopped_period) text += " stopped_period";
    if (x.readings.values != y.readings.values) text += " readings";
    if (x.impact_counts != y.impact_counts) text += " impacts";
    if (x.contact_steps != y.contact_steps) text += " contact_steps";
    if (!same_settling(x.settling, y.settling)) text += " settling";
    if (!same(x.entry, y.entry)) text += " entry";
    if (!same(x.now, y.now)) text += " now";
    if (!std::equal(x.impacts.begin(), x.impacts.end(), y.impacts.begin(), y.impacts.end(),
                    [](const ImpactPoint& p, const ImpactPoint& q) {
                      return p.phase == q.phase && p.side == q.side && p.speed == q.speed;
                    }))
      text += " impact points";
    // Bytes between the numbers of an impact are nobody's.
    if (!text.empty()) return "orbit " + std::to_string(i) + ":" + text;
  }
  return "";
}

const std::function<void(const MarchedOrbits&)> nowhere = [](const MarchedOrbits&) {};

std::vector<std::string> marched(const Sweep& sweep, int workers, int lanes) {
  ScheduleOptions options = sweep.options;
  const std::unique_ptr<BlockThreads> blocks = sweep.workers(workers);
  options.blocks = blocks.get();
  options.lanes = lanes;
  OrbitScheduler scheduler(sweep.scenes, options);
  add_all(scheduler, sweep);
  const std::atomic<bool> stop = false;
  scheduler.run(stop, nowhere);
  return bytes_of(scheduler);
}

/// Marches, is stopped at every so many checkpoints, and goes on from the bytes until all is done.
std::vector<std::string> interrupted(const Sweep& sweep, int workers, int lanes, int every, int& stops) {
  MarchedOrbits saved;
  stops = 0;
  for (;;) {
    ScheduleOptions options = sweep.options;
    const std::unique_ptr<BlockThreads> blocks = sweep.workers(workers);
    options.blocks = blocks.get();
    options.lanes = lanes;
    options.interval = 0;  // after every period of any block
    OrbitScheduler scheduler(sweep.scenes, options);
    add_all(scheduler, sweep);
    scheduler.restore(saved);
    std::atomic<bool> stop = false;
    int seen = 0;
    try {
      scheduler.run(stop, [&](const MarchedOrbits& now) {
        const MarchedOrbits back = marched_orbits(to_bytes(now));
        saved.finished.insert(saved.finished.end(), back.finished.begin(), back.finished.end());
        saved.running = back.running;
        if (++seen == every) stop = true;
      });
    } catch (const Interrupted&) {
    }
    const std::vector<std::string> all = bytes_of(scheduler);
    if (std::find(all.begin(), all.end(), "") == all.end()) return all;
    ++stops;
    REQUIRE(stops < 1000);
  }
}

Json spring_diagram() {
  Json text = beam_sweep({0.078, 0.086, 0.099});
  text["methods"]["contact"] = {{"name", "penalty"}, {"stiffness", 1e4}};
  return text;
}

}  // namespace

TEST_CASE("orbits do not depend on who marches them nor on lanes") {
  Json text = beam_sweep({0.05, 0.076, 0.08, 0.085, 0.09, 0.095});
  SECTION("rigid, at the tip") {}
  SECTION("rigid, at all nodes") {
    text["scene"]["stops"]["at"] = "nodes";
  }
  SECTION("springs") {
    text["methods"]["contact"] = {{"name", "penalty"}, {"stiffness", 1e4}};
  }
  SECTION("springs whose stiffness differs between lanes") {
    text["methods"]["contact"] = {{"name", "penalty"}, {"stiffness", 1e4}};
    text["scene"]["support"]["amplitude"] = 0.09;
    text["parameter"] = {{"pointer", "/methods/contact/stiffness"}, {"values", {1e2, 1e3, 1e4, 1e5, 1e6}}};
  }
  SECTION("multipliers that remember") {
    text["methods"]["contact"] = {{"name", "augmented-lagrangian"}, {"augmentation", 1e4}};
  }
  SECTION("efforts over three levels, a gate") {
    text["methods"]["mass"] = "consistent";
    text["methods"]["time"] = {{"name", "moreau-jean"}, {"restitution", 0.5}};
  }
  const Sweep sweep(text);
  const auto reference = marched(sweep, 0, 1);
  for (const std::string& one : reference) CHECK_FALSE(one.empty());
  CHECK(difference(marched(sweep, 0, 2), reference) == "");
  CHECK(difference(marched(sweep, 0, 8), reference) == "");
  CHECK(difference(marched(sweep, 1, 8), reference) == "");
  CHECK(difference(marched(sweep, 3, 2), reference) == "");
}

TEST_CASE("a sweep that is stopped at any moment goes on bitwise equal") {
  Json text = beam_sweep({0.078, 0.086, 0.099});
  SECTION("rigid") {}
  SECTION("springs") {
    text = spring_diagram();
  }
  SECTION("multipliers that remember") {
    text["methods"]["contact"] = {{"name", "augmented-lagrangian"}, {"augmentation", 1e4}};
  }
  SECTION("a gate that knows its fastest approach") {
    text["methods"]["mass"] = "consistent";
    text["methods"]["time"] = {{"name", "moreau-jean"}, {"restitution", 0.5}};
  }
  SECTION("three groups") {
    text["parameter"] = {{"pointer", "/scene/support/pulsation"}, {"values", {9, 10, 11}}};
  }
  const Sweep sweep(text);
  const auto reference = marched(sweep, 0, 8);
  int stops = 0;
  CHECK(difference(interrupted(sweep, 0, 8, 1, stops), reference) == "");
  CHECK(stops > 20);
  CHECK(difference(interrupted(sweep, 0, 1, 7, stops), reference) == "");
  CHECK(stops > 2);
  CHECK(difference(interrupted(sweep, 2, 2, 3, stops), reference) == "");
}

TEST_CASE("an orbit that diverges is the same whoever marches beside it") {
  // Central differences beyond their limit: energy grows from round-off until it passes the scene's own scale.
  Json text = beam_sweep({0.001, 0.01, 0.05, 0.08});
  text["methods"]["mass"] = "consistent";
  text["methods"]["time"] = {{"name", "newmark-dumont-paoli"}, {"beta", 0.0}};
  text["scene"]["structure"]["damping"]["stiffness"] = 0;
  const Sweep sweep(text);
  const auto reference = marched(sweep, 0, 1);
  CHECK(difference(marched(sweep, 0, 8), reference) == "");
  CHECK(difference(marched(sweep, 0, 2), reference) == "");
}

TEST_CASE("a chain goes over an orbit that stops, from what that orbit began with") {
  // The stiffest explicit spring diverges, those before and after it do not.
  Json text = beam_sweep({0.09});
  text["methods"]["mass"] = "consistent";
  text["methods"]["contact"] = {{"name", "penalty"}, {"stiffness", 1e2}, {"evaluation", "explicit"}};
  text["parameter"] = {{"pointer", "/methods/contact/stiffness"}, {"values", {10, 20, 1e9}}};
  const Sweep sweep(text);
  REQUIRE(sweep.scenes.groups() == 1);
  const std::atomic<bool> stop = false;
  OrbitScheduler over(sweep.scenes, sweep.options), without(sweep.scenes, sweep.options);
  const int first = over.add(sweep.task(0)), broken = over.add(sweep.task(2, first)),
            next = over.add(sweep.task(1, broken));
  over.run(stop, nowhere);
  REQUIRE(over.orbit(first).stage == Orbit::Stage::complete);
  REQUIRE(over.orbit(broken).stage == Orbit::Stage::stopped);
  CHECK(over.orbit(broken).end);
  CHECK(over.orbit(broken).stopped_period > 0);
  REQUIRE(over.orbit(next).stage == Orbit::Stage::complete);
  without.add(sweep.task(0));
  const int direct = without.add(sweep.task(1, 0));
  without.run(stop, nowhere);
  CHECK(over.orbit(next).now.slots == without.orbit(direct).now.slots);
  CHECK(over.orbit(next).transient_periods == without.orbit(direct).transient_periods);

  // The first of a chain that stops hands on nothing: the next one starts from its own initial state.
  OrbitScheduler chain(sweep.scenes, sweep.options), alone(sweep.scenes, sweep.options);
  const int lost = chain.add(sweep.task(2));
  const int after = chain.add(sweep.task(0, lost));
  chain.run(stop, nowhere);
  alone.add(sweep.task(0));
  alone.run(stop, nowhere);
  REQUIRE(chain.orbit(lost).stage == Orbit::Stage::stopped);
  CHECK(chain.orbit(after).now.slots == alone.orbit(0).now.slots);
}

TEST_CASE("what is marched after the first run takes part as if it had been there") {
  const Sweep sweep(beam_sweep({0.078, 0.086, 0.099}));
  const std::atomic<bool> stop = false;
  OrbitScheduler once(sweep.scenes, sweep.options), twice(sweep.scenes, sweep.options);
  for (OrbitScheduler* scheduler : {&once, &twice}) {
    scheduler->add(sweep.task(0));
    if (scheduler == &twice) scheduler->run(stop, nowhere);
    scheduler->add(sweep.task(1, 0));
    scheduler->add(sweep.task(2));
    scheduler->run(stop, nowhere);
  }
  CHECK(difference(bytes_of(once), bytes_of(twice)) == "");
}

TEST_CASE("a budget that is spent ends the integration, and says so") {
  Sweep sweep(beam_sweep({0.078, 0.086, 0.099}));
  sweep.options.budget = 1e-6;
  OrbitScheduler scheduler(sweep.scenes, sweep.options);
  add_all(scheduler, sweep);
  const std::atomic<bool> stop = false;
  MarchedOrbits left;
  scheduler.run(stop, [&](const MarchedOrbits& now) { left = now; });
  CHECK(scheduler.over_budget());
  CHECK_FALSE(scheduler.finished(0));
  CHECK(left.finished.empty());
  CHECK_FALSE(left.running.empty());
}
