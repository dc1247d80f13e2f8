#pragma once
#include <filesystem>

namespace ricochet {

/// The right to write in a results folder, for one process at a time: flock(2) on FOLDER/results.lock, which the kernel
/// gives back however the process ends. The file says who holds it and is removed at the end. Throws StoreError when
/// another process holds it (naming that process) or the folder is not writable.
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

}  // namespace ricochet
