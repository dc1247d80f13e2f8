#pragma once
#include <optional>
#include <ricochet/measure/statistics/refinement.hpp>
#include <string>
#include <vector>

namespace ricochet {

/// The order of a run of errors e(h): the longest run of at least two local slopes log(e_i/e_{i+1})/log(h_i/h_{i+1})
/// that are ≥ 0.4 and within 0.6 of each other, over errors above three floors.
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
  /// Whether it has two slopes alone, half of all at most, and ends before the finest error above the floor: it may be
  /// one of chance.
  bool in_passing = false;
  std::optional<double> stops_at;  ///< the error at which the fall ends: the smallest that was seen
  double last = 0, last_size = 0;  ///< the error at the finest size
  double smallest = 0;             ///< of all errors
};
/// "order", "stops", "does not fall", "no steady order", "at the floor", "too few".
const char* word(OrderRun::Verdict verdict);

/// `errors` ≥ 0 by size, in any order; nothing of none. `floor`: what the reference itself may be wrong by.
std::optional<OrderRun> order_run(std::vector<SizedValue> errors, double floor);

/// ½ in [0.4, 0.7), 1 in [0.7, 1.4), 1½ in [1.4, 1.6), 2 in [1.6, 2.6), 3 in [2.6, 3.4), 4 in [3.4, 4.7); else rounded.
double order_class(double order);

}  // namespace ricochet
