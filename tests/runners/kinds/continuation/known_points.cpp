// Special points of oscillators against closed forms and event-driven shooting.
#include <cmath>
#include <complex>
#include <random>

#include "tests/runners/kinds/continuation/tube_study.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

struct Oscillator {
  double damping = 0.04, pulsation = 1.3, stop = 1, stiffness = 30;
  /// |x| over F with this stiffness, mass 1.
  double response(double k) const {
    return 1 / std::abs(std::complex<double>(k - pulsation * pulsation, damping * pulsation));
  }
};

Json study_of(const Oscillator& one, double from, double to, double at, int steps) {
  Json study = Json::parse(R"({
    "name": "oscillator", "kind": "continuation",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "force": {"amplitude": 1}},
              "stops": {"at": "tip"}},
    "methods": {"mass": "consistent", "contact": {"name": "penalty", "evaluation": "averaged"},
                "time": {"name": "newmark-dumont-paoli", "beta": 0.25}},
    "parameter": {"pointer": "/scene/structure/force/amplitude"},
    "orbits": [{"from": "rest", "periods": 300}], "switch": null, "at_most": {"arc": 100}
  })");
  study["scene"]["structure"]["damping"] = one.damping;
  study["scene"]["structure"]["force"]["pulsation"] = one.pulsation;
  study["scene"]["stops"]["upper"] = one.stop;
  study["methods"]["contact"]["stiffness"] = one.stiffness;
  study["parameter"]["from"] = from;
  study["parameter"]["to"] = to;
  study["orbits"][0]["at"] = at;
  study["steps_per_period"] = steps;
  return study;
}

SpecialRow only_one(const std::vector<SpecialRow>& points, PointKind kind, double near, double within) {
  std::vector<SpecialRow> found;
  for (const SpecialRow& one : points)
    if (one.kind == kind && std::abs(*one.parameter - near) < within) found.push_back(one);
  INFO(word(kind) << " near " << near);
  REQUIRE(found.size() == 1);
  CHECK(*found[0].low <= *found[0].parameter);
  CHECK(*found[0].high >= *found[0].parameter);
  return found[0];
}

}  // namespace

TEST_CASE("a first contact is where the linear response meets the stop, to round-off of each step, with order 2") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(0, 1);
  for (int times = 0; times < 3; ++times) {
    Oscillator one;
    one.damping = 0.05 + 0.3 * share(random);
    one.pulsation = 0.4 + 2 * share(random);
    one.stop = 0.2 + share(random);
    const double exact = one.stop / one.response(1);
    std::vector<double> errors;
    for (const int steps : {250, 500, 1000}) {
      Json study = study_of(one, 0.1 * exact, 2 * exact, 0.5 * exact, steps);
      study["orbits"][0]["from"] = "free";
      study["stop_at"] = "contact";
      study["both_ways"] = false;
      const SpecialRow contact = only_one(points_of(continued(study)), PointKind::contact, exact, 0.1 * exact);
      CHECK(contact.note == "first contact");
      CHECK(*contact.high - *contact.low < 1e-10 * exact);
      errors.push_back(std::abs(*contact.parameter - exact) / exact);
    }
    INFO(errors[0] << " " << errors[1] << " " << errors[2]);
    // The largest displacement at a step is less than that between two by (ωh)²/8 at most: 8e-5, 2e-5, 5e-6.
    CHECK(errors[0] < 4e-4);
    CHECK(errors[2] < 4e-4 / 12);
  }
}

TEST_CASE("a contact that held the mass opens where the least force of the closed motion is zero") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  for (int times = 0; times < 3; ++times) {
    Oscillator one;
    one.damping = 0.1 + 0.3 * share(random);
    one.pulsation = 0.7 + share(random);
    one.stop = -0.02 - 0.1 * share(random);  // at rest the mass is pressed on its stop
    const double k = 1 + one.stiffness, exact = -one.stop / k / one.response(k);
    Json study = study_of(one, 0.2 * exact, 1.1 * exact, 0.6 * exact, 500);
    study["stop_at"] = "contact";
    study["both_ways"] = false;
    const SpecialRow opens = only_one(points_of(continued(study)), PointKind::contact, exact, 0.1 * exact);
    CHECK(opens.note == "a permanent contact opens");
    CHECK(opens.held_before == 1);
    CHECK(opens.held_after == 0);
    // Order 2 in the step, of a spring that the mean of two steps closes.
    CHECK(*opens.parameter == Approx(exact).epsilon(2e-4));
    CHECK(*opens.high - *opens.low < 1e-10 * exact);
  }
}

TEST_CASE("a motion that its stop never leaves has no impacts") {
  Oscillator one;
  one.stop = -0.1;
  for (const BranchRow& row : rows_of(continued(study_of(one, 0.01, 0.05, 0.03, 200)))) {
    CHECK(*row.contact_runs == 1);
    CHECK(*row.impacts_per_period == 0);
  }
}

TEST_CASE("the flip of a bilinear oscillator converges to that of event-driven shooting with order 2") {
  Oscillator one;
  one.pulsation = 2.6;
  constexpr double exact = 5.7644225;
  std::vector<double> errors;
  for (const int steps : {500, 1000, 2000}) {
    Json study = study_of(one, 5.755, 5.77, 5.757, steps);
    study["orbits"][0]["from"] = "free";
    study["both_ways"] = false;
    const SpecialRow flip = only_one(points_of(continued(study)), PointKind::flip, exact, 1e-3);
    CHECK(flip.note.find("frozen") == std::string::npos);
    CHECK(*flip.low <= exact);
    CHECK(*flip.high >= exact);
    errors.push_back(std::abs(*flip.parameter - exact));
  }
  // 2.5e-4, 7.2e-5, 1.8e-5 N.
  CHECK(errors[0] < 3e-4);
  CHECK(errors[1] < errors[0] / 3);
  CHECK(errors[2] < errors[1] / 3);
}

TEST_CASE("both folds of a response that is bent are told, each once, wherever the branch began") {
  for (const double began : {0.12, 0.5}) {
    Oscillator one;
    const SpecialRow lower =
        only_one(points_of(continued(study_of(one, 0.02, 1.5, began, 250))), PointKind::fold, 0.1, 0.05);
    CHECK(*lower.prominence > 0.5);
    CHECK(lower.side == "above");
  }
  for (const int steps : {250, 500}) {
    Oscillator one;
    Json study = study_of(one, 0.3, 1, 0.5, steps);
    study["orbits"][0]["from"] = "free";
    // Event-driven shooting: 0.6921345 N.
    const SpecialRow upper = only_one(points_of(continued(study)), PointKind::fold, 0.6921345, 0.01);
    CHECK(*upper.parameter == Approx(0.6921345).margin(steps == 250 ? 2e-4 : 6e-5));
  }
}
