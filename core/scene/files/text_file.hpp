#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// Text files of numbers that a study names. Nothing here prints, and nothing depends on a locale.
namespace ricochet {

/// What is wrong with a file: "K.mtx, line 7: row 99 of a matrix of 98".
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The lines of a text: line ends LF or CRLF, a byte order mark before the first is left out. `content` must outlive
/// it. A line is at most 64 KiB, longer ones throw FileError.
class TextLines {
 public:
  TextLines(std::string_view content, std::string name);
  /// The next line without its end; nothing after the last.
  std::optional<std::string_view> next();
  /// Number of the line that next() gave, from 1.
  long line() const { return line_; }
  /// Bytes that follow that line.
  std::size_t left() const { return content_.size(); }
  const std::string& name() const { return name_; }
  /// Throws FileError: "NAME, line N: what".
  [[noreturn]] void fail(const std::string& what) const;
  /// The same of another line.
  [[noreturn]] void fail_at(long line, const std::string& what) const;

 private:
  std::string_view content_;
  std::string name_;
  long line_ = 0;
};

/// Words of a line, separated by spaces and tabs.
std::vector<std::string_view> words_of(std::string_view line);
/// Text without spaces and tabs at its ends.
std::string_view trimmed(std::string_view text);

/// A number as std::from_chars reads it, a + before it allowed; nothing where the text is no finite number.
std::optional<double> finite_number(std::string_view text);
/// A whole number from 0; nothing where the text is none.
std::optional<long long> whole_number(std::string_view text);

/// Content of `folder`/`name`. Throws FileError where it is missing (with the nearest name of the folder), is no file,
/// is larger than the limit (2 GiB, or RICOCHET_FILE_LIMIT bytes) or cannot be read.
std::string read_file(const std::filesystem::path& folder, const std::string& name);

/// 32 hexadecimal digits that tell contents apart (SHA-1, of which 122 bits are kept).
std::string file_digest(std::string_view content);

}  // namespace ricochet
