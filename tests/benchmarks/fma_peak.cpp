#include "tests/benchmarks/fma_peak.hpp"

#include <algorithm>
#include <chrono>

namespace {

typedef double Vector __attribute__((vector_size(32)));

__attribute__((target("avx2,fma"), noinline)) double chains(long rounds) {
  Vector a0 = {1, 1, 1, 1}, a1 = a0, a2 = a0, a3 = a0, a4 = a0, a5 = a0, a6 = a0, a7 = a0, a8 = a0, a9 = a0;
  const Vector b = a0 * 0.999999, c = a0 * 1e-9;
  for (long r = 0; r < rounds; ++r) {
#define CHAIN(a) \
  a = a * b + c; \
  asm("" : "+x"(a));
    CHAIN(a0) CHAIN(a1) CHAIN(a2) CHAIN(a3) CHAIN(a4) CHAIN(a5) CHAIN(a6) CHAIN(a7) CHAIN(a8) CHAIN(a9)
#undef CHAIN
  }
  const Vector sum = a0 + a1 + a2 + a3 + a4 + a5 + a6 + a7 + a8 + a9;
  return sum[0] + sum[1] + sum[2] + sum[3];
}

}  // namespace

double fma_peak() {
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return 0;
  double best = 0;
  volatile double sink = 0;
  for (int run = 0; run < 20; ++run) {
    constexpr long rounds = 500000;
    const auto start = std::chrono::steady_clock::now();
    sink = sink + chains(rounds);
    const double elapsed = std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
    best = std::max(best, static_cast<double>(rounds) * 10 * 4 / elapsed);
  }
  return best;
}
