#include "runners/march/load_changes.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/marching.hpp"

using namespace ricochet;
using Catch::Matchers::Contains;

namespace {

SceneSpec pushed(const std::vector<std::string>& forces) {
  SceneSpec scene;
  scene.structure = OscillatorSpec{.mass = 1, .stiffness = 100, .damping = 0, .force = {}};
  for (const std::string& force : forces)
    scene.load.terms.push_back(
        {.force = true, .at = std::nullopt, .shape = Formula(), .history = Formula(force, "/scene/load/0/force", "t")});
  return scene;
}

std::vector<std::string> said(const std::string& force, double step, long long steps) {
  std::vector<std::string> texts;
  for (const Said& change : load_changes(pushed({force}), step, steps)) texts.push_back(change.text);
  return texts;
}

}  // namespace

TEST_CASE("a load that steps resolve has nothing to be said of") {
  CHECK(said("5", 0.1, 100).empty());
  CHECK(said("3 + 2*exp(-t)", 0.1, 100).empty());
  // Waves of ten steps and more, at any phase; a pulse that lasts as long.
  for (const double per_period : {10.0, 12.7, 20.0, 64.0})
    for (const double phase : {0.0, 0.3, 1.1}) {
      const std::string wave = fmt::format("7*sin(2*pi*t/{} + {})", per_period * 0.01, phase);
      CAPTURE(wave);
      CHECK(said(wave, 0.01, 5000).empty());
      CHECK(said(fmt::format("exp(-((t - 0.5)/{})^2)", per_period * 0.01 / 4), 0.01, 5000).empty());
    }
  // A ramp and a table with corners at the steps' own spacing.
  CHECK(said("t < 1 ? 10*t : 10", 0.01, 200).empty());
  CHECK(said("t < 0.02 ? 50*t : (t < 0.05 ? 1 + 20*(t - 0.02) : 1.6)", 0.01, 200).empty());
  // Small beside the largest load.
  CHECK(load_changes(pushed({"sin(t)", "t > 0.3 && t < 0.3001 ? 0.05 : 0"}), 0.01, 1000).empty());
  // A support and a force that are harmonic are no formulas.
  SceneSpec harmonic = pushed({});
  std::get<OscillatorSpec>(harmonic.structure).force = {.amplitude = 1, .pulsation = 1000, .phase = 0};
  CHECK(load_changes(harmonic, 0.1, 100).empty());
}

TEST_CASE("a load that comes and goes within a step is told with its times") {
  // Within one step of some thousands, wherever it lies in it.
  for (const double at : {0.30001, 0.30037, 0.30052, 0.30098}) {
    const auto found = said(fmt::format("t > {0} && t < {0} + 1e-5 ? 1000 : 0", at), 1e-3, 4000);
    CAPTURE(at, found);
    REQUIRE(found.size() == 1);
    CHECK_THAT(found[0], Contains("comes and goes within a step of 0.001 s, at t = 0.300"));
  }
  // The same of a million steps, of which a hundredth is looked at: the formula says where.
  CHECK(said("abs(t - 0.73311) < 1e-8 ? 4 : 0", 1e-6, 1000000).size() == 1);
  // One instant alone meets it.
  const auto once = said("abs(t - 0.5) < 0.004 ? 1 : 0", 0.01, 100);
  REQUIRE(once.size() == 1);
  CHECK_THAT(once[0], Contains("comes and goes") && Contains("at t = 0.5 s"));
  // A wave of three steps.
  CHECK_THAT(said("sin(2*pi*t/0.03)", 0.01, 100).at(0), Contains("comes and goes") && Contains(" more"));
  // One part of several, and what is spread over a beam.
  CHECK(load_changes(pushed({"1 + 0.1*sin(t)", "t > 0.3 && t < 0.3001 ? 5 : 0"}), 0.01, 1000).size() == 1);
  SceneSpec beam;
  BeamSpec whole;
  whole.length = 2;
  beam.structure = whole;
  beam.load = Formula("x^2*(t > 0.3 && t < 0.3001 ? 5 : 0)", "/scene/load", "xt");
  CHECK(load_changes(beam, 0.01, 1000).size() == 1);
  beam.load = LoadSpec();
  beam.load.terms.push_back({.force = false,
                             .at = std::nullopt,
                             .shape = Formula("x", "", "x"),
                             .history = Formula("t > 0.3 && t < 0.3001 ? 5 : 0", "", "t")});
  CHECK(load_changes(beam, 0.01, 1000).size() == 1);
}

