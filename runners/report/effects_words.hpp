#pragma once
#include <string>
#include <vector>

#include "runners/report/case_view.hpp"

namespace ricochet::report {

/// The share of a measure's variance that one choice, or an interaction, has.
struct MeasureShare {
  std::string factor;
  double share = 0, low = 0, high = 0;
  size_t order = 1;  ///< factors that take part; 4 for all that is higher, 0 for repeats
};

/// The shares of one measure, largest first.
struct MeasureShares {
  std::string name;
  bool log = false;
  std::vector<MeasureShare> shares;
  bool told() const { return !shares.empty() && shares.front().share > 0; }
};

/// The table `effects` by measure.
std::vector<MeasureShares> measure_shares(const StudyResults& results);

/// "87 % of the spread of energy end comes from the mass matrix, 9 % from its interaction with the step."
std::string effects_sentence(const MeasureShares& measure);

/// What the shares are not of: cases without the measure, choices that do not vary.
std::string effects_caveats(const CaseView& view, const MeasureShares& measure);

/// A share in per cent: two digits where it is small, no decimals where it is not.
std::string effects_percent(double share);

/// A name of a column as words.
std::string in_words(std::string name);

}  // namespace ricochet::report
