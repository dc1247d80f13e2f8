#pragma once
#include <nlohmann/json.hpp>
#include <string>

/// \file
/// Studies of each kind that take a second or less.
namespace quick_studies {

using Json = nlohmann::ordered_json;

inline Json study_of(const std::string& kind) {
  Json study = Json::parse(R"({
    "name": "here", "question": "Is it the same?",
    "scene": {"structure": {"type": "beam", "length": 1.501, "young": 2e11, "density": 8000,
                            "section": {"type": "tube", "outer_diameter": 0.01, "wall": 0.0005}, "damping": {"stiffness": 1e-4}},
              "stops": {"lower": -0.1, "upper": 0.1, "at": "tip"}},
    "mesh": {"elements": 4},
    "methods": {"mass": ["consistent", {"name": "singular", "velocity": "P1"}], "contact": "signorini", "time": "newmark-dumont-paoli"}
  })");
  study["kind"] = kind;
  Json& scene = study["scene"];
  if (kind == "trajectory" || kind == "convergence" || kind == "work-precision" || kind == "stability")
    scene["initial"] = {{"displacement", "0.04*x^2"}, {"velocity", "-2*x"}};
  else
    scene["support"] = {{"amplitude", 0.08}, {"pulsation", 10}};
  if (kind == "trajectory") study.update(Json::parse(R"({"step": [1e-4, 5e-5], "duration": 0.3})"));
  if (kind == "convergence")
    study.update(Json::parse(R"({"step": [4e-4, 2e-4, 1e-4], "duration": 0.2, "reference": "self"})"));
  if (kind == "work-precision")
    study.update(Json::parse(R"({"step": [4e-4, 2e-4, 1e-4], "duration": 0.1, "reference": "self", "repeats": 2})"));
  if (kind == "stability")
    study.update(Json::parse(R"({"steps": {"from": 1e-5, "to": 1e-2, "count": 4}, "duration": 0.05})"));
  if (kind == "bifurcation")
    study.update(Json::parse(R"({
      "parameter": {"pointer": "/scene/support/amplitude", "from": 0.07, "to": 0.1, "count": 7},
      "steps_per_period": 200, "start": ["rest", "up", "down"], "transient": {"periods": 40, "at_most": 80}, "keep": 20,
      "section": "strobe", "exponents": 2, "refine": 0.002})"));
  if (kind == "basins") {
    scene["initial"] = {{"displacement", "0.1*(x/1.501)^2"}, {"velocity", "x/1.501"}};
    study.update(Json::parse(R"({
      "axes": [{"pointer": "/scene/initial/displacement", "from": -1, "to": 1, "count": 9},
               {"pointer": "/scene/initial/velocity", "from": -2, "to": 2, "count": 7}],
      "steps_per_period": 200, "transient": {"periods": 40, "at_most": 80}, "keep": 16, "refine": true})"));
  }
  return study;
}

/// A sweep with a law that does what no plugin may do.
inline Json stumbling(const std::string& how, double beyond) {
  Json study = study_of("bifurcation");
  study["methods"]["mass"] = "consistent";
  study["methods"]["contact"] = {{"name", "stumbles"}, {"how", how}, {"beyond", beyond}};
  study["refine"] = nullptr;
  study["exponents"] = 0;
  return study;
}

/// A sweep that takes a second or two.
inline Json longer() {
  Json study = study_of("bifurcation");
  study["parameter"]["count"] = 13;
  study["steps_per_period"] = 4000;
  return study;
}

}  // namespace quick_studies
