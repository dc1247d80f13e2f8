#pragma once
#include <string>
#include <utility>
#include <vector>

namespace ricochet {

/// What would run for a case, decided without running it.
struct CasePlan {
  std::string refusal;        ///< "" when the case applies
  std::string operator_name;  ///< diagonal, modal, band, sparse
  long long steps = 0;
  double predicted_seconds = 0;
  /// Of these, what no more processors shorten: orbits that begin where others end, the last block of a grid. 0: all.
  double chain_seconds = 0;
  double bytes = 0;                           ///< of its results in the store, roughly
  double coarsest_step = 0, finest_step = 0;  ///< s, of those that the case takes; 0 where it is refused
  std::vector<std::pair<std::string, std::string>> left_out;  ///< item, reason
  std::vector<std::string> notes;
};

/// Thrown out of a case when `stop` became true while it marched; the case leaves nothing behind.
struct Interrupted {};

}  // namespace ricochet
