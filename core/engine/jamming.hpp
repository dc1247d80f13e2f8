#pragma once
#include <optional>
#include <ricochet/engine/compile.hpp>

namespace ricochet {

/// Of each rubbing point, the largest over stages, rows and lanes. Two solves a point.
std::vector<JamNumber> jam_numbers(Program& program);

/// The sentence for the first point whose J is 1 or more; fills Program::jam.
std::optional<Refusal> refuse_jamming(Program& program);

}  // namespace ricochet
