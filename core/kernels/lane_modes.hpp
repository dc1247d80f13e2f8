#pragma once
#include <ricochet/kernels/lane_vectors.hpp>
#include <type_traits>

/// \file
/// Steps of modes, see ModeStep and ModeRun: a mode is read and written once per step.
namespace ricochet::lane_bodies {

/// What the point reads, by modes i mod 8, in G vectors of lanes.
template <int T, int G>
struct PointSums {
  V<T> sum[8][G] = {};
  RICOCHET_INLINE void add(int i, int k, const double* c, const V<T>& position, const V<T>& increment) {
    sum[i][k] += c[3] * position;
    sum[i][k] += c[4] * increment;
  }
  RICOCHET_INLINE V<T> total(int k) const {
    return ((sum[0][k] + sum[4][k]) + (sum[2][k] + sum[6][k])) + ((sum[1][k] + sum[5][k]) + (sum[3][k] + sum[7][k]));
  }
};

/// `one`(i mod 8, i) of each mode, the first a constant.
template <class One>
RICOCHET_INLINE void by_eights(long rows, One&& one) {
  long begin = 0;
  for (; begin + 8 <= rows; begin += 8)
#pragma GCC unroll 8
    for (int r = 0; r < 8; ++r) one(r, begin + r);
#pragma GCC unroll 7
  for (int r = 0; r < 7; ++r)
    if (begin + r < rows) one(r, begin + r);
}

// Vectors of lanes that sums by eight leave registers for.
template <int T>
constexpr int groups_at_once = T > wide_rows&& Row<T>::count > 1 ? 2 : 1;

// The same of one lane, modes side by side.
struct PointSum {
  Vector4 sum[2] = {};
  RICOCHET_INLINE double total() const {
    const Vector4 all = sum[0] + sum[1];
    return (all[0] + all[2]) + (all[1] + all[3]);
  }
};

/// The numbers of one lane's modes by columns.
struct ModeColumns {
  const double *of_q, *of_d, *of_scale, *to_point_q, *to_point_d;
  RICOCHET_INLINE explicit ModeColumns(const Modes& modes) {
    const long stride = (modes.rows + 7) / 8 * 8;
    of_q = modes.coefficient;
    of_d = of_q + stride;
    of_scale = of_d + stride;
    to_point_q = of_scale + stride;
    to_point_d = to_point_q + stride;
  }
  RICOCHET_INLINE Vector4 unknown(long i, double scale, const Vector4& position, const Vector4& increment) const {
    Vector4 z = Vector4{} + scale * load4(of_scale + i);
    z += load4(of_q + i) * position;
    z += load4(of_d + i) * increment;
    return z;
  }
  RICOCHET_INLINE void add(long i, Vector4& sum, const Vector4& position, const Vector4& increment) const {
    sum += load4(to_point_q + i) * position;
    sum += load4(to_point_d + i) * increment;
  }
};

template <int T, int G, bool Update, bool Test>
RICOCHET_INLINE void modes_of(const ModeStep& step, long first) {
  V<T> scale[G];
  for (int k = 0; k < G; ++k) scale[k] = row<T>(step.scale, 0)[first + k];
  PointSums<T, G> point;
  const long rows = step.modes.rows;
  by_eights(
      rows, [&](int r, long i) __attribute__((always_inline)) {
        const double* c = step.modes.coefficient + Modes::numbers * i;
#pragma GCC unroll 4
        for (int k = 0; k < G; ++k) {
          V<T> position, increment;
          if constexpr (Update) {
            V<T>*q = row<T>(step.update->x[0], i) + first, *d = row<T>(step.update->x[1], i) + first;
            increment = d[k] + (row<T>(step.update->last, i) + first)[k];
            position = q[k] + increment;
            d[k] = increment;
            q[k] = position;
          } else {
            position = (row<T>(step.x[0], i) + first)[k];
            increment = (row<T>(step.x[1], i) + first)[k];
          }
          V<T> z = V<T>{} + c[2] * scale[k];
          z += c[0] * position;
          z += c[1] * increment;
          (row<T>(step.z, i) + first)[k] = z;
          if constexpr (Test) point.add(r, k, c, position, increment);
        }
      });
  if constexpr (Test) {
    constexpr int per = Row<T>::lanes / Row<T>::count;
    Inside<T> inside[G];
    for (int k = 0; k < G; ++k) {
      const long place = (first + k) * per;
      V<T> y = row<T>(step.test->offset, 0)[first + k];
      y += step.modes.direct * scale[k];
      y = point.total(k) + y;
      row<T>(step.test->y, 0)[first + k] = y;
      inside[k].test(y, step.test->lower + place, step.test->upper + place);
    }
    step.test->outside |= outside_lanes<T, G>(inside, first);
  }
}

// One lane: by vectors of four modes.
template <bool Update, bool Test, Weights weights>
RICOCHET_INLINE void modes_alone(const ModeStep& step) {
  constexpr bool Sum = weights != Weights::none;
  const ModeColumns modes(step.modes);
  double *q = nullptr, *d = nullptr;
  const double *x = step.x[0], *y = step.x[1], *last = nullptr;
  if constexpr (Update) {
    q = step.update->x[0];
    d = step.update->x[1];
    last = step.update->last;
  }
  double* const z = step.z;
  const double scale = step.scale[0];
  const long rows = step.modes.rows;
  PointSum point;
  SquaresDown<weights> squares;
  if constexpr (Sum) squares = SquaresDown<weights>(*step.sum);
  // Four modes, all of them there but for the last ones.
  const auto four = [&](auto all, long i, Vector4& sum) __attribute__((always_inline)) {
    Vector4 position, increment;
    if constexpr (Update) {
      increment = load4(d + i) + load4(last + i);
      position = load4(q + i) + increment;
      *reinterpret_cast<Vector4*>(d + i) = increment;
      *reinterpret_cast<Vector4*>(q + i) = position;
    } else {
      position = load4(x + i);
      increment = load4(y + i);
    }
    const Vector4 unknown = modes.unknown(i, scale, position, increment);
    *reinterpret_cast<Vector4*>(z + i) = unknown;
    if constexpr (Sum) squares.add(all ? 4 : rows - i, unknown, increment);
    if constexpr (Test) modes.add(i, sum, position, increment);
  };
  long i = 0;
  for (; i + 8 <= rows; i += 8) {
    four(std::true_type{}, i, point.sum[0]);
    four(std::true_type{}, i + 4, point.sum[1]);
  }
  if (i + 4 <= rows) {
    four(std::true_type{}, i, point.sum[0]);
    if (i + 4 < rows) four(std::false_type{}, i + 4, point.sum[1]);
  } else if (i < rows) {
    four(std::false_type{}, i, point.sum[0]);
  }
  if constexpr (Sum) squares.finish(*step.sum);
  if constexpr (Test) {
    Inside<1> inside;
    double measured = step.test->offset[0];
    measured += step.modes.direct * scale;
    measured = point.total() + measured;
    step.test->y[0] = measured;
    inside.test(measured, step.test->lower, step.test->upper);
    step.test->outside = outside_lanes<1, 1>(&inside, 0);
  }
}

template <int T, int G, bool Update, bool Test>
RICOCHET_INLINE void modes_at(const ModeStep& step, long first) {
  if constexpr (T == 1)
    !step.sum        ? modes_alone<Update, Test, Weights::none>(step)
    : step.sum->ones ? modes_alone<Update, Test, Weights::ones>(step)
                     : modes_alone<Update, Test, Weights::any>(step);
  else
    modes_of<T, G, Update, Test>(step, first);
}

template <int T>
RICOCHET_INLINE void mode_step_body(const ModeStep& step) {
  constexpr int G = groups_at_once<T>;
  if (step.test) step.test->outside = 0;
  for (long first = 0; first < Row<T>::count; first += G) {
    if (step.update && step.test)
      modes_at<T, G, true, true>(step, first);
    else if (step.update)
      modes_at<T, G, true, false>(step, first);
    else if (step.test)
      modes_at<T, G, false, true>(step, first);
    else
      modes_at<T, G, false, false>(step, first);
  }
}

// Step number s of a run for G vectors of lanes, or the test alone before it.
template <int T, int G, bool Move, bool Effort>
RICOCHET_INLINE std::uint32_t run_lanes(const ModeRun& run, long s, long first) {
  constexpr int per = Row<T>::lanes / Row<T>::count;
  const long next = Move ? s + 1 : s;
  V<T> scale[G], effort[G];
  for (int k = 0; k < G; ++k) {
    scale[k] = row<T>(run.scale, s)[first + k];
    if constexpr (Effort) effort[k] = row<T>(run.effort, 0)[first + k];
  }
  PointSums<T, G> point;
  const long rows = run.modes.rows;
  by_eights(
      rows, [&](int r, long i) __attribute__((always_inline)) {
        const double* c = run.modes.coefficient + Modes::numbers * i;
        V<T>*q = row<T>(run.x[0], i) + first, *d = row<T>(run.x[1], i) + first;
#pragma GCC unroll 4
        for (int k = 0; k < G; ++k) {
          V<T> position = q[k], increment = d[k];
          if constexpr (Move) {
            V<T> z = V<T>{} + c[2] * scale[k];
            z += c[0] * position;
            z += c[1] * increment;
            if constexpr (Effort) z += run.column[i] * effort[k];
            increment = increment + z;
            position = position + increment;
            d[k] = increment;
            q[k] = position;
          }
          point.add(r, k, c, position, increment);
        }
      });
  Inside<T> inside[G];
  for (int k = 0; k < G; ++k) {
    V<T> y = row<T>(run.offset, next)[first + k];
    y += run.modes.direct * row<T>(run.scale, next)[first + k];
    y = point.total(k) + y;
    row<T>(run.y, 0)[first + k] = y;
    inside[k].test(y, run.lower + (first + k) * per, run.upper + (first + k) * per);
  }
  return outside_lanes<T, G>(inside, first);
}

// The same of one lane.
template <bool Move, bool Effort>
RICOCHET_INLINE std::uint32_t run_alone(const ModeRun& run, long s) {
  const ModeColumns modes(run.modes);
  const long next = Move ? s + 1 : s;
  const double scale = run.scale[s];
  double *q = run.x[0], *d = run.x[1];
  PointSum point;
  const auto four = [&](long i, Vector4& sum) __attribute__((always_inline)) {
    Vector4 position = load4(q + i), increment = load4(d + i);
    if constexpr (Move) {
      Vector4 z = modes.unknown(i, scale, position, increment);
      if constexpr (Effort) z += run.effort[0] * load4(run.column + i);
      increment = increment + z;
      position = position + increment;
      *reinterpret_cast<Vector4*>(d + i) = increment;
      *reinterpret_cast<Vector4*>(q + i) = position;
    }
    modes.add(i, sum, position, increment);
  };
  for (long i = 0; i < run.modes.rows; i += 8) {
    four(i, point.sum[0]);
    four(i + 4, point.sum[1]);
  }
  double y = run.offset[next];
  y += run.modes.direct * run.scale[next];
  y = point.total() + y;
  run.y[0] = y;
  Inside<1> inside;
  inside.test(y, run.lower, run.upper);
  return outside_lanes<1, 1>(&inside, 0);
}

template <int T, bool Move, bool Effort>
RICOCHET_INLINE std::uint32_t run_all(const ModeRun& run, long s) {
  if constexpr (T == 1) return run_alone<Move, Effort>(run, s);
  constexpr int G = groups_at_once<T>;
  std::uint32_t outside = 0;
  for (long first = 0; first < Row<T>::count; first += G) outside |= run_lanes<T, G, Move, Effort>(run, s, first);
  return outside;
}

template <int T>
RICOCHET_INLINE int mode_run_body(ModeRun& run) {
  if (run.steps == 0) {
    run.outside = run_all<T, false, false>(run, 0);
    return 0;
  }
  int s = 0;
  run.outside = 0;
  if (run.effort) run.outside = run_all<T, true, true>(run, s++);
  while (s < run.steps && run.outside == 0) run.outside = run_all<T, true, false>(run, s++);
  return s;
}

}  // namespace ricochet::lane_bodies
