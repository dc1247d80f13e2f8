#pragma once
#include <functional>
#include <memory>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/contract/friction_law.hpp>
#include <ricochet/contract/stage_facts.hpp>
#include <ricochet/contract/step_plan.hpp>
#include <ricochet/engine/march_model.hpp>
#include <ricochet/engine/stage_delassus.hpp>
#include <ricochet/engine/stage_operator.hpp>
#include <string>
#include <variant>
#include <vector>

namespace ricochet {

class Flight;

/// One trajectory of a block: what may differ between lanes that share a factorisation.
struct LaneSpec {
  double amplitude = 0, phase = 0;     ///< of the support motion, m and rad
  Eigen::VectorXd position, velocity;  ///< q₀, v₀ of w, nodal
  Eigen::VectorXd lower, upper;        ///< g1, g2 at the contact points, absolute
  Parameters law;                      ///< checked parameters of the contact law
  std::vector<Rubbing> rubbing = {};   ///< μ and N of each rubbing point
};

/// The lane that the scene itself describes.
LaneSpec scene_lane(const SemiDiscrete& problem, const Parameters& law);

/// How an integration goes from step to step.
enum class MarchWay {
  automatic,  ///< by flights where they are expected to cost less, else every step
  every_step,
  flights,  ///< refused where the motion cannot fly
};

/// Something that a run does without, and why.
struct LeftOut {
  std::string item, reason;
};

/// J = μ|W_nt|/(W_nn + 1/(ηκ)) of a point that rubs, in a stage that gives momentum at contact; κ of a compliant law
/// that is linear, without it W_nn alone. J < 1: one effort; else a step may have several (Painlevé's paradox).
struct JamNumber {
  double coupling = 0;  ///< J/μ
  double number = 0;    ///< J; 0 below 1e-9, which is round-off
  double across = 0;    ///< W_tt/W_nn along that coupling, of a rigid law
  double mu = 0;        ///< the largest of all lanes
};

struct CompileOptions {
  OperatorKind kind = OperatorKind::automatic;
  long long expected_steps = 100000;  ///< over which set-up is paid back
  bool eager_delassus = false;        ///< all columns at once (tests)
  int tangents = 0;                   ///< tangent columns per lane
  bool moving_support = false;        ///< lanes may get an amplitude later, even if none has one now
  MarchWay march = MarchWay::every_step;
  bool bounded = true;   ///< a lane beyond its energy bound is stopped
  bool audited = false;  ///< the energies of each step count (EnergyAudit): steps may not be left out unseen
  std::optional<double> memory = {};  ///< bytes that may be taken for leaving out steps; none: what there is
  /// The friction law, where points rub; null: such a problem is refused.
  std::function<std::unique_ptr<FrictionLaw>()> make_friction = {};
};

/// What the facts of a scheme need to know about a problem.
ProblemFacts problem_facts(const SemiDiscrete& problem, const ContactLaw& law);

/// Σ_k w_k sin(ω(t + c_k h)) = along·sin ωt + across·cos ωt: what a weighted set of time levels does to a harmonic
/// motion.
struct PhaseWeights {
  double along = 0, across = 0;
  PhaseWeights() = default;
  PhaseWeights(const Levels& levels, double pulsation, double h);
};

/// What will run: one stage of the plan with everything that is constant worked out.
struct StageProgram {
  FoldedStage folded;
  std::unique_ptr<StageOperator> op;  ///< null: the stage solves nothing
  Combination measure;                ///< what the law reads
  Levels measure_levels;
  bool reads_contact = false;
  bool driven = true;    ///< whether b has any term; else z° = 0
  int restores = 0;      ///< k > 0: its efforts give back the work of contact in the stage k before
  Combination motion;    ///< of a stage whose work is given back: its test displacement; else empty
  Levels motion_levels;  ///< of the supports, in it
  double measure_z = 0;  ///< η
  /// What an effort moves the measure and the rate by, over what the columns given to the law say. Where these are
  /// W = H S⁻¹Hᵀ, they are η π₀ and η_u π₀.
  double reach = 0, rate_reach = 0;
  ImpulseProgram impulse;
  std::vector<double> effort = {1.0};  ///< π
  /// p̄ of the work form over p, p₋₁, …: its weights and those of the equations. Of a start rule without work form, the
  /// momentum that p gives within it.
  std::vector<double> work_effort;
  /// Of friction where points rub: what one of its efforts weighs in the equation, what an effort moves the end rate by
  /// over what the columns say, p̄ of the work form, and the momentum of 1 N, s.
  double friction_weight = 0, friction_reach = 0, friction_momentum = 0;
  std::vector<double> friction_work;
  std::optional<VelocityGate> gate;
  std::optional<ComplianceMeasure> compliance;  ///< the one the law reads, with its rate
  PhaseWeights load_phase, measure_phase, rate_phase, before_phase, predictor_phase, approach_phase, motion_phase;
  StageFacts facts;
  double momentum = 0;  ///< s: what an effort of 1 N of this stage finally gives to a free mass
  /// Contact stages that ask at the same instant (a velocity, then a projection) are one contact instant. So are all of
  /// a step in which a later stage asks at an earlier time. Whether this stage is its first, and its last.
  bool opens_instant = false, closes_instant = false;
  double lasts = 0;        ///< s: Ω of its instant
  double force_share = 1;  ///< of the force of its instant: 0 where it gives no momentum, and only puts places right
  /// Whether the law's memory goes on with this stage. Else it reads that of before the step, as a stage of the same
  /// step asks at a later time.
  bool keeps_memory = true;
};

/// A compiled scene × methods, ready to march a block of lanes.
struct Program {
  std::shared_ptr<const SemiDiscrete> problem;
  std::shared_ptr<const MarchModel> model;
  StepPlan plan;  ///< complete: what it left to be derived is filled in
  double h = 0;
  double velocity_offset = 0;  ///< where plan.velocity stands after a step, in steps
  int increment_slot = -1;     ///< the slot that holds what the position moved by in the last stage; −1: none
  std::unique_ptr<ContactLaw> law;
  std::unique_ptr<FrictionLaw> friction;  ///< null: nothing rubs
  std::vector<JamNumber> jam;             ///< of each rubbing point
  double held_root = 0;                   ///< FrictionFacts::held_root, where something rubs
  std::vector<LaneSpec> lanes;
  int width = 1;     ///< T
  int tangents = 0;  ///< tangent columns per lane, behind the lanes
  OperatorKind kind = OperatorKind::band;
  std::vector<StageProgram> start, stages;
  bool own_sets = false;  ///< whether the law has a set for each point and lane (stop_parameters.hpp)
  bool contact = false, support = false, load = false, load_constant = false, eager_delassus = false;
  double load_pulsation = 0;  ///< Ω of a load c + a sin Ωt + b cos Ωt, rad/s; 0: it is no such load, or unasked
  bool bounded = true;        ///< whether a lane beyond its energy bound is stopped
  double predicted_step_seconds = 0;  ///< per step of the whole block
  double predicted_setup_seconds = 0;
  std::vector<LeftOut> left_out;
  std::shared_ptr<Flight> flight;  ///< null: every step is marched
  /// Number of the law's parameter set of a point in a lane.
  int law_set(int point, int lane) const { return own_sets ? point * width + lane : lane; }
  /// Farthest before a stop that the law acts, m; of a law that is prepared for one lane.
  double farthest_layer() const;
  std::string every_step_because;  ///< why no step can be left out; empty where one could be, or nobody asked
};

using ProgramOrRefusal = std::variant<Program, Refusal>;

/// Decides, once and from facts, what runs and what is left out. Refuses combinations that do not apply: a law that
/// reads a measure that the scheme does not offer, a singular S.
ProgramOrRefusal compile(std::shared_ptr<const SemiDiscrete> problem, StepPlan plan, double h,
                         std::unique_ptr<ContactLaw> law, std::vector<LaneSpec> lanes,
                         const CompileOptions& options = {});

}  // namespace ricochet
