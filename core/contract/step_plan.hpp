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
/// A scheme keeps named state slots x_0 … x_{s−1} (n-vectors; x_0 is always the position q) and makes each step of one
/// or more stages of the form
///
///     S z = b + Hᵀ(π₀ p + π₁ p₋₁ + π₂ p₋₂),   S = s_M M + s_C C + s_K K                                      (2)
///     b   = Σ_j (β^M_j M + β^C_j C + β^K_j K) x_j + Σ_k φ_k F(t + c_k h)                                      (3)
///     y   = H(Σ_j y_j x_j + y_z z)          the impact measure, restitution folded in: rigid laws             (4)
///     g   = H(Σ_j g_j x_j + g_z z)          the displacement where the scheme evaluates compliance            (5)
///     x_j ← Σ_i u_ji x_i + u_jz z                                                                              (6)
///
/// with p₋₁, p₋₂ the efforts of the previous steps. Everything else follows from these numbers: the engine's loop, the
/// spectral radius on each mode, the energy balance.
namespace ricochet {

/// Σ_j slots[j] x_j + z z, over the slots *before* the stage and the stage's unknown. Missing trailing slots are zero.
struct Combination {
  std::vector<double> slots;
  double z = 0;
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

/// Velocity-level closure: which sides take part in the box problem, and how fast they rebound.
/// Gap test: the predicted position H·predictor has reached the bound Σ weight·bound(t + at·h); other sides are open.
/// Approach, w⁻ = H·approach − (bound rate at the approach levels): where w⁻ does not leave the side (up to 1e-10 of
/// the largest speed the lane has shown at its stops, so that a point at rest on a stop stays there whatever its
/// round-off) the bound on y is −e·w⁻; where it leaves, −w⁻: a point that goes is not held, and not thrown back faster
/// than it went. Both relative to the bound's rate at the measure's levels. Then every effort meets w⁻ + w⁺ = (1−e)w⁻
/// against it, or 0: contact never gives energy, for 0 ≤ e ≤ 1, and a load cannot press a leaving point through its
/// stop for more than a step.
struct VelocityGate {
  Combination predictor;
  Levels predictor_bound;
  Combination approach;
  Levels approach_bound;
  double restitution = 0;
};

/// The measure y of rigid laws. Position level (no gate): Σ w lower(t+ch) ≤ y ≤ Σ w upper(t+ch), with the same levels
/// as y itself. Velocity level (gate): y is a velocity and `bound` weights the rates of the bounds.
struct ImpactMeasure {
  Combination value;
  Levels bound;
  std::optional<VelocityGate> gate;
};

/// Where the scheme evaluates a compliant law, and how the resulting effort enters its equation.
struct ComplianceMeasure {
  Combination displacement;  ///< g, metres
  Levels bound;              ///< the stop's position in the same combination
  Combination rate;          ///< u, m/s, for laws with damping
  Levels rate_bound;
  std::vector<double> effort = {1.0};  ///< π₀, π₁, π₂
};

/// The three ways to evaluate a compliant law within a step.
enum class Evaluation { implicit_end, averaged, explicit_start };

/// A test displacement s and the levels that go with it: when the stage's equation is multiplied by s, the change of
/// the scheme's own energy equals s·F̄ − s·C r + s·Hᵀp̄ exactly (no remainder but round-off) where the scheme has an
/// invariant.
struct WorkForm {
  Combination displacement;            ///< s
  Combination rate;                    ///< r, the velocity that damping sees
  Levels load;                         ///< F̄
  std::vector<double> effort = {1.0};  ///< p̄ = Σ effort_k p_{−k}
  Levels support;  ///< the combination of φ that s is of q: what the stops move by in the frame of the clamp
};

struct Stage {
  OperatorWeights matrix;                                      ///< S; all zero: no solve, z = 0
  std::vector<OperatorWeights> history;                        ///< (β^M_j, β^C_j, β^K_j) per slot
  Levels load;                                                 ///< (c_k, φ_k)
  std::optional<ImpactMeasure> impact;                         ///< absent: this stage lets rigid laws be
  std::array<std::optional<ComplianceMeasure>, 3> compliance;  ///< indexed by Evaluation
  std::vector<Combination> update;                             ///< one per slot
  Combination increment;  ///< position after − position before, without cancellation
  std::optional<WorkForm> work;
  const std::optional<ComplianceMeasure>& at(Evaluation e) const { return compliance[static_cast<int>(e)]; }
  std::optional<ComplianceMeasure>& at(Evaluation e) { return compliance[static_cast<int>(e)]; }
};

/// coefficient · |Σ_j w_j x_j|²_A over the slots after the step, A = M or K.
struct QuadraticTerm {
  enum class Matrix { M, K };
  Matrix matrix = Matrix::M;
  double coefficient = 0.5;
  std::vector<double> slots;
};

enum class Restitution { exact, asymptotic, ignored };

/// What a scheme declares of itself; the conformance suite measures each and fails the plugin that is wrong.
struct SchemeFacts {
  double order = 1;  ///< in h, without contact, with the start rule chosen
  /// In h, at rigid stops: of displacements, impact times and impulses once an impact has happened.
  double contact_order = 1;
  Restitution restitution = Restitution::ignored;
  bool needs_regular_mass = false;
  /// Largest stable h·ω on the undamped oscillator, none when unconditionally stable.
  std::optional<double> stability_limit;
  /// Whether the scheme's own energy can never grow at a contact that rests on a fixed stop.
  bool contact_never_gains = false;
};

struct StepPlan {
  std::vector<std::string> slots;  ///< names; slots[0] is "q"
  /// Slots before the start rule: x_j = a_j q₀ + b_j v₀ (per slot: {a, b}).
  std::vector<std::array<double, 2>> initial;
  std::vector<Stage> start;           ///< applied once; empty: nothing to do
  bool start_advances = false;        ///< whether the start rule moves time by h
  std::vector<Stage> stages;          ///< one to three
  std::vector<QuadraticTerm> energy;  ///< scheme_energy; empty when none is declared
  Combination velocity;               ///< tip velocity shown to people, over the slots after the step
  SchemeFacts facts;
};

using PlanOrRefusal = std::variant<StepPlan, Refusal>;

/// Ill-formed plans are plugin bugs; returns what is wrong with the plan, or nothing.
std::optional<std::string> check_plan(const StepPlan& plan);

/// The plan as a person reads it: slots, S, b, measures, updates, with numbers.
std::string print_plan(const StepPlan& plan);

}  // namespace ricochet
