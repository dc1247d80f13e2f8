#pragma once
#include <memory>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/contract/step_plan.hpp>
#include <ricochet/loader/catalogue.hpp>
#include <string>

#include "runners/study/load_study.hpp"
#include "tests/refusals.hpp"

namespace ricochet::tests {

struct NoMass : MassStrategy {
  InertiaOrRefusal build(const FiniteElementSpace&) const override { return Refusal{"a test stand-in"}; }
};
struct NoLaw : ContactLaw {
  void prepare(int, std::span<const Parameters>) override {}
  void solve(ReducedProblem&) override {}
};
struct NoScheme : TimeScheme {
  PlanOrRefusal plan(double, const ProblemFacts&) const override { return Refusal{"a test stand-in"}; }
};

inline PluginManual stand_in(const char* name, std::vector<ParameterSpec> parameters) {
  return {name, "A stand-in.", "Registered by the tests.", "none", std::move(parameters)};
}

/// Methods registered by the tests themselves: what is tested is the reading of studies, not the plugins.
inline Registry stand_ins() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto mass = [](const Parameters&) { return std::make_unique<NoMass>(); };
  const auto law = [](const Parameters&) { return std::make_unique<NoLaw>(); };
  const auto scheme = [](const Parameters&) { return std::make_unique<NoScheme>(); };
  Registry registry;
  registry.add_mass(stand_in("full", {}), mass);
  registry.add_mass(stand_in("poor", {word_parameter("velocity", {"P1", "P0"}, "P1", "Space of velocities.")}), mass);
  registry.add_contact(stand_in("rigid", {}), law);
  registry.add_contact(
      stand_in("spring", {real_parameter("stiffness", "N/m", std::nullopt, {0, infinity, true, false}, "k.")}), law);
  registry.add_contact(stand_in("rows", {table_parameter("force", "N against m", false, "p."),
                                         table_parameter("back", "N against m", true, "b.")}),
                       law);
  registry.add_time(stand_in("three-level", {real_parameter("beta", "1", 0.5, {0, 1, false, false}, "β."),
                                             real_parameter("restitution", "1", 0.0, {0, 1, false, false}, "e."),
                                             integer_parameter("order", 2, {1, 4, false, false}, "Order.")}),
                    scheme);
  return registry;
}

/// A small valid study of the stand-ins; tests change it.
inline Json small_study() {
  return Json::parse(R"({
    "name": "small",
    "kind": "trajectory",
    "scene": {
      "structure": {"type": "beam", "length": 1.5, "young": 2e11, "density": 8000,
                    "section": {"type": "tube", "outer_diameter": 0.01, "wall": 0.0005}},
      "stops": {"lower": -0.1, "upper": "0.1", "at": "tip"},
      "initial": {"displacement": "0.04*x^2"}
    },
    "mesh": {"elements": 10},
    "methods": {"mass": ["full", "poor"], "contact": "rigid", "time": [{"name": "three-level", "beta": [0.25, 0.5]}]},
    "step": [1e-3, 1e-4],
    "duration": 0.1
  })");
}

/// A small valid study of kind `bifurcation`: a shaken beam, its amplitude the parameter.
inline Json small_sweep() {
  return Json::parse(R"({
    "name": "sweep",
    "kind": "bifurcation",
    "scene": {
      "structure": {"type": "beam", "length": 1.5, "young": 2e11, "density": 8000,
                    "section": {"type": "tube", "outer_diameter": 0.01, "wall": 0.0005}},
      "stops": {"lower": -0.1, "upper": "0.1 + 0.1*x", "at": "tip"},
      "support": {
  "amplitude" : 0.08, "pulsation" : 10
}
}
, "mesh" : {"elements" : [ 10, 20 ]},
           "methods" : {"mass" : [ "full", "poor" ], "contact" : "rigid", "time" : "three-level"},
                       "parameter" : {"pointer" : "/scene/support/amplitude", "from" : 0.07, "to" : 0.09, "count" : 3},
                                     "steps_per_period" : [ 2000, 8000 ],
                                                          "start" : [ "rest", "up", "down", {"random" : 3, "seed" : 7} ]
})");
}

/// A small valid study of kind `basins`: a driven oscillator over its initial states.
inline Json small_basins() {
  return Json::parse(R"({
    "name": "grid",
    "kind": "basins",
    "scene": {
      "structure": {"type": "oscillator", "mass": 1, "stiffness": 1,
                    "force": {"amplitude": 1, "pulsation": 2.2}},
      "stops": {"upper": 1.5, "at": "tip"}
    },
    "methods": {"mass": "full", "contact": "rigid", "time": "three-level"},
    "axes": [{"pointer": "/scene/initial/displacement", "from": -1, "to": 1, "count": 5},
             {"pointer": "/scene/initial/velocity", "from": -2, "to": 2, "count": 4}],
    "steps_per_period": 1000
  })");
}

inline Study parse(const std::string& text) {
  Registry registry = stand_ins();
  Catalogue catalogue("/nonexistent", {}, {});
  return parse_study(text, catalogue, registry);
}
inline Study parse(const Json& study) {
  return parse(study.dump(1));
}

/// The error of a study that must be refused: "pointer: message", or "" when it is accepted.
inline std::string refusal(const std::string& text) {
  return testing::input_error([&] { parse(text); }, "");
}
inline std::string refusal(const Json& study) {
  return refusal(study.dump(1));
}

/// small_study() with one value set at a pointer.
inline Json with(const std::string& pointer, const Json& value) {
  Json study = small_study();
  study[Json::json_pointer(pointer)] = value;
  return study;
}

inline Json without(const std::string& parent, const std::string& key) {
  Json study = small_study();
  study[Json::json_pointer(parent)].erase(key);
  return study;
}

}  // namespace ricochet::tests
