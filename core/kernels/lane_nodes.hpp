#pragma once
#include <ricochet/kernels/band_ldlt.hpp>
#include <ricochet/kernels/lane_vectors.hpp>

/// \file
/// The free step by nodes, see NodeStep. What a node's rows need of their neighbours stays in registers, so that a pass
/// reads and writes each row once.
namespace ricochet::lane_bodies {

/// Two rows of a node, of `G` vectors of lanes each.
template <int T, int G>
struct NodeRows {
  V<T> w[G], t[G];
};

// Rows 2a and 2a + 1 of k, of the slots as they are after the update. With `Test` also what these give to the measure
// of the point there: the way up then need not read their rows.
template <int T, int G, bool Update, bool Test>
RICOCHET_INLINE void combined_rows(const NodeStep& step, long a, long first, NodeRows<T, G>& out) {
#pragma GCC unroll 2
  for (long i = 0; i < 2; ++i) {
    V<T>* to = i == 0 ? out.w : out.t;
    if constexpr (Update) {
      const IncrementUpdate& update = *step.update;
      const V<T>* z = row<T>(update.last, 2 * a + i) + first;
      V<T>*q = row<T>(update.x[0], 2 * a + i) + first, *d = row<T>(update.x[1], 2 * a + i) + first;
#pragma GCC unroll 2
      for (int k = 0; k < G; ++k) {
        const V<T> increment = d[k] + z[k], position = q[k] + increment;
        d[k] = increment;
        q[k] = position;
        V<T> sum = V<T>{} + update.next[0] * position;
        sum += update.next[1] * increment;
        to[k] = sum;
        if constexpr (Test)
          if (i == 0 && step.point[a] >= 0) {
            V<T> measure = V<T>{} + step.test->weight[0] * position;
            measure += step.test->weight[1] * increment;
            (row<T>(step.test->y, step.point[a]) + first)[k] = measure;
          }
      }
    } else {
      const V<T>* k_row = row<T>(step.k, 2 * a + i) + first;
#pragma GCC unroll 2
      for (int k = 0; k < G; ++k) to[k] = k_row[k];
    }
  }
}

// K k + shape·scale of one row, and what substitution takes off it, nearest last.
template <int T, int G>
RICOCHET_INLINE void product_of(const double* c, const NodeRows<T, G>& before, const NodeRows<T, G>& here,
                                const NodeRows<T, G>& after, V<T>* sum) {
#pragma GCC unroll 2
  for (int k = 0; k < G; ++k) {
    sum[k] = V<T>{} + c[0] * before.w[k];
    sum[k] += c[1] * before.t[k];
    sum[k] += c[2] * here.w[k];
    sum[k] += c[3] * here.t[k];
    sum[k] += c[4] * after.w[k];
    sum[k] += c[5] * after.t[k];
  }
}
template <int T, int G>
RICOCHET_INLINE void take(double l, const V<T>* y, V<T>* sum) {
#pragma GCC unroll 2
  for (int k = 0; k < G; ++k) sum[k] -= l * y[k];
}
template <int T, int G>
RICOCHET_INLINE void put(const V<T>* from, V<T>* to) {
#pragma GCC unroll 2
  for (int k = 0; k < G; ++k) to[k] = from[k];
}

// Forward substitution of node a: w, r and t are those of the node before, then its own.
template <int T, int G, bool Border>
RICOCHET_INLINE void substitute_down(const NodeStep& step, long a, long first, const double* l, V<T>* w, V<T>* r,
                                     V<T>* t, V<T>* next_w, V<T>* next_t) {
  if constexpr (Border) {
    V<T> next_r[G] = {};
    take<T, G>(l[0], w, next_w);
    take<T, G>(l[1], r, next_w);
    take<T, G>(l[2], t, next_w);
    take<T, G>(l[3], w, next_r);
    take<T, G>(l[4], r, next_r);
    take<T, G>(l[5], t, next_r);
    take<T, G>(l[6], next_w, next_r);
    take<T, G>(l[7], w, next_t);
    take<T, G>(l[8], r, next_t);
    take<T, G>(l[9], t, next_t);
    take<T, G>(l[10], next_w, next_t);
    take<T, G>(l[11], next_r, next_t);
    put<T, G>(next_r, r);
    put<T, G>(r, row<T>(step.r, a) + first);
  } else {
    take<T, G>(l[0], w, next_w);
    take<T, G>(l[1], t, next_w);
    take<T, G>(l[2], w, next_t);
    take<T, G>(l[3], t, next_t);
    take<T, G>(l[4], next_w, next_t);
  }
  put<T, G>(next_w, w);
  put<T, G>(next_t, t);
  put<T, G>(w, row<T>(step.z, 2 * a) + first);
  put<T, G>(t, row<T>(step.z, 2 * a + 1) + first);
}

// Down the nodes: update, product, forward substitution.
template <int T, int G, bool Border, bool Update, bool Test>
RICOCHET_INLINE void nodes_down(const NodeStep& step, long first) {
  constexpr int stride = node_down_stride(Border);
  NodeRows<T, G> before = {}, here, after;
  V<T> w[G] = {}, r[G] = {}, t[G] = {}, scale[G];
  put<T, G>(row<T>(step.scale, 0) + first, scale);
  combined_rows<T, G, Update, Test>(step, 0, first, here);
  const double* c = step.down;
  for (long a = 0; a < step.nodes; ++a, c += stride) {
    if (a + 1 < step.nodes)
      combined_rows<T, G, Update, Test>(step, a + 1, first, after);
    else
      after = {};
    V<T> next_w[G], next_t[G];
    product_of<T, G>(c, before, here, after, next_w);
    product_of<T, G>(c + 6, before, here, after, next_t);
#pragma GCC unroll 2
    for (int k = 0; k < G; ++k) {
      next_w[k] += c[12] * scale[k];
      next_t[k] += c[13] * scale[k];
    }
    before = here;
    here = after;
    substitute_down<T, G, Border>(step, a, first, c + 14, w, r, t, next_w, next_t);
  }
}

// The same of one lane: products by vectors of four rows, which need not wait for the substitution of those before.
template <bool Border>
RICOCHET_INLINE void nodes_down_alone(const NodeStep& step) {
  constexpr int stride = node_down_stride(Border);
  const long rows = 2L * step.nodes;
  double w = 0, r = 0, t = 0;
  const double scale = step.scale[0];
  const double* l = step.down + 14;
  alignas(32) double b[4];
  for (long i = 0; i < rows; i += 4) {
    Vector4 sum = Vector4{} + loadu4(step.K + i) * loadu4(step.k + i - 3);
#pragma GCC unroll 8
    for (int s = 1; s < 7; ++s) sum += loadu4(step.K + s * rows + i) * loadu4(step.k + i - 3 + s);
    sum += scale * loadu4(step.shape + i);
    *reinterpret_cast<Vector4*>(b) = sum;
    substitute_down<1, 1, Border>(step, i / 2, 0, l, &w, &r, &t, b, b + 1);
    if (i + 2 < rows) substitute_down<1, 1, Border>(step, i / 2 + 1, 0, l + stride, &w, &r, &t, b + 2, b + 3);
    l += 2 * stride;
  }
}

template <int T, int G>
RICOCHET_INLINE void divide(const V<T>* y, double by, V<T>* sum) {
#pragma GCC unroll 2
  for (int k = 0; k < G; ++k) sum[k] = V<T>{} + y[k] * by;
}

// One point of a node, while its deflection is in registers.
template <int T, int G, bool Begun>
RICOCHET_INLINE void test_point(const NodeStep& step, long a, long first, const V<T>* z, Inside<T>* inside) {
  const int point = step.point[a];
  if (point < 0) return;
  constexpr int per = Row<T>::lanes / Row<T>::count;
  const PointTest& test = *step.test;
  const long place = static_cast<long>(point) * Row<T>::lanes + first * per;
  V<T>* y = row<T>(test.y, point) + first;
#pragma GCC unroll 2
  for (int k = 0; k < G; ++k) {
    V<T> sum, total = (row<T>(test.offset, 0) + first)[k];
    if constexpr (Begun) {
      sum = y[k];
    } else {
      sum = V<T>{} + test.weight[0] * (row<T>(test.x[0], 2 * a) + first)[k];
      sum += test.weight[1] * (row<T>(test.x[1], 2 * a) + first)[k];
    }
    sum += test.weight[2] * z[k];
    total += step.value[a] * sum;
    y[k] = total;
    inside[k].test(total, test.lower + place + k * per, test.upper + place + k * per);
  }
}

// One lane, a point at every node: by vectors of four points, last ones first, which are there first.
RICOCHET_INLINE void test_points_alone(const NodeStep& step) {
  const PointTest test = *step.test;
  const double offset = test.offset[0];
  const long points = step.nodes, whole = points / 4 * 4;
  Inside<1> rest;
  for (long a = points - 1; a >= whole; --a) {
    double sum = 0.0 + test.weight[0] * test.x[0][2 * a], total = offset;
    sum += test.weight[1] * test.x[1][2 * a];
    sum += test.weight[2] * step.z[2 * a];
    total += step.value[a] * sum;
    test.y[a] = total;
    rest.test(total, test.lower + a, test.upper + a);
  }
  const auto deflections = [](const double* x, long a) __attribute__((always_inline)) {
    return __builtin_shufflevector(loadu4(x + 2 * a), loadu4(x + 2 * a + 4), 0, 2, 4, 6);
  };
  Inside<4> inside;
  for (long a = whole - 4; a >= 0; a -= 4) {
    Vector4 sum = Vector4{} + test.weight[0] * deflections(test.x[0], a), total = Vector4{} + offset;
    sum += test.weight[1] * deflections(test.x[1], a);
    sum += test.weight[2] * deflections(step.z, a);
    total += loadu4(step.value + a) * sum;
    *reinterpret_cast<Vector4*>(test.y + a) = total;
    inside.test(total, test.lower + a, test.upper + a);
  }
  step.test->outside = outside_lanes<1, 1>(&rest, 0) | (outside_lanes<4, 1>(&inside, 0) != 0);
}

// 1/D and backward substitution of node a: w, r and t are those of the node after, then its own.
template <int T, int G, bool Border>
RICOCHET_INLINE void substitute_up(const NodeStep& step, long a, long first, const double* u, V<T>* w, V<T>* r,
                                   V<T>* t) {
  V<T> next_w[G], next_t[G];
  V<T>*out_w = row<T>(step.z, 2 * a) + first, *out_t = row<T>(step.z, 2 * a + 1) + first;
  divide<T, G>(out_t, u[0], next_t);
  if constexpr (Border) {
    V<T> next_r[G];
    take<T, G>(u[1], t, next_t);
    take<T, G>(u[2], r, next_t);
    take<T, G>(u[3], w, next_t);
    divide<T, G>(row<T>(step.r, a) + first, u[4], next_r);
    take<T, G>(u[5], t, next_r);
    take<T, G>(u[6], r, next_r);
    take<T, G>(u[7], w, next_r);
    take<T, G>(u[8], next_t, next_r);
    divide<T, G>(out_w, u[9], next_w);
    take<T, G>(u[10], t, next_w);
    take<T, G>(u[11], r, next_w);
    take<T, G>(u[12], w, next_w);
    take<T, G>(u[13], next_t, next_w);
    take<T, G>(u[14], next_r, next_w);
    put<T, G>(next_r, r);
  } else {
    take<T, G>(u[1], t, next_t);
    take<T, G>(u[2], w, next_t);
    divide<T, G>(out_w, u[3], next_w);
    take<T, G>(u[4], t, next_w);
    take<T, G>(u[5], w, next_w);
    take<T, G>(u[6], next_t, next_w);
  }
  put<T, G>(next_w, w);
  put<T, G>(next_t, t);
  put<T, G>(w, out_w);
  put<T, G>(t, out_t);
}

// Up the nodes: backward substitution, measures.
template <int T, int G, bool Border, bool Test, bool Begun>
RICOCHET_INLINE void nodes_up(const NodeStep& step, long first) {
  constexpr int stride = node_up_stride(Border);
  V<T> w[G] = {}, r[G] = {}, t[G] = {};
  Inside<T> inside[G];
  const double* u = step.up + static_cast<long>(step.nodes - 1) * stride;
  for (long a = step.nodes - 1; a >= 0; --a, u -= stride) {
    substitute_up<T, G, Border>(step, a, first, u, w, r, t);
    if constexpr (Test) test_point<T, G, Begun>(step, a, first, w, inside);
  }
  if constexpr (Test) step.test->outside |= outside_lanes<T, G>(inside, first);
}

// The same of one lane, with the sums of its squares. Those of two nodes are taken at once, while the substitution
// waits for itself.
template <bool Border, bool Test>
RICOCHET_INLINE void nodes_up_summed(const NodeStep& step) {
  constexpr int stride = node_up_stride(Border);
  double w = 0, r = 0, t = 0;
  Inside<1> inside;
  SquaresUp<3> squares(*step.sum, (step.nodes + 1) / 2);
  const double* u = step.up + static_cast<long>(step.nodes - 1) * stride;
  const auto next = [&](long a) __attribute__((always_inline)) {
    substitute_up<1, 1, Border>(step, a, 0, u, &w, &r, &t);
    if constexpr (Test) test_point<1, 1, false>(step, a, 0, &w, &inside);
    u -= stride;
  };
  long a = step.nodes - 1;
  if (step.nodes % 2 == 1) {
    next(a);
    squares.add(Vector4{w, t, 0, 0}, Vector4{step.sum->x[2 * a], step.sum->x[2 * a + 1], 0, 0});
    --a;
  }
  for (; a >= 0; a -= 2) {
    next(a);
    const double later_w = w, later_t = t;
    next(a - 1);
    squares.add(Vector4{w, t, later_w, later_t}, loadu4(step.sum->x + 2 * a - 2));
  }
  squares.finish(*step.sum);
  if constexpr (Test) step.test->outside |= outside_lanes<1, 1>(&inside, 0);
}

template <int T, bool Border>
RICOCHET_INLINE void node_step_of(const NodeStep& step) {
  // As many vectors at once as leave the neighbours in registers: of these there are 32 with vectors of eight, else 16.
  constexpr int G = T > wide_rows && Row<T>::count > 1 ? 2 : 1;
  for (long first = 0; first < Row<T>::count; first += G) {
    if (step.update && step.test) {
      nodes_down<T, G, Border, true, true>(step, first);
      nodes_up<T, G, Border, true, true>(step, first);
      continue;
    }
    if (step.update)
      nodes_down<T, G, Border, true, false>(step, first);
    else
      nodes_down<T, G, Border, false, false>(step, first);
    if (step.test)
      nodes_up<T, G, Border, true, false>(step, first);
    else
      nodes_up<T, G, Border, false, false>(step, first);
  }
}

// An update made apart, by vectors of rows, is faster for one lane: k is what comes of it.
template <bool Border>
RICOCHET_INLINE void node_step_alone(const NodeStep& step) {
  if (step.update)
    nodes_down<1, 1, Border, true, false>(step, 0);
  else
    nodes_down_alone<Border>(step);
  const bool points = step.test && !step.everywhere;
  if (step.sum)
    points ? nodes_up_summed<Border, true>(step) : nodes_up_summed<Border, false>(step);
  else if (points)
    nodes_up<1, 1, Border, true, false>(step, 0);
  else
    nodes_up<1, 1, Border, false, false>(step, 0);
  if (step.test && step.everywhere) test_points_alone(step);
}

template <int T>
RICOCHET_INLINE void node_step_body(const NodeStep& described) {
  // A copy: what is stored through these pointers could otherwise be the pointers themselves.
  const NodeStep step = described;
  if (step.test) step.test->outside = 0;
  if constexpr (T == 1)
    step.border ? node_step_alone<true>(step) : node_step_alone<false>(step);
  else
    step.border ? node_step_of<T, true>(step) : node_step_of<T, false>(step);
}

}  // namespace ricochet::lane_bodies