TEST_CASE("a load that jumps is told with the steps in which it does") {
  const auto found = said("t < 0.305 ? 0 : 10", 0.01, 100);
  REQUIRE(found.size() == 1);
  CHECK(found[0] == "the load jumps within a step, at t = 0.3 to 0.31 s");
  // A square wave jumps twice in each period.
  const auto square = said("sin(2*pi*t) > 0 ? 1 : -1", 0.01, 1000);
  REQUIRE(square.size() == 1);
  CHECK_THAT(square[0], Contains("the load jumps within a step, at t = ") && Contains(" more"));
  // A ramp of a tenth of a step is one; of five steps none.
  CHECK(said("t < 0.3 ? 0 : (t < 0.301 ? 1000*(t - 0.3) : 1)", 0.01, 100).size() == 1);
  CHECK(said("t < 0.3 ? 0 : (t < 0.35 ? 20*(t - 0.3) : 1)", 0.01, 100).empty());
}

TEST_CASE("a run of less than a hundredth of the slowest period is told, beside that period") {
  // An oscillator of 10 rad/s: T = 2π/10 exactly.
  const auto oscillator = testing::problem_of(pushed({}), 1, {"consistent"});
  CHECK(short_run(*oscillator, 0.00629).empty());
  CHECK(short_run(*oscillator, 0.00628).text ==
        "the run of 0.00628 s lasts 0.01 of the slowest period, 0.628 s: nothing of that motion is seen");
  // A bar of eight lumped elements: ω₁ = 2c/ℓ sin(π/32) = 4 sin(π/32), T = 16.03 s.
  SceneSpec scene;
  BarSpec bar;
  bar.length = 8;
  bar.EA = 4;
  scene.structure = bar;
  const double period = 2 * M_PI / (4 * std::sin(M_PI / 32));
  for (const char* mass : {"lumped", "consistent"}) {
    const auto problem = testing::problem_of(scene, 8, {mass});
    CAPTURE(mass);
    // The quotient is from above: what is told is short in truth.
    CHECK(short_run(*problem, 0.0101 * period).empty());
    CHECK_FALSE(short_run(*problem, 0.0095 * period).empty());
  }
  // E a thousand million times too small makes T √10⁹ times as long.
  bar.EA = 4e-9;
  scene.structure = bar;
  CHECK_THAT(short_run(*testing::problem_of(scene, 8, {"lumped"}), 10).text, Contains("5.07e+05 s"));
  // What nothing holds has no slowest period.
  std::get<OscillatorSpec>(scene.structure = OscillatorSpec{}).mass = 1;
  std::get<OscillatorSpec>(scene.structure).stiffness = 0;
  CHECK(short_run(*testing::problem_of(scene, 1, {"consistent"}), 1e-9).empty());
}

TEST_CASE("what passes between two steps in a table is told, of a load as of a motion") {
  // Between the instants of the steps: only the entries of the table tell where.
  const auto table = [](double from, double to) {
    auto out = std::make_shared<TimeTable>();
    out->times = {0, from, 0.5 * (from + to), to, 2};
    out->values = {0, 0, 1000, 0, 0};
    return out;
  };
  const auto motion = [&](double from, double to) {
    SceneSpec scene = pushed({});
    MotionSpec one;
    const auto accelerations = table(from, to);
    one.history = std::make_shared<PiecewiseCubic>(PiecewiseCubic::integrate_twice(*accelerations, 0, 0));
    one.table = accelerations;
    scene.motions.push_back(one);
    return scene;
  };
  const std::vector<Said> passes = load_changes(motion(0.5035, 0.5039), 0.01, 200);
  REQUIRE(passes.size() == 1);
  CHECK_THAT(passes.front().text, Contains("comes and goes within a step of 0.01 s, at t = 0.5037 s"));
  // What steps resolve, and entries at their instants, are not.
  CHECK(load_changes(motion(0.4, 0.6), 0.01, 200).empty());
  CHECK(load_changes(motion(0.5035, 0.5039), 2e-5, 100000).empty());
}
