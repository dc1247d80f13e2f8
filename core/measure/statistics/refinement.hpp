#pragma once
#include <array>
#include <optional>
#include <ricochet/contract/worded.hpp>
#include <string>
#include <vector>

/// \file
/// What becomes of a value as a step or a mesh is refined.
namespace ricochet {

/// A value computed at one size of the refinement: the step h (s), or 1/N of a mesh of N elements.
struct SizedValue {
  double size = 0;
  double value = 0;
};

/// What a sequence of values does.
enum class LimitStatus {
  one,            ///< a single size
  same,           ///< equal within round-off at every size
  two,            ///< two sizes: nothing tells how the difference goes on
  settles,        ///< the last three values converge with order 0.5 or more
  reaches_truth,  ///< the distance to the known exact value falls with order 0.5 or more, or is round-off
  vanishes,       ///< |v| itself falls to zero with order 0.5 or more, and its limit is not beyond
  moves,          ///< the last differences have one sign and do not shrink fast enough
  wanders,        ///< none of these
  blows_up        ///< |v| grows with every refinement
};
constexpr std::array<const char*, 9> words_of(LimitStatus) {
  return {"one", "same", "two", "settles", "reaches truth", "vanishes", "moves", "wanders", "blows up"};
}

/// The limit of one method along a refinement, as far as its values tell.
struct Limit {
  LimitStatus status = LimitStatus::one;
  double value = 0;                   ///< of the finest size
  std::optional<double> uncertainty;  ///< u ≥ 0; infinite of what blows up; nothing of a single size
  double low = 0, high = 0;           ///< where the limit is expected: value ± u, towards the truth, or the last three
  std::optional<double> order;        ///< where two orders in a row agree, or the distance to the truth shows one
  std::size_t sizes = 1;
  double ratio = 1;  ///< of the last two sizes, the coarser over the finer
  int trend = 0;     ///< of a value that moves: 1 rises, −1 falls
  double range = 0;  ///< of the last three values
  /// Settled, equal, at the truth, or falling to zero.
  bool settled() const;
  bool restless() const { return status == LimitStatus::moves || status == LimitStatus::wanders; }
};

/// The order p with (h₂ᵖ − h₃ᵖ)/(h₁ᵖ − h₂ᵖ) = |d₂/d₁| for sizes h₁ > h₂ > h₃ and differences d₁ = v₂ − v₁,
/// d₂ = v₃ − v₂ of v = a + b hᵖ; by bisection in [−3, 8], whose ends stand for all beyond. Nothing where d₁ = 0.
std::optional<double> order_of(double h1, double h2, double h3, double d1, double d2);

/// How a value errs. `smooth`: by powers of the size. `saw_toothed`: by where within a step impacts fall, so that the
/// error has no steady factor and two values may be near to each other by chance.
enum class Errors { smooth, saw_toothed };

/// The lowest order that counts as convergence: what a convergent scheme shows through contact.
inline constexpr double lowest_order = 0.5;

/// The limit of `values`, sizes in any order, one value of each. `floor` ≥ 0: what round-off makes of a value. `truth`:
/// the exact value where one is known. Nothing of no values.
///
/// With the differences d of values from coarse to fine and the ratio r of the last sizes, the rest is
/// 1.25 |d_last|/(rᵖ − 1) (Roache, 1994, for three sizes). Where two orders p in a row agree within 0.6, the
/// uncertainty u is the rest, at least a tenth of |d_last|; p is then less by as much as the two differ. Without them
/// u is at least 1.25 |d_last|, and by how much a later value missed the interval that three coarser sizes, or more,
/// had told. Where d_last has another sign than the difference before it, or p > 4.5, it is small by chance: u is at
/// least what first order leaves of that, 1.25 |d_before| h₃/(h₁ − h₂). Where errors have a saw tooth it always is, and
/// at least the range of the last three values, and no order is confirmed. Of two sizes u is |d_last|, of what moves 2
/// |d_last|, of what wanders that range.
std::optional<Limit> limit_of(std::vector<SizedValue> values, double floor, std::optional<double> truth = {},
                              Errors errors = Errors::smooth);

/// The limit over two refinements, at the finest of both: uncertainties are added, so are the ways to low and to high.
/// The status is the worse of the two. A single size says nothing. Nothing where both are absent.
std::optional<Limit> combined(const std::optional<Limit>& step, const std::optional<Limit>& mesh);

/// What grows, but lies within the bound |v| ≤ most that nothing exceeds, moves: u is twice the range of the last
/// three.
void bound_growth(Limit& limit, double most);

/// Adds half an interval of the value itself, as of a mean over a window.
void widen(Limit& limit, double half);

/// Three values may settle by chance. Where more than half of all methods move or wander, those that settle on three
/// values without an order are taken as moving. Their u is then the larger of what it was and the range of the three.
void doubt_chance(std::vector<Limit*> limits);

/// Where the limit may be: what wanders is as wide as its last values and half of that on both sides.
struct LimitInterval {
  double low = 0, high = 0;
};
LimitInterval interval(const Limit& limit);

/// The order of a run of errors e(h), from local slopes log(e_i/e_{i+1})/log(h_i/h_{i+1}) over errors above three
/// floors. The run is the longest of at least two slopes that are ≥ 0.4 and within 0.6 of each other.
struct OrderRun {
  enum class Verdict {
    order,            ///< such a run
    stops,            ///< none, and the last slope is below 0.35: the error ends at a level
    does_not_fall,    ///< no slope reaches 0.35
    no_steady_order,  ///< none of these
    below_floor,      ///< fewer than two errors above three floors
    too_few           ///< fewer than three errors above three floors
  };
  Verdict verdict = Verdict::too_few;
  double order = 0, least = 0, most = 0;  ///< slope over the whole run, and of its local slopes
  double from = 0, to = 0;                ///< sizes of its ends
  /// Whether it may be one of chance. Then it has two slopes alone, half of all at most, and ends before the finest
  /// error above the floor.
  bool in_passing = false;
  static constexpr double steepest_of_two = 3.4;
  std::optional<double> stops_at;     ///< the error at which the fall ends: the smallest that was seen
  double last = 0, last_size = 0;     ///< the error at the finest size
  double smallest = 0;                ///< of all errors
  std::vector<double> slopes;         ///< all, from the coarsest size on
  std::size_t first = 0, length = 0;  ///< the run among them
  /// Slopes ≥ 0.35 beyond the run and more than 0.6 from its order, not on the way to a level that is reached.
  std::vector<double> beyond;
  /// Whether the run is what the error does: no chance, at least half of the slopes that fall are like it, one beyond
  /// it at most is not. Slopes that fall off by 0.3 of the order approach a level. Two slopes alone agree to 0.15 of
  /// it, and no other falls; above order 3.4 they are chance.
  bool clean() const;
};
constexpr std::array<const char*, 6> words_of(OrderRun::Verdict) {
  return {"order", "stops", "does not fall", "no steady order", "at the floor", "too few"};
}

/// `errors` ≥ 0 by size, in any order; nothing of none. `floor`: what the reference itself may be wrong by.
std::optional<OrderRun> order_run(std::vector<SizedValue> errors, double floor);

/// ½ in [0.4, 0.7), 1 in [0.7, 1.4), 1½ in [1.4, 1.6), 2 in [1.6, 2.6), 3 in [2.6, 3.4), 4 in [3.4, 4.7). Others are
/// rounded.
double order_class(double order);

}  // namespace ricochet
