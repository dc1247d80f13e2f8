#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <ricochet/contract/worded.hpp>
#include <string>
#include <vector>

/// \file
/// Orders of convergence that carry a confidence. A power law e ≈ C r^p is fitted over the range where the errors
/// behave so, and compared with what a method declares.
///
/// 1. *Usable* points have e > 4 max(floor, other error): closer, what the error is measured against shapes it as much
///    as the method does. A lone dip is left out, one in five points at most. In a dip e is under a quarter of what its
///    two neighbours interpolate, and the next one is larger again. That is a signed error on its way through zero.
/// 2. A window of at least three neighbouring points is *straight* under three conditions. First, ln e over ln r
///    scatters by at most 0.4 around its line. That is a factor of 1.5, as impacts do. Second, it bends by no more than
///    chance, or by less than 0.1 in slope from end to end (quadratic term, t test at 95 %). Six points or more whose
///    slopes only rise, or only fall, bend. Third, each of its ends is predicted from the others, within 5 % or by t at
///    99 %. Of three points the scatter alone is asked.
/// 3. The longest straight window is taken, the finer of equals. It gives way to a straight window that lies beyond it
///    by three finer points and falls: the coarser one was pre-asymptotic. A window falls where the low end of its
///    interval is above 0.3. One that does not fall gives way to a coarser one that does: there the errors meet a
///    floor.
/// 4. The order p is the least-squares slope. Half its 95 % interval is
///
///        t_{0.975, m−2} s / √S_xx · √((1+ρ)/(1−ρ)) + Σ_k |w_k| δ_k + d,    w_k = (ln r_k − mean) / S_xx
///
///    with s the scatter and ρ ∈ [0, 0.8] the lag-one correlation of the residuals (m ≥ 5). The term d is half the
///    change of slope from end to end, where that is more than chance or goes one way only. Each δ_k is the larger of
///    0.02 and −ln(1 − (floor + other)/e_k). No error is trusted to better than 2 %, so that points exactly on a line
///    still have an interval.
namespace ricochet {

/// One error of a refinement.
struct OrderPoint {
  double size = 0;                ///< r: the step (s) or the length of an element (m), > 0
  double error = 0;               ///< e ≥ 0; what is not finite is left out
  double floor = 0;               ///< uncertainty of what e is measured against, in the unit of e
  std::optional<double> value{};  ///< the quantity itself, signed: then the GCI is its own, else that of the errors
};

/// What is asked of a fit besides the points.
struct OrderQuestion {
  std::optional<double> declared{};
  std::string refined = "step";  ///< what r is, for sentences
  double other_error = 0;        ///< estimate of the error that refining r does not lower, in the unit of e
  std::string other = "the other refinement";  ///< where that error comes from, for sentences: "the mesh"
  bool other_unknown = false;  ///< there is such an error and nothing tells how large: too slow refutes nothing then
};

enum class OrderVerdict { confirmed, refuted, undecided };
constexpr std::array<const char*, 3> words_of(OrderVerdict) {
  return {"confirmed", "refuted", "undecided"};
}

struct OrderFit {
  std::optional<double> order, low, high;  ///< p and its 95 % interval; absent with fewer than three usable points
  std::optional<double> constant;          ///< C of e ≈ C r^p: the line extrapolated to r = 1
  std::size_t first = 0, last = 0;         ///< coarsest and finest point used, as indices into the points given
  std::size_t points = 0;                  ///< points used
  std::vector<std::size_t> left_out;       ///< dips inside the range, indices
  std::optional<double> gci;  ///< of the finest point used, in the unit of value (or e): see grid_convergence()
  bool saturated = false;     ///< the errors do not fall over the range: the slope is no order
  OrderVerdict verdict = OrderVerdict::undecided;
  std::string reason;  ///< one sentence: why this verdict, which points
};

/// Fits the order. Confirmed: the interval holds the declared order and is no wider than ±0.5, or |p − declared| ≤ 0.05
/// with ±0.3. Refuted: the interval is 0.1 or more away, the range reaches the finest usable point, and finer points do
/// not move towards the declared order. They move where slopes go one way, or the finer half is nearer by half. Too
/// fast is refuted over five points or more, since errors that cancel fall faster for a while. Else undecided, with the
/// reason: too few points, too wide an interval, another error, errors that stop falling, nothing declared. Points in
/// any order; equal sizes are taken together (geometric mean). Throws std::invalid_argument on a size that is not
/// positive, on a negative error or floor.
OrderFit fit_order(const std::vector<OrderPoint>& points, const OrderQuestion& question = {});

/// Three grids of one constant ratio.
struct GridConvergence {
  double order = 0;         ///< p = ln((f₃ − f₂)/(f₂ − f₁))/ln ratio
  double extrapolated = 0;  ///< f₁ + (f₁ − f₂)/(ratio^p − 1), Richardson
  double index = 0;  ///< grid convergence index of f₁: 1.25 |f₁ − f₂|/(ratio^p − 1), in the unit of f (not relative)
};
/// Grid convergence index (Roache 1994, J. Fluids Eng. 116, 405–413, eq. 11, Fs = 1.25 for three grids); f₁ on the
/// finest. Nothing where the differences change sign or do not fall: the grids are not in the asymptotic range.
std::optional<GridConvergence> grid_convergence(double f3, double f2, double f1, double ratio);

}  // namespace ricochet
