#include <ricochet/algebra/lane_kernels.hpp>
#include <stdexcept>
#include <string>

// One body per kernel, force-inlined into a wrapper per instruction set. `a += b * c` contracts to one fused operation
// in each wrapper that has it, in scalar and in vector code alike, which is what makes lanes independent of their
// number.
#define RICOCHET_INLINE inline __attribute__((always_inline))
#define RICOCHET_AVX2 __attribute__((target("avx2,fma")))

namespace ricochet {
namespace {

typedef double Vector2 __attribute__((vector_size(16), may_alias));
typedef double Vector4 __attribute__((vector_size(32), may_alias));
typedef double Scalar __attribute__((may_alias));

template <int T>
struct Row {
  using V = Vector4;
  static constexpr int count = T / 4;
};
template <>
struct Row<2> {
  using V = Vector2;
  static constexpr int count = 1;
};
template <>
struct Row<1> {
  using V = Scalar;
  static constexpr int count = 1;
};

template <int T>
using V = typename Row<T>::V;

template <int T>
RICOCHET_INLINE const V<T>* row(const double* block, long i) {
  return reinterpret_cast<const V<T>*>(block + i * T);
}
template <int T>
RICOCHET_INLINE V<T>* row(double* block, long i) {
  return reinterpret_cast<V<T>*>(block + i * T);
}

// Blocks start on 64 bytes, but a row of T = 1 need not start on 32.
RICOCHET_INLINE Vector4 load4(const double* from) {
  return *reinterpret_cast<const Vector4*>(from);
}
typedef double Unaligned4 __attribute__((vector_size(32), may_alias, aligned(8)));
RICOCHET_INLINE Vector4 loadu4(const double* from) {
  return *reinterpret_cast<const Unaligned4*>(from);
}

// In a loop of unknown length over one lane the compiler would multiply in vectors and add one by one, unfused: this
// keeps each step of the sum where it is written.
template <int T, int W>
RICOCHET_INLINE void keep_order([[maybe_unused]] V<T>* sum) {
  if constexpr (T == 1 && W < 0) asm("" : "+x"(sum[0]));
}

template <int T, int W, bool Add>
RICOCHET_INLINE void product_row(const double* a, int stride, const V<T>* in, const V<T>* out, V<T>* sum) {
  for (int k = 0; k < Row<T>::count; ++k) sum[k] = (Add ? out[k] : V<T>{}) + a[0] * in[k];
#pragma GCC unroll 16
  for (int s = 1; s < (W >= 0 ? 2 * W + 1 : stride); ++s) {
    for (int k = 0; k < Row<T>::count; ++k) sum[k] += a[s] * in[s * Row<T>::count + k];
    keep_order<T, W>(sum);
  }
}

// Out of the way of the loops.
[[noreturn, gnu::cold, gnu::noinline]] void refuse_count(const char* kernel, int count, int most) {
  throw std::logic_error(std::string("the kernel '") + kernel + "' takes 1 to " + std::to_string(most) +
                         " blocks, not " + std::to_string(count));
}
RICOCHET_INLINE void check_count(const char* kernel, int count, int most) {
  if (count < 1 || count > most) refuse_count(kernel, count, most);
}

// Elementwise kernels do not see lanes: they run over whole blocks, four doubles at a time (blocks are padded to 64
// bytes).
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
  check_count("combine", count, most_lane_slots);
  const double* in[most_lane_slots];
  double w[most_lane_slots];
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

// y = A x (+ y): rows of A contiguous, or diagonals contiguous for one lane, where rows vectorise instead of lanes.
template <int T, int W, bool Add>
RICOCHET_INLINE void product_body(int rows, int half_width, const double* band, const double* x, double* y) {
  const int w = W >= 0 ? W : half_width;
  const int stride = 2 * w + 1;
  if constexpr (T == 1) {
    long i = 0;
    for (; i + 4 <= rows; i += 4) {
      Vector4 sum = (Add ? load4(y + i) : Vector4{}) + loadu4(band + i) * loadu4(x + i - w);
#pragma GCC unroll 16
      for (int s = 1; s < stride; ++s) sum += loadu4(band + s * static_cast<long>(rows) + i) * loadu4(x + i - w + s);
      *reinterpret_cast<Vector4*>(y + i) = sum;
    }
    for (; i < rows; ++i) {
      double sum = (Add ? y[i] : 0.0) + band[i] * x[i - w];
      for (int s = 1; s < stride; ++s) {
        sum += band[s * static_cast<long>(rows) + i] * x[i - w + s];
        asm("" : "+x"(sum));
      }
      y[i] = sum;
    }
  } else {
    for (long i = 0; i < rows; ++i) {
      V<T> sum[Row<T>::count];
      product_row<T, W, Add>(band + i * stride, stride, row<T>(x, i - w), row<T>(y, i), sum);
      for (int k = 0; k < Row<T>::count; ++k) row<T>(y, i)[k] = sum[k];
    }
  }
}

template <int T, int W>
RICOCHET_INLINE void forward_row(const double* l, int w, const V<T>* above, V<T>* sum) {
#pragma GCC unroll 8
  for (int s = 0; s < (W >= 0 ? W : w); ++s) {
    for (int k = 0; k < Row<T>::count; ++k) sum[k] -= l[s] * above[s * Row<T>::count + k];
    keep_order<T, W>(sum);
  }
}

template <int T, int W>
RICOCHET_INLINE void backward(int rows, int half_width, const double* factor, double* z) {
  const int w = W >= 0 ? W : half_width;
  const int stride = 2 * w + 1;
  for (long i = rows - 1; i >= 0; --i) {
    const double* u = factor + i * stride + w;
    V<T>* out = row<T>(z, i);
    V<T> sum[Row<T>::count];
    for (int k = 0; k < Row<T>::count; ++k) sum[k] = V<T>{} + out[k] * u[w];
      // Farthest first: the row just finished is needed last.
#pragma GCC unroll 8
    for (int s = w; s >= 1; --s) {
      for (int k = 0; k < Row<T>::count; ++k) sum[k] -= u[s - 1] * out[s * Row<T>::count + k];
      keep_order<T, W>(sum);
    }
    for (int k = 0; k < Row<T>::count; ++k) out[k] = sum[k];
  }
}

template <int T, int W>
RICOCHET_INLINE void forward(int rows, int half_width, const double* factor, const int* from, const double* b,
                             double* z) {
  const int w = W >= 0 ? W : half_width;
  const int stride = 2 * w + 1;
  for (long i = 0; i < rows; ++i) {
    const long source = from ? from[i] : i;
    V<T> sum[Row<T>::count];
    for (int k = 0; k < Row<T>::count; ++k) sum[k] = source >= 0 ? row<T>(b, source)[k] : V<T>{};
    forward_row<T, W>(factor + i * stride, w, row<T>(z, i - w), sum);
    for (int k = 0; k < Row<T>::count; ++k) row<T>(z, i)[k] = sum[k];
  }
}

// Product, load shape and forward substitution of a row while it is in registers.
template <int T, int W, int S>
RICOCHET_INLINE void fused_forward(const BandStep& step) {
  constexpr int stride = 2 * W + 1, solve_stride = 2 * S + 1;
  const double *K = step.K, *shape = step.shape, *factor = step.factor, *x = step.k;
  double* z = step.z;
  V<T> scale[Row<T>::count];
  for (int k = 0; k < Row<T>::count; ++k) scale[k] = shape ? row<T>(step.scale, 0)[k] : V<T>{};
  for (long i = 0; i < step.rows; ++i) {
    V<T> sum[Row<T>::count];
    product_row<T, W, false>(K + i * stride, stride, row<T>(x, i - W), row<T>(x, i), sum);
    if (shape)
      for (int k = 0; k < Row<T>::count; ++k) sum[k] += shape[i] * scale[k];
    forward_row<T, S>(factor + i * solve_stride, S, row<T>(z, i - S), sum);
    for (int k = 0; k < Row<T>::count; ++k) row<T>(z, i)[k] = sum[k];
  }
}

template <int T, bool Add>
RICOCHET_INLINE void product_any(int rows, int w, const double* band, const double* x, double* y) {
  switch (w) {
    case 0:
      return product_body<T, 0, Add>(rows, w, band, x, y);
    case 1:
      return product_body<T, 1, Add>(rows, w, band, x, y);
    case 3:
      return product_body<T, 3, Add>(rows, w, band, x, y);
    default:
      return product_body<T, -1, Add>(rows, w, band, x, y);
  }
}

template <int T>
RICOCHET_INLINE void add_column_body(int rows, const double* column, const double* scale, double* y) {
  V<T> a[Row<T>::count];
  for (int k = 0; k < Row<T>::count; ++k) a[k] = row<T>(scale, 0)[k];
  for (long i = 0; i < rows; ++i)
    for (int k = 0; k < Row<T>::count; ++k) row<T>(y, i)[k] += column[i] * a[k];
}

template <int T, int S>
RICOCHET_INLINE void solve_body(const BandStep& step) {
  forward<T, S>(step.solve_rows, step.solve_width, step.factor, step.from, step.b, step.z);
  backward<T, S>(step.solve_rows, step.solve_width, step.factor, step.z);
}

template <int T>
RICOCHET_INLINE void band_step_body(const BandStep& step) {
  if constexpr (T >= 2)
    if (step.factor && step.K && !step.M && !step.load && !step.from && step.product_width == 3 &&
        step.solve_width == 3) {
      fused_forward<T, 3, 3>(step);
      return backward<T, 3>(step.rows, 3, step.factor, step.z);
    }
  if (step.K)
    product_any<T, false>(step.rows, step.product_width, step.K, step.k, step.b);
  else
    for (long i = 0; i < static_cast<long>(step.rows) * T; ++i) step.b[i] = 0;
  if (step.M) product_any<T, true>(step.rows, step.product_width, step.M, step.m, step.b);
  if (step.shape) add_column_body<T>(step.rows, step.shape, step.scale, step.b);
  if (step.load)
    for (long i = 0; i < step.rows; ++i)
      for (int k = 0; k < Row<T>::count; ++k) row<T>(step.b, i)[k] += step.load[i];
  if (!step.factor) return;
  switch (step.solve_width) {
    case 0:
      return solve_body<T, 0>(step);
    case 1:
      return solve_body<T, 1>(step);
    case 3:
      return solve_body<T, 3>(step);
    case 5:
      return solve_body<T, 5>(step);
    default:
      return solve_body<T, -1>(step);
  }
}

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
  if constexpr (T == 1) {
    bool outside = false;
    // Written so that a value that is no number counts as outside.
    for (long i = 0; i < rows; ++i) outside |= !((y[i] >= lower[i]) & (y[i] <= upper[i]));
    return outside;
  } else {
    using Mask = decltype(V<T>{} < V<T>{});
    Mask inside[Row<T>::count];
    for (int k = 0; k < Row<T>::count; ++k) inside[k] = V<T>{} == V<T>{};
    for (long i = 0; i < rows; ++i)
      for (int k = 0; k < Row<T>::count; ++k) {
        const V<T> value = row<T>(y, i)[k];
        inside[k] &= (value >= row<T>(lower, i)[k]) & (value <= row<T>(upper, i)[k]);
      }
    constexpr int per = T / Row<T>::count;
    std::uint32_t mask = 0;
    for (int l = 0; l < T; ++l) mask |= static_cast<std::uint32_t>(inside[l / per][l % per] == 0) << l;
    return mask;
  }
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

constexpr int written_slots = 4, written_terms = 5;
RICOCHET_INLINE bool written(int count, int most) {
  return count >= 1 && count <= most;
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

// The wrappers: one set per instruction set. What any count may ask for stands apart, out of the way of the registers
// of the usual ones.
// clang-format off
#define RICOCHET_KERNEL_SET(NAME, TARGET)                                                                              \
  template <int T>                                                                                                     \
  struct NAME {                                                                                                        \
    TARGET [[gnu::noinline]] static void combine_many(long n, int c, const double* const* x, const double* w, double* o) {\
      combine_general(n, c, x, w, o);                                                                                  \
    }                                                                                                                  \
    TARGET static void combine(long n, int c, const double* const* x, const double* w, double* o) {                    \
      if (!written(c, written_slots)) return combine_many(n, c, x, w, o);                                              \
      combine_any(n, c, x, w, o);                                                                                      \
    }                                                                                                                  \
    TARGET [[gnu::noinline]] static void update_many(long n, int c, double* const* x, const double* z, const double* w,\
                                                     const double* next, double* o) {                                  \
      if (next) update_general<true>(n, c, x, z, w, next, o);                                                          \
      else update_general<false>(n, c, x, z, w, next, o);                                                              \
    }                                                                                                                  \
    TARGET static void update(long n, int c, double* const* x, const double* z, const double* w, const double* next,   \
                              double* o) {                                                                             \
      if (!written(c, written_slots)) return update_many(n, c, x, z, w, next, o);                                      \
      if (next) update_any<true>(n, c, x, z, w, next, o);                                                              \
      else update_any<false>(n, c, x, z, w, next, o);                                                                  \
    }                                                                                                                  \
    TARGET static void band_step(const BandStep& step) { band_step_body<T>(step); }                                    \
    TARGET [[gnu::noinline]] static void diagonal_many(int n, int c, const double* f, const double* const* x,          \
                                                       const double* a, double* z) {                                   \
      diagonal_general<T>(n, c, f, x, a, z);                                                                           \
    }                                                                                                                  \
    TARGET static void diagonal_step(int n, int c, const double* f, const double* const* x, const double* a, double* z) {\
      if (!written(c, written_slots)) return diagonal_many(n, c, f, x, a, z);                                          \
      diagonal_any<T>(n, c, f, x, a, z);                                                                               \
    }                                                                                                                  \
    TARGET [[gnu::noinline]] static void measure_many(const LaneRows& h, int c, const double* const* x, const double* w,\
                                                      const double* o, double* y) {                                    \
      measure_general<T>(h, c, x, w, o, y);                                                                            \
    }                                                                                                                  \
    TARGET static void measure(const LaneRows& h, int c, const double* const* x, const double* w, const double* o,     \
                               double* y) {                                                                            \
      if (!written(c, written_terms)) return measure_many(h, c, x, w, o, y);                                           \
      measure_any<T>(h, c, x, w, o, y);                                                                                \
    }                                                                                                                  \
    TARGET static void add_column(int n, const double* s, const double* a, double* y) { add_column_body<T>(n, s, a, y); } \
    TARGET static std::uint32_t outside(int n, const double* y, const double* l, const double* u) {                    \
      return outside_body<T>(n, y, l, u);                                                                              \
    }                                                                                                                  \
    TARGET static double triple_product(long n, const double* a, const double* x, const double* y) {                   \
      return triple_product_body(n, a, x, y);                                                                          \
    }                                                                                                                  \
    static constexpr LaneKernels table{combine, update,  band_step, diagonal_step, measure, add_column,                 \
                                       outside, triple_product};                                                       \
  };
// clang-format on

RICOCHET_KERNEL_SET(Baseline, )
RICOCHET_KERNEL_SET(Avx2, RICOCHET_AVX2)

template <template <int> class Set>
const LaneKernels& select(int lanes) {
  switch (lanes) {
    case 1:
      return Set<1>::table;
    case 2:
      return Set<2>::table;
    case 4:
      return Set<4>::table;
    case 8:
      return Set<8>::table;
    case 16:
      return Set<16>::table;
    case 32:
      return Set<32>::table;
    default:
      throw std::logic_error("a block has 1, 2, 4, 8, 16 or 32 lanes");
  }
}

bool has_avx2() {
  static const bool has = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return has;
}

}  // namespace

const LaneKernels& lane_kernels(int lanes, bool baseline) {
  return has_avx2() && !baseline ? select<Avx2>(lanes) : select<Baseline>(lanes);
}

int lane_width(int lanes) {
  for (int width = 1; width <= 32; width *= 2)
    if (lanes <= width) return width;
  throw std::logic_error("a block holds at most 32 lanes");
}

const char* lane_instruction_set() {
  return has_avx2() ? "AVX2 + FMA" : "baseline";
}

}  // namespace ricochet
