#pragma once
#include <algorithm>
#include <ricochet/measure/contact/contact_instants.hpp>
#include <ricochet/measure/contact/start_contact.hpp>
#include <ricochet/measure/energy/stage_works.hpp>
#include <vector>

namespace ricochet {

/// Energies of one step, joules, in the frame of the clamp (w = u − φ), at the time where the plan's own velocity
/// stands. That is the end of the step, from this velocity and q_{n+1}. For plans whose velocity is a mean over the
/// step it is the middle of its last sub-step, from v = Δq/Δt and q̄ = q_{n+1} − Δq/2. Neither has a bias of order h²
/// of its own there. Positions of another time beside a velocity would show a gain that the scheme does not make.
struct EnergySample {
  double kinetic = 0;  ///< ½ vᵀM v
  double elastic = 0;  ///< ½ qᵀK q
  double contact = 0;  ///< potential of a compliant law at that q
  double load =
      0;  ///< potential of the steady load at that q, −F₀ᵀq less the zero level, where count_load() was called
  double scheme = 0;  ///< the scheme's own invariant; kinetic, elastic and contact where it declares none
  double common() const { return kinetic + elastic + contact + load; }
};

/// What the audit of a lane adds up.
struct EnergyTotals {
  EnergySample first;  ///< of the initial state itself, at t = 0, whatever the scheme makes of it
  EnergySample last;
  double scheme_start = 0;       ///< scheme energy from which the balance starts
  bool own_energy = false;       ///< the scheme declares one; else `scheme` has the potential at the stops in it
  bool driven = false;           ///< something but a steady load brings energy in: a load in t, a support, a stop
  double largest_step_gain = 0;  ///< max over steps of ΔE_scheme − W_loads (J), never below 0
  double work_of_damping = 0;    ///< Σ sᵀC r ≥ 0 where the scheme pairs them (J)
  double work_of_loads = 0;      ///< Σ sᵀF̄, and the support's work through the stops (J)
  double work_of_friction = 0;   ///< Σ p̄_tᵀ(T s + Δφ_t − ∫V dt) (J)
  double work_of_contact = 0;    ///< Σ p̄ᵀ(H s + Δφ): what the stops, at rest in the laboratory, give (J)
  double work_of_scheme = 0;     ///< Σ of the plan's loss terms: what the scheme itself dissipates (J ≥ 0)
  double work_of_law = 0;        ///< what the contact law itself dissipates, by the power that it reports (J ≥ 0)
  void add(const Works& works);
  /// E_end − E_start − loads + damping + scheme − contact: round-off × steps where the scheme has an exact balance,
  /// else what is left.
  double balance_residual() const {
    const double stored = own_energy ? 0.0 : last.contact - first.contact;
    return last.scheme - stored - scheme_start - work_of_loads + work_of_damping + work_of_scheme - work_of_contact -
           work_of_friction;
  }
  /// The work of all that depends on time until the last sample, J: of the loads' that which no potential tells.
  double work_of_driving() const { return driven ? work_of_loads - (first.load - last.load) : 0.0; }
  double most_driven = 0;  ///< the largest of these, at the samples that mark_brought_in() looked at (J ≥ 0)
  /// What the motion had to lose (J): the energy of its start, and the most that driving had brought in.
  double brought_in() const { return first.common() + std::max(most_driven, work_of_driving()); }
};

/// Contact seen over a run, per lane. It is looked at once per instant: each sub-step, with the stages that ask
/// together as one. The sides of a clearance are one point.
struct ContactTotals {
  /// Times that a point closed, summed over the points; contact that is there from the start (StartContact) is none.
  long long impacts = 0;
  long long spells = 0;              ///< times that contact began anywhere: from no closed point to some
  long long active_set_changes = 0;  ///< steps whose set of active points (with side) differs from the step before
  long long contact_steps = 0;
  int most_iterations = 0;                       ///< of one solve of the law
  double impulse = 0;                            ///< Σ ω Σ_i |p_i| (N s), ω the momentum weight of the stage
  double deepest_penetration = 0;                ///< m
  double residual = 0;                           ///< largest complementarity residual of the law
  double first_impact = -1, first_release = -1;  ///< of an impact, of the end of contact anywhere, s; −1: never
  double force = 0;                              ///< Σ_i p_i of the last step, N
  int active = 0;                                ///< points active in the last step
};

/// When an audit reads the energies off the state, which costs more than a step.
enum class SamplingMode {
  every_step,
  /// At every check_interval-th step and where somebody asks (sample_after). The works of every step are added up
  /// between. A scheme has a balance where it has an energy of its own and every stage a work form. The gain of a step
  /// is then contact − damping − scheme, and a sample confirms the sum. A sample may find more than a share `confirmed`
  /// of the energy that the works do not explain. The gain then counts it, and that lane is sampled at every step from
  /// there on. A scheme without a balance is sampled at every step too.
  seldom,
};

/// The energy audit. It adds up the works of every step and samples energies at every step or seldom. Where it samples
/// seldom, steps that touch no stop need not be shown to it. The squares that a free step adds up tell their works.
/// Flights may leave out any number of steps where the scheme has an energy of its own that no free step can gain. What
/// energy() and totals() tell is of the last sample. A lane whose common energy passes the marcher's bound is stopped
/// where that is seen.
class EnergyAudit final : public StepObserver {
 public:
  static constexpr double confirmed = 1e-10;
  /// Share of the energy that is there or was brought in. Works of one step beyond it have the next shown step sampled.
  /// A lane that blows up is seen at once where stops work in it.
  static constexpr double alarming = 0.1;

