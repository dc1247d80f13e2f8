#pragma once
#include <string>
#include <vector>

/// \file
/// What a terminal shows: tables and spans of time as plain text.
namespace ricochet {

/// Characters shown, for UTF-8 text without combining marks.
std::size_t shown_width(const std::string& text);

/// Plain text in aligned columns; the last column is not padded, and empty columns are left out.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> header) : rows_{std::move(header)} {}
  /// One cell per column of the header.
  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  /// Each line starts with `indent` blanks.
  std::string text(std::size_t indent = 0) const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// A span of time in two digits or in whole seconds, never in scientific notation: "2.4 ms", "8.4 s", "42 s", "3 min 05
/// s", "2 h 10 min".
std::string duration_text(double seconds);

/// A number of bytes in two digits: "950 B", "25 kB", "1.2 GB".
std::string size_text(double bytes);

}  // namespace ricochet
