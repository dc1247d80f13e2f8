#pragma once

/// \file
/// What a loop over modes and lanes takes for the same sweep, in a library of its own: compiled for the processor at
/// hand, it shares no inline function with the rest.
namespace ricochet::benchmarks {

/// Newmark with β = ½ in modes, one stop on each side of the tip, e = 0, C = αK: numbers of a scene.
struct FairModes {
  int modes = 0, lanes = 1, steps_per_period = 0, periods = 0;
  const double *stiffness = nullptr, *mass = nullptr, *tip = nullptr, *shape = nullptr;
  double damping = 0, h = 0, gap = 0;
  const double* force = nullptr;      ///< per step of a period: what multiplies `shape`, per metre of amplitude
  const double* clamp = nullptr;      ///< per step: where the clamp stands after it, per metre of amplitude
  const double* amplitude = nullptr;  ///< per lane, m
  const double* place = nullptr;      ///< modes × lanes: u before the first step, and one step before
  const double* before = nullptr;
};

struct FairSweep {
  double lane_step_seconds = 0;
  long long pushed = 0;  ///< lane-steps in contact
  double end = 0;        ///< of the last lane's tip, relative to the clamp
};

}  // namespace ricochet::benchmarks

/// Marches 1, 8, 16 or 32 lanes; processor time of one thread.
extern "C" [[gnu::visibility("default")]] ricochet::benchmarks::FairSweep ricochet_fair_sweep(
    const ricochet::benchmarks::FairModes& scene);
