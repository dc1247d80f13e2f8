#pragma once
#include <Eigen/Core>
#include <complex>
#include <optional>
#include <ricochet/measure/orbits/periodic_map.hpp>
#include <ricochet/measure/orbits/set_steps.hpp>
#include <vector>

namespace ricochet {

/// Eigenvalues of the derivative of a map, largest modulus first; empty where the iteration failed. `without_kernel`:
/// those at −1 (to 1e-6) that a scheme has on the kernel of a singular mass are left out, that many at most.
std::vector<std::complex<double>> multipliers_of(Eigen::MatrixXd derivative, int without_kernel = 0);

/// Those of sign · P over the steps of a clock, without those of massless_roots() (to 1e-6): no motion has them.
std::vector<std::complex<double>> multipliers_of(const PeriodicMap& map, const MapClock& clock,
                                                 Eigen::MatrixXd derivative);

/// How many multipliers are where.
struct Outside {
  int total = 0;  ///< |μ| > 1
  int above = 0;  ///< real, > 1
  int below = 0;  ///< real, < −1
  int pairs = 0;  ///< complex, |μ| > 1, counted once
  bool operator==(const Outside&) const = default;
  /// Sign of det(1 − P').
  int side() const { return above % 2 != 0 ? -1 : 1; }
};
Outside outside(const std::vector<std::complex<double>>& multipliers);

/// The derivative of sign · P with the half-step rule. Where a contact set changes from one step to the next, the
/// motion would change it at θ = m₀/(m₀ + m₁) in the step. The margins of the free measure to the bound are m₀ before
/// and m₁ after. The derivative of
///
///     θ < ½: the step before the change   (½ + θ) old + (½ − θ) new
///     θ ≥ ½: the first step after it      (θ − ½) old + (3/2 − θ) new
///
/// is that of the frozen sets at θ = ½ and continuous where a change moves from step to step. Of a step that both ends
/// of a run would blend the later one counts. Step 0 follows the last one. `frozen`: the derivative with the sets as
/// they are. `measures`: of the sweep that they belong to.
Eigen::MatrixXd half_step_derivative(PeriodicMap& map, Eigen::MatrixXd frozen, const SetSequence& sets,
                                     const MapClock& clock, double parameter, const PeriodicMap::Measures& measures);

/// Roots of modulus 1 (to 1e-7) that the step of a program has on displacements without mass, all points open: M φ = 0.
/// `sets`: of that program.
std::vector<std::complex<double>> massless_roots(const Program& program, const SetSteps& sets);

/// The multipliers that roots of modulus 1 have after so many steps of a map that changes the sign or not: sign · rⁿ.
std::vector<std::complex<double>> after_steps(std::vector<std::complex<double>> roots, long long steps, double sign);

}  // namespace ricochet
