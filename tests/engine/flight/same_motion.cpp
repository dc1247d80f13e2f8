// Leaving out steps changes nothing: every scheme, law and mass matrix, and random scenes, against the same integration
// of every step.
#include <fmt/format.h>

#include <random>

#include "tests/engine/flight/compare_marches.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

SceneSpec shaken() {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-4;
  scene.stops.place = StopsSpec::Place::nodes;
  scene.support.amplitude = 0.03;
  return scene;
}

}  // namespace

TEST_CASE(
    "an integration that leaves out steps is the integration of every step, whatever the scheme, the law and the "
    "mass") {
  int flew = 0, left_out = 0;
  std::map<std::string, int> by_scheme, by_law;
  for (const std::string& mass : registry().names(Role::mass))
    for (const std::string& law : registry().names(Role::contact))
      for (const std::string& time : registry().names(Role::time)) {
        // All schemes with one law and one mass, all laws with one scheme, all masses: and those that cross.
        const bool crossed = time == "newmark-dumont-paoli" ||
                             (law == "signorini" && (mass == "consistent" || mass == "singular")) ||
                             (law == "penalty" && mass == "lumped");
        if (!crossed) continue;
        const Methods methods{with_values(registry().mass(mass)->manual), with_values(registry().contact(law)->manual),
                              with_values(registry().time(time)->manual)};
        SceneSpec scene = shaken();
        Compared result;
        try {
          result = compare(scene, 4, methods, 4e-5, 4000);
        } catch (const std::exception& error) {
          result.cause = error.what();
        }
        INFO(mass << " × " << law << " × " << time << ": " << result.apart);
        CHECK(result.alike);
        flew += result.flew;
        left_out += result.flew && 2 * result.visited < result.steps;
        by_scheme[time] += result.flew;
        by_law[law] += result.flew;
      }
  CHECK(flew > 100);
  CHECK(left_out > flew / 2);
  for (const auto& [law, times] : by_law) {
    INFO(law);
    CHECK(times > 0);
  }
  for (const auto& [scheme, times] : by_scheme) {
    INFO(scheme);
    CHECK(times > 0);
  }
}

TEST_CASE("leaving out steps changes nothing in random scenes") {
  std::mt19937 random(20);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto one_of = [&](const auto& list) {
    return list[std::uniform_int_distribution<std::size_t>(0, list.size() - 1)(random)];
  };
  const std::vector<Choice> masses = {{"consistent"},
                                      {"lumped"},
                                      {"singular", {{"velocity", std::string("P1")}}},
                                      {"singular", {{"velocity", std::string("P0")}}}};
  const std::vector<Choice> laws = {{"signorini"}, {"signorini"}, {"penalty", {{"stiffness", 1e5}}}};
  const std::vector<Choice> times = {{"newmark-dumont-paoli", {{"restitution", 0.5}}},
                                     {"newmark-dumont-paoli", {{"beta", 0.5}}},
                                     {"newmark-dumont-paoli", {{"beta", 0.3}}},
                                     {"moreau-jean", {{"theta", 0.6}}},
                                     {"midpoint"},
                                     {"bathe"},
                                     {"generalised-alpha", {{"rho_inf", 0.8}}}};
  int flew = 0, held = 0;
  for (int k = 0; k < 240; ++k) {
    SceneSpec scene = working_set();
    beam_of(scene).damping.stiffness = one_of(std::vector<double>{0, 1e-5, 1e-3});
    beam_of(scene).damping.mass = one_of(std::vector<double>{0, 0, 5});
    scene.stops.place = one_of(std::vector{StopsSpec::Place::nodes, StopsSpec::Place::tip});
    scene.stops.lower = Formula(-between(0.02, 0.1));
    scene.stops.upper = Formula(between(0.02, 0.1));
    scene.support = {one_of(std::vector<double>{0, 0.01, 0.05}), between(2, 60), between(0, 6)};
    // The clamp stays between the stops.
    scene.support.amplitude = std::min(scene.support.amplitude, 0.015);
    if (k % 5 == 0) scene.load = Formula(fmt::format("{}*x", between(-3, 3)), "/scene/load");
    scene.initial.displacement =
        Formula(fmt::format("{}*x^2", between(-0.008, 0.008)), "/scene/initial/displacement", "x");
    scene.initial.velocity = Formula(fmt::format("{}*x", between(-2, 2)), "/scene/initial/velocity", "x");
    const Methods methods{one_of(masses), one_of(laws), one_of(times)};
    const double h = std::pow(10, -between(4, 5));
    const Compared result = compare(scene, 2 + k % 5, methods, h, 4000);
    INFO(k << ": " << methods.mass.name << " × " << methods.contact.name << " × " << methods.time.name << ", h = " << h
           << ": " << result.apart << result.cause);
    CHECK(result.alike);
    flew += result.flew && result.visited < result.steps;
    held += result.flew && result.visited < result.contact_steps;
  }
  CHECK(flew > 150);
  // Some rest at a stop long enough that closed contact is left out too.
  CHECK(held > 10);
}

