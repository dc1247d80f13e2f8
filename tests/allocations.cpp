#include "tests/allocations.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

// Every form is replaced, also those that would forward to another: a sanitizer brings its own of each.
namespace {
std::atomic<long> count{0};

void* take(std::size_t size, std::align_val_t alignment = std::align_val_t(alignof(std::max_align_t))) noexcept {
  ++count;
  const auto unit = static_cast<std::size_t>(alignment);
  return std::aligned_alloc(unit, (std::max<std::size_t>(size, 1) + unit - 1) / unit * unit);
}

void* insist(void* memory) {
  if (memory != nullptr) return memory;
  if (const std::new_handler handler = std::get_new_handler()) handler();
  throw std::bad_alloc();
}
}  // namespace

long allocations() {
  return count;
}

using std::align_val_t, std::nothrow_t, std::size_t;

void* operator new(size_t size) {
  return insist(take(size));
}
void* operator new[](size_t size) {
  return insist(take(size));
}
void* operator new(size_t size, align_val_t alignment) {
  return insist(take(size, alignment));
}
void* operator new[](size_t size, align_val_t alignment) {
  return insist(take(size, alignment));
}
void* operator new(size_t size, const nothrow_t&) noexcept {
  return take(size);
}
void* operator new[](size_t size, const nothrow_t&) noexcept {
  return take(size);
}
void* operator new(size_t size, align_val_t alignment, const nothrow_t&) noexcept {
  return take(size, alignment);
}
void* operator new[](size_t size, align_val_t alignment, const nothrow_t&) noexcept {
  return take(size, alignment);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, size_t, align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, size_t, align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, const nothrow_t&) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, const nothrow_t&) noexcept {
  std::free(memory);
}
void operator delete(void* memory, align_val_t, const nothrow_t&) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, align_val_t, const nothrow_t&) noexcept {
  std::free(memory);
}
