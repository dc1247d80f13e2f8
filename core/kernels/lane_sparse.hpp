#pragma once
#include <ricochet/kernels/lane_vectors.hpp>

/// \file
/// Products with rows of any sparse matrix, and substitution through a sparse L D Lᵀ by blocks of columns. Sums go in
/// four parts in turn, whatever the number of lanes: none waits for the one before it.
namespace ricochet::lane_bodies {

template <int T, int G>
RICOCHET_INLINE void row_columns(const LaneRows& matrix, bool add, const double* x, double* y, long first) {
  for (long i = 0; i < matrix.rows; ++i) {
    V<T> sum[4][G] = {};
    int e = matrix.start[i];
    const int end = matrix.start[i + 1];
    for (; e + 4 <= end; e += 4)
#pragma GCC unroll 4
      for (int part = 0; part < 4; ++part)
#pragma GCC unroll 4
        for (int k = 0; k < G; ++k)
          sum[part][k] += matrix.value[e + part] * (row<T>(x, matrix.index[e + part]) + first)[k];
    for (; e < end; ++e)
#pragma GCC unroll 4
      for (int k = 0; k < G; ++k) sum[0][k] += matrix.value[e] * (row<T>(x, matrix.index[e]) + first)[k];
    V<T>* out = row<T>(y, i) + first;
#pragma GCC unroll 4
    for (int k = 0; k < G; ++k) {
      const V<T> all = (sum[0][k] + sum[1][k]) + (sum[2][k] + sum[3][k]);
      out[k] = add ? out[k] + all : all;
    }
  }
}

template <int T>
RICOCHET_INLINE void row_product_body(const LaneRows& matrix, bool add, const double* x, double* y) {
  constexpr int G = Row<T>::count < 4 ? Row<T>::count : 4;
  for (long first = 0; first < Row<T>::count; first += G) row_columns<T, G>(matrix, add, x, y, first);
}

// A block of W columns of L: what stands in its own rows by rows, then the rows below by fours, each four by columns.
constexpr long own_entries(long columns) {
  return (columns * (columns - 1) / 2 + 3) / 4 * 4;
}

// One lane, rows in vectors of four.
template <int W>
RICOCHET_INLINE void block_down(const double* value, const int* index, long fours, double* own, double* work) {
  double x[W];
#pragma GCC unroll 8
  for (int i = 0; i < W; ++i) {
    x[i] = own[i];
#pragma GCC unroll 8
    for (int j = 0; j < i; ++j) x[i] -= value[i * (i - 1) / 2 + j] * x[j];
    own[i] = x[i];
  }
  const double* panel = value + own_entries(W);
  for (long f = 0; f < fours; ++f, panel += 4 * W, index += 4) {
    Vector4 even = Vector4{} + load4(panel) * x[0], odd = Vector4{};
#pragma GCC unroll 8
    for (int c = 1; c < W; ++c) (c % 2 == 0 ? even : odd) += load4(panel + 4 * c) * x[c];
    const Vector4 all = even + odd;
#pragma GCC unroll 4
    for (int k = 0; k < 4; ++k) work[index[k]] -= all[k];
  }
}

template <int W>
RICOCHET_INLINE void block_up(const double* value, const int* index, long fours, const double* inverse, double* own,
                              const double* work) {
  Vector4 sum[W] = {};
  const double* panel = value + own_entries(W);
  for (long f = 0; f < fours; ++f, panel += 4 * W, index += 4) {
    const Vector4 below = {work[index[0]], work[index[1]], work[index[2]], work[index[3]]};
#pragma GCC unroll 8
    for (int c = 0; c < W; ++c) sum[c] += load4(panel + 4 * c) * below;
  }
  double x[W];
#pragma GCC unroll 8
  for (int c = 0; c < W; ++c) x[c] = (0.0 + own[c] * inverse[c]) - total(sum[c]);
#pragma GCC unroll 8
  for (int i = W - 1; i >= 0; --i) {
#pragma GCC unroll 8
    for (int j = 0; j < i; ++j) x[j] -= value[i * (i - 1) / 2 + j] * x[i];
    own[i] = x[i];
  }
}

// Several lanes, the same operations on each.
template <int T>
RICOCHET_INLINE V<T>* own_row(double* rows, long i, long first) {
  return row<T>(rows, i) + first;
}

template <int T, int G>
RICOCHET_INLINE void lanes_down(const double* value, const int* index, long fours, long columns, double* own_rows,
                                double* work, long first) {
  for (long i = 1; i < columns; ++i)
    for (long j = 0; j < i; ++j)
#pragma GCC unroll 4
      for (int k = 0; k < G; ++k)
        own_row<T>(own_rows, i, first)[k] -= value[i * (i - 1) / 2 + j] * own_row<T>(own_rows, j, first)[k];
  const double* panel = value + own_entries(columns);
  for (long f = 0; f < fours; ++f, panel += 4 * columns, index += 4)
    for (int r = 0; r < 4; ++r) {
      V<T> even[G], odd[G] = {};
#pragma GCC unroll 4
      for (int k = 0; k < G; ++k) even[k] = V<T>{} + panel[r] * own_row<T>(own_rows, 0, first)[k];
      for (long c = 1; c < columns; c += 2) {
#pragma GCC unroll 4
        for (int k = 0; k < G; ++k) odd[k] += panel[4 * c + r] * own_row<T>(own_rows, c, first)[k];
        if (c + 1 == columns) break;
#pragma GCC unroll 4
        for (int k = 0; k < G; ++k) even[k] += panel[4 * (c + 1) + r] * own_row<T>(own_rows, c + 1, first)[k];
      }
      V<T>* out = row<T>(work, index[r]) + first;
#pragma GCC unroll 4
      for (int k = 0; k < G; ++k) out[k] -= even[k] + odd[k];
    }
}

template <int T, int G>
RICOCHET_INLINE void lanes_up(const double* value, const int* index, long fours, long columns, const double* inverse,
                              double* own_rows, const double* work, long first) {
  for (long c = 0; c < columns; ++c) {
    V<T> sum[4][G] = {};
    const double* panel = value + own_entries(columns) + 4 * c;
    for (long f = 0; f < fours; ++f, panel += 4 * columns)
#pragma GCC unroll 4
      for (int r = 0; r < 4; ++r)
#pragma GCC unroll 4
        for (int k = 0; k < G; ++k) sum[r][k] += panel[r] * (row<T>(work, index[4 * f + r]) + first)[k];
#pragma GCC unroll 4
    for (int k = 0; k < G; ++k)
      own_row<T>(own_rows, c, first)[k] = (V<T>{} + own_row<T>(own_rows, c, first)[k] * inverse[c]) -
                                          ((sum[0][k] + sum[1][k]) + (sum[2][k] + sum[3][k]));
  }
  for (long i = columns - 1; i > 0; --i)
    for (long j = 0; j < i; ++j)
#pragma GCC unroll 4
      for (int k = 0; k < G; ++k)
        own_row<T>(own_rows, j, first)[k] -= value[i * (i - 1) / 2 + j] * own_row<T>(own_rows, i, first)[k];
}

template <int T>
RICOCHET_INLINE void down_any(const double* value, const int* index, long fours, long columns, double* own,
                              double* work) {
  if constexpr (T == 1) {
    switch (columns) {
      case 1:
        return block_down<1>(value, index, fours, own, work);
      case 2:
        return block_down<2>(value, index, fours, own, work);
      case 3:
        return block_down<3>(value, index, fours, own, work);
      case 4:
        return block_down<4>(value, index, fours, own, work);
      case 5:
        return block_down<5>(value, index, fours, own, work);
      case 6:
        return block_down<6>(value, index, fours, own, work);
      case 7:
        return block_down<7>(value, index, fours, own, work);
      default:
        return block_down<8>(value, index, fours, own, work);
    }
  } else {
    constexpr int G = Row<T>::count < 4 ? Row<T>::count : 4;
    for (long first = 0; first < Row<T>::count; first += G)
      lanes_down<T, G>(value, index, fours, columns, own, work, first);
  }
}

template <int T>
RICOCHET_INLINE void up_any(const double* value, const int* index, long fours, long columns, const double* inverse,
                            double* own, const double* work) {
  if constexpr (T == 1) {
    switch (columns) {
      case 1:
        return block_up<1>(value, index, fours, inverse, own, work);
      case 2:
        return block_up<2>(value, index, fours, inverse, own, work);
      case 3:
        return block_up<3>(value, index, fours, inverse, own, work);
      case 4:
        return block_up<4>(value, index, fours, inverse, own, work);
      case 5:
        return block_up<5>(value, index, fours, inverse, own, work);
      case 6:
        return block_up<6>(value, index, fours, inverse, own, work);
      case 7:
        return block_up<7>(value, index, fours, inverse, own, work);
      default:
        return block_up<8>(value, index, fours, inverse, own, work);
    }
  } else {
    constexpr int G = Row<T>::count < 4 ? Row<T>::count : 4;
    for (long first = 0; first < Row<T>::count; first += G)
      lanes_up<T, G>(value, index, fours, columns, inverse, own, work, first);
  }
}

// Lᵀ x in the place of x, one lane: rows below a block are what they were.
RICOCHET_INLINE void sparse_strain_body(const SparseBlocks& L, double* x) {
  x[L.rows] = 0;
  const double* value = L.value;
  for (long s = 0; s < L.blocks; ++s) {
    const long first = L.column[s], columns = L.column[s + 1] - first, fours = L.below[s + 1] - L.below[s];
    const double* panel = value + own_entries(columns);
    double* own = x + first;
    for (long i = 1; i < columns; ++i)
      for (long j = 0; j < i; ++j) own[j] += value[i * (i - 1) / 2 + j] * own[i];
    const int* index = L.index + 4 * static_cast<long>(L.below[s]);
    Vector4 sum[SparseBlocks::widest] = {};
    for (long f = 0; f < fours; ++f, panel += 4 * columns, index += 4) {
      const Vector4 below = {x[index[0]], x[index[1]], x[index[2]], x[index[3]]};
      for (long c = 0; c < columns; ++c) sum[c] += load4(panel + 4 * c) * below;
    }
    for (long c = 0; c < columns; ++c) own[c] += total(sum[c]);
    value = panel;
  }
}

template <int T>
RICOCHET_INLINE void sparse_step_body(const SparseStep& described) {
  const SparseStep step = described;
  const SparseBlocks& L = step.L;
  for (long j = 0; j < L.rows; ++j)
    for (int k = 0; k < Row<T>::count; ++k)
      row<T>(step.work, j)[k] = step.from[j] >= 0 ? row<T>(step.b, step.from[j])[k] : V<T>{};
  for (int k = 0; k < Row<T>::count; ++k) row<T>(step.work, L.rows)[k] = V<T>{};
  const double* value = L.value;
  for (long s = 0; s < L.blocks; ++s) {
    const long columns = L.column[s + 1] - L.column[s], fours = L.below[s + 1] - L.below[s];
    down_any<T>(value, L.index + 4 * static_cast<long>(L.below[s]), fours, columns,
                step.work + L.column[s] * static_cast<long>(Row<T>::lanes), step.work);
    value += own_entries(columns) + 4 * columns * fours;
  }
  for (long s = L.blocks - 1; s >= 0; --s) {
    const long columns = L.column[s + 1] - L.column[s], fours = L.below[s + 1] - L.below[s];
    value -= own_entries(columns) + 4 * columns * fours;
    up_any<T>(value, L.index + 4 * static_cast<long>(L.below[s]), fours, columns, L.inverse + L.column[s],
              step.work + L.column[s] * static_cast<long>(Row<T>::lanes), step.work);
  }
  for (long j = 0; j < L.rows; ++j) {
    if (step.to[j] < 0) continue;
    for (int k = 0; k < Row<T>::count; ++k) row<T>(step.z, step.to[j])[k] = row<T>(step.work, j)[k];
  }
}

}  // namespace ricochet::lane_bodies
