// Denormal numbers are zero inside of the scope, and the thread gets back the control word that it had, whatever it
// was.
#include <catch2/catch.hpp>
#include <cfenv>
#include <limits>
#include <random>
#include <ricochet/kernels/block.hpp>
#include <ricochet/kernels/floating_point.hpp>
#include <ricochet/kernels/lane_kernels.hpp>
#include <thread>

using namespace ricochet;

namespace {

constexpr double tiny = std::numeric_limits<double>::denorm_min(), least = std::numeric_limits<double>::min();

// Where the compiler cannot see the numbers.
double times(double a, double b) {
  volatile double x = a, y = b;
  return x * y;
}
double plus(double a, double b) {
  volatile double x = a, y = b;
  return x + y;
}

// The sum compared as a bit pattern: a comparison would read a denormal number as zero itself.
bool flushes_results() {
  const volatile double product = times(least, 0.5);
  return plus(product, product) == 0;
}
bool flushes_operands() {
  return times(tiny, 0x1p200) == 0;
}

// Only a processor that is not known may do without.
bool can_flush() {
#if defined(__x86_64__) || defined(__aarch64__)
  REQUIRE(flushing_bits() != 0);
#endif
  return flushing_bits() != 0;
}

}  // namespace

TEST_CASE("denormal operands and results are zero inside of the scope only") {
  if (!can_flush()) return;
  const KeepFloatControl test;
  set_float_control(float_control() & ~flushing_bits());
  REQUIRE_FALSE(flushes_results());
  REQUIRE_FALSE(flushes_operands());
  {
    const FlushDenormals outer;
    CHECK(flushes_results());
    CHECK(flushes_operands());
    {
      const FlushDenormals inner;
      CHECK(flushes_operands());
    }
    CHECK(flushes_operands());
  }
  CHECK_FALSE(flushes_results());
  CHECK_FALSE(flushes_operands());
}

TEST_CASE("the control word is afterwards what it was before, whatever was done to it") {
  const KeepFloatControl test;
  const std::uint64_t usual = float_control() & ~flushing_bits();
#if defined(__x86_64__)
  // Round up, flush results only, flush operands only, an exception flag that is up; all exceptions stay masked.
  const std::uint64_t words[] = {usual, usual | 0x4000, usual | 0x8000, usual | 0x0040, usual | 0x0010};
#else
  const std::uint64_t words[] = {usual, usual | flushing_bits()};
#endif
  for (const std::uint64_t word : words) {
    set_float_control(word);
    {
      const FlushDenormals flush;
      CHECK((float_control() & flushing_bits()) == flushing_bits());
      set_float_control(usual);  // as the code of others would
    }
    CHECK(float_control() == word);
    {
      const KeepFloatControl keep;
      CHECK(float_control() == word);
      set_float_control(usual | flushing_bits());
    }
    CHECK(float_control() == word);
    try {
      const FlushDenormals flush;
      throw 1;
    } catch (int) {
    }
    CHECK(float_control() == word);
  }
}

TEST_CASE("inside of the scope numbers are rounded to nearest, whatever was set before") {
  const KeepFloatControl test;
  for (const int rounding : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(rounding);
    {
      const FlushDenormals flush;
      CHECK(std::fegetround() == FE_TONEAREST);
      CHECK(plus(1, 0x1p-60) == 1);
      CHECK(plus(1, -0x1p-60) == 1);
      CHECK(plus(-1, -0x1p-60) == -1);
    }
    CHECK(std::fegetround() == rounding);
  }
}

TEST_CASE("one thread's denormal numbers are no other's") {
  if (!can_flush()) return;
  const KeepFloatControl test;
  set_float_control(float_control() & ~flushing_bits());
  bool before = true, inside = false;
  std::thread([&] {
    before = flushes_operands();
    const FlushDenormals flush;
    inside = flushes_operands();
  }).join();
  CHECK_FALSE(before);
  CHECK(inside);
  CHECK_FALSE(flushes_operands());
}

TEST_CASE("flushed, a lane does not depend on the other lanes of its block or the instruction set's width") {
  if (!can_flush()) return;
  const FlushDenormals flush;
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  constexpr int n = 17;
  // Products and sums around the smallest normal number.
  std::vector<double> x(n), y(n), coefficient(3 * n);
  for (int i = 0; i < n; ++i) {
    x[static_cast<std::size_t>(i)] = 8 * least * uniform(engine);
    y[static_cast<std::size_t>(i)] = 8 * least * uniform(engine);
  }
  for (double& c : coefficient) c = uniform(engine);
  std::vector<double> alone(n);
  for (const int T : {1, 2, 4, 8, 16, 32}) {
    Block a(n, T), b(n, T), scale(1, T), z(n, T);
    for (int i = 0; i < n; ++i)
      for (int l = 0; l < T; ++l) {
        a.at(i, l) = x[static_cast<std::size_t>(i)];
        b.at(i, l) = y[static_cast<std::size_t>(i)];
      }
    const double* slots[] = {a.data(), b.data()};
    lane_kernels(T).diagonal_step(n, 2, coefficient.data(), slots, scale.data(), z.data());
    int zeros = 0;
    for (int i = 0; i < n; ++i) {
      if (T == 1) alone[static_cast<std::size_t>(i)] = z.at(i, 0);
      zeros += z.at(i, T - 1) == 0;
      CHECK(z.at(i, 0) == alone[static_cast<std::size_t>(i)]);
      CHECK(z.at(i, T - 1) == alone[static_cast<std::size_t>(i)]);
    }
    CHECK(zeros > 0);  // some results were flushed
    CHECK(zeros < n);
  }
}
