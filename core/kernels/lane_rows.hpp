#pragma once
#include <ricochet/kernels/lane_vectors.hpp>

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

// Combinations of whole blocks: Σ_j w_j x_j, and the update of all slots at once. These do not see lanes: they run
// over a block four doubles at a time (blocks are padded to 64 bytes).

template <int N>
RICOCHET_INLINE void combine_body(long size, const double* const* x, const double* weight, double* out) {
  const double* in[N];
  double w[N];
  for (int j = 0; j < N; ++j) {
    in[j] = x[j];
    w[j] = weight[j];
  }
  for (long i = 0; i < size; i += 4) {
    Vector4 sum = Vector4{} + w[0] * load4(in[0] + i);
#pragma GCC unroll 4
    for (int j = 1; j < N; ++j) sum += w[j] * load4(in[j] + i);
    *reinterpret_cast<Vector4*>(out + i) = sum;
  }
}

// d ← d + z, q ← q + d: what two-slot increment schemes do, without the multiplications by one and zero.
template <bool Next>
RICOCHET_INLINE void update_increments(long size, double* const* x, const double* z, const double* next,
                                       double* combined) {
  double *q = x[0], *d = x[1];
  const double of_q = Next ? next[0] : 0, of_d = Next ? next[1] : 0;
  for (long i = 0; i < size; i += 4) {
    const Vector4 increment = load4(d + i) + load4(z + i), position = load4(q + i) + increment;
    *reinterpret_cast<Vector4*>(d + i) = increment;
    *reinterpret_cast<Vector4*>(q + i) = position;
    if (Next) {
      Vector4 sum = Vector4{} + of_q * position;
      sum += of_d * increment;
      *reinterpret_cast<Vector4*>(combined + i) = sum;
    }
  }
}

RICOCHET_INLINE bool only_increments(int count, const double* w) {
  return count == 2 && w[0] == 1 && w[1] == 1 && w[2] == 1 && w[3] == 0 && w[4] == 1 && w[5] == 1;
}

template <int N, bool Next>
RICOCHET_INLINE void update_body(long size, double* const* x, const double* z, const double* weight, const double* next,
                                 double* combined) {
  double* slot[N];
  double w[N][N + 1], c[N];
  for (int j = 0; j < N; ++j) {
    slot[j] = x[j];
    c[j] = Next ? next[j] : 0;
    for (int s = 0; s <= N; ++s) w[j][s] = weight[j * (N + 1) + s];
  }
  for (long i = 0; i < size; i += 4) {
    Vector4 old[N + 1], fresh[N];
#pragma GCC unroll 4
    for (int j = 0; j < N; ++j) old[j] = load4(slot[j] + i);
    old[N] = load4(z + i);
#pragma GCC unroll 4
    for (int j = 0; j < N; ++j) {
      fresh[j] = Vector4{} + w[j][0] * old[0];
#pragma GCC unroll 4
      for (int s = 1; s <= N; ++s) fresh[j] += w[j][s] * old[s];
      *reinterpret_cast<Vector4*>(slot[j] + i) = fresh[j];
    }
    if (Next) {
      Vector4 sum = Vector4{} + c[0] * fresh[0];
#pragma GCC unroll 4
      for (int j = 1; j < N; ++j) sum += c[j] * fresh[j];
      *reinterpret_cast<Vector4*>(combined + i) = sum;
    }
  }
}

// The same for any count, term by term in the same order. Two vectors at a time: a sum waits for its last term.
RICOCHET_INLINE void combine_general(long size, int count, const double* const* x, const double* weight, double* out) {
  check_count("combine", count, most_lane_terms);
  const double* in[most_lane_terms];
  double w[most_lane_terms];
  for (int j = 0; j < count; ++j) {
    in[j] = x[j];
    w[j] = weight[j];
  }
  for (long i = 0; i < size; i += 8) {
    Vector4 sum[2];
    for (int k = 0; k < 2; ++k) sum[k] = Vector4{} + w[0] * load4(in[0] + i + 4 * k);
    for (int j = 1; j < count; ++j)
      for (int k = 0; k < 2; ++k) sum[k] += w[j] * load4(in[j] + i + 4 * k);
    for (int k = 0; k < 2; ++k) *reinterpret_cast<Vector4*>(out + i + 4 * k) = sum[k];
  }
}

template <bool Next>
RICOCHET_INLINE void update_general(long size, int count, double* const* x, const double* z, const double* weight,
                                    const double* next, double* combined) {
  check_count("update", count, most_lane_slots);
  double* slot[most_lane_slots];
  double w[most_lane_slots * most_lane_terms], c[most_lane_slots];
  for (int j = 0; j < count; ++j) {
    slot[j] = x[j];
    c[j] = Next ? next[j] : 0;
  }
  for (int e = 0; e < count * (count + 1); ++e) w[e] = weight[e];
  for (long i = 0; i < size; i += 8) {
    Vector4 old[most_lane_terms][2], combination[2] = {};
    for (int j = 0; j <= count; ++j)
      for (int k = 0; k < 2; ++k) old[j][k] = load4((j < count ? slot[j] : z) + i + 4 * k);
    for (int j = 0; j < count; ++j) {
      const double* of = w + j * (count + 1);
      Vector4 fresh[2];
      for (int k = 0; k < 2; ++k) fresh[k] = Vector4{} + of[0] * old[0][k];
      for (int s = 1; s <= count; ++s)
        for (int k = 0; k < 2; ++k) fresh[k] += of[s] * old[s][k];
      for (int k = 0; k < 2; ++k) {
        *reinterpret_cast<Vector4*>(slot[j] + i + 4 * k) = fresh[k];
        if (Next) combination[k] += c[j] * fresh[k];
      }
    }
    if (Next)
      for (int k = 0; k < 2; ++k) *reinterpret_cast<Vector4*>(combined + i + 4 * k) = combination[k];
  }
}

RICOCHET_INLINE void combine_any(long size, int count, const double* const* x, const double* weight, double* out) {
  switch (count) {
    case 1:
      return combine_body<1>(size, x, weight, out);
    case 2:
      return combine_body<2>(size, x, weight, out);
    case 3:
      return combine_body<3>(size, x, weight, out);
    default:
      return combine_body<4>(size, x, weight, out);
  }
}
template <bool Next>
RICOCHET_INLINE void update_any(long size, int count, double* const* x, const double* z, const double* weight,
                                const double* next, double* combined) {
  if (only_increments(count, weight)) return update_increments<Next>(size, x, z, next, combined);
  switch (count) {
    case 1:
      return update_body<1, Next>(size, x, z, weight, next, combined);
    case 2:
      return update_body<2, Next>(size, x, z, weight, next, combined);
    case 3:
      return update_body<3, Next>(size, x, z, weight, next, combined);
    default:
      return update_body<4, Next>(size, x, z, weight, next, combined);
  }
}

}  // namespace ricochet::lane_bodies
