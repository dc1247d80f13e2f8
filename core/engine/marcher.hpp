#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <ricochet/contact_solvers/circle_solver.hpp>
#include <ricochet/contract/said.hpp>
#include <ricochet/engine/compile.hpp>
#include <ricochet/engine/march_loads.hpp>
#include <ricochet/engine/step_observer.hpp>
#include <span>
#include <string>
#include <vector>

namespace ricochet {

/// What one lane carries from step to step, in model coordinates: enough to go on elsewhere with bitwise equal results.
struct LaneState {
  std::vector<double> slots;    ///< slot by slot
  std::vector<double> efforts;  ///< per stage its p, and those of steps before where the plan weights them
  std::vector<double> fastest;  ///< per stage with a gate: the largest speed seen at its stops, m/s
  std::vector<double> memory;   ///< of the law, per point; of friction: whether each point sticks, what rows keep
};

/// Why the integration of a lane ended.
enum class EndCause {
  none,                   ///< it runs
  position_not_finite,    ///< the displacement at a contact point
  effort_not_finite,      ///< that a contact law found
  law_not_converged,      ///< value: residual, in units of the measure, ∞: no finite force; count: iterations made
  friction_not_found,     ///< value: residual over the largest effort; count: turns of law and friction
  state_not_finite,       ///< count: steps between two checks of the state
  elastic_energy_beyond,  ///< value: ½wᵀKw, J; bound, J: factor times the scene's own scale
  energy_not_finite,      ///< of an audit
  energy_beyond,          ///< value: energy of an audit, J; bound, J
  idle,                   ///< nothing is marched there
  twin_met,               ///< a twin trajectory fell on its orbit
  process_ended,          ///< that of the integration, for a reason of its own
};

/// The end of an integration: its cause, with the numbers that the cause tells of.
struct LaneEnd {
  EndCause cause = EndCause::none;
  double value = 0, bound = 0, factor = 0;
  long long count = 0;

  /// Whether there is one.
  explicit operator bool() const { return cause != EndCause::none; }
  /// Whether the step itself could not be made: then the integration has failed. Otherwise it went where no motion of
  /// the scene goes: it has diverged.
  bool failed() const {
    return cause == EndCause::law_not_converged || cause == EndCause::friction_not_found ||
           cause == EndCause::process_ended;
  }
  bool operator==(const LaneEnd&) const = default;
};

/// The cause in words, with its numbers: "the contact law did not converge (residual 0.3 after 50 iterations)"; "" for
/// none.
Said told(const LaneEnd& end);
std::string text(const LaneEnd& end);

/// How a lane fares. A lane that diverges is frozen at zero, out of every stop's reach, and the others go on.
struct LaneStatus {
  bool running = true;
  long long step = 0;  ///< when it stopped
  double time = 0;     ///< s
  LaneEnd end;
};

class EnergyBounds;
class LaneFlight;
class LoadWindow;
struct ModeRunBlocks;
struct StageState;
struct StageFriction;

/// The one time loop. Allocates in its constructor only.
class Marcher {
 public:
  /// Steps between two checks of lanes that nobody observes.
  static constexpr long long check_interval = 16;

  explicit Marcher(Program program);
  ~Marcher();
  Marcher(Marcher&&) noexcept;

  /// Applies the start rule; call once, before march().
  void start(const Observers& observers = {});
  /// Makes up to `steps` steps; returns early (with how many it made) only when no lane runs any more.
  long long march(long long steps, const Observers& observers = {});
  /// Steps that were marched, and not left out.
  long long steps_visited() const { return visited_; }

  /// The state of a lane between steps, and its return. `spec` takes the place of the lane's own: amplitude, phase,
  /// stops and law parameters; its initial position and velocity are not read. A lane that had stopped runs again.
  LaneState lane_state(int lane) const;
  void set_lane(int lane, const LaneSpec& spec, const LaneState& state);
  /// Sets the number of steps made, hence the time: a periodic problem may be marched period after period on one clock.
  /// From there on the integration depends on the lanes' states alone.
  void set_clock(long long step);

  /// Tangent columns per lane: X_k' = Df X_k along the lane, with its own contact set and without loads. The derivative
  /// of the discrete step while the contact set stays; what it lacks at impacts with inertia, impact_jump.hpp adds.
  int tangents() const { return program_.tangents; }
  /// Where column k of a lane stands in the block.
  int tangent_lane(int lane, int k) const { return lanes() * (1 + k) + lane; }
  LaneState tangent(int lane, int k) const { return state_at(tangent_lane(lane, k)); }
  void set_tangent(int lane, int k, const LaneState& state) { set_state_at(tangent_lane(lane, k), state); }

