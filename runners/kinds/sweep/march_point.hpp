#pragma once
#include <functional>
#include <ricochet/contract/registry.hpp>
#include <ricochet/engine/marcher.hpp>
#include <string>
#include <vector>

#include "runners/kinds/kind.hpp"
#include "runners/kinds/stored_study.hpp"
#include "runners/kinds/sweep/forced_scenes.hpp"
#include "runners/store/record.hpp"
#include "runners/study/study.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {

/// An integration of orbits again from where their kept periods began, one step after a strobe, that reads the tips.
class TipMarch {
 public:
  /// The program has a lane for each orbit.
  TipMarch(Program program, const std::vector<const Orbit*>& orbits, const SectionPlan& plan);

  /// The tip of a lane, `step` steps after the strobe: displacement and velocity, central over two steps.
  using Use = std::function<void(std::size_t lane, long long step, double displacement, double velocity)>;
  /// Marches on and hands over what stands one step back, from the second step after the strobe.
  void march(long long steps, const Use& use);
  /// Turns the clock back to the beginning of a period, as a run does after each.
  void turn_back() { marcher_.set_clock(begin_); }
  double h() const { return marcher_.program().h; }

 private:
  Marcher marcher_;
  long long begin_, made_ = 1;       // of the clock; steps since the strobe
  std::vector<double> before_, at_;  // tips per lane
};

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

/// Marches the orbit and hands over its samples, `samples` per period, the last of each at the strobe. They are bitwise
/// equal to those of the run that left the entry. Throws InputError where the scene cannot be marched at this value.
void march_point(const StudyCase& study_case, const Registry& registry, const PointTask& task,
                 const std::function<void(const PointSample&)>& use);

/// Marches an orbit of this scene on from where its kept periods began, sample by sample.
void march_on(const ForcedScenes& scenes, int scene, const Orbit& orbit, const SectionPlan& plan, SampleCount count,
              const std::function<void(const PointSample&)>& use);

/// The table of this name that a case left. Throws PointRefused where it has none, with what became of it.
const Table& stored_table(const CaseRecord& record, const std::string& name);

/// Samples as lines of CSV: t, tip_displacement, tip_velocity.
class SamplePrinter {
 public:
  explicit SamplePrinter(std::ostream& out);
  void operator()(const PointSample& sample);

 private:
  std::ostream& out_;
};

/// --periods and --samples, or what stands for them.
SampleCount wanted_count(const PointRequest& asked);

/// "; 3 of 4 strobes as stored: the results are of another build of the program".
std::string comparison_text(std::size_t equal, std::size_t compared);

/// "0.1, 0.2, 0.3": the values nearest to a wanted one.
std::string nearest_values(const std::vector<double>& values, double wanted);
/// Whether a stored value is the one that was written in digits.
bool is_value(double stored, double wanted);

}  // namespace ricochet
