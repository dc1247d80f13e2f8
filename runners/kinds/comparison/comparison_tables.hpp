#pragma once
#include "runners/store/record.hpp"

namespace ricochet {

/// The errors that a study asks for, in its order.
std::vector<std::string> errors_of(const StudyResults& results);

/// errors: one row per case and error, with the floor below which it says nothing.
Table errors_table(const StudyResults& results);

/// orders: one row per method, error and refined quantity, with the fit's verdict and reason.
Table orders_table(const StudyResults& results);

/// work_precision: one row per case and error, with the processor time it took.
Table work_precision_table(const StudyResults& results);

/// Whether an axis says how a case is computed, whatever its step and mesh: mass matrix, contact law, time scheme, way
/// of marching.
bool is_method(const std::string& column);
/// Whether another value makes another scene of it: neither method, nor mesh, nor step.
bool is_scene(const std::string& column);

/// precision_targets: for each error, scene and power of ten, the cheapest method that gets there with a step that was
/// run, and the runner-up. From the power that the worst case misses (or the first that some case reaches) to the last
/// that one does. What an error is known to is its value, or the floor of its reference if that is larger.
Table precision_targets_table(const StudyResults& results);

/// order_verdicts: how many of the orders with a declared one are confirmed, refuted and undecided.
Table order_verdicts_table(const Table& orders);

}  // namespace ricochet
