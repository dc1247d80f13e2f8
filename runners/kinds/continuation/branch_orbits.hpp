#pragma once
#include <functional>
#include <limits>
#include <optional>
#include <ricochet/measure/orbits/orbit_motion.hpp>
#include <ricochet/measure/orbits/stepped_map.hpp>

#include "runners/kinds/continuation/continuation_tables.hpp"
#include "runners/store/record.hpp"
#include "runners/table/number_type.hpp"

/// \file
/// What a case keeps of the orbits of its branches beside their rows. States: any orbit is solved again from one.
/// Samples: what some of the orbits look like. They are tables of numbers that are not exported.
namespace ricochet {

struct FollowedBranch;

/// One period of an orbit, and the stops that it meets.
struct BranchMotion {
  OrbitMotion motion;
  std::vector<double> x;           ///< place of each contact point, m
  std::vector<std::string> stops;  ///< their names; empty where they have none
  Eigen::VectorXd lower, upper;    ///< its stops, m; infinite where there is none
  int tip_point = -1;              ///< the contact point that is the tip; −1: none is
};
/// Marches an orbit that a marcher begins over so many steps. `lane`: whose stops they are.
BranchMotion branch_motion(Marcher& marcher, const LaneSpec& lane, long long steps, StepObserver* beside = nullptr);
/// The same from a state of a map at a value of the parameter.
using MarchBranchOrbit = std::function<BranchMotion(const Eigen::VectorXd& x, double parameter, long long steps)>;

MarchBranchOrbit marches_of(PeriodicMap& map);
MarchBranchOrbit marches_of(SteppedMap& map);

/// An orbit of a branch that others are followed from.
struct BranchStart {
  double arc = 0, parameter = 0;
  int way = 1;       ///< sign of dλ/ds behind it
  SetChange change;  ///< that made its corner; none of the first
  Eigen::VectorXd x;
};

/// Orbits that are drawn of one branch, samples of one period, and states kept of one that is followed by pieces.
inline constexpr std::size_t most_branch_portraits = 60, branch_samples = 320, most_branch_states = 200;
/// Of a branch that is followed by steps: those between two rows are interpolated.
inline constexpr std::size_t all_branch_states = std::numeric_limits<std::size_t>::max();

/// `branch_portraits`: an orbit that is drawn, with its number of samples and the stops of the tip (m).
struct BranchPortraitColumns {
  const Series *branch = nullptr, *row = nullptr, *samples = nullptr, *lower = nullptr, *upper = nullptr;
};
NumberType<BranchPortraitColumns> branch_portraits_type();
/// `branch_samples`: the tip over the period, or over the first half where the orbit is its own image. Samples are
/// evenly spaced and begin at the strobe; portrait follows portrait.
struct BranchSampleColumns {
  const Series *displacement = nullptr, *velocity = nullptr;
};
NumberType<BranchSampleColumns> branch_samples_type();
/// `branch_runs`: a run of contact of an orbit that is drawn, in forcing periods from the strobe.
struct BranchRunColumns {
  const Series *branch = nullptr, *row = nullptr, *x = nullptr, *upper = nullptr, *bound = nullptr, *begin = nullptr,
               *length = nullptr;
};
NumberType<BranchRunColumns> branch_runs_type();

/// What collects these tables for a case.
class BranchOrbits {
 public:
  BranchOrbits();
  /// A branch with its rows. At most so many states are kept, evenly, the first, the last and those of marks among
  /// them.
  void add(const FollowedBranch& branch, const std::vector<BranchRow>& rows, const MarchBranchOrbit& march,
           std::size_t most_states);
  void put(CaseRecord& record) const;

 private:
  void keep(double branch, const BranchStart& start);
  void draw(double branch, const FollowedBranch& of, const BranchRow& row, const Eigen::VectorXd& x,
            const MarchBranchOrbit& march);

  std::vector<std::string> names_;
  NumberTable states_, portraits_, samples_, runs_;
};

/// The last kept state of a branch at an arc or before it, and the one behind; none where the case keeps none there.
struct KeptStarts {
  std::optional<BranchStart> at, next;
};
KeptStarts kept_starts(const CaseRecord& record, const std::string& branch, double arc);

}  // namespace ricochet
