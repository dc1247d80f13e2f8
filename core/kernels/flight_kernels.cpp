#include <cmath>
#include <ricochet/kernels/flight_kernels.hpp>
#include <ricochet/kernels/instruction_set.hpp>

namespace ricochet {
namespace {

// All that takes or gives a vector is inlined. A call would pass the vector as the caller's instruction set has it, and
// the callee would take it as its own has it.
#define RICOCHET_BODY [[gnu::always_inline]] inline
#define RICOCHET_INLINED __attribute__((always_inline))

// Four numbers: a sum by four has one order, whatever the instruction set.
constexpr int wide = 4;
using Wide = double __attribute__((vector_size(32)));

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
  add_row(n, slots - 1, drives, row + n, x + n, e, out);
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

RICOCHET_BODY Wide load(const double* x) {
  return *reinterpret_cast<const LooseFour*>(x);
}
// Fewer than four of them, and zeros.
RICOCHET_BODY Wide load_some(const double* x, int count) {
  switch (count) {
    case 0:
      return Wide{};
    case 1:
      return Wide{x[0], 0, 0, 0};
    case 2:
      return Wide{x[0], x[1], 0, 0};
    default:
      return Wide{x[0], x[1], x[2], 0};
  }
}
// One pass for up to four modes; all that is read of a mode is read before any of it is written.
template <int slots, int drives>
RICOCHET_BODY void leap_slots(int n, const double* table, const double* x, const double* e, double* out) {
  const int width = slots + drives;
  const auto at = [n](int row) RICOCHET_INLINED { return static_cast<long>(row) * n; };
  const auto leap = [&](int j, auto load_one, auto store) RICOCHET_INLINED {
    decltype(load_one(x)) own[slots], next[slots];
#pragma GCC unroll 4
    for (int k = 0; k < slots; ++k) own[k] = load_one(x + at(k) + j);
#pragma GCC unroll 4
    for (int i = 0; i < slots; ++i) {
      const double* const row = table + at(i * width) + j;
      next[i] = load_one(row) * own[0];
#pragma GCC unroll 4
      for (int k = 1; k < slots; ++k) next[i] += load_one(row + at(k)) * own[k];
#pragma GCC unroll 4
      for (int k = 0; k < drives; ++k) next[i] += load_one(row + at(slots + k)) * e[k];
      next[i] += own[i];
    }
#pragma GCC unroll 4
    for (int i = 0; i < slots; ++i) store(out + at(i) + j, next[i]);
  };
  int j = 0;
  for (; j + wide <= n; j += wide)
    leap(
        j, [](const double* from) RICOCHET_INLINED { return load(from); },
        [](double* to, Wide value) RICOCHET_INLINED { *reinterpret_cast<LooseFour*>(to) = value; });
  for (; j < n; ++j)
    leap(
        j, [](const double* from) RICOCHET_INLINED { return *from; },
        [](double* to, double value) RICOCHET_INLINED { *to = value; });
}

// Any number of slots, by a pass for each; `out` is another place.
RICOCHET_BODY void leap_any(int n, int slots, int drives, const double* table, const double* x, const double* e,
                            double* __restrict out) {
  const int width = slots + drives;
  for (int i = 0; i < slots; ++i, table += static_cast<long>(width) * n, out += n) {
    row_body(n, slots, drives, table, x, e, out);
    const double* own = x + static_cast<long>(i) * n;
    for (int j = 0; j < n; ++j) out[j] += own[j];
  }
}

RICOCHET_BODY void leap_body(int n, int slots, int drives, const double* table, const double* x, const double* e,
                             double* out) {
  switch (4 * slots + drives) {
#define RICOCHET_LEAP(SLOTS, DRIVES) \
  case 4 * SLOTS + DRIVES:           \
    return leap_slots<SLOTS, DRIVES>(n, table, x, e, out);
#define RICOCHET_LEAPS(SLOTS) \
  RICOCHET_LEAP(SLOTS, 0) RICOCHET_LEAP(SLOTS, 1) RICOCHET_LEAP(SLOTS, 2) RICOCHET_LEAP(SLOTS, 3)
    RICOCHET_LEAPS(1)
    RICOCHET_LEAPS(2) RICOCHET_LEAPS(3) RICOCHET_LEAPS(4) default : return leap_any(n, slots, drives, table, x, e, out);
  }
}

RICOCHET_BODY Wide size_of(Wide x) {
  return x < 0 ? -x : x;
}
RICOCHET_BODY double total(Wide even, Wide odd) {
  const Wide sum = even + odd;
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

RICOCHET_BODY void reach_body(int n, long stride, const double* h, const double* places, double* out) {
  const double *near = places, *near_radius = places + stride, *far = places + 2 * stride,
               *far_radius = places + 3 * stride;
  Wide a{}, b{}, c{}, d{};
  int j = 0;
  for (; j + wide <= n; j += wide) {
    const Wide weight = load(h + j), size = size_of(weight);
    a += weight * load(near + j);
    b += size * load(near_radius + j);
    c += weight * load(far + j);
    d += size * load(far_radius + j);
  }
  for (int l = 0; j < n; ++j, ++l) {
    const double weight = h[j], size = std::abs(weight);
    a[l] += weight * near[j];
    b[l] += size * near_radius[j];
    c[l] += weight * far[j];
    d[l] += size * far_radius[j];
  }
  out[0] = total(a, Wide{});
  out[1] = total(b, Wide{});
  out[2] = total(c, Wide{});
  out[3] = total(d, Wide{});
}

// Of points from i on, as many as a vector holds.
template <class Number, class Load, class Store>
RICOCHET_BODY void reaches_from(int i, int n, long stride, int points, const double* h, const double* places,
                                double* out, Load load_one, Store store) {
  Number a{}, b{}, c{}, d{};
  for (int j = 0; j < n; ++j) {
    const Number weight = load_one(h + static_cast<long>(j) * points + i), size = weight < 0 ? -weight : weight;
    a += weight * places[j];
    b += size * places[stride + j];
    c += weight * places[2 * stride + j];
    d += size * places[3 * stride + j];
  }
  store(out + i, a);
  store(out + points + i, b);
  store(out + 2L * points + i, c);
  store(out + 3L * points + i, d);
}

RICOCHET_BODY void reaches_body(int n, long stride, int points, const double* h, const double* places, double* out) {
  int i = 0;
  for (; i + wide <= points; i += wide)
    reaches_from<Wide>(
        i, n, stride, points, h, places, out, [](const double* from) RICOCHET_INLINED { return load(from); },
        [](double* to, Wide value) RICOCHET_INLINED { *reinterpret_cast<LooseFour*>(to) = value; });
  for (; i < points; ++i)
    reaches_from<double>(
        i, n, stride, points, h, places, out, [](const double* from) RICOCHET_INLINED { return *from; },
        [](double* to, double value) RICOCHET_INLINED { *to = value; });
}

// Two sums of products over n, eight at a time: `add`(sums, at) adds four products to one of them, at(array) being its
// next four numbers. What is over goes on in the same order, without a number that is written to memory.
template <class Sums, class Add>
RICOCHET_BODY void sum_by_eight(int n, Sums& even, Sums& odd, Add add) {
  int j = 0;
  for (; j + 2 * wide <= n; j += 2 * wide) {
    add(even, [j](const double* of) RICOCHET_INLINED { return load(of + j); });
    add(odd, [j](const double* of) RICOCHET_INLINED { return load(of + j + wide); });
  }
  if (j + wide <= n) {
    add(even, [j](const double* of) RICOCHET_INLINED { return load(of + j); });
    j += wide;
    add(odd, [j, count = n - j](const double* of) RICOCHET_INLINED { return load_some(of + j, count); });
  } else if (j < n) {
    add(even, [j, count = n - j](const double* of) RICOCHET_INLINED { return load_some(of + j, count); });
  }
}

RICOCHET_BODY double dot_body(int n, const double* h, const double* x) {
  Wide even{}, odd{};
  sum_by_eight(n, even, odd, [&](Wide& sum, auto at) RICOCHET_INLINED { sum += at(h) * at(x); });
  return total(even, odd);
}

// Four sums at a time do not wait for each other. Each has the order of dot_body.
struct Four {
  Wide a{}, b{}, c{}, d{};
};

// Of four rows.
RICOCHET_BODY void dots_body(int n, int rows, const double* matrix, const double* x, double* out) {
  int i = 0;
  for (; i + 4 <= rows; i += 4, matrix += 4L * n) {
    const double *a = matrix, *b = a + n, *c = b + n, *d = c + n;
    Four even, odd;
    sum_by_eight(n, even, odd, [&](Four& sums, auto at) RICOCHET_INLINED {
      const Wide factor = at(x);
      sums.a += at(a) * factor;
      sums.b += at(b) * factor;
      sums.c += at(c) * factor;
      sums.d += at(d) * factor;
    });
    out[i] = total(even.a, odd.a);
    out[i + 1] = total(even.b, odd.b);
    out[i + 2] = total(even.c, odd.c);
    out[i + 3] = total(even.d, odd.d);
  }
  for (; i < rows; ++i, matrix += n) out[i] = dot_body(n, matrix, x);
}

// Of two rows and two vectors.
RICOCHET_BODY void products_body(int n, int rows, const double* matrix, int vectors, const double* const* x,
                                 double* const* out) {
  int v = 0;
  for (; v + 2 <= vectors; v += 2) {
    const double *one = x[v], *other = x[v + 1], *row = matrix;
    int i = 0;
    for (; i + 2 <= rows; i += 2, row += 2L * n) {
      const double* const next = row + n;
      Four even, odd;
      sum_by_eight(n, even, odd, [&](Four& sums, auto at) RICOCHET_INLINED {
        const Wide first = at(row), second = at(next), left = at(one), right = at(other);
        sums.a += first * left;
        sums.b += second * left;
        sums.c += first * right;
        sums.d += second * right;
      });
      out[v][i] = total(even.a, odd.a);
      out[v][i + 1] = total(even.b, odd.b);
      out[v + 1][i] = total(even.c, odd.c);
      out[v + 1][i + 1] = total(even.d, odd.d);
    }
    for (; i < rows; ++i, row += n) {
      out[v][i] = dot_body(n, row, one);
      out[v + 1][i] = dot_body(n, row, other);
    }
  }
  if (v < vectors) dots_body(n, rows, matrix, x[v], out[v]);
}

RICOCHET_BODY void add_body(int n, double a, const double* x, double* __restrict out) {
  for (int j = 0; j < n; ++j) out[j] += a * x[j];
}

RICOCHET_BODY double quadratic_body(int n, int slots, int drives, const double* form, const double* x,
                                    const double* e) {
  double sum = 0;
  const int width = slots + drives;
  for (int a = 0; a < width; ++a)
    for (int b = a; b < width; ++b, form += n) {
      const double* left = x + static_cast<long>(a) * n;
      const double* right = x + static_cast<long>(b) * n;
      if (a < slots && b >= slots) {
        sum += e[b - slots] * dot_body(n, form, left);
        continue;
      }
      Wide even{}, odd{};
      if (b < slots) {
        sum_by_eight(n, even, odd,
                     [&](Wide& own, auto at) RICOCHET_INLINED { own += at(form) * at(left) * at(right); });
        sum += total(even, odd);
      } else {
        sum_by_eight(n, even, odd, [&](Wide& own, auto at) RICOCHET_INLINED { own += at(form); });
        sum += e[a - slots] * e[b - slots] * total(even, odd);
      }
    }
  return sum;
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
    TARGET static void reach(int n, long stride, const double* h, const double* p, double* o) {                        \
      reach_body(n, stride, h, p, o);                                                                                  \
    }                                                                                                                  \
    TARGET static void reaches(int n, long stride, int points, const double* h, const double* p, double* o) {          \
      reaches_body(n, stride, points, h, p, o);                                                                        \
    }                                                                                                                  \
    TARGET static double dot(int n, const double* h, const double* x) { return dot_body(n, h, x); }                    \
    TARGET static void dots(int n, int r, const double* m, const double* x, double* o) { dots_body(n, r, m, x, o); }   \
    TARGET static void products(int n, int r, const double* m, int v, const double* const* x, double* const* o) {      \
      products_body(n, r, m, v, x, o);                                                                                 \
    }                                                                                                                  \
    TARGET static void add(int n, double a, const double* x, double* o) { add_body(n, a, x, o); }                      \
    TARGET static double quadratic(int n, int s, int d, const double* f, const double* x, const double* e) {           \
      return quadratic_body(n, s, d, f, x, e);                                                                         \
    }                                                                                                                  \
    static constexpr FlightKernels kernels{leap, row, modulus,  cone, reach,    reaches,                               \
                                           dot,  dots, products, add,  quadratic};                                     \
  };
RICOCHET_FLIGHT_SET(Baseline, )
RICOCHET_FLIGHT_SET(Avx2, RICOCHET_AVX2)
// clang-format on

}  // namespace

const FlightKernels& flight_kernels() {
  return has_avx2() ? Avx2::kernels : Baseline::kernels;
}

}  // namespace ricochet
