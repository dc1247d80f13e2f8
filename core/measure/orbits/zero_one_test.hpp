#pragma once
#include <cstdint>
#include <optional>
#include <span>

namespace ricochet {

/// The 0–1 test for chaos: K near 0 for regular motion, near 1 for chaotic. For the series φ_j less its mean and 100
/// frequencies c, seeded, in (π/5, 4π/5),
///
///     p(n) = Σ_{j≤n} φ_j cos jc,   q(n) = Σ_{j≤n} φ_j sin jc
///     D_c(n) = 1/(N−m) Σ_j [p(j+n) − p(j)]² + [q(j+n) − q(j)]²,   n = 1 … m,   m = N/10, 100 at most
///     K_c = correlation of (1, …, m) and (D_c(1), …, D_c(m)),     K = median of K_c
///
/// Without its mean the series has no oscillatory term (Eφ)²(1 − cos nc)/(1 − cos c) to be subtracted, which is what
/// regularises D_c. A constant series gives 0. The series is strobed, hence not oversampled. Nothing below 60 readings
/// or where one is not finite. Source: Gottwald and Melbourne (2009), SIAM J. Appl. Dyn. Syst. 8, 129–145, eqs. (2.1),
/// (3.4), (3.6).
std::optional<double> zero_one_test(std::span<const double> series, std::uint64_t seed = 1);

}  // namespace ricochet
