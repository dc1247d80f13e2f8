#pragma once
#include <string>
#include <vector>

#include "runners/report/figures.hpp"

/// \file
/// The sections of a report that turn derived tables (errors, orders, work_precision, effects) into evidence. Each is
/// empty where the results have no such table.
namespace ricochet::report {

/// Errors against the step and against the number of elements, log–log, one view per kind of error, one curve per
/// method: the fitted slope over the points that follow it, the error floor, points at or below it in grey, cases
/// without an error as marks along the upper edge. Elements: at each method's smallest step.
std::vector<Figure> error_figures(const CaseView& view);

/// Run time, steps, and time per step against the error, one view per kind of error, one curve per method over its
/// steps: fastest and slowest repeat, the Pareto front of all methods of a scene, the error floor, and a gutter for the
/// cases without an error.
std::vector<Figure> work_precision_figures(const CaseView& view);

/// Shares of variance per measure, one bar per factor or interaction with its interval.
std::vector<Figure> effects_figures(const CaseView& view);

/// How many orders are confirmed, refuted and undecided; methods × errors with orders and verdicts; every order with
/// its interval and reason, what is not confirmed first.
std::string orders_html(const CaseView& view);

/// For each error and each 10⁻ᵏ, the method that gets there in the least time with a step that was run, the runner-up,
/// the speed-up, and whether their spreads overlap.
std::string work_precision_html(const CaseView& view);

/// One sentence to quote per measure, what the shares leave out, and the table of shares.
std::string effects_html(const CaseView& view);

}  // namespace ricochet::report
