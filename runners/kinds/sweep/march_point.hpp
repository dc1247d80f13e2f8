#pragma once
#include <functional>
#include <ricochet/contract/registry.hpp>
#include <ricochet/engine/marcher.hpp>
#include <string>

#include "runners/kinds/sweep/forced_scenes.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// How much of a motion is wanted.
struct SampleCount {
  int periods = 1;
  int samples = 1;  ///< per period, at most one per step
};

/// One orbit of a case of kind `bifurcation`, to be marched again from where its kept periods began.
struct PointTask {
  double parameter = 0;  ///< a value that the case marched
  std::string start;     ///< "rest", "up", "random-3" …
  LaneState entry;
  SampleCount count;
};

/// A sample: t from the strobe before the kept periods (s), the tip's absolute displacement (m) and velocity (m/s,
/// central over two steps). `strobe`: the number of the strobe that it stands at, from 0 as in points.csv; else −1.
struct PointSample {
  double time = 0, displacement = 0, velocity = 0;
  long long strobe = -1;
};

/// Marches the orbit and hands over its samples, `samples` per period, the last of each at the strobe: with the bits of
/// the run that left the entry. Throws InputError where the scene cannot be marched at this value.
void march_point(const StudyCase& study_case, const Registry& registry, const PointTask& task,
                 const std::function<void(const PointSample&)>& use);

/// Marches an orbit of this scene on from where its kept periods began, sample by sample.
void march_on(const ForcedScenes& scenes, int scene, const Orbit& orbit, const SectionPlan& plan, SampleCount count,
              const std::function<void(const PointSample&)>& use);

}  // namespace ricochet
