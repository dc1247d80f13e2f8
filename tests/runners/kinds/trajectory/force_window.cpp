#include "runners/kinds/trajectory/force_window.hpp"

#include <catch2/catch.hpp>

#include "runners/store/record_values.hpp"
#include "tests/runners/kinds/trajectory/case_runs.hpp"

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
    REQUIRE(record.status == "done");
    // One stop, so that all efforts have one sign; an instant at an end of the window may fall in or out: a step of
    // 300.
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