  /// Lets tangent columns fly free through the first `steps` steps of contact at these points. An impact with inertia
  /// is over by then. The caller puts its jump on.
  void delay_tangents(const std::vector<bool>& points, int steps);

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
  /// The same of the levels that `phase` holds, t the beginning of the step under way; no sine is asked for.
  double support(int lane, const PhaseWeights& phase) const {
    double sine = 0, cosine = 0;
    clamp_.drive(lane, sine, cosine);
    return phase.along * sine + phase.across * cosine;
  }
  /// The same of a step that was not shown.
  double support(int lane, const PhaseWeights& phase, const FreeStep& step) const {
    double sine = step.sine, cosine = step.cosine;
    clamp_.turn(lane, sine, cosine);
    return phase.along * sine + phase.across * cosine;
  }
  /// What supports lift a contact point by at t, and its rate: φ, and Σ (Hψ_j) φ_j of motions by histories.
  double lift(int lane, int point, double t) const { return support(lane, t) + motions().point(point, t); }
  double lift_rate(int lane, int point, double t) const {
    return support_rate(lane, t) + motions().point_rate(point, t);
  }
  /// Σ weight lift(t + at·h).
  double lift_levels(int lane, int point, double t, const Levels& levels) const;
  /// What a row that rubs is moved by against its surface at t, m/s; and Σ weight of the same as a way, V t counted
  /// from t, with weights that sum to 0.
  double rubbed_rate(int lane, int row, double t) const;
  double rubbed_levels(int lane, int row, double t, const Levels& levels) const;
  /// Whether a surface moves, or a support of what rubs: else both know the motion of the rows alone.
  bool surfaces_move() const;
  const SupportMotions& motions() const { return program_.problem->motions; }
  /// Which stops pushed a lane at the last instant of contact: lower, upper.
  std::array<bool, 2> pushed_by(int lane) const;
  /// Absolute displacement of the tip at the end of the last step.
  double tip(int lane) const;
  /// Largest distance by which a contact point lies beyond its stop at the end of the last step (0: none), m.
  /// `law_saw_end`: where the last stage's law reads the position there, points that its own problem leaves between
  /// their stops need not be measured.
  double penetration(int lane, bool law_saw_end = false) const;
  /// Energy that a compliant law stores at all contact points, J, for their absolute displacements (m).
  double stored(int lane, const double* places) const;
  /// Energy that the friction law stores at all its rows, J.
  double stored_by_friction(int lane) const;
  /// The circle of a lane whose first point this is.
  StopCircle circle(int lane, int point) const {
    const LaneSpec& spec = program_.lanes[static_cast<std::size_t>(lane)];
    return StopCircle::of(spec.lower, spec.upper, point);
  }
  /// `see`(point, p) of each push of a lane in a stage: of a circle its first point, and p = −N.
  template <class See>
  void each_push(const StageView& view, int lane, See&& see) const {
    const double* efforts = view.effort[0] + lane;
    const auto effort = [&](int j) { return efforts[static_cast<std::ptrdiff_t>(j) * width()]; };
    for (const int j : view.pushed) {
      const double p = effort(j);
      if (p == 0) continue;
      if (!circles_.holds(j))
        see(j, p);
      else if (circles_.first(j))
        see(j, -std::hypot(p, effort(j + 1)));
      else if (effort(j - 1) == 0)
        see(j - 1, -std::abs(p));
    }
  }
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
  /// Whether an energy is beyond it; samples a load that depends on time before it says so.
  bool beyond_bound(int lane, double energy);

 private:
  // marcher.cpp: the loop.
  std::unique_ptr<StageState> make_state(StageProgram& program, const Stage& plan) const;
  void connect_works();
  void connect_tests();
  void connect(const Observers& observers);
  bool run_stage(StageProgram& program, const Stage& plan, StageState& state, int index, bool unseen, bool may_wait);
  long long fly(long long most);
  // mode_run.cpp: steps in modes that nobody looks at.
  bool may_run() const;
  void prepare_run();
  long long run(long long most);
  void drive_run(int steps);
  bool push_in_run();
  void keep_free_step(const StageState& state);
  void tell_free_steps();
  void free_step(StageProgram& program, const Stage& plan, StageState& state);
  void combine_for(const StageProgram& program);
  static void find_pushed(const Block& effort, int rows, std::vector<int>& points);
  StageView view_of(bool starting, std::size_t index, const StageState& state) const;
  void show(StageState& state, const double* z);

  // readings.cpp
  template <class See>
  bool may_be_beyond(See&& see) const;

  const Block& law_lower() const { return circles_.any() ? law_lower_ : lower_; }
  const Block& law_upper() const { return circles_.any() ? law_upper_ : upper_; }

