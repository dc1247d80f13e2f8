#pragma once
#include <cstddef>

/// \file
/// What sixty lines of Eigen and CHOLMOD take for the same motion, in a library of its own: compiled for the processor
/// at hand, it shares no inline function with the rest.
namespace ricochet::benchmarks {

/// Newmark with β = ½ between stops, e = 0, C = αK: numbers of a scene, matrices compressed by columns, both triangles.
struct FairScene {
  int n = 0;
  const int *stiffness_start = nullptr, *stiffness_row = nullptr, *mass_start = nullptr, *mass_row = nullptr;
  const double *stiffness = nullptr, *mass = nullptr;
  int points = 0;
  const int* point = nullptr;  ///< dofs between −gap and gap
  double gap = 0;
  int loaded = 0;  ///< dof pushed by force·sin(pulsation·t)
  double force = 0, pulsation = 0;
  double h = 0, damping = 0;
};

enum class FairFactor { eigen, cholmod_simplicial, cholmod_supernodal };

struct FairResult {
  double setup_seconds = 0, step_seconds = 0, impulse = 0, end = 0;
  double bytes = 0;      ///< that the march holds
  long long pushed = 0;  ///< steps in contact
};

}  // namespace ricochet::benchmarks

/// Processor time of one thread.
extern "C" [[gnu::visibility("default")]] ricochet::benchmarks::FairResult ricochet_fair_march(
    const ricochet::benchmarks::FairScene& scene, ricochet::benchmarks::FairFactor factor, long long steps);
/// Seconds that the slowest modes take: (K, M) by shift-invert Lanczos (Spectra) with a supernodal factor of K.
/// `squares`: ω², ascending.
extern "C" [[gnu::visibility("default")]] double ricochet_fair_modes(const ricochet::benchmarks::FairScene& scene,
                                                                     int count, double* squares);
