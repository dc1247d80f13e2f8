#include <catch2/catch.hpp>
#include <functional>

#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

Formula in_x(const std::string& text) {
  return Formula(text, "/given", "x");
}

std::string refused(const std::function<void(SceneSpec&)>& change) {
  SceneSpec scene = working_set();
  scene.stops.place = StopsSpec::Place::nodes;
  change(scene);
  return input_error([&] { check_scene(scene, 10); });
}

}  // namespace

TEST_CASE("scenes that make sense pass") {
  CHECK(refused([](SceneSpec&) {}) == "no error");
  CHECK(refused([](SceneSpec& s) { s.stops = {}; }) == "no error");
  CHECK(refused([](SceneSpec& s) { s.stops.lower.reset(); }) == "no error");
  CHECK(refused([](SceneSpec& s) {
          s.support.amplitude = 0.1;
          s.initial = {};
        }) == "no error");
  // At rest exactly on the stop.
  CHECK(refused([](SceneSpec& s) { s.initial.displacement = in_x("0.1*(x/1.501)^2"); }) == "no error");
  // Stops that meet at the clamp, which is no contact point.
  CHECK(refused([](SceneSpec& s) {
          s.initial = {};
          s.stops.lower = in_x("-0.1*x");
          s.stops.upper = in_x("0.1*x");
        }) == "no error");
}

TEST_CASE("a structure that cannot exist") {
  CHECK(refused([](SceneSpec& s) { beam_of(s).length = -1.5; }) ==
        "/scene/structure/length: the length is -1.5 m; expected a finite number above 0");
  CHECK_THAT(refused([](SceneSpec& s) { beam_of(s).length = std::nan(""); }), StartsWith("/scene/structure/length: "));
  CHECK_THAT(refused([](SceneSpec& s) { beam_of(s).section.wall = 0.02; }),
             StartsWith("/scene/structure/section/wall: "));
  CHECK(refused([](SceneSpec& s) { beam_of(s).damping.stiffness = -1e-4; }) ==
        "/scene/structure/damping/stiffness: the stiffness damping α is -0.0001 s; expected a finite number, 0 or "
        "above");
  CHECK_THAT(refused([](SceneSpec& s) { beam_of(s).damping.mass = -1; }),
             StartsWith("/scene/structure/damping/mass: "));
  CHECK(input_error([] { check_scene(working_set(), 0); }) == "/mesh/elements: 0 elements; expected at least 1");
}

TEST_CASE("stops that cross, depend on time, have no value, or stand nowhere") {
  CHECK(refused([](SceneSpec& s) { s.stops.lower = Formula(0.2); }) ==
        "/scene/stops/lower: at x = 0.007505 m the lower stop, 0.2 m, is above the upper stop, 0.1 m. Expected "
        "lower ≤ upper everywhere, or a compliant law that lets points pass both");
  // They cross between two nodes of this mesh only.
  CHECK_THAT(refused([](SceneSpec& s) { s.stops.lower = in_x("abs(x-0.22) < 0.02 ? 0.3 : -0.1"); }),
             StartsWith("/scene/stops/lower: at x = 0.2"));
  CHECK_THAT(refused([](SceneSpec& s) { s.stops.upper = Formula("0.1+t", "/scene/stops/upper", "xt"); }),
             StartsWith("/scene/stops/upper: the formula \"0.1+t\" depends on t"));
  CHECK_THAT(refused([](SceneSpec& s) { s.stops.lower = Formula("-0.1+sqrt(x-1)", "/scene/stops/lower", "x"); }),
             StartsWith("/scene/stops/lower: ") && Contains("gives no number (NaN) at x = 0.0075"));
  const auto at = [](std::vector<double> positions) {
    return refused([&](SceneSpec& s) {
      s.stops.place = StopsSpec::Place::positions;
      s.stops.positions = positions;
    });
  };
  CHECK(at({0.5, 1.501}) == "no error");
  CHECK(at({0.5, 1.6}) ==
        "/scene/stops/at/1: a stop at x = 1.6 m is not on the free part of the structure; expected 0 < x ≤ 1.501 m");
  CHECK_THAT(at({0.0}), StartsWith("/scene/stops/at/0: "));
  CHECK_THAT(at({0.5, 0.7, 0.5}), StartsWith("/scene/stops/at/2: two stops at x = 0.5 m"));
  CHECK_THAT(at({}), StartsWith("/scene/stops/at: the list of positions is empty"));
}

