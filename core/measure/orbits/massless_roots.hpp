#pragma once
#include <complex>
#include <ricochet/measure/orbits/set_steps.hpp>
#include <vector>

namespace ricochet {

/// Roots of modulus 1 (to 1e-7) that the step of a program has on displacements without mass, all points open: M φ = 0.
/// `sets`: of that program.
std::vector<std::complex<double>> massless_roots(const Program& program, const SetSteps& sets);

/// The multipliers that roots of modulus 1 have after so many steps of a map that changes the sign or not: sign · rⁿ.
std::vector<std::complex<double>> after_steps(std::vector<std::complex<double>> roots, long long steps, double sign);

}  // namespace ricochet
