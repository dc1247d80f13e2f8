#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace ricochet::report {

/// What stands beside the answer of an ask, as SVG that needs no script; "" where nothing is to be drawn. By `form`:
/// - "bars": `rows` of `name`, `group`, `value`, `low`, `high`: a dot with its interval in each row, groups under
///   headings; `at`: lines across; `sorted`: the largest first in each group;
/// - "pairs": `rows` of `pair`, `name`, `value`, `low`, `high`: a row for each pair, its levels connected;
/// - "along": `rows` of `series`, `x`, `value`, `low`, `high`: values along an axis `along` in `along_unit`, `at` as
///   lines, ranges `between` shaded;
/// - "parts": `rows` of `name`, `part`, `value`: parts of a whole, stacked from zero; `at` as lines;
/// - "ranges": `rows` of `name`, `motion`, `from`, `to`: stretches of `x` in `x_unit`, a row for each name; `group` and
///   `colour` of each or of none: what the legend names, and "#0072B2";
/// - "curves": `series` of `name`, `points` [x, y] in the order of their line, and `floor`, over `x` and `y` with
///   `x_unit` and `y_unit`, in logarithms where `log`; `at` as lines of y;
/// - "branches": `series` of `name` and `points` [x, y, stable], what is not stable broken, and `marks` of `kind`,
///   `name`, `branch`, `value` and `tip`.
/// The value axis is `measure` in `unit`, of logarithms where `log`, or where a linear one hides the small values. A
/// row without a value says so.
std::string figure_svg(const nlohmann::ordered_json& figure);

/// The numbers of such a figure as CSV, a row for each mark: all of its digits, units in the head; ends of intervals in
/// columns of their own. Lines across are rows of their own, `at`. "" where nothing is drawn.
std::string figure_csv(const nlohmann::ordered_json& figure);

}  // namespace ricochet::report
