#include "runners/store/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <vector>

namespace ricochet {
namespace {

constexpr const char* kMark = ".part-";

[[noreturn]] void fail(const std::filesystem::path& file, int error) {
  if (error == ENOSPC || error == EDQUOT)
    throw StoreError(
        fmt::format("{}: the disk is full; free some space and run the same command again", file.string()));
  throw StoreError(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(error)));
}

/// Returns 0, or the errno of what went wrong.
int write_all(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

}  // namespace

FileWriter::FileWriter(std::filesystem::path file)
    : file_(std::move(file)), temporary_(file_.string() + kMark + std::to_string(::getpid())) {
  descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(file_, errno);
}

FileWriter::~FileWriter() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(temporary_.c_str());
}

void FileWriter::close_and_fail(int error) {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  ::unlink(temporary_.c_str());
  fail(file_, error);
}

void FileWriter::write(std::string_view content) {
  if (const int error = write_all(descriptor_, content); error != 0) close_and_fail(error);
}

void FileWriter::commit() {
  // No fsync: these files are derived from the store and rebuilt from it.
  const int closed = ::close(descriptor_) == 0 ? 0 : errno;
  descriptor_ = -1;
  if (closed != 0) close_and_fail(closed);
  if (std::rename(temporary_.c_str(), file_.c_str()) != 0) close_and_fail(errno);
}

void write_file(const std::filesystem::path& file, std::string_view content) {
  FileWriter writer(file);
  writer.write(content);
  writer.commit();
}

void remove_leftovers(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::vector<std::filesystem::path> leftovers;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    const std::size_t mark = name.rfind(kMark);
    if (mark == std::string::npos || mark == 0) continue;
    const std::string process = name.substr(mark + std::strlen(kMark));
    if (!process.empty() && process.find_first_not_of("0123456789") == std::string::npos)
      leftovers.push_back(entry.path());
  }
  for (const auto& leftover : leftovers) std::filesystem::remove(leftover, ignored);
}

void check_regular(const std::filesystem::path& file) {
  for (const char* suffix : {"", "-journal", "-wal", "-shm"}) {
    const std::filesystem::path one = file.string() + suffix;
    std::error_code ignored;
    if (std::filesystem::exists(one, ignored) && !std::filesystem::is_regular_file(one, ignored))
      throw StoreError(fmt::format(
          "{}: cannot be opened: it is a folder, a pipe, a socket or a device; choose another folder", one.string()));
  }
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && !std::filesystem::is_directory(folder, error) && !error)
    error = std::make_error_code(std::errc::not_a_directory);
  if (error) throw StoreError(fmt::format("{}: the folder cannot be created: {}", folder.string(), error.message()));
}

bool has_curve_files(const StudyResults& results) {
  const auto curves = std::count_if(results.cases.begin(), results.cases.end(),
                                    [](const CaseRecord& record) { return !record.curve.names.empty(); });
  return static_cast<std::size_t>(curves) <= kMostCurveFiles;
}

std::string where_curves_are(const StudyResults& results) {
  return has_curve_files(results) ? "each case has its own in curves/ID.csv"
                                  : "cases are too many for a file each, all curves are in the store: `ricochet export "
                                    "DIR --to CSVDIR --curves` writes them into one curves.csv";
}

}  // namespace ricochet
