#include "runners/kinds/trajectory/window_means.hpp"

#include <algorithm>
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
  REQUIRE(record.status == Status::done);
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
  REQUIRE(record.status == Status::done);
  // The scheme's period is longer by (2π/1000)²/12 = 3.3e-6 of it.
  CHECK(measure(record, "window_tip_rms").value() == Approx(2 / std::sqrt(2.0)).epsilon(1e-4));
  CHECK(measure(record, "confidence.window_tip_rms").value() < 1e-4);
  CHECK(measure(record, "window_impact_rate").value() == 0);
}

TEST_CASE("window means: a root mean square does not depend on the number of parts") {
  Json text = bouncing_study();
  std::vector<double> found;
  for (const int parts : {8, 16, 64}) {
    text["window"]["parts"] = parts;
    found.push_back(measure(CaseRuns().first_of(text), "window_tip_rms").value());
  }
  // 6400 steps in 8, 16 or 64 equal parts: round-off.
  for (const double one : found) CHECK(one == Approx(found.front()).epsilon(1e-12));
}

TEST_CASE("window means: parts that are no whole number of steps weigh by their length") {
  Json text = bouncing_study();
  text["step"] = 0.1;
  for (const int parts : {16, 30, 101, 639}) {
    INFO(parts);
    text["window"]["parts"] = parts;
    const CaseRecord record = CaseRuns().first_of(text);
    CHECK(64 * measure(record, "window_force").value() == Approx(measure(record, "impulse").value()).epsilon(1e-10));
    CHECK(64 * measure(record, "window_impact_rate").value() ==
          Approx(measure(record, "impacts").value()).epsilon(1e-10));
  }
  text["window"] = {{"from", 10}, {"to", 64}, {"parts", 17}};
  const CaseRecord inside = CaseRuns().first_of(text);
  CHECK(-measure(inside, "contact_force_mean").value() ==
        Approx(measure(inside, "window_force").value()).epsilon(1e-10));
  // 640 steps.
  text["window"] = {{"from", 0}, {"to", 64}, {"parts", 641}};
  const CaseRecord record = CaseRuns().first_of(text);
  CHECK_FALSE(measure(record, "window_force"));
  CHECK(std::find(record.notes.begin(), record.notes.end(),
                  "no means over the window: it has fewer steps than its 641 parts; use fewer parts") !=
        record.notes.end());
}

TEST_CASE("window means: a window to the end of the run ends with its last whole step") {
  Json text = bouncing_study();
  const auto rate = [&](double step) {
    text["step"] = step;
    const CaseRecord record = CaseRuns().first_of(text);
    const double end = step * std::floor(64 / step);
    CHECK(measure(record, "window_impact_rate").value_or(0) * end ==
          Approx(measure(record, "impacts").value()).epsilon(1e-10));
  };
  // What is left of the run is less than half a step, or more.
  for (const double step : {0.01, 64 / 6400.3, 64 / 6400.7}) rate(step);
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
  CHECK(stopped.status == Status::failed);
  CHECK_FALSE(measure(stopped, "window_force"));
}

using namespace ricochet;
using namespace ricochet::testing;

namespace {

Json bar_study() {
  return Json::parse(R"({
    "name": "thrown", "kind": "trajectory",
    "scene": {"structure": {"type": "bar", "length": 10, "EA": 900, "rhoA": 1, "fixed": "none"},
              "stops": {"lower": -5, "at": "tip"},
              "initial": {"displacement": 0, "velocity": -10}},
    "mesh": {"elements": 20},
    "methods": {"mass": "consistent", "contact": "signorini",
                "time": ["newmark-dumont-paoli", "midpoint", {"name": "bathe", "rho_inf": 0}, "noh-bathe",
                         {"name": "contact-stabilised-newmark", "velocity": ["original", "corrected"]}]},
    "step": 0.005, "duration": 1.5, "window": {"from": 0, "to": 1.5}})");
}

}  // namespace

TEST_CASE("the mean force over a window is the impulse that came in it, whatever the stages of the scheme") {
  for (const CaseRecord& record : CaseRuns().of(bar_study())) {
    INFO(axis(record, "time").text() << " " << axis(record, "time.velocity").text());
    REQUIRE(record.status == Status::done);
    // One stop, so that all efforts have one sign. A start rule weighs otherwise: by less than a step of 300.
    CHECK(measure(record, "contact_force_mean").value() * 1.5 ==
          Approx(measure(record, "impulse").value()).epsilon(1.01 / 300));
    CHECK(measure(record, "contact_force_deviation").value() > 100);  // in and out of contact, 300 N
  }
}

TEST_CASE("the force on a mass that is pressed to its stop is the load, and deviates by round-off") {
  Json text = bar_study();
  text["scene"] = Json::parse(R"({"structure": {"type": "oscillator", "mass": 1, "stiffness": 0},
                                  "stops": {"lower": 0, "at": "tip"}, "load": -5,
                                  "initial": {"displacement": 0, "velocity": 0}})");
  text.erase("mesh");
  text["window"] = {{"from", 0.5}, {"to", 1}};
  for (const CaseRecord& record : CaseRuns().of(text)) {
    INFO(axis(record, "time").text() << " " << axis(record, "time.velocity").text());
    CHECK(measure(record, "contact_force_mean").value() == Approx(5).epsilon(1e-9));
    // A force is found from positions of 1e-4 m over h²: round-off of 1e-16 m is 1e-11 N.
    CHECK(measure(record, "contact_force_deviation").value() < 1e-8);
  }
}

TEST_CASE("a window is a range of time within the run, or none") {
  CaseRuns runs;
  Json text = bar_study();
  text.erase("window");
  text["methods"]["time"] = "midpoint";
  const CaseRecord without = runs.of(text).front();
  CHECK_FALSE(measure(without, "contact_force_mean"));
  text["window"] = nullptr;
  CHECK(runs.of(text).front().id == without.id);
  for (const auto& [from, to] : {std::pair{1.0, 1.0}, {1.0, 0.5}, {1.0, 1.6}}) {
    text["window"] = {{"from", from}, {"to", to}};
    try {
      runs.of(text);
      FAIL_CHECK("accepted: " << from << " to " << to);
    } catch (const InputError& error) {
      CHECK(error.pointer() == "/window/to");
    }
  }
}
