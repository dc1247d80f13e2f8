#pragma once
#include "runners/report/kind_page.hpp"

/// \file
/// What a report of kind `work-precision` shows beside errors and orders: what an error costs.
namespace ricochet::report {

KindPage work_precision_page();

/// Each timed error as a point of work against precision: its floor, time per step, whether it lies on the Pareto
/// fronts of its scene, or why it has no point.
Table work_points(const CaseView& view);

/// For each error and each 10⁻ᵏ, the method that gets there in the least time with a step that was run, the runner-up,
/// the speed-up, and whether their spreads overlap. Empty without the table `precision_targets`.
std::string work_precision_html(const CaseView& view);

}  // namespace ricochet::report
