#include <algorithm>
#include <cmath>
#include <ricochet/algebra/flight_kernels.hpp>

namespace ricochet {
namespace {

#define RICOCHET_BODY [[gnu::always_inline]] inline

constexpr int parts = 8;  // of a sum, so that it vectorises without a change of its order

RICOCHET_BODY double total(const double* sums) {
  return ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7]));
}

RICOCHET_BODY void add_row(int n, int slots, int drives, const double* row, const double* x, const double* e,
                           double* __restrict out) {
  for (int k = 0; k < slots; ++k, row += n, x += n)
    for (int j = 0; j < n; ++j) out[j] += row[j] * x[j];
  for (int k = 0; k < drives; ++k, row += n) {
    const double drive = e[k];
    for (int j = 0; j < n; ++j) out[j] += row[j] * drive;
  }
}

RICOCHET_BODY void row_body(int n, int slots, int drives, const double* row, const double* x, const double* e,
                            double* __restrict out) {
  for (int j = 0; j < n; ++j) out[j] = row[j] * x[j];
  if (slots > 1) {
    add_row(n, slots - 1, drives, row + n, x + n, e, out);
    return;
  }
  add_row(n, 0, drives, row + n, x, e, out);
}

RICOCHET_BODY void leap_body(int n, int slots, int drives, const double* table, const double* x, const double* e,
                             double* __restrict out) {
  const int width = slots + drives;
  for (int i = 0; i < slots; ++i, table += static_cast<long>(width) * n, out += n) {
    row_body(n, slots, drives, table, x, e, out);
    const double* own = x + static_cast<long>(i) * n;
    for (int j = 0; j < n; ++j) out[j] += own[j];
  }
}

RICOCHET_BODY void modulus_body(int n, const double* re, const double* im, const double* weight,
                                double* __restrict amplitude, double* __restrict bend) {
  for (int j = 0; j < n; ++j) {
    const double size = std::sqrt(re[j] * re[j] + im[j] * im[j]);
    amplitude[j] += size;
    bend[j] += weight[j] * size;
  }
}

RICOCHET_BODY void cone_body(int n, double k, const double* value, const double* change, const double* amplitude,
                             const double* bend, double* __restrict places) {
  double *near = places, *near_radius = places + n, *far = places + 2L * n, *far_radius = places + 3L * n;
  const double half = 0.5 * k * (k - 1);
  for (int j = 0; j < n; ++j) {
    const double turn = half * bend[j];
    const bool slow = turn <= amplitude[j];
    near[j] = slow ? value[j] : 0;
    far[j] = slow ? value[j] + k * change[j] : 0;
    near_radius[j] = slow ? 0 : amplitude[j];
    far_radius[j] = slow ? turn : amplitude[j];
  }
}

RICOCHET_BODY void reach_body(int n, const double* h, const double* places, double* out) {
  const double *near = places, *near_radius = places + n, *far = places + 2L * n, *far_radius = places + 3L * n;
  double a[parts] = {}, b[parts] = {}, c[parts] = {}, d[parts] = {};
  int j = 0;
  for (; j + parts <= n; j += parts)
    for (int l = 0; l < parts; ++l) {
      const double weight = h[j + l], size = std::abs(weight);
      a[l] += weight * near[j + l];
      b[l] += size * near_radius[j + l];
      c[l] += weight * far[j + l];
      d[l] += size * far_radius[j + l];
    }
  for (int l = 0; j < n; ++j, ++l) {
    const double weight = h[j], size = std::abs(weight);
    a[l] += weight * near[j];
    b[l] += size * near_radius[j];
    c[l] += weight * far[j];
    d[l] += size * far_radius[j];
  }
  out[0] = total(a);
  out[1] = total(b);
  out[2] = total(c);
  out[3] = total(d);
}

RICOCHET_BODY double dot_body(int n, const double* h, const double* x) {
  double sums[parts] = {};
  int j = 0;
  for (; j + parts <= n; j += parts)
    for (int l = 0; l < parts; ++l) sums[l] += h[j + l] * x[j + l];
  for (int l = 0; j < n; ++j, ++l) sums[l] += h[j] * x[j];
  return total(sums);
}

RICOCHET_BODY double quadratic_body(int n, int slots, int drives, const double* form, const double* x,
                                    const double* e) {
  double sums[parts] = {};
  const int width = slots + drives;
  for (int a = 0; a < width; ++a)
    for (int b = a; b < width; ++b, form += n) {
      const double* left = a < slots ? x + static_cast<long>(a) * n : nullptr;
      const double* right = b < slots ? x + static_cast<long>(b) * n : nullptr;
      const double given = (a < slots ? 1.0 : e[a - slots]) * (b < slots ? 1.0 : e[b - slots]);
      double own[parts] = {};
      int j = 0;
      if (left && right) {
        for (; j + parts <= n; j += parts)
          for (int l = 0; l < parts; ++l) own[l] += form[j + l] * left[j + l] * right[j + l];
        for (int l = 0; j < n; ++j, ++l) own[l] += form[j] * left[j] * right[j];
      } else if (left) {
        for (; j + parts <= n; j += parts)
          for (int l = 0; l < parts; ++l) own[l] += form[j + l] * left[j + l];
        for (int l = 0; j < n; ++j, ++l) own[l] += form[j] * left[j];
      } else {
        for (; j + parts <= n; j += parts)
          for (int l = 0; l < parts; ++l) own[l] += form[j + l];
        for (int l = 0; j < n; ++j, ++l) own[l] += form[j];
      }
      for (int l = 0; l < parts; ++l) sums[l] += given * own[l];
    }
  return total(sums);
}

// clang-format off
#define RICOCHET_FLIGHT_SET(NAME, TARGET)                                                                              \
  struct NAME {                                                                                                        \
    TARGET static void leap(int n, int s, int d, const double* t, const double* x, const double* e, double* o) {       \
      leap_body(n, s, d, t, x, e, o);                                                                                  \
    }                                                                                                                  \
    TARGET static void row(int n, int s, int d, const double* r, const double* x, const double* e, double* o) {        \
      row_body(n, s, d, r, x, e, o);                                                                                   \
    }                                                                                                                  \
    TARGET static void modulus(int n, const double* re, const double* im, const double* w, double* a, double* b) {     \
      modulus_body(n, re, im, w, a, b);                                                                                \
    }                                                                                                                  \
    TARGET static void cone(int n, double k, const double* v, const double* c, const double* a, const double* b,       \
                            double* p) { cone_body(n, k, v, c, a, b, p); }                                             \
    TARGET static void reach(int n, const double* h, const double* p, double* o) { reach_body(n, h, p, o); }           \
    TARGET static double dot(int n, const double* h, const double* x) { return dot_body(n, h, x); }                    \
    TARGET static double quadratic(int n, int s, int d, const double* f, const double* x, const double* e) {           \
      return quadratic_body(n, s, d, f, x, e);                                                                         \
    }                                                                                                                  \
    static constexpr FlightKernels kernels{leap, row, modulus, cone, reach, dot, quadratic};                           \
  };
RICOCHET_FLIGHT_SET(Baseline, )
RICOCHET_FLIGHT_SET(Avx2, __attribute__((target("avx2,fma"))))
// clang-format on

}  // namespace

const FlightKernels& flight_kernels() {
  static const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return avx2 ? Avx2::kernels : Baseline::kernels;
}

}  // namespace ricochet
