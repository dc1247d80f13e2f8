#pragma once
#include "runners/answers/answer.hpp"

namespace ricochet {

/// Sentences before those on cases without a result.
inline constexpr std::size_t sentences_at_most = 6;

/// What a convergence study says: orders in the step and in the mesh, who stops and at what, who does not converge.
answers::Answer orders_answer(const answers::Compared& study);

/// What a work-precision study says: the cheapest methods for an accuracy of 10, 1, 0.1, … %, who never gets there, and
/// what a compared choice costs.
answers::Answer precision_answer(const answers::Compared& study);

/// order_runs: one row per method, error and refined quantity.
Table order_runs_table(const answers::Compared& study);

}  // namespace ricochet
