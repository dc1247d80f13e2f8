#include <ricochet/kernels/instruction_set.hpp>
#include <ricochet/kernels/lane_band.hpp>
#include <ricochet/kernels/lane_kernels.hpp>
#include <ricochet/kernels/lane_modes.hpp>
#include <ricochet/kernels/lane_nodes.hpp>
#include <ricochet/kernels/lane_rows.hpp>
#include <ricochet/kernels/lane_sparse.hpp>
#include <stdexcept>

namespace ricochet {
namespace {

using namespace lane_bodies;

// The wrappers: one set per instruction set. What any count may ask for stands apart, out of the way of the registers
// of the usual ones.
// clang-format off
#define RICOCHET_KERNEL_SET(NAME, TARGET)                                                                              \
  template <int T>                                                                                                     \
  struct NAME {                                                                                                        \
    [[gnu::noinline]] TARGET static void combine_many(long n, int c, const double* const* x, const double* w, double* o) {\
      combine_general(n, c, x, w, o);                                                                                  \
    }                                                                                                                  \
    TARGET static void combine(long n, int c, const double* const* x, const double* w, double* o) {                    \
      if (!written(c, written_slots)) return combine_many(n, c, x, w, o);                                              \
      combine_any(n, c, x, w, o);                                                                                      \
    }                                                                                                                  \
    [[gnu::noinline]] TARGET static void update_many(long n, int c, double* const* x, const double* z, const double* w,\
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
    TARGET static void node_step(const NodeStep& step) { node_step_body<T>(step); }                                    \
    TARGET static void mode_step(const ModeStep& step) { mode_step_body<T>(step); }                                    \
    TARGET static int mode_run(ModeRun& run) { return mode_run_body<T>(run); }                                         \
    TARGET static void sparse_step(const SparseStep& step) { sparse_step_body<T>(step); }                              \
    TARGET static void sparse_strain(const SparseBlocks& L, double* x) { sparse_strain_body(L, x); }                   \
    TARGET static void row_product(const LaneRows& h, bool add, const double* x, double* y) {                          \
      row_product_body<T>(h, add, x, y);                                                                               \
    }                                                                                                                  \
    [[gnu::noinline]] TARGET static void diagonal_many(int n, int c, const double* f, const double* const* x,          \
                                                       const double* a, double* z) {                                   \
      diagonal_general<T>(n, c, f, x, a, z);                                                                           \
    }                                                                                                                  \
    TARGET static void diagonal_step(int n, int c, const double* f, const double* const* x, const double* a, double* z) {\
      if (!written(c, written_slots)) return diagonal_many(n, c, f, x, a, z);                                          \
      diagonal_any<T>(n, c, f, x, a, z);                                                                               \
    }                                                                                                                  \
    [[gnu::noinline]] TARGET static void measure_many(const LaneRows& h, int c, const double* const* x, const double* w,\
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
    static constexpr LaneKernels table{combine,   update,  band_step,  node_step, diagonal_step,                        \
                                       mode_step, mode_run,  sparse_step, sparse_strain, row_product, measure, add_column, outside, triple_product};   \
  };
// clang-format on

RICOCHET_KERNEL_SET(Baseline, )
RICOCHET_KERNEL_SET(Avx2, RICOCHET_AVX2)
RICOCHET_KERNEL_SET(Avx512, RICOCHET_AVX512)

template <template <int> class Set, int wide = 0>
const LaneKernels& select(int lanes) {
  switch (lanes) {
    case 1:
      return Set<1>::table;
    case 2:
      return Set<2>::table;
    case 4:
      return Set<4>::table;
    case 8:
      return Set<8 + wide>::table;
    case 16:
      return Set<16 + wide>::table;
    case 32:
      return Set<32 + wide>::table;
    default:
      throw std::logic_error("a block has 1, 2, 4, 8, 16 or 32 lanes");
  }
}

}  // namespace

const LaneKernels& lane_kernels(int lanes, InstructionSet set) {
  switch (set) {
    case InstructionSet::avx512:
      return select<Avx512, wide_rows>(lanes);
    case InstructionSet::avx2:
      return select<Avx2>(lanes);
    default:
      return select<Baseline>(lanes);
  }
}

int lane_width(int lanes) {
  for (int width = 1; width <= 32; width *= 2)
    if (lanes <= width) return width;
  throw std::logic_error("a block holds at most 32 lanes");
}

const char* lane_instruction_set() {
  static constexpr const char* names[] = {"baseline", "AVX2 + FMA", "AVX-512"};
  return names[static_cast<int>(best_instruction_set())];
}

}  // namespace ricochet
