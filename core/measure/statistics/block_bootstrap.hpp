#pragma once
#include <cstdint>
#include <span>

namespace ricochet {

/// A number with its confidence interval.
struct Interval {
  double value = 0, low = 0, high = 0;
};

/// Fewest readings that a bootstrap is made of.
constexpr int fewest_resampled = 8;

/// Mean block length for the stationary bootstrap of the mean,
///
///     b = (2 G²/D)^{1/3} N^{1/3},   G = Σ_k λ(k/M)|k| R(k),   D = 2 (Σ_k λ(k/M) R(k))²
///
/// R: autocovariances; λ: the flat-top window (1 up to ½, then linear to 0 at 1). M: twice the lag after which the
/// autocorrelations stay below 2√(log₁₀N/N). The length lies between 1 and min(3√N, N/3). Sources: Politis and White
/// (2004), Econometric Reviews 23, 53–70; D as corrected by Patton, Politis and White (2009), ibid. 28, 372–375.
double bootstrap_block_length(std::span<const double> series);

/// The mean of a stationary, dependent series with its interval at `confidence`: the stationary bootstrap (Politis and
/// Romano 1994, J. Amer. Statist. Assoc. 89, 1303–1313: circular blocks of geometric length), percentiles of the
/// resampled means. They are opened about the mean by t_{N/b−1}/z, because the N/b blocks are few. They are opened by
/// √(Σ λ R/N / resampled variance) too where that is above 1, because blocks cut dependence off. Depends on the seed
/// and on nothing else. Throws std::invalid_argument below 8 readings, on readings that are not finite, and on a
/// confidence outside (0, 1).
Interval block_bootstrap_mean(std::span<const double> series, double confidence = 0.95, int resamples = 1000,
                              std::uint64_t seed = 1);

}  // namespace ricochet
