#pragma once
#include "runners/study/study.hpp"

namespace ricochet {

/// The JSON Schema (draft-07) of a study: every object closed, each key with its meaning, unit, range and default, and
/// the parameters of every method that `registry` holds. What a schema cannot say (formulas, stops that cross, excludes
/// that match nothing) is left to load_study().
Json study_schema(const Registry& registry);

}  // namespace ricochet
