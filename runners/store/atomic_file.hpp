#pragma once
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include "runners/store/record.hpp"

namespace ricochet {

/// The results folder cannot serve (exit code 5). The message names the path, says what was found and what was
/// expected, and what to do.
class StoreError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file written in pieces, to a temporary file of the same folder: nothing is seen of it before commit(), which
/// renames it to `file`. Destroyed without commit(), it leaves an older `file` as it was. Throws StoreError (path and
/// cause).
class FileWriter {
 public:
  explicit FileWriter(std::filesystem::path file);
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;
  void write(std::string_view content);
  void commit();

 private:
  [[noreturn]] void close_and_fail(int error);
  std::filesystem::path file_;
  std::string temporary_;
  int descriptor_ = -1;
};

/// Writes `content` to a temporary file of the same folder, then renames it to `file`. Readers see the old file or the
/// new one, never a part. Throws StoreError (path and cause) when the folder does not exist, is not writable or the
/// disk is full. The temporary file is then removed and an older `file` is left as it was.
void write_file(const std::filesystem::path& file, std::string_view content);

/// Removes the temporary files that a killed process left in `folder`. Only while the folder's lock is held.
void remove_leftovers(const std::filesystem::path& folder);

/// Throws StoreError where a file of a store, or one that SQLite keeps beside it, is a folder, a pipe, a socket or a
/// device: opening one may never end.
void check_regular(const std::filesystem::path& file);

/// Creates the folder and its parents. Throws StoreError (path and cause).
void make_folder(const std::filesystem::path& folder);

/// Cases with a curve that have each a file of their own, curves/ID.csv, at most. Where there are more, nobody opens
/// them one by one, and shared file systems suffer. Their curves are exported into one file.
inline constexpr std::size_t kMostCurveFiles = 2000;

/// Whether each case that has a curve has its file.
bool has_curve_files(const StudyResults& results);

/// Where all curves are, as the end of a sentence: "each case has its own in curves/ID.csv".
std::string where_curves_are(const StudyResults& results);

}  // namespace ricochet
