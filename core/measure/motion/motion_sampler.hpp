#pragma once
#include <array>
#include <deque>
#include <optional>
#include <ricochet/contract/reference.hpp>
#include <ricochet/engine/compile.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/kernels/quadratic_form.hpp>
#include <ricochet/measure/contact/start_contact.hpp>
#include <vector>

namespace ricochet {

/// The momentum that contact efforts have given by the end of each step (N s), whatever the plan. The plan itself moves
/// a free unit mass under the sum of the efforts, with the weights that the program gives them. The velocity of that
/// mass is read as the plan reads it. In a plan of one stage that is Σ h p, unless an effort acts over several steps.
/// Then its momentum comes when the plan gives it (Newmark: γh now, (1−γ)h in the next; averaged penalties). Allocates
/// in its constructor only; between contacts it costs one test.
class MomentumLedger {
 public:
  explicit MomentumLedger(const Program& program);

  /// Σ_i p_i that stage `k` of the start rule or of a step found (0 where it found none); every stage in turn.
  void stage(bool starting, std::size_t k, double force) {
    if (moving_ || force != 0) move(starting, k, force);
  }
  void step_done() {
    if (moving_) settle();
  }
  /// Whether efforts found so far still give some.
  bool moving() const { return moving_; }
  /// Where the scheme's velocity stands: at Program::velocity_offset.
  double momentum() const { return given_ + velocity_; }

 private:
  struct Stage {
    std::array<std::array<double, most_slots>, most_slots> slots{};  // x ← A x + b e
    std::array<double, most_slots> push{};
    std::array<double, most_slots> jump{};  // of the effort that is found now, through w
    bool jumps = false;
    std::array<double, most_efforts> weights{};
    std::size_t efforts = 0;
  };
  Stage describe(const ricochet::Stage& plan, const StageProgram& program) const;
  void move(bool starting, std::size_t k, double force);
  void settle();
  void restart();

  std::size_t slot_count_ = 0;
  std::vector<Stage> start_, stages_;
  std::array<double, most_slots> reads_{};  // the velocity
  std::array<double, most_slots> state_{};
  std::array<double, most_efforts> past_{};  // newest first
  int quiet_ = 0;                            // stages since the last effort
  bool moving_ = false;
  double given_ = 0, velocity_ = 0, largest_change_ = 0;
};

/// Places that divide the structure evenly: two Gauss points in each of `cells` cells, with their weights; none for an
/// oscillator (length 0).
void sample_places(double length, int cells, SampleGrid& grid);

/// Contact as it happens, lane 0: impacts and releases per side, and the impulse so far. A step without contact costs
/// one test.
///
/// The time of an impact is where the gap of the point that closes, carried on at its velocity, is zero. It is kept
/// within a sub-step of the beginning of the one that closed it. A release is the beginning of the first sub-step
/// without contact on that side. Contact that is there from the start (StartContact) is no impact, and has a release
/// only.
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
/// Positions at a time t between steps n and n+1 are the cubic through steps n−1 … n+2, velocities its derivative. At a
/// time that is a step they are q_n and (q_{n+1} − q_{n−1})/2h. Both are second-order accurate or better, whatever the
/// scheme keeps as its own velocity. Impulses are the momentum that the plan gives to a free mass (MomentumLedger).
/// Those of a scheme whose momentum stands at mid-step (d/h) are brought to t. Energy is ½vᵀMv + ½wᵀKw plus the law's
/// potential at that time. The integration goes up to two steps beyond the last time.
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
  /// With which order in the step velocities are read: 2 by (q_{n+1} − q_{n−1})/2h where most times are at steps, else
  /// 3 by the slope of a cubic.
  int velocity_order() const { return 2 * at_steps_ > sampled() ? 2 : 3; }
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
  /// The motion at a time, between steps.
  struct Read {
    Eigen::VectorXd position, velocity;
    double impulse;
  };
  const State* at(long long step);
  /// Nothing where the lane stopped before.
  std::optional<Read> read(double t);
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
  std::size_t next_ = 0, at_steps_ = 0;
  bool started_ = false;
};

template <class KeepGoing>
void MotionSampler::march(KeepGoing keep_going) {
  while (keep_going() && next()) {
  }
}

}  // namespace ricochet
