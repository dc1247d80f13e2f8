#pragma once
#include <filesystem>
#include <string>

namespace ricochet {

/// A folder of this process alone in the system's folder for such files, gone with its owner. Throws StoreError (path
/// and cause) where none can be made.
class TemporaryFolder {
 public:
  /// `use`: a word of its name, ricochet-USE-….
  explicit TemporaryFolder(const std::string& use);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace ricochet
