#pragma once
#include <ricochet/algebra/lane_vectors.hpp>

/// \file
/// Kernels that see a row of lanes at a time: the diagonal free step, measures at points, and the test of their bounds.
namespace ricochet::lane_bodies {

template <int T, int N>
RICOCHET_INLINE void diagonal_body(int rows, const double* coefficient, const double* const* x, const double* scale,
                                   double* z) {
  const double* in[N];
  for (int j = 0; j < N; ++j) in[j] = x[j];
  V<T> a[Row<T>::count];
  for (int k = 0; k < Row<T>::count; ++k) a[k] = row<T>(scale, 0)[k];
  for (long i = 0; i < rows; ++i) {
    const double* c = coefficient + i * (N + 1);
    for (int k = 0; k < Row<T>::count; ++k) {
      V<T> sum = V<T>{} + c[N] * a[k];
#pragma GCC unroll 4
      for (int j = 0; j < N; ++j) sum += c[j] * row<T>(in[j], i)[k];
      row<T>(z, i)[k] = sum;
    }
  }
}

template <int T, int N>
RICOCHET_INLINE void measure_body(const LaneRows& matrix, const double* const* x, const double* weight,
                                  const double* offset, double* y) {
  const double* in[N];
  double w[N];
  for (int j = 0; j < N; ++j) {
    in[j] = x[j];
    w[j] = weight[j];
  }
  for (long i = 0; i < matrix.rows; ++i) {
    V<T> total[Row<T>::count];
    for (int k = 0; k < Row<T>::count; ++k) total[k] = offset ? row<T>(offset, 0)[k] : V<T>{};
    for (int e = matrix.start[i]; e < matrix.start[i + 1]; ++e) {
      const long at = matrix.index[e];
      const double value = matrix.value[e];
      for (int k = 0; k < Row<T>::count; ++k) {
        V<T> sum = V<T>{} + w[0] * row<T>(in[0], at)[k];
#pragma GCC unroll 8
        for (int j = 1; j < N; ++j) sum += w[j] * row<T>(in[j], at)[k];
        total[k] += value * sum;
      }
    }
    for (int k = 0; k < Row<T>::count; ++k) row<T>(y, i)[k] = total[k];
  }
}

// Any count: one lane keeps its order as in a band of unknown width.
template <int T>
RICOCHET_INLINE void diagonal_general(int rows, int count, const double* coefficient, const double* const* x,
                                      const double* scale, double* z) {
  check_count("diagonal_step", count, most_lane_slots);
  const double* in[most_lane_slots];
  for (int j = 0; j < count; ++j) in[j] = x[j];
  V<T> a[Row<T>::count];
  for (int k = 0; k < Row<T>::count; ++k) a[k] = row<T>(scale, 0)[k];
  for (long i = 0; i < rows; ++i) {
    const double* c = coefficient + i * (count + 1);
    V<T> sum[Row<T>::count];
    for (int k = 0; k < Row<T>::count; ++k) sum[k] = V<T>{} + c[count] * a[k];
    keep_order<T, -1>(sum);
    for (int j = 0; j < count; ++j) {
      for (int k = 0; k < Row<T>::count; ++k) sum[k] += c[j] * row<T>(in[j], i)[k];
      keep_order<T, -1>(sum);
    }
    for (int k = 0; k < Row<T>::count; ++k) row<T>(z, i)[k] = sum[k];
  }
}

template <int T>
RICOCHET_INLINE void measure_general(const LaneRows& matrix, int count, const double* const* x, const double* weight,
                                     const double* offset, double* y) {
  check_count("measure", count, most_lane_terms);
  const double* in[most_lane_terms];
  double w[most_lane_terms];
  for (int j = 0; j < count; ++j) {
    in[j] = x[j];
    w[j] = weight[j];
  }
  for (long i = 0; i < matrix.rows; ++i) {
    V<T> total[Row<T>::count];
    for (int k = 0; k < Row<T>::count; ++k) total[k] = offset ? row<T>(offset, 0)[k] : V<T>{};
    for (int e = matrix.start[i]; e < matrix.start[i + 1]; ++e) {
      const long at = matrix.index[e];
      const double value = matrix.value[e];
      V<T> sum[Row<T>::count];
      for (int k = 0; k < Row<T>::count; ++k) sum[k] = V<T>{} + w[0] * row<T>(in[0], at)[k];
      for (int j = 1; j < count; ++j) {
        for (int k = 0; k < Row<T>::count; ++k) sum[k] += w[j] * row<T>(in[j], at)[k];
        keep_order<T, -1>(sum);
      }
      for (int k = 0; k < Row<T>::count; ++k) total[k] += value * sum[k];
      keep_order<T, -1>(total);
    }
    for (int k = 0; k < Row<T>::count; ++k) row<T>(y, i)[k] = total[k];
  }
}

template <int T>
RICOCHET_INLINE std::uint32_t outside_body(int rows, const double* y, const double* lower, const double* upper) {
  constexpr int per = Row<T>::lanes / Row<T>::count;
  Inside<T> inside[Row<T>::count];
  for (long i = 0; i < rows; ++i)
    for (int k = 0; k < Row<T>::count; ++k) {
      const long place = i * Row<T>::lanes + k * per;
      inside[k].test(row<T>(y, i)[k], lower + place, upper + place);
    }
  return outside_lanes<T, Row<T>::count>(inside, 0);
}

// Four vector sums: enough to hide the latency of an addition.
RICOCHET_INLINE double triple_product_body(long size, const double* a, const double* x, const double* y) {
  Vector4 sum[4] = {};
  long i = 0;
  for (; i + 16 <= size; i += 16)
    for (int k = 0; k < 4; ++k) sum[k] += loadu4(a + i + 4 * k) * (loadu4(x + i + 4 * k) * loadu4(y + i + 4 * k));
  for (; i + 4 <= size; i += 4) sum[0] += loadu4(a + i) * (loadu4(x + i) * loadu4(y + i));
  const Vector4 all = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  double total = (all[0] + all[1]) + (all[2] + all[3]);
  for (; i < size; ++i) total += a[i] * (x[i] * y[i]);
  return total;
}

template <int T>
RICOCHET_INLINE void diagonal_any(int rows, int count, const double* c, const double* const* x, const double* scale,
                                  double* z) {
  switch (count) {
    case 1:
      return diagonal_body<T, 1>(rows, c, x, scale, z);
    case 2:
      return diagonal_body<T, 2>(rows, c, x, scale, z);
    case 3:
      return diagonal_body<T, 3>(rows, c, x, scale, z);
    default:
      return diagonal_body<T, 4>(rows, c, x, scale, z);
  }
}
template <int T>
RICOCHET_INLINE void measure_any(const LaneRows& matrix, int count, const double* const* x, const double* weight,
                                 const double* offset, double* y) {
  switch (count) {
    case 1:
      return measure_body<T, 1>(matrix, x, weight, offset, y);
    case 2:
      return measure_body<T, 2>(matrix, x, weight, offset, y);
    case 3:
      return measure_body<T, 3>(matrix, x, weight, offset, y);
    case 4:
      return measure_body<T, 4>(matrix, x, weight, offset, y);
    default:
      return measure_body<T, 5>(matrix, x, weight, offset, y);
  }
}

}  // namespace ricochet::lane_bodies
