// What the kept periods of an orbit say, told of orbits that were never marched.
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/measure/orbits/judge_orbit.hpp>

using namespace ricochet;

namespace judge_orbit_tests {

namespace {

SectionPlan plan_of_section() {
  SectionPlan plan;
  plan.pulsation = 10;
  plan.steps_per_period = 100;
  plan.keep = 80;
  plan.scale = 0.1;
  return plan;
}

/// Complete, with strobes that repeat every `period`; `image`: what the mirrored orbit shows at strobe k.
Orbit kept(int period, double (*image)(double), bool contact = true) {
  Orbit orbit;
  orbit.stage = Orbit::Stage::complete;
  orbit.settled = true;
  orbit.readings.width = 4;
  for (int k = 0; k < 80; ++k) {
    const double x = 0.02 + 0.03 * (k % period);
    orbit.strobed.push_back({x, 0.1, image(x), image(0.1)});
    orbit.readings.values.insert(orbit.readings.values.end(), {x, 0.1, image(x), image(0.1)});
    orbit.impact_counts.push_back(contact ? 2 : 0);
  }
  orbit.kept_periods = 80;
  orbit.contact_steps = contact ? 160 : 0;
  return orbit;
}

double same(double x) {
  return x;
}
double other(double x) {
  return x - 0.05;
}

}  // namespace

TEST_CASE("judging an orbit: its class, whether it is its own image, how often it strikes") {
  const SectionPlan plan = plan_of_section();
  for (const int period : {1, 3}) {
    const JudgedOrbit judged = judge(kept(period, same), plan, std::nullopt);
    CHECK(judged.verdict.motion == MotionClass{Regime::periodic, period});
    CHECK(judged.verdict.period == period);
    CHECK(judged.symmetric == true);
    CHECK(judge(kept(period, other), plan, std::nullopt).symmetric == false);
  }
  CHECK(impacts_per_period(kept(1, same)) == 2);
  CHECK(impacts_per_period(Orbit{}) == 0);
  // Without contact it repeats as well, and its class says no period.
  const JudgedOrbit open = judge(kept(2, same, false), plan, std::nullopt);
  CHECK(open.verdict.motion == MotionClass{Regime::no_contact, 0});
  CHECK(open.verdict.period == 2);
}

TEST_CASE("the rough class of an orbit is its class where it repeats or never touches") {
  const SectionPlan plan = plan_of_section();
  for (const int period : {1, 2, 5})
    for (const bool contact : {true, false}) {
      const Orbit orbit = kept(period, same, contact);
      CHECK(rough_class(orbit, plan) == judge(orbit, plan, std::nullopt).verdict.motion);
    }
  Orbit wandering = kept(1, same);
  for (std::size_t k = 0; k < 80; ++k)
    wandering.readings.values[4 * k] = 0.05 * std::sin(2.399963 * static_cast<double>(k * k));
  CHECK(rough_class(wandering, plan) == MotionClass{Regime::undecided, 0});
  Orbit stopped = kept(1, same);
  stopped.stage = Orbit::Stage::stopped;
  CHECK_FALSE(rough_class(stopped, plan));
  CHECK_FALSE(judge(stopped, plan, std::nullopt).verdict.motion.decided());
}

}  // namespace judge_orbit_tests
