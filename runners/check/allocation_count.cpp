#include "runners/check/allocation_count.hpp"

#include <cerrno>
#include <cstddef>
#include <cstdlib>

// A program's own malloc stands before the C library's for every library that it loads. It hands on to the allocator
// that glibc keeps under these names; memory is freed as ever. Sanitizers bring an allocator of their own.
#if defined(__GLIBC__) && !defined(RICOCHET_SANITIZED)
#define RICOCHET_COUNTS_ALLOCATIONS 1
#endif

namespace {
constinit thread_local long count = 0;
}  // namespace

namespace ricochet::checking {

long allocations_of_this_thread() {
  return count;
}

bool allocations_are_counted() {
#ifdef RICOCHET_COUNTS_ALLOCATIONS
  return true;
#else
  return false;
#endif
}

}  // namespace ricochet::checking

#ifdef RICOCHET_COUNTS_ALLOCATIONS
#define RICOCHET_EXPORTED __attribute__((visibility("default")))
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t number, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

RICOCHET_EXPORTED void* malloc(std::size_t size) noexcept {
  ++count;
  return __libc_malloc(size);
}
RICOCHET_EXPORTED void* calloc(std::size_t number, std::size_t size) noexcept {
  ++count;
  return __libc_calloc(number, size);
}
RICOCHET_EXPORTED void* realloc(void* memory, std::size_t size) noexcept {
  ++count;
  return __libc_realloc(memory, size);
}
RICOCHET_EXPORTED void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  ++count;
  return __libc_memalign(alignment, size);
}
RICOCHET_EXPORTED int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  if (alignment % sizeof(void*) != 0 || (alignment & (alignment - 1)) != 0 || alignment == 0) return EINVAL;
  ++count;
  void* made = __libc_memalign(alignment, size);
  if (!made) return ENOMEM;
  *memory = made;
  return 0;
}
}
#endif
