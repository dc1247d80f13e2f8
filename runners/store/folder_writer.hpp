#pragma once
#include <filesystem>

namespace ricochet {

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
