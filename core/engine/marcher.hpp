#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <ricochet/engine/compile.hpp>
#include <ricochet/engine/lane_status.hpp>
#include <string>
#include <vector>

namespace ricochet {

class EnergyScale;

/// What one lane carries from step to step, in model coordinates: enough to go on elsewhere with the same bits.
struct LaneState {
  std::vector<double> slots;    ///< slot by slot
  std::vector<double> efforts;  ///< per stage its p, and those of steps before where the plan weights them
  std::vector<double> fastest;  ///< per stage with a gate: the largest speed seen at its stops, m/s
  std::vector<double> memory;   ///< of the law, per point
};

/// What an observer sees while a step is made. Blocks are rows × T or points × T.
struct StageView {
  int stage = 0;
  const Stage* plan = nullptr;
  const StageProgram* program = nullptr;  ///< what was derived of the stage
  bool starting = false;                  ///< a stage of the start rule
  double time = 0;                        ///< when the step begins, s
  double from = 0, to = 0;                ///< when the position stands before and after the stage, s
  const double* const* slots = nullptr;   ///< before the stage
  const double* z = nullptr;              ///< the stage's unknown, efforts included
  const double* const* effort = nullptr;  ///< p, p₋₁, … as far as the plan weights them; null: no contact
  int efforts = 0;                        ///< how many; each may be null: a stage that reads no contact
  const LaneOutcome* outcome = nullptr;   ///< per lane, of the law; of lanes that were looked at
  std::uint32_t touched_lanes = 0;        ///< lanes that the law looked at
  const double* free = nullptr;           ///< what the law measured before any effort, absolute; null where nothing did
  std::uint32_t contact_lanes = 0;        ///< lanes with a non-zero effort now
};

class Marcher;

/// Looks at every step of a block; a march without an observer pays nothing for it.
class StepObserver {
 public:
  virtual ~StepObserver() = default;
  /// The stage has found z and p; the slots are not yet updated.
  virtual void stage_solved(const Marcher& marcher, const StageView& view) = 0;
  /// The step is complete.
  virtual void step_done(Marcher& marcher) = 0;
};

/// The one time loop. Allocates in its constructor only.
class Marcher {
 public:
  explicit Marcher(Program program);
  ~Marcher();
  Marcher(Marcher&&) noexcept;

  /// Applies the start rule; call once, before march().
  void start(StepObserver* observer = nullptr);
  /// Makes up to `steps` steps; returns early (with how many it made) only when no lane runs any more.
  long long march(long long steps, StepObserver* observer = nullptr);

  /// The state of a lane between steps, and its return. `spec` takes the place of the lane's own: amplitude, phase,
  /// stops and law parameters; its initial position and velocity are not read. A lane that had stopped runs again.
  LaneState lane_state(int lane) const;
  void set_lane(int lane, const LaneSpec& spec, const LaneState& state);
  /// Sets the number of steps made, hence the time: a periodic problem may be marched period after period on one clock.
  void set_clock(long long step);

  /// Tangent columns per lane: X_k' = Df X_k along the lane, with its own contact set and without loads. The derivative
  /// of the discrete step while the contact set stays; what it lacks at impacts with inertia, impact_jump.hpp adds.
  int tangents() const { return program_.tangents; }
  /// Where column k of a lane stands in the block.
  int tangent_lane(int lane, int k) const { return lanes() * (1 + k) + lane; }
  LaneState tangent(int lane, int k) const { return state_at(tangent_lane(lane, k)); }
  void set_tangent(int lane, int k, const LaneState& state) { set_state_at(tangent_lane(lane, k), state); }

  /// Lets tangent columns fly free through the first `steps` steps of contact at these points: an impact with inertia
  /// is over by then, and its jump is put on by whoever asked.
  void hold_tangents(const std::vector<bool>& points, int steps);

  long long step() const { return step_; }
  double time() const { return static_cast<double>(step_) * program_.h; }
  int lanes() const { return static_cast<int>(program_.lanes.size()); }
  int width() const { return program_.width; }
  const Program& program() const { return program_; }
  const LaneStatus& status(int lane) const { return status_[static_cast<std::size_t>(lane)]; }
  bool any_running() const;

