#pragma once
#include <ricochet/engine/marcher.hpp>
#include <vector>

namespace ricochet {

/// Steps over which a stop pushes a point.
struct ContactRun {
  int point = 0;
  bool upper = false;   ///< which stop
  long long begin = 0;  ///< first step, from 1; of a run over the strobe the one before it
  long long steps = 0;  ///< how many
  double impulse = 0;   ///< N s, positive upwards
};

/// One period of an orbit, at the strobe and after each of its steps. Of equal length, the first row and the last are
/// the strobe.
struct OrbitMotion {
  std::vector<double> time;          ///< s
  std::vector<double> displacement;  ///< of the tip, absolute, m
  std::vector<double> velocity;      ///< of the tip, central over two steps, m/s
  std::vector<double> force;         ///< mean over the step that ends there, of all points, positive upwards, N
  std::vector<ContactRun> runs;      ///< by point, in time
  double penetration = 0;            ///< m
  LaneEnd end;                       ///< none: the march went to its end
};

/// Marches lane 0, which begins an orbit of so many steps, from a set clock. `beside` is told of the steps as well.
OrbitMotion march_orbit(Marcher& marcher, long long steps, StepObserver* beside = nullptr);

}  // namespace ricochet
