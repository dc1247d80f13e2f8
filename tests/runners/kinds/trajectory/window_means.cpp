#include "runners/kinds/trajectory/window_means.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "runners/store/record_values.hpp"
#include "tests/runners/kinds/trajectory/case_runs.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

Json bouncing_study() {
  return Json::parse(R"({
    "name": "bouncing", "kind": "trajectory",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1,
                            "force": {"amplitude": 1, "pulsation": 2.8}},
              "stops": {"upper": 0, "at": "tip"}, "initial": {"displacement": -0.5}},
    "methods": {"mass": "consistent", "contact": "signorini", "time": {"name": "moreau-jean", "restitution": 0.8}},
    "step": 0.01, "duration": 64, "window": {"from": 0, "to": 64, "parts": 16}})");
}

}  // namespace

TEST_CASE("window means: over the whole run they are what the run adds up, divided by its length") {
  const CaseRecord record = CaseRuns().first_of(bouncing_study());
  REQUIRE(record.status == "done");
  REQUIRE(measure(record, "impacts").value() > 20);
  const auto times_length = [&](const char* name) { return 64 * measure(record, name).value(); };
  // Sums of parts against one sum: round-off of some thousand terms.
  CHECK(times_length("window_force") == Approx(measure(record, "impulse").value()).epsilon(1e-10));
  CHECK(times_length("window_power") == Approx(measure(record, "dissipated_at_contact").value()).epsilon(1e-10));
  CHECK(times_length("window_impact_rate") == Approx(measure(record, "impacts").value()).epsilon(1e-10));
  for (const char* name : {"window_power", "window_force", "window_impact_rate", "window_tip_rms"})
    CHECK(measure(record, std::string("confidence.") + name).value() > 0);
}

TEST_CASE("window means: a free oscillation has the root mean square of a sine, and no spread between whole periods") {
  Json text = bouncing_study();
  text["scene"] = Json::parse(R"({"structure": {"type": "oscillator", "mass": 1, "stiffness": 1},
                                  "initial": {"displacement": 2}})");
  text["methods"] = {{"mass", "consistent"}, {"contact", "none"}, {"time", "newmark"}};
  const double period = 2 * std::numbers::pi;
  text["step"] = period / 1000;
  text["duration"] = 16 * period;
  text["window"] = {{"from", 0}, {"to", 16 * period}, {"parts", 16}};
  const CaseRecord record = CaseRuns().first_of(text);
  REQUIRE(record.status == "done");
  // The scheme's period is longer by (2π/1000)²/12 = 3.3e-6 of it.
  CHECK(measure(record, "window_tip_rms").value() == Approx(2 / std::sqrt(2.0)).epsilon(1e-4));
  CHECK(measure(record, "confidence.window_tip_rms").value() < 1e-4);
  CHECK(measure(record, "window_impact_rate").value() == 0);
}

TEST_CASE("window means: twice the window is an interval narrower by about the root of two") {
  // Chaotic (ζ = 0, e = 0.8): parts are draws, so the ratio has a spread of its own of some 20 % for 64 parts.
  Json text = bouncing_study();
  text["scene"]["structure"]["damping"] = 0.1;
  text["step"] = 0.005;
  const auto width = [&](double length, int parts) {
    text["duration"] = 100 + length;
    text["window"] = {{"from", 100}, {"to", 100 + length}, {"parts", parts}};
    return measure(CaseRuns().first_of(text), "confidence.window_force").value();
  };
  const double once = width(800, 64), four = width(3200, 256);
  CHECK(four < 0.8 * once);
  CHECK(four > 0.3 * once);
}

TEST_CASE("window means: without parts there are none, and a run that ends before its window says so") {
  Json text = bouncing_study();
  text["window"].erase("parts");
  CHECK_FALSE(measure(CaseRuns().first_of(text), "window_force"));
  // 64.005 s are no whole number of steps: the last one ends before the window does.
  text["duration"] = 64.005;
  text["window"] = {{"from", 0}, {"to", 64.005}, {"parts", 8}};
  const CaseRecord record = CaseRuns().first_of(text);
  CHECK(measure(record, "window_force"));
  text["budget"] = 1e-9;
  const CaseRecord stopped = CaseRuns().first_of(text);
  CHECK(stopped.status == "failed");
  CHECK_FALSE(measure(stopped, "window_force"));
}
