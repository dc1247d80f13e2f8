#pragma once
#include <optional>
#include <string>
#include <vector>

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

/// A point that an answer tells.
struct ToldPoint {
  const NamedPoint* name = nullptr;      ///< of a point of the reference case
  const PointLimitRow* limit = nullptr;  ///< of the reference's method
  bool ends_stability = false;           ///< stable orbits lie on one side of it alone
  const StudyPoint& point() const { return *name->point; }
};

/// What the special points of a study come to over its cases. Empty where no case left a branch.
struct PointAnalysis {
  explicit PointAnalysis(const Choices& study);
  /// Appends point_presence, point_shifts, point_orders and point_limits, and puts special_points behind `branches`:
  /// with names, and without folds that have none and that steps may have invented. Their parameter goes back by less
  /// than StudyPoints::least_fold().
  void append_tables(StudyResults& results) const;

  StudyPoints points;
  std::vector<std::vector<PointConvergence>> convergence;  ///< of each name, with the method of each head
  std::vector<PointPresenceRow> presence;
  std::vector<PointShiftRow> shifts;
  std::vector<PointOrderRow> orders;
  std::vector<PointLimitRow> limits;
  /// The named points of the reference's method at which stable orbits end, and its first contacts; all where none ends
  /// them. One of each kind stands before a second of any. A fold at a first contact is told as the contact, and what
  /// several branches have at one place once.
  std::vector<ToldPoint> told;
};
/// PointAnalysis::told, of all its other members.
std::vector<ToldPoint> told_points(const PointAnalysis& of);

}  // namespace ricochet
