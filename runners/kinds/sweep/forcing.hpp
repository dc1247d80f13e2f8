#pragma once
#include <ricochet/scene/scene.hpp>
#include <string>

/// \file
/// What drives a scene, and after what all of it repeats.
namespace ricochet {

/// ω of the forcing (rad/s), T = 2π/ω the shortest period after which all repeats that changes with time: a support
/// that moves, forces of oscillators with an amplitude, motions and tables that say their period, and loads by formulas
/// of sin, cos and tan of multiples of t. T is at most ten periods of the slowest of them.
///
/// Where no support moves and no oscillator is pushed, the first pulsation that is given sets the period: of the
/// support, else of a force. 0: no period at all.
double forcing_pulsation(const SceneSpec& scene);

/// Of how many periods of each wave that of the forcing is, where it is longer than all; else "".
std::string forcing_note(const SceneSpec& scene);

/// Whether anything changes with time: the support, forces of oscillators, the load, motions.
bool is_forced(const SceneSpec& scene);

/// Throws InputError (with pointer) unless the scene has a forcing period T and everything that changes with time
/// repeats with it. Told are two pulsations without a common period. A load has f(x, t + kT) = f(x, t) to 1e-9 of its
/// largest value, read at 9 places, 64 phases and k = 1, 2, 7, 50, 300, 2000.
void check_forcing(const SceneSpec& scene);

}  // namespace ricochet
