#pragma once
#include <Eigen/Core>
#include <complex>
#include <optional>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/contract/step_plan.hpp>
#include <variant>
#include <vector>

/// \file
/// One step of a plan as a matrix, while the contact set stays what it is. Stage by stage, with R = S⁻¹Hᵀ and W = H R
/// over the closed points alone,
///
///     z° = S⁻¹ Σ_j (β^M_j M + β^C_j C + β^K_j K) x_j + R(π₁ p₋₁ + π₂ p₋₂ + …),     z = z° + π₀ R p
///     rigid:      0 = H(Σ_j y_j x_j + y_z z)                                   the impact measure rests on its stop,
///                                                                              or a way that no work comes back on
///     compliant:  p = −κ H(Σ_j g_j x_j + g_z z)                                the spring, pulling as well as pushing
///     conserving: p = −½κ H(Σ_j (g_j + g⁻_j) x_j + g_z z)                      its discrete gradient
///
/// where a stage with an impulse has π₀R + S⁻¹(feed)R_w, R_w = R⁻¹ιHᵀ, in place of π₀R, and weighs w = R_w p beside z;
/// and x_j ← Σ_i u_ji x_i + u_jz z + u_jw w. Loads and bounds move the fixed point and not the eigenvalues: they are
/// left out.
namespace ricochet {

/// M, C, K (n × n) and the rows of H of the closed points (m × n; m = 0: open), in any coordinates.
struct LinearProblem {
  Eigen::MatrixXd mass, damping, stiffness, contact;
};

/// How a closed contact answers: by a constraint, or by a spring where the scheme evaluates it.
struct ClosedContact {
  std::optional<Evaluation> evaluation;  ///< absent: rigid, the impact measure is held
  double stiffness = 0;                  ///< κ, N/m
};

using StepMapOrRefusal = std::variant<Eigen::MatrixXd, Refusal>;

/// A of X_{n+1} = A X_n, X = (x_0, …, x_{s−1}, then p₋₁, p₋₂, … of the stages before, as far as one weights them).
/// Refused: a singular S, a plan without the measure that the law reads, an impact measure that no effort can move.
StepMapOrRefusal step_map(const LinearProblem& problem, const StepPlan& plan, const ClosedContact& law);

/// What a scheme does to the closed points themselves under a rigid law. It is A (s × s) of x_{n+1} = A x_n over one
/// contact row of the slots. The impact measure of the plan's single stage vanishes there at every step. Together with
/// the modes of the structure held at these points it has the eigenvalues of step_map(). For H z follows from H x
/// alone, and the constraint does not act on displacements that leave the points where they are. Nothing for plans of
/// several stages, with past efforts or an impulse, without an impact measure, or whose measure does not weigh z.
std::optional<Eigen::MatrixXd> held_point_map(const StepPlan& plan);

/// The same step in like units, slots of `rows` numbers each in metres. Velocities count times h, slots that start from
/// neither q₀ nor v₀ times h². Past efforts are lengths p/κ. Eigenvalues do not depend on it, their accuracy does.
Eigen::MatrixXd in_metres(Eigen::MatrixXd step, const StepPlan& plan, double h, Eigen::Index rows,
                          double stiffness = 1);

/// Eigenvalues that round-off cannot tell apart, as one.
struct Root {
  std::complex<double> value;  ///< their mean: far better known than each, where the matrix is defective
  int multiplicity = 1;
  /// Fewer eigenvectors than eigenvalues: powers of the matrix grow like n on the unit circle. Only with vectors.
  bool defective = false;
  Eigen::VectorXcd vector;  ///< an eigenvector, empty when not asked for
};

/// Eigenvalues closer than this are one cluster; a double root is known to about the square root of round-off.
constexpr double root_cluster = 1e-6;

/// Eigenvalues of A, largest modulus first, after balancing by powers of two (Parlett and Reinsch 1969), so that slots
/// may have different units. Empty when A is not finite or the iteration fails.
std::vector<Root> step_roots(const Eigen::MatrixXd& matrix, bool vectors);

/// The step of a plan on one scalar mode m q'' + c q' + k q = 0, contact open: x_{n+1} = A x_n over the slots (s × s,
/// dimensionless up to the slots' own units). Follows from the plan alone. A mode on which S vanishes gives a matrix of
/// infinities.
Eigen::MatrixXd amplification(const StepPlan& plan, double m, double c, double k);

/// ρ∞: what one step leaves of a mode whose frequency is far above 1/h, the largest |r| as hω → ∞, found on a spring
/// without mass (m = c = 0, k = 1). Roots that coincide there are known by their mean; slots that the position never
/// depends on do not count. Nothing where S vanishes on it: an explicit step.
std::optional<double> root_at_infinity(const StepPlan& plan);

}  // namespace ricochet
