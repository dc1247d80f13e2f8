#pragma once

/// Of a function that is compiled for AVX2 and FMA, to be called only where has_avx2().
#define RICOCHET_AVX2 __attribute__((target("avx2,fma")))
/// The same without fused operations: what it computes number by number is rounded as elsewhere.
#define RICOCHET_AVX2_ALONE __attribute__((target("avx2")))
/// Of one that may use vectors of eight doubles as well, to be called only where has_avx512().
#ifdef __clang__
// It has no word for the width, and drops an attribute of which it does not know one word.
#define RICOCHET_AVX512 __attribute__((target("avx2,fma,avx512f,avx512vl,avx512dq")))
#else
#define RICOCHET_AVX512 __attribute__((target("avx2,fma,avx512f,avx512vl,avx512dq,prefer-vector-width=512")))
#endif
namespace ricochet {

/// What kernels over lanes are compiled for.
enum class InstructionSet { baseline, avx2, avx512 };

/// Whether this processor has AVX2 and FMA: asked for once.
inline bool has_avx2() {
  static const bool has = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return has;
}

/// Whether it has AVX-512 as well, and the parts of it that vectors of doubles need.
inline bool has_avx512() {
  static const bool has = has_avx2() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                          __builtin_cpu_supports("avx512dq");
  return has;
}

/// The best that this processor has.
inline InstructionSet best_instruction_set() {
  return has_avx512() ? InstructionSet::avx512 : has_avx2() ? InstructionSet::avx2 : InstructionSet::baseline;
}

/// Four numbers that may start at any of them. A typedef: in a using, clang leaves the alignment out.
typedef double LooseFour __attribute__((vector_size(32), aligned(8), may_alias));
static_assert(alignof(LooseFour) == 8);

}  // namespace ricochet
