#pragma once
#include <optional>
#include <string>

#include "runners/kinds/continuation/study_points.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/table/row_type.hpp"

/// \file
/// The tables of a study of kind `continuation` that compare the special points of its cases.
namespace ricochet {

/// One row of `point_presence`: a named point in a case.
struct PointPresenceRow {
  std::string id, name, presence;
  std::optional<int> points = {};  ///< of its kind at its place
  std::optional<double> passed_from = {}, passed_to = {};
  bool robust = false;
};
TableType<PointPresenceRow> point_presence_type(const SweptColumns& swept = {});

/// One row of `point_shifts`: a named point against that of the reference case, from which its case differs in one
/// choice.
struct PointShiftRow {
  std::string id, name, choice, value, reference_value;
  std::optional<double> shift = {}, low = {}, high = {};
};
TableType<PointShiftRow> point_shifts_type(const SweptColumns& swept = {});

/// One row of `point_orders`: a named point with one method, along one refinement.
struct PointOrderRow {
  std::string id, name, method, refined;  ///< the finest case that was used, and the finest of the method
  std::optional<double> order = {}, low = {}, high = {};
  int sizes = 0, used = 0;
  std::string verdict = {}, reason = {};
};
TableType<PointOrderRow> point_orders_type();
inline constexpr const char *order_told = "told", *order_not_told = "not told";

/// One row of `point_limits`: a named point with one method.
struct PointLimitRow {
  std::string id, name;
  std::optional<double> finest = {}, limit = {}, low = {}, high = {}, step_open = {}, mesh_open = {}, law_open = {};
  std::optional<double> reference = {}, reference_gap = {};
};
TableType<PointLimitRow> point_limits_type(const SweptColumns& swept = {});

/// Gives the rows of `special_points` their names, and adds point_presence, point_shifts, point_orders and point_limits
/// to the results. Nothing where no case left a branch.
void derive_points(StudyResults& results);

}  // namespace ricochet
