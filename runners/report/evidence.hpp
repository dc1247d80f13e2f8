#pragma once
#include <string>

#include "runners/report/case_view.hpp"

/// \file
/// The sections of a report that turn derived tables (errors, orders, work_precision, effects) into evidence. Each is
/// empty where the results have no such table.
namespace ricochet::report {

/// How many orders are confirmed, refuted and undecided; methods × errors with orders and verdicts; every order with
/// its interval and reason, what is not confirmed first.
std::string orders_html(const CaseView& view);

/// For each error and each 10⁻ᵏ, the method that gets there in the least time with a step that was run, the runner-up,
/// the speed-up, and whether their spreads overlap.
std::string work_precision_html(const CaseView& view);

/// One sentence to quote per measure, what the shares leave out, and the table of shares.
std::string effects_html(const CaseView& view);

}  // namespace ricochet::report
