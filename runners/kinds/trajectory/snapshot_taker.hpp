#pragma once
#include <ricochet/engine/marcher.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <vector>

#include "runners/store/snapshots.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// How many instants the settings of a case ask for; 0 for none.
int snapshots_asked(const Json& settings);

/// Takes snapshots of one lane at `count` equal fractions of its `steps` steps, and at the start.
class SnapshotTaker final : public StepObserver {
 public:
  SnapshotTaker(const SceneSpec& scene, const Marcher& marcher, long long steps, int count);
  /// Of a lane that begins elsewhere than its scene says, between other stops.
  SnapshotTaker(const SceneSpec& scene, const Marcher& marcher, const LaneSpec& lane, const Eigen::VectorXd& position,
                long long steps, int count);

  void stage_solved(const Marcher& marcher, const StageView& view) override;
  void step_done(Marcher& marcher) override;
  void interval(Marcher& marcher, const StepInterval& steps) override;

  bool taken() const { return count_ > 0; }
  Snapshots finish() const;

 private:
  void take(const SemiDiscrete& problem, const Eigen::VectorXd& position, double support, double time);
  long long step_of(long long k) const { return (steps_ * k + count_ / 2) / count_; }

  long long steps_, count_, next_ = 1;
  int group_ = 1;                                    // contact points that are one
  Eigen::SparseMatrix<double, Eigen::RowMajor> at_;  // places × n
  Eigen::VectorXd by_support_;                       // how much of the clamp's motion each place has
  Eigen::MatrixXd shares_;                           // of motions at the places, and at the clamp
  Snapshots shape_;                                  // all that does not change
  std::vector<double> t_, clamp_, displacement_;
  std::vector<double> given_;  // per point since the last snapshot, N s
  bool any_given_ = false;
  std::vector<std::uint32_t> pushed_;
  std::vector<double> force_;
};

/// What a film shows of a structure: places of a beam, a bar or an oscillator, or nodes on a plane with what joins
/// them. Bodies and beams in two planes are nodes as well. Where no node has a place of its own, each point is a bar.
struct DrawnRows {
  Snapshots shape;  ///< all that does not change, with a stop for each contact point, without bounds
  SparseRows rows;  ///< of its values at an instant, on the dofs of the mesh
  /// What supports add to them, values × r: static modes there, and their own displacements.
  Eigen::MatrixXd on_supports;
  Eigen::VectorXd by_clamp;  ///< how much of the harmonic motion of all supports each value has
};
DrawnRows drawn_rows(const SceneSpec& scene, const SemiDiscrete& problem);

}  // namespace ricochet