  // stage_contact.cpp: efforts of a stage, and its unknown corrected by them.
  void contact(StageProgram& program, StageState& state, double* z);
  void remember_efforts(const StageProgram& program, StageState& state, double* z);
  void correct(StageState& state, const double* effort, std::span<const int> pushing, double* z);
  void jump(StageState& state, double* z);
  void add_jump(StageState& state);
  void choose_touched(StageState& state, std::uint32_t mask);
  void solve_law(const StageProgram& program, StageState& state, std::span<const int> touched);
  void restore_work(const StageProgram& program, StageState& state);
  void measure_way(const StageProgram& program, StageState& state, const double* z);
  void find_efforts(const StageProgram& program, StageState& state, const double* z);
  void keep_contact(StageState& state);
  // What the law reads before any effort.
  std::uint32_t measure_contact(StageProgram& program, StageState& state, const double* z);
  void measure_rows(const RowMatrix& rows, int terms, const double* const* x, const double* weights,
                    const double* offset, double* out);
  void add_motions(const Levels& levels, bool rate, Block& out) const;
  double gate_slack(const StageProgram& program, StageState& state, int point, int lane);
  void open_gates(StageProgram& program, StageState& state, std::span<const double* const> terms);

  // stage_friction.cpp: efforts along surfaces that rub.
  void rub(const StageProgram& program, StageState& state, const double* z);
  void rub_lane(const StageProgram& program, StageState& state, int lane);
  void measure_end_rates(const StageProgram& program, StageState& state, const double* z);
  void find_pressed(const StageProgram& program, const StageState& state, int lane);
  void gather_friction(const StageProgram& program, StageState& state, int lane, bool first);
  LaneOutcome find_friction(const StageProgram& program, StageState& state, int lane, bool first);
  void moved_by_friction(StageState& state, const std::vector<double>& efforts);
  bool friction_moves_normals(StageState& state, double reach, int lane);
  static DelassusColumns& columns_of(StageState& state);
  const double* column_of(StageState& state, int row) const;

  // effort_history.cpp: efforts of stages and steps before.
  void connect_efforts();
  void keep_start_efforts();
  void begin_contact();

  // tangent_contact.cpp: the same derivative for tangent columns.
  void remove_load(StageProgram& program, const double* load);
  void tangent_contact(StageProgram& program, StageState& state, const double* z);
  void measure_tangents(StageState& state, const double* z);
  void add_round_slopes(DelassusColumns& columns, double base, StageState& state, int lane);
  void tangent_targets(const StageProgram& program, StageState& state, int lane, int tangent);

  // lane_state.cpp: lanes that come and go, or diverge.
  void check_lanes();
  void push_back();
  void clear_lane(int lane);
  void clear_efforts(int column);

  void place_lane(int lane);
  double stored_at_start(int lane) const;
  void place_stops(int lane);
  void prepare_law();
  LaneState state_at(int column) const;
  void set_state_at(int column, const LaneState& state);

  Program program_;
  const LaneKernels& kernels_;
  std::vector<Block> blocks_;
  std::vector<double*> slots_;
  std::vector<const double*> slot_pointers_;
  Block combination_;  // Σ β^K_j x_j of the stage to come
  const StageProgram* combined_for_ = nullptr;
  const double* waiting_ = nullptr;  // z of an update that the next free step makes
  std::vector<std::unique_ptr<StageState>> start_states_, stage_states_;
  ClampMotion clamp_;
  Block scale_, offset_, lower_, upper_;  // bounds between which no law need be asked
  CircleSolver circles_;
  Block law_lower_, law_upper_;                  // bounds that the law sees; none where they are the same
  Block memory_;                                 // of the law, points × T for each number that it keeps
  Block memory_before_, memory_apart_;           // the same before the step, and of a stage that does not keep it
  std::vector<int> touched_, pushed_, pushing_;  // lanes looked at; points with an effort, as shown and as corrected
  std::vector<unsigned char> pushes_;            // of each point, whether some lane has one
  std::unique_ptr<StageFriction> rubbing_;       // null: nothing rubs
  std::vector<LaneOutcome> outcome_;
  std::vector<LaneStatus> status_;
  std::uint32_t frozen_now_ = 0;  // lanes that froze since the last update of the slots
  std::unique_ptr<LoadWindow> load_window_;
  std::vector<double> scratch_;
  Block elastic_;
  std::vector<bool> delayed_points_;  // see delay_tangents()
  int delay_steps_ = 0;
  std::vector<double> stiffness_band_;  // empty where the operator is sparse
  int stiffness_width_ = 0;
  long long step_ = 0, visited_ = 0;
  std::unique_ptr<LaneFlight> lane_flight_;  // null: every step is marched
  Observers observers_;
  std::unique_ptr<ModeRunBlocks> run_;               // null: steps are made one by one
  bool runs_ = false;                                // whether this march makes them many at a time
  bool keeps_sums_ = false;                          // of steps that are not shown, for observers that can do without
  bool tells_tip_ = false;                           // of them too
  std::array<FreeStep, check_interval> free_steps_;  // of which nobody has been told
  std::size_t free_count_ = 0;
  std::unique_ptr<EnergyBounds> energy_bounds_;
};

}  // namespace ricochet
