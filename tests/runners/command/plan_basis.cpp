// `ricochet plan` of a study in modes: what these leave out at each stop.
#include <catch2/catch.hpp>
#include <string>

#include "tests/runners/command/said.hpp"

using Catch::Matchers::Contains;

TEST_CASE("plan tells what modes leave out at each stop, and that times the stiffest spring") {
  const ScratchFolder here;
  const std::string study = R"json({
    "name": "modes", "kind": "trajectory",
    "scene": {"structure": {"type": "beam", "length": 1, "section": {"type": "given", "EI": 1, "rhoS": 1},
                            "supports": [{"name": "left", "x": 0, "type": "pinned"},
                                         {"name": "right", "x": 1, "type": "pinned"}]},
              "stops": [{"name": "mid", "at": {"x": 0.5}, "upper": 0.01}],
              "load": [{"at": 0.3, "force": "sin(t)"}]},
    "mesh": {"elements": 20, "modes": 1},
    "methods": {"mass": "consistent", "contact": LAWS, "time": "newmark-dumont-paoli"},
    "step": 1e-3, "duration": 0.1})json";
  const auto planned = [&](const std::string& laws) {
    std::string text = study;
    text.replace(text.find("LAWS"), 4, laws);
    write_text(here / "modes.json", text);
    const CommandOutput plan = say(here, "plan modes.json");
    INFO(plan.err);
    REQUIRE(plan.code == 0);
    return plan.out;
  };
  // R = 1/48 − 2/π⁴ = 3.0126e-4 m/N, 1.4 % of 1/48.
  const std::string both = planned(R"(["signorini", {"name": "penalty", "stiffness": [10, 1000]}])");
  CHECK_THAT(both, Contains("stop mid: the modes leave out 1.4 % of the flexibility, 0.000301 m/N"));
  CHECK_THAT(both, Contains("what modes leave out times the stiffest spring, R κ with κ = 1000 N/m: mid 30 %"));
  CHECK_THAT(planned(R"("signorini")"), !Contains("stiffest spring"));
  // A stop with a spring of its own is told by that.
  std::string own = study;
  own.replace(own.find("LAWS"), 4, R"({"name": "penalty", "stiffness": 10})");
  own.replace(own.find(R"("upper": 0.01)"), 13, R"("upper": 0.01, "stiffness": 1000)");
  write_text(here / "own.json", own);
  CHECK_THAT(say(here, "plan own.json").out, Contains("mid 30 % (of its own 1000 N/m)"));
}
