#pragma once
#include <cmath>

#include "tests/marching.hpp"

namespace ricochet::testing {

/// A plugin as it comes. A parameter without default: the first word, the middle of a bounded range, else a
/// stiffness-like number, or a table of that stiffness.
inline Choice with_defaults(const PluginManual& manual) {
  Choice choice{manual.name, {}};
  for (const ParameterSpec& spec : manual.parameters) {
    if (spec.fallback) continue;
    if (spec.type == ParameterSpec::Type::word)
      choice.values[spec.key] = spec.words.front();
    else if (spec.type == ParameterSpec::Type::table)
      choice.values[spec.key] = ParameterTable{{0, 0}, {1e-3, 100}};
    else if (std::isfinite(spec.range.low) && std::isfinite(spec.range.high))
      choice.values[spec.key] = 0.5 * (spec.range.low + spec.range.high);
    else
      choice.values[spec.key] = 1e5;
  }
  return choice;
}

}  // namespace ricochet::testing