TEST_CASE("leaving out steps changes nothing under loads of one pulsation, nor with damping by modes") {
  std::mt19937 random(53);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const std::vector<Choice> times = {{"newmark-dumont-paoli", {{"beta", 0.5}}},
                                     {"newmark-dumont-paoli", {{"restitution", 0.5}}},
                                     {"moreau-jean", {{"theta", 0.6}}},
                                     {"bathe"},
                                     {"generalised-alpha", {{"rho_inf", 0.8}}}};
  int flew = 0, held = 0, met = 0, by_modes = 0;
  for (std::size_t k = 0; k < 80; ++k) {
    SceneSpec scene = working_set();
    if (k % 4 == 1)
      beam_of(scene).damping = {.ratios = {0.01, 0.03}, .beyond = 0.02};
    else
      beam_of(scene).damping.stiffness = k % 3 == 0 ? 0 : 1e-4;
    scene.stops.place = k % 4 == 0 ? StopsSpec::Place::nodes : StopsSpec::Place::tip;
    scene.stops.lower = Formula(-between(0.005, 0.05));
    scene.stops.upper = Formula(between(0.005, 0.05));
    scene.support = {};
    const double pulsation = between(2, 60);
    scene.load = k % 2 == 0 ? Formula(fmt::format("{0}*x*sin({2}*t) + {1}*x^2*cos({2}*t + 0.4) - {1}", between(2, 30),
                                                  between(2, 20), pulsation),
                                      "/scene/load")
                            : Formula(fmt::format("{}*sin(2*x - {}*t)", between(10, 40), pulsation), "/scene/load");
    scene.initial.displacement = Formula();
    scene.initial.velocity = Formula(fmt::format("{}*x", between(-0.2, 0.2)), "/scene/initial/velocity", "x");
    const Methods methods{{k % 3 == 1 ? "singular" : "consistent"},
                          k % 5 == 4 ? Choice{"penalty", {{"stiffness", 1e5}}} : Choice{"signorini"},
                          times[k % times.size()]};
    const Compared result = compare(scene, 2 + static_cast<int>(k % 5), methods, std::pow(10, -between(4, 5)), 6000);
    INFO(k << ": " << methods.mass.name << " × " << methods.contact.name << " × " << methods.time.name << ": "
           << result.apart << result.cause);
    CHECK(result.alike);
    flew += result.flew && 2 * result.visited < result.steps;
    met += result.contact_steps > 0;
    by_modes += result.flew && k % 4 == 1 && 2 * result.visited < result.steps;
    held += result.flew && result.visited < result.contact_steps;
  }
  CHECK(flew > 60);
  CHECK(met > 40);
  CHECK(held > 5);
  CHECK(by_modes > 10);
}

TEST_CASE("a flight that looks for the stops where they are not is found out") {
  const Methods methods{{"consistent"}, {"signorini"}, {"newmark-dumont-paoli", {{"beta", 0.5}}}};
  const SceneSpec scene = shaken();
  CHECK(compare(scene, 4, methods, 4e-5, 4000).alike);
  CHECK_FALSE(compare(scene, 4, methods, 4e-5, 4000, 0.02).alike);
}

TEST_CASE("the balance of an integration that leaves out steps closes as well as that of every step") {
  // Where closed contact is left, round-off of the constraint (1e-17 m a step) is a velocity of 1e-10 m/s at h = 1e-7.
  // Taken off along what moves the whole structure, it gave or took 1e-11 J each time.
  SceneSpec scene = working_set();
  scene.stops.place = StopsSpec::Place::nodes;
  const Methods methods{
      {"lumped"}, {"signorini"}, {"newmark-dumont-paoli", {{"beta", 0.5}, {"start", std::string("first-order")}}}};
  CompileOptions flown;
  flown.march = MarchWay::flights;
  flown.expected_steps = 1500000;
  Marcher beam = marcher(scene, 20, methods, 1e-7, flown);
  const EnergyAudit audit = audited(beam, 0.15);
  CHECK(beam.steps_visited() < 50000);
  CHECK(audit.contact(0).contact_steps > 1000);
  CHECK(std::abs(audit.totals(0).balance_residual()) < 1e-11 * audit.totals(0).first.common());
}
