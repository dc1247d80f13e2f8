#include <ricochet/contract/float_control.hpp>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace ricochet {
namespace {

#if defined(__x86_64__)
constexpr unsigned x87_at = 32;
// Exception flags: what arithmetic raises, which no result depends on.
constexpr std::uint64_t flags = 0x3F;
#else
constexpr std::uint64_t flags = 0;
#endif

thread_local const char* changer = nullptr;

}  // namespace

#if defined(__x86_64__)

std::uint64_t float_control() noexcept {
  std::uint16_t x87 = 0;
  asm volatile("fnstcw %0" : "=m"(x87));
  return std::uint64_t{x87} << x87_at | _mm_getcsr();
}

void set_float_control(std::uint64_t word) noexcept {
  const auto x87 = static_cast<std::uint16_t>(word >> x87_at);
  asm volatile("fldcw %0" : : "m"(x87));
  _mm_setcsr(static_cast<unsigned>(word));
}

// FTZ, bit 15, and DAZ, bit 6: every 64-bit processor has both.
std::uint64_t flushing_bits() noexcept {
  return 0x8040;
}

// Both words as a process begins with them.
std::uint64_t marching_control() noexcept {
  return std::uint64_t{0x037F} << x87_at | 0x1F80 | flushing_bits();
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

std::uint64_t marching_control() noexcept {
  return flushing_bits();
}

#else

std::uint64_t float_control() noexcept {
  return 0;
}

void set_float_control(std::uint64_t) noexcept {}

std::uint64_t flushing_bits() noexcept {
  return 0;
}

std::uint64_t marching_control() noexcept {
  return 0;
}

#endif

KeepFloatControl::KeepFloatControl() noexcept : found_(float_control()) {}

KeepFloatControl::~KeepFloatControl() {
  set_float_control(found_);
}

FloatControlOfCall::FloatControlOfCall(const char* function) noexcept : function_(function), found_(float_control()) {}

FloatControlOfCall::~FloatControlOfCall() {
  if (((float_control() ^ found_) & ~flags) == 0) return;
  set_float_control(found_);
  if (!changer) changer = function_;
}

const char* take_float_changer() noexcept {
  const char* const found = changer;
  changer = nullptr;
  return found;
}

}  // namespace ricochet
