#pragma once
#include <map>
#include <ricochet/contract/registry.hpp>
#include <ricochet/scene/scene.hpp>

namespace ricochet::benchmarks {

/// The working set, α = 1e-4, shaken by 0.09 m at 10 rad/s between stops at ±0.1 m.
inline SceneSpec reference_beam(StopsSpec::Place place) {
  BeamSpec beam;
  beam.length = 1.501;
  beam.young = 2e11;
  beam.density = 8000;
  beam.section.outer_diameter = 0.01;
  beam.section.wall = 0.0005;
  beam.damping.stiffness = 1e-4;
  SceneSpec made;
  made.structure = beam;
  made.stops.lower = Formula(-0.1);
  made.stops.upper = Formula(0.1);
  made.stops.place = place;
  made.support = {0.09, 10, 0};
  return made;
}

/// The parameters of a plugin: those given, and its defaults.
inline Parameters defaults(const PluginManual& manual, std::map<std::string, ParameterValue> values = {}) {
  for (const ParameterSpec& spec : manual.parameters)
    if (spec.fallback && !values.contains(spec.key)) values[spec.key] = *spec.fallback;
  return Parameters(values);
}

}  // namespace ricochet::benchmarks
