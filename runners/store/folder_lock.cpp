#include "runners/store/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <string>

#include "runners/store/store_error.hpp"

namespace ricochet {
namespace {

std::string holder(int descriptor) {
  std::array<char, 256> text{};
  const ssize_t size = ::pread(descriptor, text.data(), text.size(), 0);
  return size > 0 ? std::string(text.data(), static_cast<std::size_t>(size))
                  : std::string("a process that is starting");
}

std::string myself() {
  std::array<char, 128> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '?';
  return fmt::format("process {} on {}, started {:%Y-%m-%dT%H:%M:%SZ}", ::getpid(), host.data(),
                     fmt::gmtime(std::time(nullptr)));
}

/// The holder removes the file when it ends: a lock won on a file that is no longer the folder's own is no lock.
bool still_there(int descriptor, const std::filesystem::path& file) {
  struct stat mine {
  }, theirs{};
  return ::fstat(descriptor, &mine) == 0 && ::stat(file.c_str(), &theirs) == 0 && mine.st_ino == theirs.st_ino &&
         mine.st_dev == theirs.st_dev;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) : file_(folder / "results.lock") {
  for (;;) {
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0)
      throw StoreError(
          fmt::format("{}: the results folder is not writable: {}", folder.string(), std::strerror(errno)));
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      const int error = errno;
      const std::string who = holder(descriptor_);
      ::close(descriptor_);
      if (error != EWOULDBLOCK)
        throw StoreError(fmt::format("{}: cannot be locked: {}", file_.string(), std::strerror(error)));
      throw StoreError(
          fmt::format("{}: another run is using this folder ({}); wait for it to end or choose another "
                      "folder with --out",
                      folder.string(), who));
    }
    if (still_there(descriptor_, file_)) break;
    ::close(descriptor_);
  }
  // A message for people only: losing it (disk full) loses no safety.
  const std::string text = myself();
  if (::ftruncate(descriptor_, 0) != 0 || ::write(descriptor_, text.data(), text.size()) < 0) return;
}

FolderLock::~FolderLock() {
  ::unlink(file_.c_str());
  ::close(descriptor_);
}

}  // namespace ricochet
