#include <ricochet/loader/float_control.hpp>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace ricochet {

#if defined(__x86_64__)

std::uint64_t float_control() noexcept {
  return _mm_getcsr();
}

void set_float_control(std::uint64_t word) noexcept {
  _mm_setcsr(static_cast<unsigned>(word));
}

// FTZ, bit 15, and DAZ, bit 6: every 64-bit processor has both.
std::uint64_t flushing_bits() noexcept {
  return 0x8040;
}

#elif defined(__aarch64__)

std::uint64_t float_control() noexcept {
  std::uint64_t word = 0;
  asm volatile("mrs %0, fpcr" : "=r"(word));
  return word;
}

void set_float_control(std::uint64_t word) noexcept {
  asm volatile("msr fpcr, %0" : : "r"(word));
}

// FZ: operands and results alike.
std::uint64_t flushing_bits() noexcept {
  return 1u << 24;
}

#else

std::uint64_t float_control() noexcept {
  return 0;
}

void set_float_control(std::uint64_t) noexcept {}

std::uint64_t flushing_bits() noexcept {
  return 0;
}

#endif

KeepFloatControl::KeepFloatControl() noexcept : found_(float_control()) {}

KeepFloatControl::~KeepFloatControl() {
  set_float_control(found_);
}

}  // namespace ricochet
