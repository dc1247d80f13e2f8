#pragma once
#include <optional>
#include <vector>

namespace ricochet {

/// How the energy ratio E(T)/E(0) behaves as the step shrinks.
enum class Trend {
  none,           ///< nothing finished
  single,         ///< one step only
  kept,           ///< at no step told from its start
  reaches,        ///< at the finest step not told from its start
  same,           ///< the same change at every step, to 5 %
  settles,        ///< the two finest steps differ by less than 5 % of the change (moving: moves shrink)
  closer,         ///< the change falls
  gains,          ///< the change rises, and it is a gain
  loses,          ///< the change rises, and it is a loss
  unsteady,       ///< none of these
  pair,           ///< moving, two steps only
  keeps_moving,   ///< moving: moves stay as large
  moves_further,  ///< moving: moves grow
};
/// "kept", "comes closer", …: the word of tables.
const char* trend_word(Trend trend);

/// The trend with the figures that it rests on; what a trend does not speak of is left out.
struct EnergyTrend {
  Trend trend = Trend::none;
  std::optional<double> ratio;                            ///< at the finest step
  std::optional<double> first_change, last_change;        ///< |r − 1| at the coarsest and the finest step
  std::optional<double> smallest_change, largest_change;  ///< of |r − 1| over the steps
  std::optional<double> last_move;                        ///< |r_n − r_{n−1}|, of the two finest steps
  std::optional<double> order;  ///< of |r − 1| between the two finest steps where it falls; else see below
};

/// `steps` decreasing and positive, `ratios` = E(T)/E(0) at these steps; `noise` relative to 1: what is below it counts
/// as kept. Conservative cases are compared with 1. Where damping or loads work, 1 is no reference: the trend then
/// speaks of the moves between neighbouring steps, and the order is that of these moves, log(m₁/m₂)/log(h₁/h₂), from
/// the three finest.
EnergyTrend energy_trend(const std::vector<double>& steps, const std::vector<double>& ratios, double noise,
                         bool conservative = true);

}  // namespace ricochet
