#pragma once
#include <deque>
#include <ricochet/contract/reference.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/kernels/quadratic_form.hpp>
#include <ricochet/measure/contact/start_contact.hpp>
#include <ricochet/measure/energy/momentum_ledger.hpp>
#include <vector>

namespace ricochet {

/// Places that divide the structure evenly: two Gauss points in each of `cells` cells, with their weights; none for an
/// oscillator (length 0).
void sample_places(double length, int cells, SampleGrid& grid);

/// Contact as it happens, lane 0: impacts and releases per side, and the impulse so far. A step without contact costs
/// one test.
///
/// The time of an impact is where the gap of the point that closes, carried on at its velocity, is zero, kept within a
/// sub-step of the one that closed it; a release is the beginning of the first sub-step without contact on that side.
/// Contact that is there from the start (StartContact) is no impact, and has a release only.
class ContactLog final : public StepObserver {
 public:
  explicit ContactLog(const Marcher& marcher);
  void stage_solved(const Marcher& marcher, const StageView& view) override;
  void step_done(Marcher& marcher) override;
  void interval(Marcher& marcher, const StepInterval& steps) override;

  const std::vector<ContactEvent>& events() const { return events_; }
  double impulse() const { return momentum_.momentum(); }  ///< ∫₀ᵗ Σp, signed, N s
  double force() const { return force_; }                  ///< Σp of the last step, N
  long long changes() const { return changes_; }

 private:
  void read(const Marcher& marcher, const StageView& view);
  void close_instant(const StageView& view);
  double onset(const Marcher& marcher, const StageView& view, int point, int side);
  void see(const Marcher& marcher, const StageView& view);
  void ask(const Marcher& marcher);

  const MarchModel& model_;
  const SemiDiscrete& problem_;
  int T_;
  double h_;
  std::vector<signed char> signs_, asked_;  // at the last instant of contact, and at the present one
  std::vector<double> position_, velocity_;
  bool state_known_ = false;                                   // position_ and velocity_ are those before the stage
  bool closed_[2] = {false, false}, now_[2] = {false, false};  // lower, upper
  bool hit_[2] = {false, false};                               // whether a point has hit that side at this instant
  StartContact start_;
  double onset_[2] = {0, 0}, tip_speed_ = 0;
  std::vector<ContactEvent> events_;
  MomentumLedger momentum_;
  double force_ = 0;
  long long changes_ = 0;
};

/// Reads a marching lane 0 on a grid of times and places, as references are read.
///
/// Positions at a time t between steps n and n+1 are the cubic through steps n−1 … n+2, velocities its derivative; at a
/// time that is a step, q_n and (q_{n+1} − q_{n−1})/2h. Both are second-order accurate or better, whatever the scheme
/// keeps as its own velocity. Impulses are the momentum that the plan gives to a free mass (MomentumLedger); those of a
/// scheme whose momentum stands at mid-step (d/h) are brought to t. Energy is ½vᵀMv + ½wᵀKw plus the law's potential at
/// that time. The integration goes up to two steps beyond the last time.
class MotionSampler {
 public:
  /// `beside`: observes the same integration.
  MotionSampler(Marcher& marcher, const SampleGrid& grid, StepObserver* beside = nullptr);

  /// Marches to the end of the grid. `keep_going` is asked now and then; when it says no, or the lane stops, what was
  /// read so far is kept: `sampled()` times.
  template <class KeepGoing>
  void march(KeepGoing keep_going);
  /// Reads the next time of the grid; false when there is none left, or the lane stopped before it.
  bool next();

  std::size_t sampled() const { return next_; }
  const SampledMotion& motion() const { return motion_; }
  /// The motion, events included.
  SampledMotion finish();
  const ContactLog& contact() const { return log_; }

 private:
  struct State {
    long long step;
    Eigen::VectorXd position;
    double impulse;
  };
  const State* at(long long step);
  void keep();

  Marcher& marcher_;
  SampleGrid grid_;
  ContactLog log_;
  Observers observers_;
  QuadraticForm mass_, stiffness_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> places_, strains_;
  Eigen::MatrixXd shares_;  // of motions at the places
  double offset_ = 0;       // of the impulses kept, in steps
  std::deque<State> states_;
  SampledMotion motion_;
  std::size_t next_ = 0;
  bool started_ = false;
};

template <class KeepGoing>
void MotionSampler::march(KeepGoing keep_going) {
  while (keep_going() && next()) {
  }
}

}  // namespace ricochet
