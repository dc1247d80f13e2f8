#pragma once
#include <ricochet/kernels/lane_vectors.hpp>

/// \file
/// The free step of a band operator: products with K and M, load shape, and substitution through L D Lᵀ.
namespace ricochet::lane_bodies {

template <int T, int W, bool Add>
RICOCHET_INLINE void product_row(const double* a, int stride, const V<T>* in, const V<T>* out, V<T>* sum) {
  for (int k = 0; k < Row<T>::count; ++k) sum[k] = (Add ? out[k] : V<T>{}) + a[0] * in[k];
#pragma GCC unroll 16
  for (int s = 1; s < (W >= 0 ? 2 * W + 1 : stride); ++s) {
    for (int k = 0; k < Row<T>::count; ++k) sum[k] += a[s] * in[s * Row<T>::count + k];
    keep_order<T, W>(sum);
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
    if (step.factor && step.K && !step.M && !step.C && !step.load && !step.from && step.product_width == 3 &&
        step.solve_width == 3) {
      fused_forward<T, 3, 3>(step);
      return backward<T, 3>(step.rows, 3, step.factor, step.z);
    }
  if (step.K)
    product_any<T, false>(step.rows, step.product_width, step.K, step.k, step.b);
  else
    for (long i = 0; i < static_cast<long>(step.rows) * Row<T>::lanes; ++i) step.b[i] = 0;
  if (step.M) product_any<T, true>(step.rows, step.product_width, step.M, step.m, step.b);
  if (step.C) product_any<T, true>(step.rows, step.damping_width, step.C, step.c, step.b);
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

}  // namespace ricochet::lane_bodies
