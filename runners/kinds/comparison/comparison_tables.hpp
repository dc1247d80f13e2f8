#pragma once
#include <ricochet/measure/motion/orders.hpp>

#include "runners/store/record.hpp"
#include "runners/table/row_type.hpp"

namespace ricochet {

/// The errors that a study asks for, in its order.
std::vector<std::string> errors_of(const StudyResults& results);

/// Errors have units of their own.
inline constexpr char of_each_error[] = "that of the error";
/// The unit that all errors of a study have; of_each_error where they differ.
std::string error_unit(const StudyResults& results);

/// Below what an error of this case says nothing: what its reference is known to, and the round-off of its steps. That
/// is 4 units of the motion's size, times the root of their number.
double error_floor(const CaseRecord& record, const std::string& error);

/// One row of `errors`.
struct ErrorRow {
  std::string id, error;
  std::optional<double> value, floor;
};
TableType<ErrorRow> errors_type(const std::string& unit = of_each_error);
/// errors: one row per case and error, with the floor below which it says nothing.
Table errors_table(const StudyResults& results);

/// One row of `orders`.
struct OrderRow {
  std::string id, refined, error;
  std::optional<double> order = {}, low = {}, high = {}, declared = {};
  OrderVerdict verdict = OrderVerdict::undecided;
  std::string reason = {};
  std::optional<std::string> saturates_at = {};
};
TableType<OrderRow> orders_type();
/// orders: one row per method, error and refined quantity, with the fit's verdict and reason.
Table orders_table(const StudyResults& results);

/// One row of `work_precision`.
struct WorkRow {
  std::string id, error;
  std::optional<double> value, run_seconds, low, high;
  long long steps = 0;
  std::string status;
};
TableType<WorkRow> work_precision_type(const std::string& unit = of_each_error);
/// work_precision: one row per case and error, with the processor time it took.
Table work_precision_table(const StudyResults& results);

/// Whether an axis says how a case is computed, whatever its step and mesh: mass matrix, contact law, time scheme, way
/// of marching.
bool is_method(const std::string& column);
/// Whether another value makes another scene of it: neither method, nor mesh, nor step.
bool is_scene(const std::string& column);

/// What a case of `precision_targets` costs.
struct TargetCase {
  std::optional<std::string> id;
  std::optional<double> seconds, low, high;
};
/// One row of `precision_targets`.
struct TargetRow {
  TargetCase first, other;
  std::string error;
  std::optional<double> at_most, speed_up;
  std::optional<bool> overlap;
  std::optional<double> share;
};
TableType<TargetRow> precision_targets_type(const std::string& unit = of_each_error);
/// precision_targets: for each error, scene and power of ten, the cheapest method that gets there with a step that was
/// run, and the runner-up. From the power that the worst case misses (or the first that some case reaches) to the last
/// that one does. What an error is known to is its value, or the floor of its reference if that is larger.
Table precision_targets_table(const StudyResults& results);

/// The one row of `order_verdicts`.
struct OrderVerdicts {
  std::size_t orders = 0, declared = 0, confirmed = 0, refuted = 0, undecided = 0;
};
TableType<OrderVerdicts> order_verdicts_type();
/// order_verdicts: how many of the orders with a declared one are confirmed, refuted and undecided.
Table order_verdicts_table(const Table& orders);

}  // namespace ricochet
