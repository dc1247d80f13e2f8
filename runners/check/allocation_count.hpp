#pragma once

namespace ricochet::checking {

/// Whether this program can count allocations: it stands before the C library's allocator (glibc, no sanitizer).
bool allocations_are_counted();
/// Calls of malloc and its like so far by this thread, those of plugins and of operator new among them.
long allocations_of_this_thread();

}  // namespace ricochet::checking
