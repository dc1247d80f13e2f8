#include "runners/store/folder_writer.hpp"

#include <fmt/format.h>

#include "runners/store/atomic_file.hpp"
#include "runners/store/folder_lock.hpp"
#include "runners/store/store_error.hpp"

namespace ricochet {

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

}  // namespace ricochet
