#include "runners/workers/call_watch.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <ricochet/loader/child.hpp>

#include "runners/march/prepare_case.hpp"
#include "runners/march/seconds.hpp"

namespace ricochet {
namespace {

[[noreturn]] void fail() {
  throw RunError(fmt::format("no worker process can be started: memory to share: {}", std::strerror(errno)));
}

CallNote* mapped(int descriptor) {
  void* const memory = ::mmap(nullptr, sizeof(CallNote), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  return memory == MAP_FAILED ? nullptr : static_cast<CallNote*>(memory);
}

}  // namespace

NoteFile::NoteFile(int least) : descriptor_(::memfd_create("ricochet-note", MFD_CLOEXEC | MFD_ALLOW_SEALING)) {
  if (descriptor_ >= 0) descriptor_ = duplicated_from(least, descriptor_);
  if (descriptor_ < 0) fail();
  if (::ftruncate(descriptor_, sizeof(CallNote)) == 0 &&
      ::fcntl(descriptor_, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) == 0)
    note_ = mapped(descriptor_);
  if (!note_) {
    const int error = errno;
    ::close(descriptor_);
    errno = error;
    fail();
  }
  new (note_) CallNote;
}

NoteFile::~NoteFile() {
  ::munmap(note_, sizeof(CallNote));
  ::close(descriptor_);
}

CallNote* take_note(int descriptor) {
  CallNote* const note = mapped(descriptor);
  if (!note) fail();
  ::close(descriptor);
  return note;
}

CallWatch::CallWatch(const CallNote& note) : note_(note) {
  ::pthread_getcpuclockid(::pthread_self(), &clock_);
}

double CallWatch::processor_seconds() const {
  timespec now{};
  ::clock_gettime(clock_, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::optional<LongCall> CallWatch::overdue() {
  constexpr double asleep_share = 0.1;  // of the time that passes counts for a thread that only waits
  const SeenCall seen = note_.seen();
  if (seen.serial != serial_) {
    serial_ = seen.serial;
    seen_ = std::chrono::steady_clock::now();
    processor_then_ = processor_seconds();
  }
  if (serial_ == 0) return std::nullopt;
  LongCall call{seen.plugin.role, seen.plugin.text(), seen.function, seconds_since(seen_), 0};
  call.counted_seconds = std::max(processor_seconds() - processor_then_, asleep_share * call.seconds);
  return call;
}

std::string LongCall::text() const {
  return fmt::format("plugin {}, {}() has not returned for {:.0f} s", plugin, function, seconds);
}

}  // namespace ricochet
