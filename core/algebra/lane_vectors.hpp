#pragma once
#include <ricochet/algebra/lane_kernels.hpp>
#include <stdexcept>
#include <string>

/// \file
/// Rows of a block as vectors of lanes. For lane_kernels.cpp alone, here and in the other lane_*.hpp: one body per
/// kernel, force-inlined into a wrapper per instruction set. `a += b * c` contracts to one fused operation in each
/// wrapper that has it, in scalar and in vector code alike, which is what makes lanes independent of their number; the
/// contraction is a flag of that one source.
#define RICOCHET_INLINE inline __attribute__((always_inline))

namespace ricochet::lane_bodies {

typedef double Vector2 __attribute__((vector_size(16), may_alias));
typedef double Vector4 __attribute__((vector_size(32), may_alias));
typedef double Vector8 __attribute__((vector_size(64), may_alias));
typedef double Scalar __attribute__((may_alias));

/// A row is T lanes in vectors of four; T = wide_rows + lanes means vectors of eight.
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
  static constexpr int count = lanes / (T > wide_rows ? 8 : 4);
};
template <>
struct Row<2> {
  static constexpr int lanes = 2;
  using V = Vector2;
  static constexpr int count = 1;
};
template <>
struct Row<1> {
  static constexpr int lanes = 1;
  using V = Scalar;
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

}  // namespace ricochet::lane_bodies
