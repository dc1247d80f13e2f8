#pragma once
#include "runners/report/kind_page.hpp"

/// \file
/// What a report of kind `continuation` shows: branches with their special points, how these converge, multipliers,
/// and the turns that a step invents.
namespace ricochet::report {

KindPage continuation_page();

/// One row per point that has a name: where it goes with the first method that has it, its orders, how many cases have
/// it. Empty without such points.
std::string points_html(const CaseView& view);
/// The same by method, with what step, mesh and stiffness leave open, and the reference.
std::string point_methods_html(const CaseView& view);

/// How far the points with names are from their limit: one row per name, refinement and case.
Table point_levels(const CaseView& view);
/// The fitted orders as lines over the sizes: one row per name, refinement and method whose order is told.
Table point_lines(const CaseView& view);

}  // namespace ricochet::report
