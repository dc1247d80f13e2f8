#pragma once
#include "runners/report/kind_page.hpp"

/// \file
/// What reports of the comparing kinds share: errors along the step and along the elements, and their orders.
namespace ricochet::report {

KindPage comparison_page();

/// Where errors follow their fitted order: the longest run of points above their floor within a factor of two of
/// e = C x^p, with the ends of that line. Axes as in `orders`.
Table order_lines(const CaseView& view);

/// How many orders are confirmed, refuted and undecided; methods × errors with orders and verdicts; every order with
/// its interval and reason, what is not confirmed first. Empty without the table `orders`.
std::string orders_html(const CaseView& view);

}  // namespace ricochet::report
