// Complete chattering, sticking and single impacts are motions of their own.
#include <cmath>
#include <numbers>

#include "tests/runners/kinds/sweep/sweep_case.hpp"

namespace chatter_tests {

using namespace ricochet;
using namespace ricochet::testing;

constexpr double gravity = 9.81, omega = 2 * std::numbers::pi;

/// From which A on a ball may hit the table once in each period T: it flies with V = gT/2, and V − u = e(V + u) with
/// the table's speed u ≤ Aω.
double one_impact(double restitution) {
  return std::numbers::pi * gravity * (1 - restitution) / (1 + restitution) / (omega * omega);
}

/// A ball on a table that moves by A cos ωt, in the frame of the table, at these A over the first with one impact. It
/// begins as the orbit of one impact at `begins` does.
Json ball(double restitution, std::vector<double> ratios, double begins, const char* scheme = "moreau-jean") {
  const double first = one_impact(restitution) * omega * omega;
  for (double& one : ratios) one *= first;
  Json study = Json::parse(R"({
    "name": "ball", "kind": "bifurcation",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 0, "force": {"amplitude": 1}},
              "stops": {"lower": 0, "at": "tip"}, "load": -9.81, "initial": {"displacement": 1e-6}},
    "methods": {"mass": "consistent", "contact": "signorini"},
    "steps_per_period": 2000, "start": ["state"],
    "transient": {"periods": 60, "at_most": 200}, "keep": 20, "exponents": 0, "refine": null})");
  study["scene"]["structure"]["force"]["pulsation"] = omega;
  study["scene"]["structure"]["force"]["phase"] = -std::asin(1 / begins);
  study["scene"]["initial"]["velocity"] = gravity * restitution / (1 + restitution);
  study["methods"]["time"] = {{"name", scheme}, {"restitution", restitution}};
  study["parameter"] = {{"pointer", "/scene/structure/force/amplitude"}, {"values", ratios}};
  return study;
}

std::string first_class(const CaseRecord& record) {
  REQUIRE(record.status == Status::done);
  return of_values(record, "class").front().text();
}

TEST_CASE("chatter: below the first orbit of one impact per period a bouncing ball chatters and sticks") {
  CHECK(one_impact(0.5) == Approx(0.260218).epsilon(1e-5));
  for (const char* scheme : {"moreau-jean", "newmark-dumont-paoli"})
    for (const double e : {0.3, 0.5}) {
      CAPTURE(scheme, e);
      // Midpoint rule and e = 0.3: 200 periods do not settle the orbit of one impact.
      if (e < 0.4 && scheme[0] == 'm') continue;
      const CaseRecord below = run_sweep(ball(e, {0.97}, 1.0, scheme)),
                       above = run_sweep(ball(e, {1.03}, 1.03, scheme));
      CHECK(first_class(below) == "chattering");
      CHECK(of_values(below, "period").front().number() == 1.0);
      CHECK(of_values(below, "impacts_per_period").front().number().value() > 3);
      CHECK(first_class(above) == "periodic");
      CHECK(of_values(above, "period").front().number() == 1.0);
      CHECK(of_values(above, "impacts_per_period").front().number() == 1.0);
    }
}

TEST_CASE("chatter: what is at rest, lands without rebound or leans on a spring does not chatter") {
  const double lifts = gravity / (omega * omega) / one_impact(0.5);
  CHECK(first_class(run_sweep(ball(0.5, {0.95 * lifts}, 1.0))) == "at rest");
  Json inelastic = ball(0.5, {1.2 * lifts}, 1.0);
  inelastic["methods"]["time"]["restitution"] = 0;
  CHECK(first_class(run_sweep(inelastic)) != "chattering");
  Json soft = ball(0.5, {1.2 * lifts}, 1.0);
  soft["methods"]["contact"] = {{"name", "penalty"}, {"stiffness", 1e4}};
  soft["methods"]["time"] = "newmark";
  soft["scene"]["structure"]["damping"] = 1;
  CHECK(first_class(run_sweep(soft)) != "chattering");
}

}  // namespace chatter_tests
