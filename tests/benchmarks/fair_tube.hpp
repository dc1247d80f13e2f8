#pragma once

/// \file
/// What a page of C++ takes for a tube in modes between two-sided stops, in a library of its own: compiled for the
/// processor at hand, it shares no inline function with the rest.
namespace ricochet::benchmarks {

/// Newmark with β = ½ in modes of mass 1, e = 0 or springs at the end of the step: numbers of a scene.
struct FairTube {
  int modes = 0, points = 0;
  const double *squares = nullptr, *damping = nullptr;  ///< ω² and 2ζω of each mode
  const double *shapes = nullptr, *load = nullptr;      ///< points × modes; modes
  double gap = 0, stiffness = 0;                        ///< of springs, N/m; 0: rigid stops
  double force = 0, pulsation = 0, h = 0;
};

struct FairTubeResult {
  double step_seconds = 0, impulse = 0, end = 0;  ///< `end`: of the last point
  long long pushed = 0;                           ///< steps in contact
};

}  // namespace ricochet::benchmarks

/// From rest; processor time of one thread.
extern "C" [[gnu::visibility("default")]] ricochet::benchmarks::FairTubeResult ricochet_fair_tube(
    const ricochet::benchmarks::FairTube& scene, long long steps);
