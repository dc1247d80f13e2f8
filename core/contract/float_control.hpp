#pragma once
#include <cstdint>

namespace ricochet {

/// Puts the floating-point control word of this thread back as it was found, when it goes out of scope. The word holds
/// rounding, masks, and whether denormal numbers count as zero; on x86-64 it holds exception flags too. The guard
/// stands around code of others: a library built with -ffast-math switches denormal numbers off for the thread that
/// loads it.
class KeepFloatControl {
 public:
  KeepFloatControl() noexcept;
  ~KeepFloatControl();
  KeepFloatControl(const KeepFloatControl&) = delete;
  KeepFloatControl& operator=(const KeepFloatControl&) = delete;

 private:
  std::uint64_t found_;
};

/// The same around one call of a plugin, in the marching loop too: flags are no matter, and only a word that was
/// changed is set. Whose call changed it is kept for take_float_changer().
class FloatControlOfCall {
 public:
  /// `function`: a literal.
  explicit FloatControlOfCall(const char* function) noexcept;
  ~FloatControlOfCall();
  FloatControlOfCall(const FloatControlOfCall&) = delete;
  FloatControlOfCall& operator=(const FloatControlOfCall&) = delete;

 private:
  const char* function_;
  std::uint64_t found_;
};

/// The first function that left this thread's control word changed since this was last asked; null: none did.
const char* take_float_changer() noexcept;

/// The control word of this thread: on x86-64 MXCSR, and above it the control word of the x87 registers; FPCR on 64-bit
/// ARM; elsewhere nothing is known of it: 0.
std::uint64_t float_control() noexcept;

/// The bits of the control word that have denormal operands read as zero and denormal results become zero. They are 0
/// where the processor is not known.
std::uint64_t flushing_bits() noexcept;

/// The word of a march: rounded to nearest, no exception traps, denormal numbers are zero.
std::uint64_t marching_control() noexcept;

/// Sets it, for this thread alone.
void set_float_control(std::uint64_t word) noexcept;

}  // namespace ricochet