  explicit EnergyAudit(const Marcher& marcher, SamplingMode sampling = SamplingMode::every_step);

  /// The energies after this step (counted as Marcher::step) are asked for.
  void sample_after(long long step) {
    asked_ = step;
    if (!flies_) asks_.next_shown = std::min(asks_.next_shown, step);
  }
  void sample_every_step() {
    sampling_ = SamplingMode::every_step;
    if (!flies_) asks_.next_shown = 0;
  }

  /// From now on the common energy has the potential of a steady load F₀ (n, of the problem's coordinates), `level` (J)
  /// being its zero. Before the march; of every lane.
  void count_load(const Marcher& marcher, const Eigen::VectorXd& load, double level);
  /// Takes the last sample into what was brought in at most.
  void mark_brought_in(int lane) {
    EnergyTotals& totals = lanes_[static_cast<std::size_t>(lane)].energy;
    totals.most_driven = std::max(totals.most_driven, totals.work_of_driving());
  }

  void stage_solved(const Marcher& marcher, const StageView& view) override;
  void step_done(Marcher& marcher) override;
  void interval(Marcher& marcher, const StepInterval& steps) override;

  const EnergySample& energy(int lane) const { return lanes_[static_cast<std::size_t>(lane)].now; }
  const EnergyTotals& totals(int lane) const { return lanes_[static_cast<std::size_t>(lane)].energy; }
  const ContactTotals& contact(int lane) const { return lanes_[static_cast<std::size_t>(lane)].contact; }
  /// What the stops took and do not store until now, J; what they store is that of the last sample.
  double lost_at_stops(int lane) const;
  /// Largest distance by which a contact point lies beyond its stop, m, after the last step.
  double penetration(int lane) const { return lanes_[static_cast<std::size_t>(lane)].penetration; }
  /// Whether the plan declares a work form: without, the works and the balance are not known.
  bool balances() const { return balances_; }
  /// Δu_tip/Δt of the last sub-step, absolute, m/s, of the last step whose energies were asked for.
  double tip_velocity(int lane) const;
  /// What one of these rows moved by over that sub-step, relative to the supports, m; and how long it is, s.
  double last_way(const Marcher& marcher, const RowMatrix& rows, int row, int lane) const;
  /// Of the stage that was shown last (StageWorks), J and m by row that rubs.
  const StageWorks& works() const { return works_; }
  double last_duration(int lane) const { return lanes_[static_cast<std::size_t>(lane)].duration; }

 private:
  struct Lane {
    EnergyTotals energy;
    EnergySample now;
    ContactTotals contact;
    Lane(int points, StartContact of_start) : closed(points), start(std::move(of_start)) {}
    // Of the position over the stages of the last sub-step, where that is looked at; empty where a slot holds it.
    Block increment;
    double duration = 0;  // of that sub-step, s
    ClosedPoints closed;
    StartContact start;
    double force = 0;  // of the present instant
    Works step;        // of the step under way
    Works since;       // of the steps since the last sample
    double gain = 0;   // largest of one of them, by their works
    int steps = 0;     // how many
    int idle = 0;      // stages since the last effort
    double penetration = 0;
    double tip_way = 0;  // of the tip over the last sub-step, absolute; where that was asked for
    bool has_scheme = false;
    bool balanced = false;     // whether works are believed between samples
    bool asked = true;         // for the energies after the step under way
    bool sampled = true;       // after it, asked or not
    bool sample_next = false;  // in any mode: steps were left out, or much was worked in one
    bool touched = false;      // whether the law looked at contact where the step ends
    bool still = false;        // no effort acts, none did at the instant before, and that has been counted
  };
  EnergySample initial_energy(const Marcher& marcher, int lane);
  double potential(const Marcher& marcher, const double* place, double now, double before, int lane);
  EnergySample sample(const Marcher& marcher, int lane);
  bool asks(const Lane& state, long long step) const;
  void begin_step(const Marcher& marcher, const StageView& view, Lane& state);
  void start_balance(const StageView& view, int lane);
  void follow_position(const StageView& view, int lane, bool moves);
  static bool alarms(const Lane& state, double worked);
  void take_sample(Marcher& marcher, int lane);
  void add_marched(const Marcher& marcher, std::span<const FreeStep> steps);
  void add_flown(const Marcher& marcher, const StepInterval& steps);
  long long next_shown(const Marcher& marcher) const;
  void confirm(Lane& state, double scheme, bool flown);
  void count_contact(const Marcher& marcher, const StageView& view, int lane);
  bool held_at_start(StartContact& start, int point, int side) const;
  void close_instant(const StageView& view, Lane& state);

  const MarchModel& model_;
  QuadraticForm mass_, stiffness_;
  StateEnergies energies_;
  StageWorks works_;
  SamplingMode sampling_;
  long long asked_ = -1;
  double h_;
  int T_;
  std::vector<double> places_;  // of contact points
  bool compliant_, mean_velocity_, flies_, balances_ = false, ends_measured_ = false;
  int memory_ = 1;  // stages back to which an effort may still act
  std::vector<Lane> lanes_;
  std::vector<WeighedTerms> start_ways_, ways_;  // of the position, by stage; none where a slot holds it
  Block scratch_;
  Eigen::VectorXd load_;  // F₀ in the model's coordinates; empty where it is not counted
  double load_level_ = 0;
};

}  // namespace ricochet
