#pragma once

/// Of a function that is compiled for AVX2 and FMA, to be called only where has_avx2().
#define RICOCHET_AVX2 __attribute__((target("avx2,fma")))
/// The same without fused operations: what it computes number by number is rounded as elsewhere.
#define RICOCHET_AVX2_ALONE __attribute__((target("avx2")))

namespace ricochet {

/// Whether this processor has AVX2 and FMA: asked for once.
inline bool has_avx2() {
  static const bool has = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return has;
}

}  // namespace ricochet
