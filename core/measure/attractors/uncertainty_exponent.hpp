#pragma once
#include <optional>
#include <ricochet/measure/statistics/block_bootstrap.hpp>
#include <vector>

namespace ricochet {

/// How the share of initial states whose end is uncertain falls with their uncertainty ε:
///
///     f(ε) ~ ε^s,      s = d − D,     d: dimensions of the grid, D: dimension of the basins' boundary
///
/// s = 1: a smooth boundary; s < 1: a fractal one; s = 0: no accuracy helps. `labels` is row after row (rows ×
/// columns; one row is a line, d = 1), one label per cell, < 0 where the end is not known. f(ε) is the share of the
/// known cells of which one of the (up to 2d) cells ε further along an axis is known and ends differently; ε = 1, 2, 4,
/// … cells, up to a quarter of the shorter side. Usable sizes have 0 < f ≤ 0.8: beyond, ε is too large for this
/// boundary. s is the least-squares slope of ln f over ln ε; its 95 % interval joins the scatter (Student) and the
/// counts (1/√n, n uncertain cells that lie 2ε apart). Nothing with fewer than 3 usable sizes. Throws
/// std::invalid_argument when the labels do not fill the grid. Source: Grebogi, McDonald, Ott and Yorke (1983), Phys.
/// Lett. A 99, 415–418.
std::optional<Interval> uncertainty_exponent(const std::vector<int>& labels, int columns, int rows);

}  // namespace ricochet