  /// Slot j in model coordinates, rows × T.
  const double* slot(int j) const { return slots_[static_cast<std::size_t>(j)]; }
  const double* const* slots() const { return slot_pointers_.data(); }
  int slot_count() const { return static_cast<int>(slots_.size()); }
  /// w at the end of the last step, nodal coordinates.
  Eigen::VectorXd position(int lane) const;
  /// φ at time t for a lane, and its rate.
  double support(int lane, double t) const;
  double support_rate(int lane, double t) const;
  /// Σ weight φ(t + at·h).
  double support_levels(int lane, double t, const Levels& levels) const;
  /// Absolute displacement of the tip at the end of the last step.
  double tip(int lane) const;
  /// Largest distance by which a contact point lies beyond its stop at the end of the last step (0: none), m.
  double penetration(int lane) const;
  /// The same at w = q − increment/2 and so on: one contact point's depth (> 0 beyond a stop) for a given H w.
  double depth(int lane, int point, double relative, double support) const;
  /// Σ φ_k F(t + c_k h) of the distributed load in model coordinates (n); null when there is none.
  const double* distributed_load(const Levels& levels, double t);
  /// Number of Delassus columns computed so far in the stages.
  int delassus_columns() const;
  const ContactLaw& law() const { return *program_.law; }
  ContactLaw& law() { return *program_.law; }

  /// Stops a lane now, with its cause (used by audits that see more than the loop does).
  void freeze(int lane, const LaneEnd& end);
  /// Energy (J) above which a lane counts as diverged; its own, whoever marches beside it; stated with the cause.
  double energy_bound(int lane) const;
  /// Whether an energy is beyond it; looks again at a load that depends on time before it says so.
  bool beyond_bound(int lane, double energy);

 private:
  class StageDelassus;
  struct StageState;
  struct LoadWindow;
  struct ActiveSystem;
  void place_lane(int lane);
  void prepare_law();
  void place_stops(int lane);
  LaneState state_at(int column) const;
  void set_state_at(int column, const LaneState& state);
  void remove_load(StageProgram& program, const double* load);
  void tangent_contact(StageProgram& program, StageState& state);
  void tangent_targets(const StageProgram& program, StageState& state, int lane, int tangent);
  void run_stage(StageProgram& program, const Stage& plan, StageState& state, int index, StepObserver* observer);
  void connect_efforts();
  void keep_start_efforts();
  void contact(StageProgram& program, StageState& state, double* z);
  std::uint32_t measure_contact(StageProgram& program, StageState& state, const double* z);
  void open_gates(StageProgram& program, StageState& state);
  void check_lanes();
  void clear_lane(int lane);
  void combine_for(const StageProgram& program);
  bool finite_measure(const StageState& state, int lane) const;
  void support_offsets(const PhaseWeights& phase, double* out, bool rate) const;

  Program program_;
  const LaneKernels& kernels_;
  std::vector<Block> blocks_;
  std::vector<double*> slots_;
  std::vector<const double*> slot_pointers_;
  Block combination_;  // Σ β^K_j x_j of the stage to come
  const StageProgram* combined_for_ = nullptr;
  std::vector<std::unique_ptr<StageState>> start_states_, stage_states_;
  Block scale_, offset_, lower_, upper_, amplitude_, cos_phase_, sin_phase_;
  Block memory_;  // of the law, points × T for each number that it keeps
  bool phases_ = false;
  std::vector<int> touched_;
  std::vector<LaneOutcome> outcome_;
  std::vector<LaneStatus> status_;
  std::uint32_t frozen_now_ = 0;  // lanes that froze since the last update of the slots
  std::unique_ptr<LoadWindow> load_window_;
  std::vector<double> scratch_;
  Block elastic_;
  std::vector<bool> held_points_;  // whose tangents wait
  int held_steps_ = 0;
  std::vector<double> stiffness_rows_;
  int stiffness_width_ = 0;
  long long step_ = 0;
  std::unique_ptr<EnergyScale> energy_scale_;
  std::vector<double> lane_bounds_;
  double load_bound_ = 0, load_known_until_ = 0;
  double sine_ = 0, cosine_ = 1;
};

}  // namespace ricochet
