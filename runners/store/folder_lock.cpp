#include "runners/store/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <nlohmann/json.hpp>

#include "runners/store/atomic_file.hpp"

namespace ricochet {
namespace {

/// What the holder wrote: nothing yet where it is just starting.
std::string holder_text(int descriptor) {
  std::array<char, 1024> text{};
  const ssize_t size = ::pread(descriptor, text.data(), text.size(), 0);
  return size > 0 ? std::string(text.data(), static_cast<std::size_t>(size)) : std::string();
}

/// The holder removes the file when it ends: a lock won on a file that is no longer the folder's own is no lock.
bool still_there(int descriptor, const std::filesystem::path& file) {
  struct stat mine {
  }, theirs{};
  return ::fstat(descriptor, &mine) == 0 && ::stat(file.c_str(), &theirs) == 0 && mine.st_ino == theirs.st_ino &&
         mine.st_dev == theirs.st_dev;
}

}  // namespace

std::string lock_failure(const std::filesystem::path& file, int error) {
  const std::string failure = fmt::format("{}: cannot be locked: {}", file.string(), std::strerror(error));
  if (error == ENOSYS || error == EOPNOTSUPP)
    return failure +
           "; this file system has no locks: it is to be mounted with them (of Lustre the option \"flock\", of NFS no "
           "\"nolock\"), or choose a folder on another one with --out";
  if (error == ENOLCK)
    return failure +
           "; the lock service of this file system does not answer: choose a folder on another one with --out";
  return failure;
}

FolderLock::FolderLock(const std::filesystem::path& folder) : file_(folder / "results.lock") {
  const RunIdentity me = this_run();
  for (;;) {
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0)
      throw StoreError(
          fmt::format("{}: the results folder is not writable: {}", folder.string(), std::strerror(errno)));
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      const int error = errno;
      const std::string text = holder_text(descriptor_);
      const RunIdentity holder = RunIdentity::from_json(text);
      const bool mine = still_there(descriptor_, file_);
      ::close(descriptor_);
      if (error != EWOULDBLOCK) throw StoreError(lock_failure(file_, error));
      if (!mine) continue;
      if (me.succeeds(holder)) {
        ::unlink(file_.c_str());
        continue;
      }
      throw StoreError(
          fmt::format("{}: another run is using this folder ({}); wait for it to end or choose another "
                      "folder with --out",
                      folder.string(), text.empty() ? "a process that is starting" : holder.text()));
    }
    if (still_there(descriptor_, file_)) break;
    ::close(descriptor_);
  }
  // A message for people, and for later starts of the same job: losing it (disk full) loses no safety.
  const std::string text = me.to_json() + "\n";
  if (::ftruncate(descriptor_, 0) != 0 || ::write(descriptor_, text.data(), text.size()) < 0) return;
}

FolderLock::~FolderLock() {
  if (still_there(descriptor_, file_)) ::unlink(file_.c_str());
  ::close(descriptor_);
}

namespace fs = std::filesystem;

namespace {

/// Without "." and a slash at its end: its last word is its name.
fs::path plain_path(const fs::path& folder) {
  const fs::path path = fs::absolute(folder).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

}  // namespace

FolderWriter::FolderWriter(const fs::path& folder)
    : folder_(plain_path(folder)), place_(folder_.parent_path() / ("." + folder_.filename().string() + ".merging")) {
  std::error_code error;
  if (fs::exists(place_, error)) {
    // What a killed process left, unless that one lives.
    const FolderLock lock(place_);
    fs::remove_all(place_, error);
  }
  make_folder(place_);
}

FolderWriter::~FolderWriter() {
  std::error_code ignored;
  fs::remove_all(place_, ignored);
}

void FolderWriter::commit() {
  std::error_code error;
  fs::rename(place_, folder_, error);
  if (error) throw StoreError(fmt::format("{}: cannot be made: {}", folder_.string(), error.message()));
}

std::string RunIdentity::text() const {
  const std::string where =
      job.empty() ? "" : fmt::format(", job {}{}", job, restart > 0 ? fmt::format(" (restart {})", restart) : "");
  return fmt::format("process {} on {}{}, started {}", process, host, where, started);
}

bool RunIdentity::succeeds(const RunIdentity& other) const {
  return !job.empty() && job == other.job && restart > other.restart;
}

std::string RunIdentity::to_json() const {
  const nlohmann::ordered_json all = {
      {"host", host}, {"process", process}, {"started", started}, {"job", job}, {"restart", restart}};
  return all.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

RunIdentity RunIdentity::from_json(const std::string& json) {
  RunIdentity found;
  const auto read = nlohmann::ordered_json::parse(json, nullptr, false);
  if (!read.is_object()) return found;
  found.host = read.value("host", found.host);
  found.process = read.value("process", found.process);
  found.started = read.value("started", found.started);
  found.job = read.value("job", found.job);
  found.restart = read.value("restart", found.restart);
  return found;
}

std::string utc_time() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

RunIdentity this_run() {
  RunIdentity run;
  std::array<char, 128> host{};
  run.host = ::gethostname(host.data(), host.size() - 1) == 0 ? host.data() : "?";
  run.process = ::getpid();
  run.started = utc_time();
  if (const char* job = std::getenv("SLURM_JOB_ID")) run.job = job;
  if (const char* restart = std::getenv("SLURM_RESTART_COUNT")) run.restart = std::atoi(restart);
  return run;
}

}  // namespace ricochet
