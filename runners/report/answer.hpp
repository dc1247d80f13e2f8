#pragma once
#include <string>
#include <vector>

#include "runners/report/case_view.hpp"

namespace ricochet::report {

/// How the energy ratio behaves as the step shrinks, told from measured values alone.
struct Trend {
  std::string words;
  std::optional<double> order;  ///< of |r − 1| between the two finest steps where it falls; not conservative: see below
};

/// `steps` decreasing and positive, `ratios` = E(T)/E(0) at these steps; `noise` relative to 1: what is below it counts
/// as kept. Conservative cases are compared with 1. Where damping or loads work, 1 is no reference: the words then
/// speak of the moves between neighbouring steps, and the order is that of these moves, log(m₁/m₂)/log(h₁/h₂), from the
/// three finest.
Trend step_trend(const std::vector<double>& steps, const std::vector<double>& ratios, double noise,
                 bool conservative = true);

/// Relative size below which a change of a case's energy is not told from round-off: the larger of 2⁻⁵² × steps and the
/// residual of its energy balance over its starting energy.
double noise_of(const CaseRecord& record);

/// A step counts as gaining energy above this share of the starting energy.
inline constexpr double step_gain_threshold = 1e-9;

/// Whether nothing but contact changes the energy of the finished cases: then its start is the reference.
bool conservative(const CaseView& view);

/// The section "Answer" as HTML: sentences and tables made of measured figures only.
std::string answer_html(const CaseView& view);

}  // namespace ricochet::report