TEST_CASE("a support that pushes the clamp through a stop, where the stop runs along the beam") {
  const auto moving = [](double amplitude, double pulsation, double phase) {
    return [=](SceneSpec& s) {
      s.initial = {};
      s.support = {amplitude, pulsation, phase};
    };
  };
  CHECK(refused(moving(0.12, 10, 0)) ==
        "/scene/support/amplitude: the support takes the clamp to 0.12 m, through the upper stop at 0.1 m (x = 0); "
        "expected an amplitude of at most 0.1 m");
  CHECK_THAT(refused(moving(-0.12, 10, 0)), StartsWith("/scene/support/amplitude: "));
  CHECK(refused(moving(0.12, 0, 0)) == "no error");  // it never leaves sin(0)
  CHECK_THAT(refused(moving(0.12, 0, -1.5)), Contains("through the lower stop at -0.1 m"));
  CHECK_THAT(refused([](SceneSpec& s) { s.stops.lower = in_x("0.01 - x"); }),
             StartsWith("/scene/stops/lower: the lower stop at x = 0 is at 0.01 m, beyond the clamp at 0 m"));
  CHECK(refused([&](SceneSpec& s) {
          moving(0.12, 10, 0)(s);
          s.stops.place = StopsSpec::Place::tip;
        }) == "no error");
  CHECK_THAT(refused(moving(0.01, -10, 0)),
             StartsWith("/scene/support/pulsation: the pulsation of the support is -10"));
  CHECK_THAT(refused(moving(std::nan(""), 10, 0)), StartsWith("/scene/support/amplitude: "));
}

TEST_CASE("an initial state outside the stops, with the place") {
  CHECK(
      refused([](SceneSpec& s) { s.initial.displacement = in_x("0.08*x^2"); }) ==
      "/scene/initial/displacement: the initial displacement is 0.100038 m at x = 1.11824 m, beyond the upper stop at "
      "0.1 m; expected a state between the stops, or a compliant law that lets points pass them");
  CHECK_THAT(refused([](SceneSpec& s) { s.initial.displacement = in_x("-0.05*x^2"); }),
             Contains("beyond the lower stop at -0.1 m"));
  // Only the tip has a stop: passing it elsewhere is allowed.
  CHECK(refused([](SceneSpec& s) {
          s.stops.place = StopsSpec::Place::tip;
          s.initial.displacement = in_x("x*(1.501-x)");
        }) == "no error");
  CHECK_THAT(refused([](SceneSpec& s) { s.initial.velocity = Formula("1/x", "/scene/initial/velocity", "x"); }),
             StartsWith("/scene/initial/velocity: ") && Contains("at x = 0 m"));
  CHECK_THAT(refused([](SceneSpec& s) { s.initial.displacement = Formula("t", "/d", "xt"); }),
             StartsWith("/scene/initial/displacement: ") && Contains("depends on t"));
  CHECK_THAT(refused([](SceneSpec& s) { s.load = Formula("log(x-1)", "/scene/load"); }),
             StartsWith("/scene/load: ") && Contains("gives no number (NaN) at x = "));
}

TEST_CASE("a mesh that leaves the stops where the formula does not") {
  // Inside the first element the Hermite interpolant of this bump overshoots a stop placed there.
  SceneSpec scene = working_set();
  scene.stops.place = StopsSpec::Place::positions;
  scene.stops.positions = {0.75};
  scene.stops.upper = Formula(0.01);
  scene.initial.displacement = in_x("abs(x-0.75) < 0.1 ? 0 : 0.05*x");
  CHECK(input_error([&] { check_scene(scene, 1); }) == "no error");
  CHECK_THAT(input_error([&] { discretise(scene, 1, *mass("consistent")); }),
             StartsWith("/scene/initial/displacement: ") && Contains("x = 0.75 m"));
}
