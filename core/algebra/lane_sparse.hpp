#pragma once
#include <ricochet/algebra/lane_vectors.hpp>

/// \file
/// Substitution through a sparse factor, see SparseStep.
namespace ricochet::lane_bodies {

// What the entries from begin to end take off, one after the other.
template <int T, int G>
RICOCHET_INLINE void take_entries(const SparseFactorRows& rows, long j, const double* work, long first, V<T>* sum) {
  for (int e = rows.start[j]; e < rows.start[j + 1]; ++e) {
    const double value = rows.value[e];
    const V<T>* known = row<T>(work, rows.index[e]) + first;
#pragma GCC unroll 4
    for (int k = 0; k < G; ++k) sum[k] -= value * known[k];
    keep_order<T, -1>(sum);
  }
}

template <int T, int G>
RICOCHET_INLINE void sparse_columns(const SparseStep& step, long first) {
  V<T> sum[G];
  for (long j = 0; j < step.rows; ++j) {
    const long from = step.from[j];
#pragma GCC unroll 4
    for (int k = 0; k < G; ++k) sum[k] = from >= 0 ? (row<T>(step.b, from) + first)[k] : V<T>{};
    take_entries<T, G>(step.lower, j, step.work, first, sum);
#pragma GCC unroll 4
    for (int k = 0; k < G; ++k) (row<T>(step.work, j) + first)[k] = sum[k];
  }
  for (long j = step.rows - 1; j >= 0; --j) {
    const long to = step.to[j];
#pragma GCC unroll 4
    for (int k = 0; k < G; ++k) sum[k] = V<T>{} + (row<T>(step.work, j) + first)[k] * step.inverse[j];
    take_entries<T, G>(step.upper, j, step.work, first, sum);
#pragma GCC unroll 4
    for (int k = 0; k < G; ++k) (row<T>(step.work, j) + first)[k] = sum[k];
    if (to < 0) continue;
#pragma GCC unroll 4
    for (int k = 0; k < G; ++k) (row<T>(step.z, to) + first)[k] = sum[k];
  }
}

template <int T>
RICOCHET_INLINE void sparse_step_body(const SparseStep& described) {
  const SparseStep step = described;
  constexpr int G = Row<T>::count < 4 ? Row<T>::count : 4;
  for (long first = 0; first < Row<T>::count; first += G) sparse_columns<T, G>(step, first);
}

}  // namespace ricochet::lane_bodies
