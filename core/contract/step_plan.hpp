#pragma once
#include <array>
#include <optional>
#include <ricochet/contract/errors.hpp>
#include <string>
#include <variant>
#include <vector>

/// \file
/// A time scheme as data. The semi-discrete problem is
///
///     M q'' + C q' + K q = F(t) + Hᵀ p,        lower(t) ≤ H q ≤ upper(t)                                    (1)
///
/// q: n dofs; H: m × n, one row per contact point; p: m contact efforts (N, positive where the lower stop pushes).
/// A scheme keeps at most `most_slots` named state slots x_0 … x_{s−1}. They are n-vectors, and x_0 is always the
/// position q. Each step has one or more stages (at most `most_stages`) of the form
///
///     S z = b + Hᵀ(π₀ p + π₁ p₋₁ + π₂ p₋₂ + …),   S = s_M M + s_C C + s_K K                                  (2)
///     b   = Σ_j (β^M_j M + β^C_j C + β^K_j K) x_j + Σ_k φ_k F(t + c_k h)                                      (3)
///     y   = H(Σ_j y_j x_j + y_z z)          the impact measure, restitution folded in: rigid laws             (4)
///     g   = H(Σ_j g_j x_j + g_z z)          the displacement where the scheme evaluates compliance            (5)
///     x_j ← Σ_i u_ji x_i + u_jz z                                                                              (6)
///
/// A stage may have an `impulse`: a second unknown w, which the effort that is found alone moves, apart from b. With
/// R = r_M M + r_C C + r_K K, and f_M, f_C, f_K what of it the equation of z is fed with,
///
///     R w = ι Hᵀp,     S z = b + (f_M M + f_C C + f_K K) w + Hᵀ(π₀ p + π₁ p₋₁ + …)                              (7)
///
/// and the measures y, g, the rate u and the updates may weigh w beside z. So a contact may jump velocities by w and
/// positions by h/2 w while z, an acceleration, stays that of a smooth motion.
///
/// Stages follow each other without end: after the last stage of a step comes the first of the next. Effort p₋ₖ is what
/// the k-th stage before this one found, zero where that stage reads no contact. In a plan of one stage it is the
/// effort of k steps ago. In a plan of s stages p₋₁ is that of the previous sub-step, p₋ₛ that of this stage one step
/// ago. The stages of the start rule stand where the last ones of the steps before the first would stand.
///
/// Everything else follows from these numbers: the engine's loop, the time at which each stage stands, the momentum
/// that its effort gives. So do the spectral radius on each mode and the energy balance. Coefficients that depend on
/// the state are out of a plan's reach; a step that varies is too.
namespace ricochet {

/// Limits of a plan; check_plan() refuses what is beyond them, the loop never sees it.
inline constexpr int most_slots = 8;     ///< state vectors
inline constexpr int most_stages = 6;    ///< of a step, and of the start rule
inline constexpr int most_efforts = 13;  ///< weights π₀, π₁, …: two steps of the longest plan and now
inline constexpr int most_levels = 8;    ///< time levels of a load or of a stop in one stage

/// Σ_j slots[j] x_j + z z + w w, over the slots *before* the stage and its unknowns. Missing trailing slots are zero.
/// Only a stage with an impulse may weigh w, in what follows the effort. A gate and what was before a step may not.
struct Combination {
  std::vector<double> slots;
  double z = 0;
  double w = 0;
};

/// A weighted time level: weight · f(t + at·h), t the time when the step begins.
struct Level {
  double at = 0;
  double weight = 0;
};
using Levels = std::vector<Level>;

/// s_M M + s_C C + s_K K.
struct OperatorWeights {
  double M = 0, C = 0, K = 0;
};

/// The second unknown of a stage, (7): R w = ι Hᵀp. Effort p is that of this stage, ι the weight `impulse` of the
/// measure that found it. R acts on what moves with contact: no massless point may be in touch where R holds M alone.
/// With C = αK + ηM every operator here is a combination of M and K: what a law sees of z and w together is symmetric.
struct Impulse {
  OperatorWeights R;
  OperatorWeights feed;  ///< (f_M, f_C, f_K)
};

/// Velocity-level closure: which sides take part in the box problem, and how fast they rebound. Here z is that of the
/// stage without its own effort.
/// Gap test: the predicted position H·predictor has reached the bound Σ weight·bound(t + at·h); other sides are open.
/// Approach: w⁻ = H·approach − (bound rate at the approach levels). Where w⁻ goes into the side the bound on y is
/// −e·w⁻. Where it leaves the bound is −w⁻: a point that goes is not held, and not thrown back faster than it went.
/// Both are relative to the bound's rate at the measure's levels.
/// A leaving w⁻ up to 1e-10 of the largest speed that the lane has shown at its stops has the bound 0. So a point at
/// rest on a stop stays there whatever its round-off.
/// Every effort then meets w⁻ + w⁺ = (1−e)w⁻ against it, or 0. So contact never gives energy for 0 ≤ e ≤ 1, and a load
/// presses a leaving point through its stop for one step at most.
struct VelocityGate {
  Combination predictor;
  Levels predictor_bound;
  Combination approach;
  Levels approach_bound;
  double restitution = 0;
};

/// The measure y of rigid laws. Position level (no gate): Σ w lower(t+ch) ≤ y ≤ Σ w upper(t+ch), with the same levels
/// as y itself. Velocity level (gate): y is a velocity and `bound` weights the rates of the bounds.
///
/// Work-restoring (restores = k > 0): the stage gives back what contact took in the stage k before it, of the same step
/// (Laursen and Love 2002). That stage has the efforts λ and, in its work form, the test displacement s. Its points go
/// the way δ = H s + Δφ against their stops. With y the same of this stage,
///
///     p_i y_i = −λ_i δ_i ≥ 0,   p_i and y_i on the side of λ_i;   p_i = 0 where λ_i = 0                       (4')
///
/// so that the stops do no work over both stages, point by point. Measure y is a way, in metres: `value` is the stage's
/// own test displacement, `bound` its work.support. The engine solves (4') in the place of any rigid law
/// (restoring_solver.hpp). There is one solution wherever no λ_i δ_i is positive, as where the stage before began
/// between the stops. Else the trajectory is stopped and reported.
///
/// Levels of stops, here and below, may be left empty: they are then those at which the combination itself stands
/// (stage_facts.hpp). Given levels must agree with it on a motion at constant speed, to which check_plan() holds them.
struct ImpactMeasure {
  Combination value;
  Levels bound = {};
  std::optional<VelocityGate> gate = {};
  std::vector<double> effort = {1.0};  ///< π₀, π₁, …
  int restores = 0;                    ///< k: how many stages before; 0: no work is given back
  double impulse = 1;                  ///< ι; nothing where the stage has no impulse
};

/// Where the scheme evaluates a compliant law, and how the resulting effort enters its equation.
struct ComplianceMeasure {
  Combination displacement;            ///< g, metres
  Levels bound = {};                   ///< the stop's position in the same combination
  Combination rate = {};               ///< u, m/s, for laws with damping
  Levels rate_bound = {};              ///< of the stop's rate
  std::vector<double> effort = {1.0};  ///< π₀, π₁, …
  /// Displacement g⁻, the same one step before, over the slots before the stage. For laws that take a mean of g and g⁻,
  /// or conserve energy through the difference g − g⁻. With a work form that difference is H·work.displacement.
  std::optional<Combination> before = {};
  Levels before_bound = {};  ///< the stop's position in it
  double impulse = 1;        ///< ι; 0: a compliant effort is one of the forces of the equation, and w = 0
};

/// The ways to evaluate a compliant law within a step.
enum class Evaluation { implicit_end, averaged, explicit_start, conserving };
inline constexpr int evaluations = 4;
/// "implicit", "averaged", "explicit", "conserving".
const char* evaluation_word(Evaluation evaluation);

/// A test displacement s and the levels that go with it. The stage's equation times s is the balance of the scheme's
/// own energy. Where the scheme has an invariant, that energy changes by s·F̄ − s·C r + s·Hᵀp̄ exactly (no remainder
/// but round-off).
struct WorkForm {
  Combination displacement;  ///< s
  Combination rate;          ///< r, the velocity that damping sees; empty where the equation has no C
  Levels load;               ///< F̄
  /// p̄ = Σ effort_k e₋ₖ, e = π₀p + π₁p₋₁ + … the effort as the equation of its stage has it.
  std::vector<double> effort = {1.0};
  Levels support = {};  ///< the combination of φ that s is of q: what the stops move by in the frame of the clamp
  double impulse = 0;   ///< weight of ι p in p̄, besides: what w brings
};

enum class EnergyMatrix { M, K };

/// coefficient · |Σ_j w_j x_j + w_z z|²_A ≥ 0 (J), A = M or K, over the slots before the stage. It is what the scheme
/// itself dissipates in the stage: numerical damping, apart from C and from the stops.
struct LossTerm {
  EnergyMatrix matrix = EnergyMatrix::M;
  double coefficient = 0;
  Combination value;
};

struct Stage {
  OperatorWeights matrix;                                                ///< S; all zero: no solve, z = 0
  std::vector<OperatorWeights> history;                                  ///< (β^M_j, β^C_j, β^K_j) per slot
  Levels load;                                                           ///< (c_k, φ_k)
  std::optional<Impulse> impulse;                                        ///< absent: no w
  std::optional<ImpactMeasure> impact;                                   ///< absent: this stage lets rigid laws be
  std::array<std::optional<ComplianceMeasure>, evaluations> compliance;  ///< indexed by Evaluation
  std::vector<Combination> update;                                       ///< one per slot
  std::optional<WorkForm> work;  ///< none: the balance of the scheme is not known
  std::vector<LossTerm> loss;    ///< none: the scheme dissipates nothing itself
  const std::optional<ComplianceMeasure>& at(Evaluation e) const { return compliance[static_cast<int>(e)]; }
  std::optional<ComplianceMeasure>& at(Evaluation e) { return compliance[static_cast<int>(e)]; }
};

/// coefficient · |Σ_j w_j x_j|²_A over the slots after the step, A = M or K.
struct QuadraticTerm {
  using Matrix = EnergyMatrix;
  EnergyMatrix matrix = EnergyMatrix::M;
  double coefficient = 0.5;
  std::vector<double> slots;
};

enum class Restitution { exact, asymptotic, ignored };

/// What a scheme declares of itself; `ricochet check` measures each and names what is wrong.
struct SchemeFacts {
  double order = 1;  ///< in h, without contact, with the start rule chosen
  /// In h, at rigid stops: of displacements, impact times and impulses once an impact has happened; none: not known.
  std::optional<double> contact_order = {};
  Restitution restitution = Restitution::ignored;
  bool needs_regular_mass = false;
  /// Largest stable h·ω on the undamped oscillator, none when unconditionally stable.
  std::optional<double> stability_limit = {};
  /// Whether the scheme's own energy can never grow at a contact that rests on a fixed stop.
  bool contact_never_gains = false;
};

struct StepPlan {
  std::vector<std::string> slots;  ///< names; slots[0] is "q"
  /// Slots before the start rule: x_j = a_j q₀ + b_j v₀ (per slot: {a, b}).
  std::vector<std::array<double, 2>> initial;
  /// Applied once; empty: nothing to do. The balance of energy begins before its first stage that has a work form.
  std::vector<Stage> start;
  bool start_advances = false;  ///< whether the start rule moves time by h
  std::vector<Stage> stages;
  std::vector<QuadraticTerm> energy;  ///< scheme_energy; empty when none is declared
  /// The scheme's velocity over the slots after a step, and before each stage where they have the same meaning.
  /// Sections, the dating of impacts and momenta read it. Where in time it stands is found from the plan.
  Combination velocity;
  SchemeFacts facts;
};

using PlanOrRefusal = std::variant<StepPlan, Refusal>;

/// Ill-formed plans are plugin bugs. Returns what is wrong with the plan, or nothing: sizes, limits, numbers that are
/// none, a free mass that is not carried at constant speed. Wrong as well: levels of stops that stand elsewhere than
/// what they bound, a velocity or a test displacement that is none.
std::optional<std::string> check_plan(const StepPlan& plan);
/// The same, and whether it is a plan for the step h (s): whether it carries a free mass at 1 m/s by h.
std::optional<std::string> check_plan(const StepPlan& plan, double h);

/// The plan as a person reads it: slots, S, b, measures, updates, with numbers.
std::string print_plan(const StepPlan& plan);

/// What a scheme may know of the problem when it writes its plan.
struct ProblemFacts {
  int dofs = 0;
  int mass_kernel_dimension = 0;  ///< dim Ker M; 0 when the mass is regular
  bool damped = false;            ///< C ≠ 0
  bool contact = false;           ///< a law other than `none` and at least one stop
};

/// A time scheme: numbers, never a loop.
class TimeScheme {
 public:
  virtual ~TimeScheme() = default;
  /// The step as data for the step length h (s), or a sentence that says why it does not apply.
  virtual PlanOrRefusal plan(double h, const ProblemFacts& facts) const = 0;
};

}  // namespace ricochet
