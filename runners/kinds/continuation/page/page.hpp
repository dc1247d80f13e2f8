#pragma once
#include <memory>

#include "runners/kinds/continuation/point_tables.hpp"
#include "runners/report/choices.hpp"
#include "runners/report/curve_data.hpp"
#include "runners/report/kind_page.hpp"

/// \file
/// What a report of kind `continuation` shows: branches with their special points, how these converge, multipliers,
/// and the turns that a step invents.
namespace ricochet::report {

KindPage continuation_page(std::shared_ptr<const PointAnalysis> points);

/// One row per point that has a name: where it goes with the first method that has it, its orders, how many cases have
/// it. Empty without such points.
std::string points_html(const Choices& choices, const PointAnalysis& of);
/// The same by method, with what step, mesh and stiffness leave open, and the reference.
std::string point_methods_html(const Choices& choices, const PointAnalysis& of);

/// How far the points with names are from their limit: one row per name, refinement and case.
Table point_levels(const PointAnalysis& of);
/// The fitted orders as lines over the sizes: one row per name, refinement and method whose order is told.
Table point_lines(const PointAnalysis& of);

/// What the page's script knows of the branches of each case: their names, periods and symmetry, and blocks of equal
/// length. ID/branch/… are the number of the branch, parameter, tip displacement (m) and velocity (m/s), arc (m). Then
/// come the count of unstable multipliers, special point (0: none), real and imaginary parts of the multipliers. Of
/// more than `rows` rows an even choice of each branch is kept, with special points and changes of stability; `said`
/// tells so. Portraits are blocks ID/orbit/…: place of the row, first sample, stops of the tip; samples u and v; runs
/// of contact.
nlohmann::ordered_json branch_data(const Choices& choices, CurveData& curves);

}  // namespace ricochet::report
