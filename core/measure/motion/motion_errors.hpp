#pragma once
#include <optional>
#include <ricochet/contract/reference.hpp>
#include <string>
#include <vector>

namespace ricochet {

/// How far a motion is from a reference on the same grid, up to the horizon T. Δ is their difference; ‖·‖ are over
/// times 0 … T (trapezoidal rule, divided by T: a root mean square) and over x.
///
///     tip-linf         max_t |Δu(tip)|                                 m
///     tip-l2           (1/T ∫ Δu(tip)² dt)^½                           m
///     displacement-l2  (1/T ∫∫ Δu² dx dt)^½                            m^{3/2}
///     displacement-h2  (1/T ∫∫ (Δu'')² dx dt)^½; a bar: Δu'            m^{-1/2}; m^{½}
///     velocity-l2      (1/T ∫∫ (Δu_t)² dx dt)^½                        m^{3/2}/s
///     energy           1/T ∫ |ΔE| dt                                   J
///     impact-times     max over the impacts of both of the distance to the nearest of the other on that side   s
///     impulse          max_t |∫₀ᵗ Δ(Σp) dτ|: the contact force in the dual norm W^{-1,∞}(0,T)                    N s
///
/// An impact of the motion while the reference is in contact is at distance 0, one after it at that from its release.
/// For an oscillator the integrals over x are the values of its one point (m, m/s), and there is no strain.
struct MotionError {
  std::string name;
  std::optional<double> value;  ///< none: `reason` says why
  std::string reason;
};

/// The reason of errors that speak of contact where there is none.
inline constexpr const char* no_contact = "neither motion touches a stop";

/// The errors named (those above, others throw std::logic_error), in that order. Times beyond the horizon, or beyond
/// what the motion reached, do not count; a motion that ended early has no errors but a reason.
std::vector<MotionError> motion_errors(const SampledMotion& motion, const SampledMotion& reference,
                                       const SampleGrid& grid, double horizon, const std::vector<std::string>& names);

/// How large the quantities are that errors are differences of.
struct MotionSize {
  double size = 0;        ///< what the error of a motion that stays at rest would be; of impact-times, the horizon
  double resolution = 0;  ///< ε times the scale of what is read: differences below are round-off. For the tip, whose
                          ///< own motion may be round-off, the largest displacement anywhere.
};
/// In the order of the names; see motion_errors(). Zero where the reference has no such quantity.
std::vector<MotionSize> motion_sizes(const SampledMotion& reference, const SampleGrid& grid, double horizon,
                                     const std::vector<std::string>& names);

/// The time up to which two motions stay within `share` of the first one's largest tip displacement; the grid's last
/// time when they always do.
double common_horizon(const SampledMotion& a, const SampledMotion& b, const SampleGrid& grid, double share);

/// Richardson extrapolation of two motions whose error is C h^order, fine at h and coarse at h·ratio:
/// fine + (fine − coarse)/(ratio^order − 1). Events are the fine ones, their times extrapolated where both have the
/// same sequence of sides.
SampledMotion extrapolated(const SampledMotion& fine, const SampledMotion& coarse, double ratio, double order);

}  // namespace ricochet
