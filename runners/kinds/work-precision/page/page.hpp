#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "runners/kinds/comparison/comparison_tables.hpp"
#include "runners/report/axis_rows.hpp"
#include "runners/report/choices.hpp"
#include "runners/report/kind_page.hpp"

/// \file
/// What a report of kind `work-precision` shows beside errors and orders: what an error costs.
namespace ricochet::report {

KindPage work_precision_page();

/// Each timed error as a point of work against precision: its floor, and its time per step. Also whether it lies on the
/// Pareto fronts of its scene, or why it has no point.
Table work_points(const Choices& choices);

/// For each error and each 10⁻ᵏ, the method that reaches it in the least time with a step that was run. Also the
/// runner-up, the speed-up, and whether their spreads overlap. Empty without the table `precision_targets`.
std::string work_precision_html(const Choices& choices);

// What the charts and tables of work and precision share.

/// A timed case with one kind of error.
struct WorkPoint {
  const CaseRecord* record = nullptr;
  double error = 0;                       ///< > 0
  double seconds = 0, low = 0, high = 0;  ///< run time: median, fastest, slowest
  double steps = 0;
  double floor = 0;  ///< of the error: what is below it is not told apart
  double known() const { return std::max(error, floor); }
};

/// The results as work against precision.
class WorkPrecision {
 public:
  explicit WorkPrecision(const Choices& choices);

  bool empty() const { return rows_.empty(); }
  std::vector<std::string> errors() const { return rows_.values(&WorkRow::error); }

  /// The point of a case; nothing where it has no such error, an error of exactly 0, or no time.
  std::optional<WorkPoint> point(const CaseRecord& record, const std::string& error) const;
  /// Why a finished case has no point: "no such error", "error exactly 0", "not timed"; "" where it has one.
  std::string why_none(const CaseRecord& record, const std::string& error) const;
  std::vector<WorkPoint> points(const Cases& cases, const std::string& error) const;

 private:
  AxisRows<WorkRow> rows_;
  AxisRows<ErrorRow> errors_;
};

/// Columns that make another scene of it: neither methods, nor mesh, nor step.
std::vector<std::string> scene_columns(const Choices& choices);

/// Indices of the points that no other beats in both known error and `work`, by increasing error; equal ones all count.
std::vector<size_t> pareto_front(const std::vector<WorkPoint>& points, double (*work)(const WorkPoint&));

/// Whether the timing tells the point from the front: some point is as precise, and even its slowest repeat was faster
/// than this one's fastest.
bool told_from_front(const WorkPoint& point, const std::vector<WorkPoint>& points);

}  // namespace ricochet::report
