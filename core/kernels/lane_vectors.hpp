#pragma once
#include <ricochet/kernels/instruction_set.hpp>
#include <ricochet/kernels/lane_kernels.hpp>
#include <stdexcept>
#include <string>

/// \file
/// Rows of a block as vectors of lanes. For lane_kernels.cpp alone, here and in the other lane_*.hpp: one body per
/// kernel, force-inlined into a wrapper per instruction set. `a += b * c` contracts to one fused operation in each
/// wrapper that has it, in scalar and in vector code alike. This makes lanes independent of their number. The
/// contraction is a flag of that one source.
#define RICOCHET_INLINE inline __attribute__((always_inline))

namespace ricochet::lane_bodies {

typedef double Vector2 __attribute__((vector_size(16), may_alias));
typedef double Vector4 __attribute__((vector_size(32), may_alias));
typedef double Vector8 __attribute__((vector_size(64), may_alias));
typedef double Scalar __attribute__((may_alias));

/// A row is T lanes in vectors of four; T = wide_rows + lanes means vectors of eight. Comparisons take them in parts.
constexpr int wide_rows = 64;
template <bool wide>
struct RowVector {
  typedef Vector4 V;
};
template <>
struct RowVector<true> {
  typedef Vector8 V;
};
template <int T>
struct Row {
  static constexpr int lanes = T % wide_rows;
  using V = typename RowVector<(T > wide_rows)>::V;
  using Part = Vector4;
  static constexpr int count = lanes / (T > wide_rows ? 8 : 4);
};
template <>
struct Row<2> {
  static constexpr int lanes = 2;
  using V = Vector2;
  using Part = Vector2;
  static constexpr int count = 1;
};
template <>
struct Row<1> {
  static constexpr int lanes = 1;
  using V = Scalar;
  using Part = Scalar;
  static constexpr int count = 1;
};

template <int T>
using V = typename Row<T>::V;

template <int T>
RICOCHET_INLINE const V<T>* row(const double* block, long i) {
  return reinterpret_cast<const V<T>*>(block + i * Row<T>::lanes);
}
template <int T>
RICOCHET_INLINE V<T>* row(double* block, long i) {
  return reinterpret_cast<V<T>*>(block + i * Row<T>::lanes);
}

// Blocks start on 64 bytes, but a row of T = 1 need not start on 32.
RICOCHET_INLINE Vector4 load4(const double* from) {
  return *reinterpret_cast<const Vector4*>(from);
}
RICOCHET_INLINE Vector4 loadu4(const double* from) {
  return *reinterpret_cast<const LooseFour*>(from);
}

// In a loop of unknown length over one lane the compiler would multiply in vectors and add one by one, unfused. This
// keeps each step of the sum where it is written.
template <int T, int W>
RICOCHET_INLINE void keep_order([[maybe_unused]] V<T>* sum) {
  if constexpr (T == 1 && W < 0) asm("" : "+x"(sum[0]));
}

/// Which lanes of a vector have been between their bounds so far. By vectors of four: comparisons of eight are undone
/// lane by lane (ten times as long). Written so that a value that is no number is outside.
template <int T>
struct Inside {
  using Part = typename Row<T>::Part;
  using Mask = decltype(Part{} < Part{});
  static constexpr int parts = sizeof(V<T>) / sizeof(Part), per = sizeof(Part) / sizeof(double);
  Mask mask[parts];
  RICOCHET_INLINE Inside() {
    for (int p = 0; p < parts; ++p) mask[p] = Part{} == Part{};
  }
  RICOCHET_INLINE void test(const V<T>& y, const double* lower, const double* upper) {
    if constexpr (parts == 1) {
      test_part(0, y, lower, upper);
    } else {
      test_part(0, __builtin_shufflevector(y, y, 0, 1, 2, 3), lower, upper);
      test_part(1, __builtin_shufflevector(y, y, 4, 5, 6, 7), lower + per, upper + per);
    }
  }
  RICOCHET_INLINE void test_part(int p, const Part& y, const double* lower, const double* upper) {
    mask[p] &= (y >= *reinterpret_cast<const Part*>(lower)) & (y <= *reinterpret_cast<const Part*>(upper));
  }
  RICOCHET_INLINE bool holds(int lane) const {
    if constexpr (T == 1)
      return mask[0];
    else
      return mask[lane / per][lane % per] != 0;
  }
};

// A bit for each lane of G vectors that has not.
template <int T, int G>
RICOCHET_INLINE std::uint32_t outside_lanes(const Inside<T>* inside, long first) {
  constexpr int per = Row<T>::lanes / Row<T>::count;
  std::uint32_t mask = 0;
  for (int k = 0; k < G; ++k)
    for (int l = 0; l < per; ++l) mask |= static_cast<std::uint32_t>(!inside[k].holds(l)) << ((first + k) * per + l);
  return mask;
}

// Out of the way of the loops.
[[noreturn, gnu::cold, gnu::noinline]] inline void refuse_count(const char* kernel, int count, int most) {
  throw std::logic_error(std::string("the kernel '") + kernel + "' takes 1 to " + std::to_string(most) +
                         " blocks, not " + std::to_string(count));
}
RICOCHET_INLINE void check_count(const char* kernel, int count, int most) {
  if (count < 1 || count > most) refuse_count(kernel, count, most);
}

// Counts of slots and terms whose bodies are written out; more of them run in a loop.
constexpr int written_slots = 4, written_terms = 5;
RICOCHET_INLINE bool written(int count, int most) {
  return count >= 1 && count <= most;
}

// Sums of squares of one lane beside a step that has its numbers in registers, see SquareSum.

RICOCHET_INLINE double total(const Vector4& sum) {
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/// Fours of rows from the last to the first; W as many l as a row has.
template <int W>
class SquaresUp {
 public:
  RICOCHET_INLINE SquaresUp(const SquareSum& sum, long groups)
      : fours_(sum.fours + stride * groups), ratio_(sum.ratio) {}

  /// The next four of z and of x_1; zeros beyond the last row.
  RICOCHET_INLINE void add(const Vector4& z, const Vector4& x) {
    fours_ -= stride;
    const Vector4 here = z + ratio_ * x;
    Vector4 strain = here;
    if constexpr (W >= 1) strain += load4(fours_) * __builtin_shufflevector(here, after_, 1, 2, 3, 4);
    if constexpr (W >= 2) strain += load4(fours_ + 4) * __builtin_shufflevector(here, after_, 2, 3, 4, 5);
    if constexpr (W >= 3) strain += load4(fours_ + 8) * __builtin_shufflevector(here, after_, 3, 4, 5, 6);
    form_ += load4(fours_ + 4 * W) * strain * strain;
    projection_ += load4(fours_ + 4 * W + 4) * here;
    after_ = here;
  }
  RICOCHET_INLINE void finish(SquareSum& sum) const {
    sum.form = total(form_);
    sum.projection = total(projection_);
  }

 private:
  static constexpr int stride = 4 * (W + 2);
  const double* fours_;
  double ratio_;
  Vector4 after_ = {}, form_ = {}, projection_ = {};
};

/// Whether the squares of modes are summed up at all, and whether with weights d.
enum class Weights { none, ones, any };

/// Fours of modes, which no l couples, from the first to the last.
template <Weights weights>
class SquaresDown {
 public:
  RICOCHET_INLINE SquaresDown() {}
  RICOCHET_INLINE explicit SquaresDown(const SquareSum& sum) : fours_(sum.fours), ratio_(sum.ratio) {}

  /// The next four of z and of x_1; `rows` of them are there.
  RICOCHET_INLINE void add(long rows, const Vector4& z, const Vector4& x) {
    Vector4 here = z + ratio_ * x;
    if (rows < 4)
      for (long k = 1; k < 4; ++k)
        if (k >= rows) here[k] = 0;
    if constexpr (weights == Weights::ones)
      form_ += here * here;
    else
      form_ += load4(fours_) * here * here;
    projection_ += load4(fours_ + 4) * here;
    fours_ += 8;
  }
  RICOCHET_INLINE void finish(SquareSum& sum) const {
    sum.form = total(form_);
    sum.projection = total(projection_);
  }

 private:
  const double* fours_ = nullptr;
  double ratio_ = 0;
  Vector4 form_ = {}, projection_ = {};
};

}  // namespace ricochet::lane_bodies
