// How finely steps resolve compliant contacts.
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <ricochet/loader/catalogue.hpp>

#include "runners/kinds/trajectory/trajectory.hpp"
#include "runners/store/record_values.hpp"
#include "runners/study/load_study.hpp"
#include "tests/places.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;

namespace {

const std::atomic<bool> goes_on = false;

/// A free mass that flies against a spring at 1 m/s.
CaseRecord thrown(const Json& contact, double step) {
  static Catalogue catalogue{tests::places().plugins, {}, {}};
  static Registry registry;
  Json text = Json::parse(R"json({
    "name": "thrown", "kind": "trajectory",
    "scene": {"structure": {"type": "oscillator", "mass": 2, "stiffness": 0},
              "stops": {"lower": 0, "at": "tip"}, "initial": {"displacement": 0.05, "velocity": -1}},
    "methods": {"mass": "consistent", "time": "newmark-dumont-paoli"}, "duration": 0.2})json");
  text["methods"]["contact"] = contact;
  text["step"] = step;
  return run_case(parse_study(text.dump(), catalogue, registry).cases.front(), registry, goes_on);
}

}  // namespace

TEST_CASE("a spring turns a free mass back in half a period, whatever the step") {
  for (const double stiffness : {1e3, 1e5}) {
    const double half = std::numbers::pi * std::sqrt(2 / stiffness);
    for (const double steps : {4.0, 60.0}) {
      const CaseRecord record = thrown({{"name", "penalty"}, {"stiffness", stiffness}}, half / steps);
      CAPTURE(stiffness, steps);
      CHECK(measure(record, contact_steps_measure).value() == Approx(steps).epsilon(1e-9));
      CHECK(record.reasons.empty() == (steps > fewest_contact_steps));
      if (steps < fewest_contact_steps) CHECK_THAT(record.reason(), Contains("contact is not resolved"));
    }
  }
}

TEST_CASE("rigid stops, and those that nobody touches, have no such steps") {
  CHECK_FALSE(measure(thrown("signorini", 1e-3), contact_steps_measure));
  CaseRecord away = thrown({{"name", "penalty"}, {"stiffness", 1e8}}, 1e-3);
  CHECK(measure(away, contact_steps_measure));
  CHECK_FALSE(measure(thrown("none", 1e-3), contact_steps_measure));
}
