// What a person writes for many orbits of one beam: modes by rows, lanes side by side, a table of the forcing, and the
// stop at the tip in closed form. No check, no section, no record.
#include "tests/benchmarks/fair_sweep.hpp"

#include <utility>
#include <vector>

#include "tests/benchmarks/thread_clock.hpp"

namespace {

using ricochet::benchmarks::FairModes;
using ricochet::benchmarks::FairSweep;
using ricochet::benchmarks::thread_nanoseconds;

constexpr int most_modes = 256;

// Eight lanes side by side: left to itself the compiler keeps the sums of eight lanes in memory.
typedef double Eight __attribute__((vector_size(64)));

template <int Lanes>
FairSweep march(const FairModes& scene) {
  const int n = scene.modes;
  const double h = scene.h;
  alignas(64) static double now[most_modes * Lanes], then[most_modes * Lanes];
  std::vector<double> p(static_cast<std::size_t>(n)), q(p), push(p), inverse(p);
  double flexibility = 0;
  for (int k = 0; k < n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double K = scene.stiffness[k], M = scene.mass[k] / (h * h), C = scene.damping * K / (2 * h);
    inverse[i] = 1 / (M + C + K / 2);
    p[i] = 2 * M * inverse[i];
    q[i] = -(M - C + K / 2) * inverse[i];
    push[i] = scene.shape[k] * inverse[i];
    inverse[i] *= scene.tip[k];
    flexibility += scene.tip[k] * inverse[i];
  }
  for (int e = 0; e < n * Lanes; ++e) {
    now[e] = scene.place[e];
    then[e] = scene.before[e];
  }
  FairSweep out;
  double *u = now, *old = then;
  const double begun = thread_nanoseconds();
  for (int period = 0; period < scene.periods; ++period)
    for (int step = 0; step < scene.steps_per_period; ++step) {
      alignas(64) double tip[Lanes], force[Lanes], effort[Lanes];
      for (int l = 0; l < Lanes; ++l) {
        force[l] = scene.amplitude[l] * scene.force[step];
        tip[l] = 0;
      }
      if constexpr (Lanes == 1) {
        double sum = 0;
        for (int k = 0; k < n; ++k) {
          const auto i = static_cast<std::size_t>(k);
          old[k] = p[i] * u[k] + q[i] * old[k] + push[i] * force[0];
          sum += scene.tip[k] * old[k];
        }
        tip[0] = sum;
      } else {
        constexpr int groups = Lanes / 8;
        const auto* push_of = reinterpret_cast<const Eight*>(force);
        Eight sum[groups] = {};
        for (int k = 0; k < n; ++k) {
          const auto i = static_cast<std::size_t>(k);
          const auto* at = reinterpret_cast<const Eight*>(u) + k * groups;
          auto* was = reinterpret_cast<Eight*>(old) + k * groups;
          for (int g = 0; g < groups; ++g) {
            was[g] = p[i] * at[g] + (q[i] * was[g] + push[i] * push_of[g]);
            sum[g] += scene.tip[k] * was[g];
          }
        }
        for (int l = 0; l < Lanes; ++l) tip[l] = sum[l / 8][l % 8];
      }
      std::swap(u, old);
      bool any = false;
      for (int l = 0; l < Lanes; ++l) {
        const double place = tip[l] + scene.amplitude[l] * scene.clamp[step];
        effort[l] = place > scene.gap    ? (scene.gap - place) / flexibility
                    : place < -scene.gap ? (-scene.gap - place) / flexibility
                                         : 0.0;
        any = any || effort[l] != 0;
      }
      if (!any) continue;
      for (int l = 0; l < Lanes; ++l) out.pushed += effort[l] != 0;
      for (int k = 0; k < n; ++k)
        for (int l = 0; l < Lanes; ++l) u[k * Lanes + l] += inverse[static_cast<std::size_t>(k)] * effort[l];
    }
  const double spent = thread_nanoseconds() - begun;
  out.lane_step_seconds = 1e-9 * spent / (1.0 * scene.periods * scene.steps_per_period * Lanes);
  for (int k = 0; k < n; ++k) out.end += scene.tip[k] * u[k * Lanes + Lanes - 1];
  return out;
}

}  // namespace

FairSweep ricochet_fair_sweep(const FairModes& scene) {
  switch (scene.modes <= most_modes ? scene.lanes : 0) {
    case 1:
      return march<1>(scene);
    case 8:
      return march<8>(scene);
    case 16:
      return march<16>(scene);
    case 32:
      return march<32>(scene);
    default:
      return {};
  }
}
