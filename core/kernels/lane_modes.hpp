#pragma once
#include <ricochet/kernels/lane_vectors.hpp>
#include <type_traits>

/// \file
/// The free step of modes, see ModeStep: a mode is read and written once per step.
namespace ricochet::lane_bodies {

template <int T, int G, bool Update, bool Test>
RICOCHET_INLINE void modes_of(const ModeStep& step, long first) {
  V<T> scale[G], total[G];
  for (int k = 0; k < G; ++k) {
    scale[k] = row<T>(step.scale, 0)[first + k];
    if constexpr (Test) total[k] = row<T>(step.test->offset, 0)[first + k];
  }
  double weight[3] = {};
  if constexpr (Test)
    for (int j = 0; j < 3; ++j) weight[j] = step.test->weight[j];
  for (long i = 0; i < step.rows; ++i) {
    const double* c = step.coefficient + 3 * i;
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
      if constexpr (Test) {
        V<T> sum = V<T>{} + weight[0] * position;
        sum += weight[1] * increment;
        sum += weight[2] * z;
        total[k] += step.value[i] * sum;
      }
    }
  }
  if constexpr (Test) {
    constexpr int per = Row<T>::lanes / Row<T>::count;
    Inside<T> inside[G];
    for (int k = 0; k < G; ++k) {
      const long place = (first + k) * per;
      row<T>(step.test->y, 0)[first + k] = total[k];
      inside[k].test(total[k], step.test->lower + place, step.test->upper + place);
    }
    step.test->outside |= outside_lanes<T, G>(inside, first);
  }
}

// One lane: by vectors of four modes; the sum of the point takes them one by one, as for any number of lanes.
template <bool Update, bool Test, Weights weights>
RICOCHET_INLINE void modes_alone(const ModeStep& step) {
  constexpr bool Sum = weights != Weights::none;
  const double *of_q = step.coefficient, *of_d = of_q + (step.rows + 3) / 4 * 4, *of_scale = of_d + (of_d - of_q);
  double *q = nullptr, *d = nullptr;
  const double *x = step.x[0], *y = step.x[1], *last = nullptr, *value = step.value;
  if constexpr (Update) {
    q = step.update->x[0];
    d = step.update->x[1];
    last = step.update->last;
  }
  double* const z = step.z;
  double w0 = 0, w1 = 0, w2 = 0, total = 0;
  if constexpr (Test) {
    w0 = step.test->weight[0];
    w1 = step.test->weight[1];
    w2 = step.test->weight[2];
    total = step.test->offset[0];
  }
  const double scale = step.scale[0];
  const long rows = step.rows;
  const auto add = [&](long i, double sum) __attribute__((always_inline)) {
    total += value[i] * sum;
    asm("" : "+x"(total));
  };
  SquaresDown<weights> squares;
  if constexpr (Sum) squares = SquaresDown<weights>(*step.sum);
  // Four modes, all of them there but for the last ones.
  const auto four = [&](auto all, long i) __attribute__((always_inline)) {
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
    Vector4 unknown = Vector4{} + scale * loadu4(of_scale + i);
    unknown += loadu4(of_q + i) * position;
    unknown += loadu4(of_d + i) * increment;
    *reinterpret_cast<Vector4*>(z + i) = unknown;
    if constexpr (Sum) squares.add(all ? 4 : rows - i, unknown, increment);
    if constexpr (Test) {
      Vector4 sum = Vector4{} + w0 * position;
      sum += w1 * increment;
      sum += w2 * unknown;
      add(i, sum[0]);
      if (all || i + 1 < rows) add(i + 1, sum[1]);
      if (all || i + 2 < rows) add(i + 2, sum[2]);
      if (all || i + 3 < rows) add(i + 3, sum[3]);
    }
  };
  long i = 0;
  for (; i + 4 <= rows; i += 4) four(std::true_type{}, i);
  if (i < rows) four(std::false_type{}, i);
  if constexpr (Sum) squares.finish(*step.sum);
  if constexpr (Test) {
    Inside<1> inside;
    step.test->y[0] = total;
    inside.test(total, step.test->lower, step.test->upper);
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
  constexpr int G = Row<T>::count < 4 ? Row<T>::count : 4;
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

}  // namespace ricochet::lane_bodies
