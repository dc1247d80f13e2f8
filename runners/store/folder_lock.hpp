#pragma once
#include <filesystem>
#include <string>

namespace ricochet {

/// Who runs: which process on which machine, and of which job of a scheduler.
struct RunIdentity {
  std::string host;
  int process = 0;
  std::string started;  ///< UTC
  std::string job;      ///< SLURM_JOB_ID; "" outside of Slurm
  int restart = 0;      ///< SLURM_RESTART_COUNT

  /// "process 4711 on n012, job 815 (restart 2), started 2026-05-01T12:00:00Z".
  std::string text() const;
  /// Whether this is a later start of the same job: the scheduler took the other one for lost, and started it again.
  bool succeeds(const RunIdentity& other) const;

  std::string to_json() const;
  /// What is not there stays as it is above.
  static RunIdentity from_json(const std::string& json);
};

/// Now: "2026-05-01T12:00:00Z".
std::string utc_time();

/// This process, now.
RunIdentity this_run();

/// The right to write in a results folder, for one process at a time: flock(2) on FOLDER/results.lock. The kernel gives
/// it back however the process ends. The file says who holds it and is removed at the end. A later start of the same
/// job of a scheduler does not wait for an earlier one that is still there. It puts a file of its own in its place, and
/// the store tells the earlier one (store.hpp). Throws StoreError when another process holds it (naming that process)
/// or the folder is not writable.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// Why flock() failed with `error` although nobody holds the file, and what to do.
std::string lock_failure(const std::filesystem::path& file, int error);

/// A folder made beside the one that it becomes: nothing is seen of it before commit(). Destroyed without commit(), it
/// is removed. Throws StoreError (path and cause), also where another process makes the same folder.
class FolderWriter {
 public:
  /// `folder` is not there, or empty.
  explicit FolderWriter(const std::filesystem::path& folder);
  ~FolderWriter();
  FolderWriter(const FolderWriter&) = delete;
  FolderWriter& operator=(const FolderWriter&) = delete;

  /// Where its files are written; no store is open there when it is committed.
  const std::filesystem::path& place() const { return place_; }
  void commit();

 private:
  const std::filesystem::path folder_, place_;
};

}  // namespace ricochet
