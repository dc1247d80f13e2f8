#pragma once
#include <optional>
#include <ricochet/engine/compile.hpp>

namespace ricochet {

/// Of each rubbing point, the largest over stages, rows and lanes. Two solves a point.
std::vector<JamNumber> jam_numbers(Program& program);

/// By how much one impact of a rigid point may raise the energy at most, over that before: 0.266 for 26.6 %. W_nn, W_nt
/// and W_tt are those of the point and along its coupling. Newton's restitution with Coulomb friction gains where
/// W_nt ≠ 0 (Kane and Levinson 1985); without restitution never.
double largest_gain(const JamNumber& point, double restitution);

/// The sentence for the first point whose J is 1 or more; fills Program::jam.
std::optional<Refusal> refuse_jamming(Program& program);

}  // namespace ricochet
