// Sweeps over the numbers of stops that have names, and over bodies: which scenes share a factorisation.
#include "runners/kinds/sweep/forced_scenes.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "tests/runners/kinds/sweep/sweep_case.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

Json swept_bodies(const std::string& pointer, const std::vector<double>& values) {
  Json study = Json::parse(R"json({
    "name": "bodies", "kind": "bifurcation",
    "scene": {"bodies": {"rod": {"type": "beam", "length": 0.5, "section": {"type": "given", "EI": 14.4, "rhoS": 0.6}},
                         "ball": {"type": "oscillator", "mass": 0.1, "stiffness": 4e4}},
              "stops": [{"name": "gap", "at": {"body": "rod", "x": 0.5}, "to": {"body": "ball"}, "upper": 1e-4,
                         "stiffness": 1e5}],
              "support": {"amplitude": 0, "pulsation": 100},
              "load": [{"at": {"body": "rod", "x": 0.5}, "force": "sin(100*t)"}]},
    "mesh": {"elements": 4},
    "methods": {"mass": "consistent", "contact": {"name": "penalty", "stiffness": 1e6}, "time": "newmark-dumont-paoli"},
    "parameter": {"pointer": "", "values": []}, "steps_per_period": 500})json");
  study["parameter"] = {{"pointer", pointer}, {"values", values}};
  return study;
}

}  // namespace

TEST_CASE("a gap of a stop is a lane's own, its stiffness and its bodies are not") {
  const auto groups = [](const std::string& pointer, const std::vector<double>& values) {
    OpenedSweep opened = opened_sweep(swept_bodies(pointer, values));
    ForcedScenes scenes(opened.first(), *opened.registry);
    for (const double value : values) {
      scenes.add(pointer, value, false);
      INFO(scenes[scenes.count() - 1].refusal.text);
      REQUIRE(scenes[scenes.count() - 1].refusal.empty());
    }
    return scenes.groups();
  };
  CHECK(groups("/scene/stops/0/upper", {1e-4, 2e-4, 3e-4}) == 1);
  CHECK(groups("/scene/stops/0/stiffness", {1e5, 2e5, 3e5}) == 3);
  CHECK(groups("/scene/bodies/ball/stiffness", {1e4, 2e4}) == 2);
}
