// What makes figures doubtful stands on the first screen, of the terminal and of the page.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/runners/command/said.hpp"

namespace doubts_told_tests {

using Catch::Matchers::Contains;

/// A study of an oscillator with one stop or two, run at these steps.
nlohmann::json oscillator(const nlohmann::json& steps) {
  nlohmann::json study = nlohmann::json::parse(R"({
    "name": "told", "question": "What does it do?", "kind": "trajectory",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 100}, "stops": {"upper": 0.05}},
    "methods": {"mass": "consistent", "contact": "signorini", "time": "newmark"}, "duration": 1})");
  study["step"] = steps;
  return study;
}

/// What `run` prints above its tables, and the page up to its figures.
struct FirstScreen {
  std::string terminal, page;
};
FirstScreen first_screen(const nlohmann::json& study) {
  const ScratchFolder here;
  write_text(here / "study.json", study.dump(1));
  const CommandOutput ran = say(here, "run study.json --inline --out out");
  CAPTURE(ran.out, ran.err);
  REQUIRE(ran.code == 0);
  const std::string page = read_text(here / "out/report.html");
  const std::size_t answer = page.find("<section id=\"answer\""), figures = page.find("<section id=\"figures\"");
  REQUIRE(answer != std::string::npos);
  REQUIRE(figures != std::string::npos);
  const std::size_t blank = ran.out.find("\n\n");
  // Numbers of the page are in bold.
  std::string section = page.substr(answer, figures - answer);
  for (const char* mark : {"<strong>", "</strong>"})
    for (std::size_t at = 0; (at = section.find(mark, at)) != std::string::npos;) section.erase(at, std::string(mark).size());
  return {ran.out.substr(0, blank), section};
}

void check_both(const FirstScreen& screen, const std::string& text) {
  CHECK_THAT(screen.terminal, Contains(text));
  CHECK_THAT(screen.page, Contains(text));
}

TEST_CASE("doubts: a pulse that is shorter than a step is told on the first screen, with the cases that miss it") {
  nlohmann::json study = oscillator({2e-3, 1e-3, 1e-5});
  study["scene"]["load"] = "t > 0.3004 && t < 0.3006 ? 5000 : 0";
  check_both(first_screen(study), "Doubtful: 2 of 3 cases (");
  const FirstScreen screen = first_screen(study);
  check_both(screen, "the load comes and goes within a step of 0.002 s");
  check_both(screen, ", in the first of them.");
  study["step"] = {1e-5, 5e-6};
  CHECK_THAT(first_screen(study).terminal, !Contains("comes and goes"));
}

TEST_CASE("doubts: a step that takes a point further than its gap, and a penetration of more than it, are told") {
  nlohmann::json study = oscillator(nlohmann::json::array({0.01}));
  study["scene"]["stops"] = {{"lower", -1e-3}, {"upper", 1e-3}};
  study["scene"]["initial"] = {{"velocity", "1"}};
  check_both(first_screen(study), "Doubtful: 1 of 1 case: a step of 0.01 s takes a point further than the gap");
  study["step"] = 1e-4;
  study["methods"]["contact"] = {{"name", "penalty"}, {"stiffness", 10}};
  check_both(first_screen(study), "Doubtful: 1 of 1 case: a point passes its stop by more than the gap");
}

TEST_CASE("doubts: of a diagram as well, whose load is shorter than a step of its period") {
  nlohmann::json study = nlohmann::json::parse(R"({
    "name": "told", "question": "Which motions?", "kind": "bifurcation",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "damping": 0.2,
                            "force": {"amplitude": 1, "pulsation": 2}},
              "stops": {"upper": 0.1}, "load": "cos(2*t) > 0.99999 ? 1000 : 0"},
    "methods": {"mass": "consistent", "contact": "signorini", "time": "newmark-dumont-paoli"},
    "parameter": {"pointer": "/scene/structure/force/amplitude", "values": [1]}, "steps_per_period": 100,
    "start": ["rest"], "transient": {"periods": 20, "at_most": 20}, "keep": 16, "exponents": 0, "refine": null})");
  check_both(first_screen(study), "Doubtful: 1 of 1 case: the load jumps within a step");
}

TEST_CASE("doubts: cells of basins that begin beyond a stop are told once, and no share counts them") {
  nlohmann::json study = nlohmann::json::parse(R"({
    "name": "told", "question": "Where does it end?", "kind": "basins",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "damping": 0.2,
                            "force": {"amplitude": 1, "pulsation": 2}}, "stops": {"upper": 0.4}},
    "methods": {"mass": "consistent", "contact": "signorini",
                "time": [{"name": "newmark-dumont-paoli", "restitution": [0, 0.5]}]},
    "axes": [{"pointer": "/scene/initial/displacement", "from": -0.5, "to": 1, "count": 4},
             {"pointer": "/scene/initial/velocity", "from": -1, "to": 1, "count": 3}],
    "steps_per_period": 100, "transient": {"periods": 60, "at_most": 120}, "keep": 16})");
  const FirstScreen screen = first_screen(study);
  check_both(screen, "6 of 12 cells begin beyond a stop: they are no starts, and no share counts them.");
}

}  // namespace doubts_told_tests
